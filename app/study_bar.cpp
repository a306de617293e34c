#include "app/study_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/number_format.h"
#include "studies/rre/rre.h"

namespace retrace::app {
namespace {

bool has_tracing(const studies::Study& study, std::string_view kind) {
  return std::ranges::any_of(study.quantities,
                             [&](const auto& quantity) { return quantity->tracing().starts_with(kind); });
}

/// Returns advice on the keys of [analysis] that shorten the computation of one point.
Words to_shorten_point(const studies::Study& study) {
  const schema::Document& document = *study.document;
  const bool has_rre = has_tracing(study, "rre");
  const bool has_photometry = has_tracing(study, "photometry");
  Words advice;
  if (!has_rre && !has_photometry) return advice;
  if (const auto samples = document.number_if("analysis.samples")) {
    advice.push_back(fmt::format("give a smaller analysis.samples (now {:.0f})", *samples));
  } else if (has_rre) {
    const double error = document.number_if("analysis.target_error").value_or(studies::kDefaultTargetError);
    advice.push_back(fmt::format("give a larger analysis.target_error (now {})", shortest(error)));
  }
  if (has_photometry) {
    const auto cutoff = document.number_if("analysis.cutoff");
    advice.push_back(cutoff ? fmt::format("give a larger analysis.cutoff (now {})", shortest(*cutoff))
                            : "give an analysis.cutoff larger than its default");
  }
  return advice;
}

}  // namespace

Words to_shorten_study(const studies::Study& study, const std::string& fewer_points) {
  Words advice = to_shorten_point(study);
  if (!fewer_points.empty()) advice.push_back(fewer_points);
  return advice;
}

SearchBar::SearchBar(RunText text, std::string of, const CommonOptions& common)
    : bar_(std::move(text), common), of_(std::move(of)) {}

void SearchBar::at(std::uint64_t done, std::uint64_t total, std::uint64_t) {
  if (first_group_ == 0 && total > 0) bar_.begin_group(static_cast<double>(done) / static_cast<double>(total));
  first_group_ = total;
  at(static_cast<std::size_t>(done));
}

void SearchBar::at_fraction(double fraction) {
  at_group(fraction, first_group_);
}

void SearchBar::at(std::size_t evaluated) {
  bar_.count(fmt::format("{} {} evaluated{}", evaluated, of_, best_.empty() ? "" : ", best so far: " + best_));
  write_best();
}

void SearchBar::on_best(std::function<std::string(const studies::Variant&)> text,
                        std::function<void(const studies::Variant&)> action) {
  text_of_best_ = std::move(text);
  at_best_ = std::move(action);
}

void SearchBar::at_best(const studies::Variant& best) {
  if (text_of_best_) best_ = text_of_best_(best);
  is_new_ = !best_.empty();
  write_best();
  if (at_best_) at_best_(best);
}

void SearchBar::write_best() {
  // Short runs print no lines, because their results follow soon.
  const auto now = std::chrono::steady_clock::now();
  if (!is_new_ || now - last_line_ <= kTimeBetweenLines) return;
  bar_.write_lines("best so far: " + best_ + "\n");
  last_line_ = now;
  is_new_ = false;
}

void SearchBar::at_group(double fraction, std::size_t designs) {
  if (fraction == 0.0) bar_.begin_group(0.0);
  bar_.at_group(fraction, fmt::format("computing the next {} {}", designs, of_));
}

}  // namespace retrace::app

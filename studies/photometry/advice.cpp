#include "studies/photometry/advice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/schema/writer.h"
#include "design/io/design_reader.h"
#include "studies/rre/derivatives.h"

namespace retrace::studies {
namespace {

constexpr std::size_t kSearchParts = 1;
// Changes of the angles between facets that are tried, in minutes of arc.
constexpr std::array<double, 14> kAngleSteps = {0.5,  -0.5, 1.0,  -1.0, 1.5,  -1.5, 2.0,
                                                -2.0, 3.0,  -3.0, 4.5,  -4.5, 7.0,  -7.0};
// Factors of the element size that are tried.
constexpr std::array<double, 8> kSizeFactors = {0.7, 1.4, 0.5, 2.0, 0.35, 2.8, 0.25, 4.0};
constexpr int kBisections = 4;
// Maximum number of tables of readings that are measured. For each of the two parameters, these are the tables of all
// tried values, of the bisections, and of the returned change.
constexpr double kMaxTables = kAngleSteps.size() + kSizeFactors.size() + 2.0 * (kBisections + 1);
// Minimum ratio of a reading to its limit that counts as passing during the search. It is above 1 because the search
// uses few wavelengths and is therefore less accurate.
constexpr double kEnough = 1.01;
constexpr double kMaxErrorArcmin = 300.0;
constexpr double kNothingMade = -1.0;  // result of ratio_at() if the part cannot be made
constexpr double kWholeTable = -std::numeric_limits<double>::infinity();

/// Parameter of the design that is varied, with its start value and the values that are tried.
struct VariedParameter {
  std::string key;
  double from = 0.0;
  std::vector<double> tries;
  std::function<design::Design(double)> with;
};

VariedParameter angle_knob(const design::Design& design) {
  const std::string key = keys_of(RreParameter::dihedral_error_deg, design).front();
  const auto& errors = design.part().angle_errors.dihedral_error_arcmin;
  const bool is_prism = std::holds_alternative<geometry::RtpElement>(design.part().element);
  VariedParameter knob{key, is_prism ? errors[0] : (errors[0] + errors[1] + errors[2]) / 3.0, {}, {}};
  for (const double step : kAngleSteps)
    if (std::abs(knob.from + step) <= kMaxErrorArcmin) knob.tries.push_back(knob.from + step);
  knob.with = [design, key](double value) {
    return design::with(design, std::vector{schema::override_text(key, value)});
  };
  return knob;
}

VariedParameter size_knob(const design::Design& design) {
  constexpr RreParameter size = RreParameter::size_mm;
  VariedParameter knob{keys_of(size, design).front(), value_of(design, size), {}, {}};
  for (const double factor : kSizeFactors) knob.tries.push_back(factor * knob.from);
  knob.with = [design](double value) { return with(design, size, value); };
  return knob;
}

class Search {
 public:
  Search(const VariedParameter& knob, const TestPlan& test_plan, const TableOfDesign& table)
      : knob_(knob), test_plan_(test_plan), table_(table) {}

  /// Searches for the smallest change that makes the design pass. If no change does, keeps the change with the best
  /// ratio. A ratio is the minimum, over all readings, of a reading divided by its limit.
  /// \param than minimum ratio; changes whose ratio is not above it are ignored
  /// \return best ratio of the tried changes, or `than` if no ratio is above it
  double run(double than) {
    double best_ratio = than;
    for (const double value : knob_.tries) {
      const double ratio = ratio_at(value, best_ratio);
      if (is_cancelled_) break;
      if (ratio > best_ratio) {
        best_ = value;
        best_ratio = ratio;
      }
      if (ratio < kEnough) continue;
      best_ = nearest_that_passes(value);
      break;
    }
    return best_ratio;
  }

  /// Returns the change that run() has found, with its value rounded to three digits and its readings at all
  /// wavelengths. Returns nothing if the computation was cancelled.
  std::optional<PhotometricChange> told() const {
    const double change = best_ - knob_.from;
    const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(std::abs(change))));
    PhotometricChange found;
    found.key = knob_.key;
    found.from = knob_.from;
    found.to = std::round((knob_.from + change) * scale) / scale;
    const auto points = table_(knob_.with(found.to), materials::kSpectralParts, kWholeTable);
    if (!points) return std::nullopt;
    found.points = *points;
    found.verdict = verdict_of(found.points, test_plan_);
    return found;
  }

  bool is_cancelled() const { return is_cancelled_; }

 private:
  /// Returns the minimum, over all readings, of a reading divided by its limit. If this minimum is below `enough`, the
  /// result may be any value below `enough`. Returns kNothingMade if the part cannot be made or the search was
  /// cancelled.
  double ratio_at(double value, double enough) {
    if (is_cancelled_) return kNothingMade;
    try {
      const auto points = table_(knob_.with(value), kSearchParts, enough);
      is_cancelled_ = !points;
      return points ? min_ratio(*points) : kNothingMade;
    } catch (const InputError&) {
      return kNothingMade;
    }
  }

  double nearest_that_passes(double passing) {
    double failing = knob_.from;
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (failing + passing);
      (ratio_at(middle, kEnough) >= kEnough ? passing : failing) = middle;
    }
    return passing;
  }

  const VariedParameter& knob_;
  const TestPlan& test_plan_;
  const TableOfDesign& table_;
  double best_ = knob_.from;
  bool is_cancelled_ = false;
};

}  // namespace

double min_ratio(const std::vector<PhotometricPoint>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const PhotometricPoint& point : points) {
    const double most = point.verdict() == Verdict::undetermined ? 1.0 : least;
    least = std::min({least, most, 1.0 + point.margin()});
  }
  return least;
}

std::optional<PhotometricChange> change_that_passes(const design::Design& design, const TestPlan& test_plan,
                                                    const TableOfDesign& table, Progress* progress) {
  // Ruled cells have many angles and spacings, and no single one of them is varied.
  if (std::holds_alternative<geometry::RuledCells>(design.part().element)) return std::nullopt;
  double measured = 0.0;
  const TableOfDesign counted = [&](const design::Design& changed, std::size_t parts, double enough) {
    auto points = table(changed, parts, enough);
    if (progress != nullptr) progress->at(++measured / kMaxTables);
    return points;
  };
  const std::array<VariedParameter, 2> knobs = {angle_knob(design), size_knob(design)};
  std::optional<Search> best;
  std::optional<PhotometricChange> told;
  double best_ratio = kNothingMade;
  for (const VariedParameter& knob : knobs) {
    Search search(knob, test_plan, counted);
    const double ratio = search.run(best_ratio);
    if (search.is_cancelled()) return std::nullopt;
    if (ratio <= best_ratio) continue;
    best.emplace(search);
    best_ratio = ratio;
    told.reset();
    if (ratio < kEnough) continue;
    told = search.told();
    if (!told || told->passes()) return told;
    best_ratio = min_ratio(told->points);
  }
  if (best && !told) told = best->told();
  return told;
}

}  // namespace retrace::studies

#include "studies/validation/io/validation_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kIntroduction =
    "# Validation\n"
    "\n"
    "This page compares results of retrace with published values, closed forms and independent computations. `retrace "
    "validate` computes the\n"
    "results and writes this page. [docs/theory](theory/README.md) contains the full titles of the publications.\n"
    "\n"
    "- *published*: printed in a publication. *closed form*: a formula of the theory, evaluated separately from the "
    "code under test.\n"
    "  *independent*: computed by a program or formula that has nothing in common with retrace.\n"
    "- A difference is the result of retrace minus the expected value. 0 means less than a hundredth of the allowed "
    "difference. A difference\n"
    "  that is not allowed is printed in bold, and the command ends with exit code 1.\n"
    "- Rows without an allowed difference have a published value that retrace does not reproduce.\n";

/// Published values that are not compared, and the reasons.
constexpr const char* kLeftOut =
    "\n"
    "## Published values that are not compared\n"
    "\n"
    "- Ratio of the luminance of prisms to that of cube corners, 5.6 : 10 (Milliken 2017, 3.3.3): the observation "
    "angle of the fixture and the\n"
    "  period of the waviness are not published, and the ratio depends on both "
    "([theory/photometry.md](theory/photometry.md)).\n"
    "- 7.2 and 8.2 seconds per block of a planed lens (Bulatov et al.): focal length, wavelength, feed and tolerance "
    "are not published\n"
    "  ([theory/planing.md](theory/planing.md)).\n";

/// Returns the number of decimals with which a hundredth of the allowed difference is visible, but at most 9.
int decimals_of(double allowed) {
  return std::clamp(static_cast<int>(std::ceil(1.0 - std::log10(allowed) - 1e-9)), 0, 9);
}

/// Returns a number with enough decimals to show differences of the row's allowed size.
std::string value_text(const ValidationRow& row, double value) {
  if (!row.allowed) return fixed(value, 2);
  return *row.allowed > 0.0 ? fixed(value, decimals_of(*row.allowed)) : shortest(value);
}

/// Returns the expected value as text. Published values have the digits of the publication.
std::string expected_text(const ValidationRow& row) {
  constexpr std::size_t kPrinted = 15;  // maximum length of a printed value; longer values were computed from a formula
  const std::string text = shortest(row.expected);
  return row.reference == Reference::closed_form || text.size() > kPrinted ? value_text(row, row.expected) : text;
}

std::string difference_text(const ValidatedRow& validated) {
  const double difference = validated.difference();
  const std::optional<double>& allowed = validated.row.allowed;
  if (!std::isfinite(difference)) return "**no number**";
  if (!allowed) return fixed(difference, 2);
  if (std::abs(difference) <= 0.01 * *allowed) return "0";
  const std::string text = *allowed < 1e-4 ? fmt::format("{:.0e}", difference) : value_text(validated.row, difference);
  return *validated.holds() ? text : "**" + text + "**";
}

std::string reference_text(Reference reference) {
  std::string text(kReferenceWords[static_cast<std::size_t>(reference)]);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string line_of(const ValidatedRow& validated) {
  const ValidationRow& row = validated.row;
  return fmt::format("| {}{} | {} | {} | {} | {} | {} | {} | {} |\n", row.quantity,
                     row.unit.empty() ? "" : " (" + row.unit + ")", expected_text(row),
                     std::isfinite(validated.computed) ? value_text(row, validated.computed) : "-",
                     difference_text(validated), row.allowed ? fmt::format("{:.2g}", *row.allowed) : "-", row.why,
                     reference_text(row.reference), row.source);
}

}  // namespace

std::string validation_markdown(const ValidationResult& result) {
  std::string text = kIntroduction;
  std::string topic;
  for (const ValidatedRow& validated : result.rows) {
    if (validated.row.topic != topic) {
      topic = validated.row.topic;
      text += fmt::format(
          "\n"
          "## {}\n"
          "\n"
          "| quantity | expected | retrace | difference | allowed | reason | reference | source |\n"
          "|---|---|---|---|---|---|---|---|\n",
          topic);
    }
    text += line_of(validated);
  }
  if (!result.complete) text += fmt::format("\nInterrupted: {} of {} figures.\n", result.rows.size(), result.requested);
  return text + kLeftOut;
}

std::string validation_json(const ValidationResult& result) {
  Json rows = Json::array();
  for (const ValidatedRow& validated : result.rows) {
    const ValidationRow& row = validated.row;
    Json json = {{"topic", row.topic},
                 {"quantity", row.quantity},
                 {"unit", row.unit},
                 {"reference", kReferenceWords[static_cast<std::size_t>(row.reference)]},
                 {"source", row.source},
                 {"expected", row.expected},
                 {"computed", validated.computed},
                 {"difference", validated.difference()}};
    if (row.allowed) json["allowed"] = *row.allowed;
    json["why"] = row.why;
    if (const std::optional<bool> holds = validated.holds()) json["holds"] = *holds;
    rows.push_back(std::move(json));
  }
  return result_text("retrace.validation/1",
                     {{"verdict", result.holds() ? "pass" : "fail"},
                      {"figures", result.requested},
                      {"rows", std::move(rows)},
                      {"elapsed_s", result.elapsed_s}},
                     validation_warnings(result), result.complete);
}

Warnings validation_warnings(const ValidationResult& result) {
  Warnings warnings;
  for (const ValidatedRow& validated : result.rows)
    if (!validated.holds().value_or(true))
      warnings.push_back(
          {"not_validated",
           fmt::format("{}: {}: must be {} within {}, is {}", validated.row.topic, validated.row.quantity,
                       shortest(validated.row.expected), shortest(*validated.row.allowed),
                       std::isfinite(validated.computed) ? shortest(validated.computed) : "no number")});
  return warnings;
}

}  // namespace retrace::studies

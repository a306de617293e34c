#include "studies/photometry/io/limits_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"

namespace retrace::studies {
namespace {

constexpr std::size_t kMaxRows = 10000;
constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr double kMaxObservationDeg = 20.0;
constexpr double kMaxEntranceDeg = 85.0;
constexpr double kMaxFactor = 1e3;
constexpr double kMaxBoundCm2 = 1e6;
constexpr double kMaxColourCoefficient = 10.0;
constexpr NumberRange kLimit{.low = 0.0, .low_included = false, .high = 1e9};

enum Column : std::size_t {
  kStandard,
  kClass,
  kColour,
  kObservation,
  kV,
  kH,
  kMinimum,
  kUnit,
  kStatus,
  kSource,  // the only column that may be missing
  kColumns,
};
constexpr std::array<std::string_view, kColumns> kHeader = {
    "standard", "class", "colour", "observation_deg", "v_deg", "h_deg", "minimum", "unit", "status", "source"};
constexpr std::array<std::string_view, 7> kUnits = {"mcd/lx", "cd/lx", "cd/fc",       "cd/lx/m2",
                                                    "factor", "cm2",   "chromaticity"};
constexpr std::array<std::string_view, 4> kStatuses = {"confirmed", "read", "recalled", "incomplete"};

/// Returns the number in a text, or both signs of it for a text such as `+-10`.
std::vector<double> signed_numbers(const CsvReader& row, Column column, std::string_view text) {
  const bool both = text.starts_with("+-");
  if (both) text.remove_prefix(2);
  const std::optional<double> value = number_in(text);
  if (!value || !(std::abs(*value) <= kMaxEntranceDeg) || (both && !(*value > 0.0)))
    row.fail(
        column,
        fmt::format(
            "must be a number from -{0} to {0}, or +- and a number above 0 for both signs, as in \"+-10\"{1}, got {2}",
            shortest(kMaxEntranceDeg), column == kV ? ", or two such angles, as in \"0 or +-5\"" : "",
            in_quotes(row[column])));
  if (both) return {*value, -*value};
  return {*value};
}

/// Angle V of a test point, and the angles that replace it if the face reflects the lamp directly to the receiver at V.
/// Example: `0 or +-5`.
struct V {
  std::vector<double> deg;
  std::vector<double> beside_deg;
};

V read_v(const CsvReader& row) {
  const std::vector<std::string_view> words = split(row[kV], ' ');
  const bool has_beside = words.size() == 3 && words[1] == "or";
  V v{signed_numbers(row, kV, has_beside ? words[0] : row[kV]), {}};
  if (has_beside) v.beside_deg = signed_numbers(row, kV, words[2]);
  return v;
}

void must_be_empty(const CsvReader& row, std::initializer_list<Column> columns, std::string_view when) {
  for (const Column column : columns)
    if (!row[column].empty()) row.fail(column, fmt::format("must be empty {}, got {}", when, in_quotes(row[column])));
}

std::string named(const CsvReader& row, Column column) {
  if (row[column].empty()) row.fail(column, fmt::format("must be the name of a {}, got \"\"", kHeader[column]));
  return printable(row[column]);
}

/// Returns a row in which only the members are set that all kinds of lines have: standard, line number and classes.
template <class Row>
Row begun(const CsvReader& row) {
  Row result;
  result.standard = named(row, kStandard);
  result.line = row.line();
  for (const std::string_view name : split(row[kClass], ' '))
    if (!name.empty()) result.classes.push_back(printable(name));
  return result;
}

LimitRow limit_of(const CsvReader& row) {
  auto limit = begun<LimitRow>(row);
  limit.colour = named(row, kColour);
  limit.observation_deg = row.number(kObservation, {.low = 0.0, .high = kMaxObservationDeg});
  V v = read_v(row);
  limit.v_deg = std::move(v.deg);
  limit.substitute_v_deg = std::move(v.beside_deg);
  limit.h_deg = signed_numbers(row, kH, row[kH]);
  limit.minimum = row.number(kMinimum, kLimit);
  limit.unit = static_cast<PhotometricUnit>(row.one_of(kUnit, kUnits));
  limit.status = static_cast<LimitStatus>(row.one_of(kStatus, kStatuses));
  return limit;
}

LimitFactor factor_of(const CsvReader& row) {
  auto factor = begun<LimitFactor>(row);
  factor.colour = named(row, kColour);
  must_be_empty(row, {kObservation, kV, kH}, "for a factor");
  const std::vector<std::string_view> words = split(row[kMinimum], ' ');
  const std::optional<double> times = number_in(words.front());
  if (words.size() != 3 || words[1] != "x" || words[2].empty() || !times || !(*times > 0.0 && *times <= kMaxFactor))
    row.fail(kMinimum, fmt::format("must have the form \"FACTOR x COLOUR\" with a factor above 0 and at most {}, such "
                                   "as \"2.5 x red\", got {}",
                                   shortest(kMaxFactor), in_quotes(row[kMinimum])));
  factor.factor = *times;
  factor.reference_colour = printable(words[2]);
  factor.status = static_cast<LimitStatus>(row.one_of(kStatus, kStatuses));
  return factor;
}

LimitArea area_of(const CsvReader& row) {
  auto area = begun<LimitArea>(row);
  area.colour = printable(row[kColour]);
  must_be_empty(row, {kObservation, kV, kH}, "for an area");
  const std::vector<std::string_view> words = split(row[kMinimum], ' ');
  const bool is_begun = words.size() == 3 && words[0] == "at" && (words[1] == "most" || words[1] == "least");
  const std::optional<double> cm2 = is_begun ? number_in(words[2]) : std::nullopt;
  if (!cm2 || !(*cm2 > 0.0 && *cm2 <= kMaxBoundCm2))
    row.fail(kMinimum,
             fmt::format("must be \"at most\" or \"at least\", followed by a number above 0 and at most {}, got {}",
                         shortest(kMaxBoundCm2), in_quotes(row[kMinimum])));
  area.is_maximum = words[1] == "most";
  area.area_cm2 = *cm2;
  area.status = static_cast<LimitStatus>(row.one_of(kStatus, kStatuses));
  return area;
}

/// Reads a boundary line in the x-y plane, such as `y <= 0.335`, `z <= 0.008` or `y >= 0.146 + 0.489 x`.
void read_boundary(const CsvReader& row, ColourBoundary& boundary) {
  const std::vector<std::string_view> words = split(row[kMinimum], ' ');
  const auto word = [&](std::size_t k) { return k < words.size() ? words[k] : std::string_view(); };
  const bool is_sloping = words.size() == 6 && (word(3) == "+" || word(3) == "-") && word(5) == "x";
  const std::optional<double> constant = number_in(word(2));
  const std::optional<double> slope = is_sloping ? number_in(word(4)) : std::optional(0.0);
  const bool is_one = (word(0) == "x" || word(0) == "y" || word(0) == "z") && (word(1) == "<=" || word(1) == ">=") &&
                      (words.size() == 3 || is_sloping);
  if (!is_one || !constant || !slope || !(std::abs(*constant) <= kMaxColourCoefficient) ||
      !(std::abs(*slope) <= kMaxColourCoefficient))
    row.fail(kMinimum, fmt::format("must be a boundary in the chromaticity coordinates x, y or z, such as \"z <= "
                                   "0.008\" or \"y >= 0.146 + 0.489 x\", with numbers from -{0} to {0}, got {1}",
                                   shortest(kMaxColourCoefficient), in_quotes(row[kMinimum])));
  // Moves all terms to the left side and replaces z by 1 - x - y.
  const bool is_z = word(0) == "z";
  const double of_x = (word(0) == "x" ? 1.0 : is_z ? -1.0 : 0.0) - (word(3) == "-" ? -*slope : *slope);
  const double of_y = word(0) == "y" ? 1.0 : is_z ? -1.0 : 0.0;
  const double most = *constant - (is_z ? 1.0 : 0.0);
  if (of_x == 0.0 && of_y == 0.0)
    row.fail(kMinimum, "must be a boundary of the colour in x, y or z, but x cancels out in this expression, got " +
                           in_quotes(row[kMinimum]));
  const double sign = word(1) == "<=" ? 1.0 : -1.0;
  boundary.x_coefficient = sign * of_x;
  boundary.y_coefficient = sign * of_y;
  boundary.limit = sign * most;
  boundary.text = printable(row[kMinimum]);
}

ColourBoundary boundary_of(const CsvReader& row) {
  auto boundary = begun<ColourBoundary>(row);
  boundary.colour = named(row, kColour);
  boundary.observation_deg = row.number(kObservation, {.low = 0.0, .high = kMaxObservationDeg});
  const V v = read_v(row);
  const std::vector<double> h_deg = signed_numbers(row, kH, row[kH]);
  if (v.deg.size() != 1 || h_deg.size() != 1)
    row.fail(v.deg.size() != 1 ? kV : kH, "must be a single angle for a colour limit, but +- gives two angles");
  boundary.v_deg = v.deg.front();
  boundary.substitute_v_deg = v.beside_deg;
  boundary.h_deg = h_deg.front();
  read_boundary(row, boundary);
  boundary.status = static_cast<LimitStatus>(row.one_of(kStatus, kStatuses));
  return boundary;
}

LimitGap gap_of(const CsvReader& row) {
  auto gap = begun<LimitGap>(row);
  gap.colour = printable(row[kColour]);
  must_be_empty(row, {kObservation, kV, kH, kMinimum, kUnit}, "if the status is incomplete");
  return gap;
}

/// Returns true if the last column in the line of column names is the source.
bool names_source(std::string_view content) {
  for (const std::string_view line : split(content, '\n'))
    if (!trimmed(line).empty() && trimmed(line).front() != '#') return trimmed(line).ends_with(kHeader[kSource]);
  return false;
}

/// Sets the member `source` of a line of the limits file from the column of this name. It stays empty if the file does
/// not have this column.
template <class Line>
Line with_source(Line line, const CsvReader& row, bool has_source) {
  if (has_source) line.source = printable(row[kSource], std::string::npos);
  return line;
}

}  // namespace

LimitTable parse_limits(std::string_view content, const std::string& name) {
  LimitTable table;
  table.source = name;
  const bool has_source = names_source(content);
  CsvReader row(content, name, kMaxBytes, std::span(kHeader).first(has_source ? kColumns : kSource));
  while (row.next()) {
    if (row.rows() > kMaxRows) row.fail(fmt::format("at most {} limits are allowed", kMaxRows));
    if (kStatuses[row.one_of(kStatus, kStatuses)] == "incomplete")
      table.gaps.push_back(with_source(gap_of(row), row, has_source));
    else if (const std::string_view unit = kUnits[row.one_of(kUnit, kUnits)]; unit == "factor")
      table.factors.push_back(with_source(factor_of(row), row, has_source));
    else if (unit == "cm2")
      table.areas.push_back(with_source(area_of(row), row, has_source));
    else if (unit == "chromaticity")
      table.boundaries.push_back(with_source(boundary_of(row), row, has_source));
    else
      table.rows.push_back(with_source(limit_of(row), row, has_source));
  }
  if (table.rows.empty()) row.fail("the table must have one line for each limit");
  return table;
}

LimitTable read_limits(const std::filesystem::path& file) {
  return parse_limits(read_file(file, kMaxBytes), file.string());
}

}  // namespace retrace::studies

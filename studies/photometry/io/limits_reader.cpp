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

constexpr std::size_t kMostRows = 10000;
constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr double kMostObservationDeg = 20.0;
constexpr double kMostEntranceDeg = 85.0;
constexpr double kMostFactor = 1e3;
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
  kColumns,
};
constexpr std::array<std::string_view, kColumns> kHeader = {"standard", "class",   "colour", "observation_deg", "v_deg",
                                                            "h_deg",    "minimum", "unit",   "status"};
constexpr std::array<std::string_view, 5> kUnits = {"mcd/lx", "cd/lx", "cd/fc", "cd/lx/m2", "factor"};
constexpr std::array<std::string_view, 4> kStatuses = {"confirmed", "read", "recalled", "incomplete"};

/// A number, or both signs of it.
std::vector<double> signed_numbers(const CsvReader& row, Column column) {
  std::string_view text = row[column];
  const bool both = text.starts_with("+-");
  if (both) text.remove_prefix(2);
  const std::optional<double> value = number_in(text);
  if (!value || !(std::abs(*value) <= kMostEntranceDeg) || (both && !(*value > 0.0)))
    row.fail(column, fmt::format("must be a number from -{0} to {0}, or +- and a number above 0, got {1}",
                                 shortest(kMostEntranceDeg), in_quotes(row[column])));
  if (both) return {*value, -*value};
  return {*value};
}

void must_be_empty(const CsvReader& row, std::initializer_list<Column> columns, std::string_view when) {
  for (const Column column : columns)
    if (!row[column].empty()) row.fail(column, fmt::format("must be empty {}, got {}", when, in_quotes(row[column])));
}

std::string named(const CsvReader& row, Column column) {
  if (row[column].empty()) row.fail(column, fmt::format("must name a {}, got \"\"", kHeader[column]));
  return printable(row[column]);
}

/// What rows of every kind begin with.
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
  limit.observation_deg = row.number(kObservation, {.low = 0.0, .high = kMostObservationDeg});
  limit.v_deg = signed_numbers(row, kV);
  limit.h_deg = signed_numbers(row, kH);
  limit.minimum = row.number(kMinimum, kLimit);
  limit.unit = static_cast<PhotometricUnit>(row.one_of(kUnit, kUnits));
  limit.status = static_cast<LimitStatus>(row.one_of(kStatus, kStatuses));
  return limit;
}

LimitFactor factor_of(const CsvReader& row) {
  auto factor = begun<LimitFactor>(row);
  factor.colour = named(row, kColour);
  must_be_empty(row, {kObservation, kV, kH}, "of a factor");
  const std::vector<std::string_view> words = split(row[kMinimum], ' ');
  const std::optional<double> times = number_in(words.front());
  if (words.size() != 3 || words[1] != "x" || words[2].empty() || !times || !(*times > 0.0 && *times <= kMostFactor))
    row.fail(kMinimum, fmt::format("must be a number above 0, to {}, x and a colour, as in \"2.5 x red\", got {}",
                                   shortest(kMostFactor), in_quotes(row[kMinimum])));
  factor.factor = *times;
  factor.of_colour = printable(words[2]);
  factor.status = static_cast<LimitStatus>(row.one_of(kStatus, kStatuses));
  return factor;
}

LimitGap gap_of(const CsvReader& row) {
  auto gap = begun<LimitGap>(row);
  gap.colour = printable(row[kColour]);
  must_be_empty(row, {kObservation, kV, kH, kMinimum, kUnit}, "where the status is incomplete");
  return gap;
}

}  // namespace

LimitTable parse_limits(std::string_view content, const std::string& name) {
  LimitTable table;
  table.source = name;
  CsvReader row(content, name, kMostBytes, kHeader);
  while (row.next()) {
    if (row.rows() > kMostRows) row.fail(fmt::format("at most {} limits are allowed", kMostRows));
    if (kStatuses[row.one_of(kStatus, kStatuses)] == "incomplete")
      table.gaps.push_back(gap_of(row));
    else if (kUnits[row.one_of(kUnit, kUnits)] == "factor")
      table.factors.push_back(factor_of(row));
    else
      table.rows.push_back(limit_of(row));
  }
  if (table.rows.empty()) row.fail("must have one line for each limit");
  return table;
}

LimitTable read_limits(const std::filesystem::path& file) {
  return parse_limits(read_file(file, kMostBytes), file.string());
}

}  // namespace retrace::studies

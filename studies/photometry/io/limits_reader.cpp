#include "studies/photometry/io/limits_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

constexpr std::size_t kMostRows = 10000;
constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr double kMostObservationDeg = 20.0;
constexpr double kMostEntranceDeg = 85.0;
constexpr double kMostLimit = 1e9;

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

using Fields = std::array<std::string_view, kColumns>;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

class Reader {
 public:
  explicit Reader(const std::string& name) { table_.source = name; }

  LimitTable read(std::string_view content) {
    require_short_text(content, table_.source, kMostBytes);
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
    for (std::size_t begin = 0; begin < content.size();) {
      const std::size_t end = std::min(content.find('\n', begin), content.size());
      ++line_;
      take(trimmed(content.substr(begin, end - begin)));
      begin = end + 1;
    }
    line_ = 0;
    if (table_.rows.empty())
      fail({}, fmt::format("must have the header {} and one line for each limit", fmt::join(kHeader, ",")));
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(std::string_view column, std::string_view text) const {
    throw InputError({printable(table_.source, std::string::npos), line_, std::string(column)}, text);
  }

  void take(std::string_view line) {
    if (line.empty() || line.starts_with('#')) return;
    const std::vector<std::string_view> parts = split(line, ',');
    if (!has_header_) {
      if (!std::equal(parts.begin(), parts.end(), kHeader.begin(), kHeader.end()))
        fail({}, fmt::format("must be the header {}, got {}", fmt::join(kHeader, ","), in_quotes(line)));
      has_header_ = true;
      return;
    }
    if (parts.size() != kColumns)
      fail({}, fmt::format("every line must have the {} fields of the header, got {}", std::size_t{kColumns},
                           parts.size()));
    if (++count_ > kMostRows) fail({}, fmt::format("at most {} limits are allowed", kMostRows));
    Fields fields;
    std::copy(parts.begin(), parts.end(), fields.begin());
    if (fields[kStandard].empty()) fail("standard", "must name a standard, got \"\"");
    if (one_of(fields[kStatus], kStatuses, "status") == 3)
      take_gap(fields);
    else if (one_of(fields[kUnit], kUnits, "unit") == 4)
      take_factor(fields);
    else
      take_row(fields);
  }

  void take_row(const Fields& fields) {
    LimitRow row;
    take_names(fields, row);
    row.colour = colour_of(fields);
    row.observation_deg = number(fields, kObservation, 0.0, kMostObservationDeg);
    row.v_deg = signed_numbers(fields, kV);
    row.h_deg = signed_numbers(fields, kH);
    row.minimum = positive(fields[kMinimum], kMostLimit);
    row.unit = static_cast<PhotometricUnit>(one_of(fields[kUnit], kUnits, "unit"));
    row.status = static_cast<LimitStatus>(one_of(fields[kStatus], kStatuses, "status"));
    table_.rows.push_back(std::move(row));
  }

  void take_factor(const Fields& fields) {
    LimitFactor factor;
    take_names(fields, factor);
    factor.colour = colour_of(fields);
    for (const Column column : {kObservation, kV, kH}) must_be_empty(fields, column, "of a factor");
    const std::vector<std::string_view> words = split(fields[kMinimum], ' ');
    if (words.size() != 3 || words[1] != "x" || words[2].empty())
      fail("minimum",
           fmt::format("must be a number, x and a colour, as in \"2.5 x red\", got {}", in_quotes(fields[kMinimum])));
    factor.factor = positive(words[0], 1e3);
    factor.of_colour = printable(words[2]);
    factor.status = static_cast<LimitStatus>(one_of(fields[kStatus], kStatuses, "status"));
    table_.factors.push_back(std::move(factor));
  }

  void take_gap(const Fields& fields) {
    LimitGap gap;
    take_names(fields, gap);
    gap.colour = printable(fields[kColour]);
    for (const Column column : {kObservation, kV, kH, kMinimum, kUnit})
      must_be_empty(fields, column, "where the status is incomplete");
    table_.gaps.push_back(std::move(gap));
  }

  template <class Row>
  void take_names(const Fields& fields, Row& row) const {
    row.standard = printable(fields[kStandard]);
    row.line = line_;
    for (const std::string_view name : split(fields[kClass], ' '))
      if (!name.empty()) row.classes.push_back(printable(name));
  }

  std::string colour_of(const Fields& fields) const {
    if (fields[kColour].empty()) fail("colour", "must name a colour, got \"\"");
    return printable(fields[kColour]);
  }

  void must_be_empty(const Fields& fields, Column column, std::string_view when) const {
    if (!fields[column].empty())
      fail(kHeader[column], fmt::format("must be empty {}, got {}", when, in_quotes(fields[column])));
  }

  template <std::size_t count>
  std::size_t one_of(std::string_view text, const std::array<std::string_view, count>& names,
                     std::string_view column) const {
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) fail(column, fmt::format("must be {}, got {}", alternatives(names), in_quotes(text)));
    return static_cast<std::size_t>(found - names.begin());
  }

  static bool read_number(std::string_view text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  }

  double number(const Fields& fields, Column column, double low, double high) const {
    double value = 0.0;
    if (!read_number(fields[column], value) || !(value >= low && value <= high))
      fail(kHeader[column], fmt::format("must be a number from {} to {}, got {}", shortest(low), shortest(high),
                                        in_quotes(fields[column])));
    return value;
  }

  double positive(std::string_view text, double high) const {
    double value = 0.0;
    if (!read_number(text, value) || !(value > 0.0 && value <= high))
      fail("minimum", fmt::format("must be a number above 0, to {}, got {}", shortest(high), in_quotes(text)));
    return value;
  }

  /// A number, or both signs of it.
  std::vector<double> signed_numbers(const Fields& fields, Column column) const {
    std::string_view text = fields[column];
    const bool both = text.starts_with("+-");
    if (both) text.remove_prefix(2);
    double value = 0.0;
    if (!read_number(text, value) || !(std::abs(value) <= kMostEntranceDeg) || (both && !(value > 0.0)))
      fail(kHeader[column], fmt::format("must be a number from -{0} to {0}, or +- and a number above 0, got {1}",
                                        shortest(kMostEntranceDeg), in_quotes(fields[column])));
    if (both) return {value, -value};
    return {value};
  }

  LimitTable table_;
  int line_ = 0;
  bool has_header_ = false;
  std::size_t count_ = 0;
};

}  // namespace

LimitTable parse_limits(std::string_view content, const std::string& name) {
  return Reader(name).read(content);
}

LimitTable read_limits(const std::filesystem::path& file) {
  return parse_limits(read_file(file, kMostBytes), file.string());
}

}  // namespace retrace::studies

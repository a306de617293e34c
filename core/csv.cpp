#include "core/csv.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/text.h"

namespace retrace {

CsvReader::CsvReader(std::string_view text, std::string file, std::size_t max_bytes,
                     std::span<const std::string_view> columns)
    : remainder_(without_byte_order_mark(text)), file_(std::move(file)) {
  require_short_text(text, file_, max_bytes);
  const std::string wanted =
      columns.empty() ? "a line of column names" : fmt::format("the header {}", fmt::join(columns, ","));
  if (!next_line()) fail("the file must have " + wanted);
  if (!columns.empty() && !std::equal(values_.begin(), values_.end(), columns.begin(), columns.end()))
    fail(fmt::format("the first line must contain {}, got {}", wanted,
                     in_quotes(fmt::format("{}", fmt::join(values_, ",")))));
  columns_ = values_;
}

std::optional<std::size_t> CsvReader::find(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) return std::nullopt;
  const auto place = static_cast<std::size_t>(found - columns_.begin());
  if (std::find(found + 1, columns_.end(), column) != columns_.end())
    fail(place, "the column occurs twice in the header");
  return place;
}

bool CsvReader::next() {
  if (!next_line()) return false;
  if (values_.size() != columns_.size())
    fail(fmt::format("a line must have {} values, one for each column of the header, got {}", columns_.size(),
                     values_.size()));
  ++rows_;
  return true;
}

/// Reads the next line that is neither empty nor a comment, and splits it into values.
bool CsvReader::next_line() {
  while (!remainder_.empty()) {
    const std::size_t end = std::min(remainder_.find('\n'), remainder_.size());
    const std::string_view line = trimmed(remainder_.substr(0, end));
    remainder_.remove_prefix(std::min(end + 1, remainder_.size()));
    ++line_;
    if (line.empty() || line.front() == '#') continue;
    values_ = split(line, ',');
    return true;
  }
  line_ = 0;
  return false;
}

double CsvReader::number(std::size_t column, const NumberRange& range) const {
  const std::optional<double> value = number_in(values_[column]);
  if (value && range.contains(*value)) return *value;
  const bool is_bounded = std::isfinite(range.low) || std::isfinite(range.high);
  fail(column,
       fmt::format("must be a number{}, got {}", is_bounded ? " " + range.text() : "", in_quotes(values_[column])));
}

std::optional<double> CsvReader::number_or_none(std::size_t column) const {
  if (values_[column].empty()) return std::nullopt;
  const std::optional<double> value = number_in(values_[column]);
  if (!value) fail(column, "must be a number or empty, got " + in_quotes(values_[column]));
  return value;
}

std::size_t CsvReader::one_of(std::size_t column, std::span<const std::string_view> words) const {
  const auto found = std::find(words.begin(), words.end(), values_[column]);
  if (found == words.end())
    fail(column, fmt::format("must be {}, got {}", alternatives(words), in_quotes(values_[column])));
  return static_cast<std::size_t>(found - words.begin());
}

void CsvReader::fail(std::string_view text) const {
  throw InputError({file_, line_, ""}, text);
}

void CsvReader::fail(std::size_t column, std::string_view text) const {
  throw InputError({file_, line_, std::string(columns_[column])}, text);
}

void CsvWriter::add(double value) {
  add_plain(std::isfinite(value) ? shortest(value) : "");
}

void CsvWriter::add(const std::optional<double>& value) {
  add_plain(value ? shortest(*value) : "");
}

void CsvWriter::add(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos)
    add_plain(text);
  else
    add_quoted(text);
}

void CsvWriter::add_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  add_plain(quoted + '"');
}

void CsvWriter::end_row() {
  text_ += '\n';
  begins_row_ = true;
}

void CsvWriter::add_plain(std::string_view value) {
  if (!begins_row_) text_ += ',';
  text_ += value;
  begins_row_ = false;
}

}  // namespace retrace

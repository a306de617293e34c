#pragma once

// Tables of comma-separated values, read with messages that name line and column, and written with full precision.

#include <fmt/format.h>

#include <concepts>
#include <cstddef>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/number_range.h"

namespace retrace {

/// Reads a table row by row: a line of column names, then lines of as many values, with commas between. Blanks round
/// them, a byte order mark, empty lines and lines that begin with # mean nothing. Whatever is wrong is refused by an
/// InputError that names file, line and column.
class CsvReader {
 public:
  /// Reads the column names. \param text must outlive the reader \param file its name, for messages
  /// \param columns what the names must be; none: whatever they are
  /// \throw InputError also if the text is longer than `most_bytes`
  CsvReader(std::string_view text, std::string file, std::size_t most_bytes,
            std::span<const std::string_view> columns = {});

  /// The column of that name. \throw InputError if there are two \pre no row was read
  std::optional<std::size_t> find(std::string_view column) const;

  /// Goes on to the next row; false behind the last.
  bool next();
  /// Of the row, or of the column names; 0 behind the last.
  int line() const { return line_; }
  /// How many were read.
  std::size_t rows() const { return rows_; }

  // Values of the row.

  std::string_view operator[](std::size_t column) const { return values_[column]; }
  double number(std::size_t column, const NumberRange& range = {}) const;
  /// None where nothing stands.
  std::optional<double> number_or_none(std::size_t column) const;
  /// The place of a value among the words that it may be.
  std::size_t one_of(std::size_t column, std::span<const std::string_view> words) const;

  /// Refuses the row; behind the last, the file.
  [[noreturn]] void fail(std::string_view text) const;
  /// Refuses a value.
  [[noreturn]] void fail(std::size_t column, std::string_view text) const;

 private:
  bool next_line();

  std::string_view rest_;
  std::string file_;
  std::vector<std::string_view> columns_;
  std::vector<std::string_view> values_;
  int line_ = 0;
  std::size_t rows_ = 0;
};

/// Writes a table: numbers as the shortest text that reads back equal, nothing where they are not finite, texts in
/// quotes where they need them (RFC 4180).
class CsvWriter {
 public:
  CsvWriter() = default;
  /// \param columns their names, with commas between
  explicit CsvWriter(std::string_view columns) : text_(std::string(columns) + '\n') {}

  void add(double value);
  void add(const std::optional<double>& value);
  void add(std::string_view text);
  void add(std::integral auto value) { add_plain(fmt::format("{}", value)); }
  /// A text that is always in quotes.
  void add_quoted(std::string_view text);
  /// One value after another.
  template <std::ranges::range Values>
  requires(!std::convertible_to<const Values&, std::string_view>) void add(const Values& values) {
    for (const auto& value : values) add(value);
  }
  void end_row();

  template <class... Values>
  void row(const Values&... values) {
    (add(values), ...);
    end_row();
  }

  const std::string& text() const { return text_; }

 private:
  void add_plain(std::string_view value);

  std::string text_;
  bool begins_row_ = true;
};

}  // namespace retrace

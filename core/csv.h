#pragma once

// Reads tables of comma-separated values, with error messages that contain line and column. Writes tables with full
// precision.

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

/// Reads a table row by row. The first line contains the column names, separated by commas. Each following line
/// contains one value for each column. Blanks around values, a byte order mark, empty lines and lines that begin with #
/// are ignored. Errors are reported by an InputError with file, line and column.
class CsvReader {
 public:
  /// Reads the column names.
  /// \param text text of the table; it must outlive the reader
  /// \param file name of the file in messages
  /// \param columns required column names; if empty, any names are allowed
  /// \throw InputError if the column names are invalid or the text is longer than `max_bytes`
  CsvReader(std::string_view text, std::string file, std::size_t max_bytes,
            std::span<const std::string_view> columns = {});

  /// Returns the index of the column with the given name, or nothing if there is no such column.
  /// \throw InputError if there are two such columns
  /// \pre no row has been read
  std::optional<std::size_t> find(std::string_view column) const;

  /// Reads the next row. Returns false after the last row.
  bool next();
  /// Returns the line number of the current row, or of the column names before the first row. Returns 0 after the last
  /// row.
  int line() const { return line_; }
  /// Returns the number of rows that have been read.
  std::size_t rows() const { return rows_; }

  // The following functions return values of the current row.

  std::string_view operator[](std::size_t column) const { return values_[column]; }
  double number(std::size_t column, const NumberRange& range = {}) const;
  /// Returns the number, or nothing if the value is empty.
  std::optional<double> number_or_none(std::size_t column) const;
  /// Returns the index of the value in `words`.
  std::size_t one_of(std::size_t column, std::span<const std::string_view> words) const;

  /// Throws an InputError about the current row. After the last row, the error is about the file.
  [[noreturn]] void fail(std::string_view text) const;
  /// Throws an InputError about a value of the current row.
  [[noreturn]] void fail(std::size_t column, std::string_view text) const;

 private:
  bool next_line();

  std::string_view remainder_;
  std::string file_;
  std::vector<std::string_view> columns_;
  std::vector<std::string_view> values_;
  int line_ = 0;
  std::size_t rows_ = 0;
};

/// Writes a table. Numbers are written as the shortest text that reads back as the same number. A number that is not
/// finite becomes an empty value. Texts are quoted if necessary (RFC 4180).
class CsvWriter {
 public:
  CsvWriter() = default;
  /// \param columns names of the columns, separated by commas
  explicit CsvWriter(std::string_view columns) : text_(std::string(columns) + '\n') {}

  void add(double value);
  void add(const std::optional<double>& value);
  void add(std::string_view text);
  void add(std::integral auto value) { add_plain(fmt::format("{}", value)); }
  /// Adds a text that is always quoted.
  void add_quoted(std::string_view text);
  /// Adds all values of a range, each in a column of its own.
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

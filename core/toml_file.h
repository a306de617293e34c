#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/number_range.h"

namespace retrace {

/// One table of a TOML file. It checks every value it hands out and remembers which keys were asked for. A table that
/// is not there reads as empty. Cheap to copy; copies share that memory. Every function throws InputError with file,
/// line and key if what was given is not what is allowed; numbers are finite.
class TomlTable {
 public:
  bool exists() const;
  bool has(std::string_view key) const;
  /// Where the table begins; of one that is not there, where it would be missed.
  InputLocation where() const;
  InputLocation where(std::string_view key) const;
  [[noreturn]] void fail(std::string_view key, std::string_view text) const;

  std::optional<double> number(std::string_view key, const NumberRange& range = {});
  double required_number(std::string_view key, const NumberRange& range = {});
  /// A list of exactly `count` numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, const NumberRange& range = {});
  std::vector<double> required_numbers(std::string_view key, std::size_t count, const NumberRange& range = {});
  /// A list of lists of exactly `columns` numbers.
  std::optional<std::vector<std::vector<double>>> number_rows(std::string_view key, std::size_t columns,
                                                              const NumberRange& range = {});
  std::vector<std::vector<double>> required_number_rows(std::string_view key, std::size_t columns,
                                                        const NumberRange& range = {});
  /// A number without fraction. \pre the range's ends are whole and within 2^53
  std::optional<long long> whole(std::string_view key, const NumberRange& range);
  std::optional<bool> flag(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  std::string required_text(std::string_view key);
  /// A list of one or more texts.
  std::optional<std::vector<std::string>> texts(std::string_view key);
  /// The index of the word in `words`.
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> words);
  std::size_t required_choice(std::string_view key, std::span<const std::string_view> words);

  /// The table of that name in this one, empty if there is none.
  TomlTable table(std::string_view key);
  TomlTable required_table(std::string_view key);
  /// The tables `[[key]]`, in the order of the file; none if there are none.
  std::vector<TomlTable> tables(std::string_view key);

  /// Throws for the first key, in file order, that nobody has asked for; likewise in the tables that were handed out.
  void finish() const;

  struct Hidden;  ///< toml++ stays inside core/io/
  explicit TomlTable(std::shared_ptr<Hidden> hidden);

 private:
  std::shared_ptr<Hidden> hidden_;
};

/// The text of a TOML file; `source_name` stands for the file in messages.
/// \throw InputError for text that is not TOML, that is longer than kMostTextBytes, or whose keys nest too deeply
TomlTable parse_toml(std::string_view text, const std::string& source_name);

/// `text` between double quotes, with what TOML wants escaped.
std::string toml_text(std::string_view text);

}  // namespace retrace

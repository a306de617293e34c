#pragma once

// TOML files with checked values and messages that name file, line and key. toml++ stays behind this header; formats
// are read through core/schema/ on top of it.

#include <compare>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/number_range.h"

namespace retrace {

/// An entry of a list, whatever it is.
struct TomlItem {
  std::optional<double> number;
  std::optional<std::string> text;
  bool is_list = false;
  std::string toml;   ///< as a file would have it, on one line
  std::string shown;  ///< as a message shows it
};

/// One table of a TOML file. It checks every value it hands out and remembers which keys were requested. A table that
/// is not there reads as empty. Cheap to copy; copies share that memory. Every function throws InputError with file,
/// line and key if what was given is not what is allowed; numbers are finite.
class TomlTable {
 public:
  bool has(std::string_view key) const;
  /// Where the table begins; of one that is not there, where it would be missed.
  InputLocation where() const;
  InputLocation where(std::string_view key) const;
  [[noreturn]] void fail(std::string_view key, std::string_view text) const;

  std::optional<double> number(std::string_view key, const NumberRange& range = {});
  double required_number(std::string_view key, const NumberRange& range = {});
  /// A number or a list of one or more numbers.
  std::optional<std::vector<double>> number_or_numbers(std::string_view key, const NumberRange& range = {});
  /// A list of one or more pairs of numbers. \param shape of a pair, for messages: "[wavelength_nm, power]"
  std::optional<std::vector<std::vector<double>>> pairs(std::string_view key, std::string_view shape,
                                                        const NumberRange& first, const NumberRange& second);
  /// A list of exactly `count` numbers. \param what they are, for messages
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, const NumberRange& range = {},
                                             std::string_view what = "numbers");
  /// A list of lists of exactly `columns` numbers.
  std::optional<std::vector<std::vector<double>>> number_rows(std::string_view key, std::size_t columns,
                                                              const NumberRange& range = {});
  /// A number without fraction. \pre the range's ends are whole and within 2^53
  std::optional<long long> whole(std::string_view key, const NumberRange& range);
  std::optional<bool> flag(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  /// A list of one or more texts.
  std::optional<std::vector<std::string>> texts(std::string_view key);
  /// The index of the word in `words`. \param or_else what the key may have instead, for messages
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> words,
                                    std::string_view or_else = {});
  std::size_t required_choice(std::string_view key, std::span<const std::string_view> words);

  /// The entries of a list of anything; nothing if the key was not given or has no list.
  std::optional<std::vector<TomlItem>> items(std::string_view key);
  /// The value of a key, with `{"value": ...}` around it, as JSON; empty if it was not given.
  std::string as_json(std::string_view key) const;
  /// The whole table as JSON.
  std::string as_json() const;

  /// The table of that name in this one, empty if there is none.
  TomlTable table(std::string_view key);
  /// The tables `[[key]]`, in the order of the file; none if there are none. \param shape what they must be, for
  /// messages \param are_numbered messages tell them apart: "key[1]"
  std::vector<TomlTable> tables(std::string_view key, std::string_view shape = "tables", bool are_numbered = false);

  enum class Shape { nothing, text, number, list, table, other };
  /// What a key was given; nothing if it was not.
  Shape shape_of(std::string_view key) const;
  /// The value of a key that was given, as a message shows it: -3, "text", a table, a list.
  std::string shown(std::string_view key) const;
  /// What is in the table, in the order of the file, and then of the overrides.
  std::vector<std::string> names() const;
  /// The same, by name.
  std::vector<std::string> sorted_names() const;
  /// Orders values of a document as they were written.
  struct Position {
    std::size_t source = 0;  ///< 0: the file; then the overrides
    std::size_t line = 0;
    std::size_t column = 0;
    friend auto operator<=>(const Position&, const Position&) = default;
  };
  Position position(std::string_view key) const;

  /// Throws for the first key, in file order, that no function was called for: it is unknown. Likewise in the tables
  /// that were handed out.
  void finish() const;

  struct Hidden;  ///< toml++ stays inside core/io/
  explicit TomlTable(std::shared_ptr<Hidden> hidden);

 private:
  std::shared_ptr<Hidden> hidden_;
};

/// toml++ recurses once per level when it destroys a tree, and two bytes of `a.a.a...` make a level: 64 KiB of it run
/// out of an 8 MiB stack. Longer texts may have few dots a line; files that people write have about one KiB.
inline constexpr std::size_t kShortTomlBytes = 16384;
inline constexpr std::size_t kMostDesignBytes = std::size_t{1} << 20;  ///< designs and studies

/// Returns the key if the override has the form `KEY=`, which removes the key. Otherwise returns nothing.
std::optional<std::string_view> unset_key(std::string_view override_text);

/// Parses the text of a TOML file and applies overrides to it.
/// \param source_name name of the file in messages
/// \param most_bytes maximum length of the text in bytes
/// \param overrides texts of the form KEY=VALUE, which set a key, or KEY=, which remove a key. Messages about an
/// override quote the override instead of the name of the file.
/// \throw InputError if the text is not TOML, is longer than `most_bytes`, or has keys that nest too deeply, or if an
/// override is neither KEY=VALUE nor KEY=
TomlTable parse_toml(std::string_view text, const std::string& source_name, std::size_t most_bytes = kMostTextBytes,
                     std::span<const std::string> overrides = {});

/// `text` between double quotes, with what TOML wants escaped.
std::string toml_text(std::string_view text);

}  // namespace retrace

#pragma once

// Reads TOML files with checks of their values. Messages contain the file, line and key. This header hides toml++. File
// formats are read by core/schema/, which uses this header.

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

/// Entry of a list. The entry may have any type.
struct TomlItem {
  std::optional<double> number;
  std::optional<std::string> text;
  bool is_list = false;
  std::string toml;   ///< TOML text of the entry on one line
  std::string shown;  ///< text of the entry in messages
};

/// Name that a key, a table or a word of a file format had in former versions of the program.
struct TomlRename {
  /// Path of the table that contains the key or table, in current names and without indices; empty for the root.
  std::string table;
  std::string former;   ///< former name of the key or table, or former word
  std::string current;  ///< name or word that replaces it
  bool is_word = false;
  std::string key = {};  ///< key whose value is the word; if empty, the word may be the value of any key of the table
};

/// Returns the replacements of current names by former ones, in the order that parse_toml() requires.
std::vector<TomlRename> reversed(std::vector<TomlRename> renames);

/// Former name that was found in an input and replaced by the current one.
struct RenamedInput {
  /// Location of the former name. For a renamed word, it is the location of the key that has this word.
  InputLocation where;
  std::string former;   ///< former name of the key or table, or former word
  std::string current;  ///< name or word that replaced it
};

/// Returns the path of a key or table with all former names replaced. Paths have no indices.
std::string current_path(std::string_view path, std::span<const TomlRename> names);

/// One table of a TOML file. Functions that return values check them and record that their key was requested. A table
/// that is not in the file is treated as empty. Copies are cheap and share their data. All functions throw InputError
/// with file, line and key if a value is not allowed. Numbers must be finite.
class TomlTable {
 public:
  bool has(std::string_view key) const;
  /// Returns the position of the table. For a table that is not in the file, returns the position of its parent.
  InputLocation where() const;
  InputLocation where(std::string_view key) const;
  [[noreturn]] void fail(std::string_view key, std::string_view text) const;

  std::optional<double> number(std::string_view key, const NumberRange& range = {});
  double required_number(std::string_view key, const NumberRange& range = {});
  /// Returns the value of a key that is a number or a list of one or more numbers.
  std::optional<std::vector<double>> number_or_numbers(std::string_view key, const NumberRange& range = {});
  /// Returns a list of one or more pairs of numbers.
  /// \param shape text for a pair in messages, such as "[wavelength_nm, power]"
  std::optional<std::vector<std::vector<double>>> pairs(std::string_view key, std::string_view shape,
                                                        const NumberRange& first, const NumberRange& second);
  /// Returns a list of exactly `count` numbers.
  /// \param what text for the numbers in messages
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, const NumberRange& range = {},
                                             std::string_view what = "numbers");
  /// Returns a list of lists of exactly `columns` numbers.
  std::optional<std::vector<std::vector<double>>> number_rows(std::string_view key, std::size_t columns,
                                                              const NumberRange& range = {});
  /// Returns an integer.
  /// \pre the ends of the range are integers of a magnitude up to 2^53
  std::optional<long long> integer(std::string_view key, const NumberRange& range);
  std::optional<bool> flag(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  /// Returns a list of one or more texts.
  std::optional<std::vector<std::string>> texts(std::string_view key);
  /// Returns the index of the value in `words`.
  /// \param or_else text for messages that describes further allowed values
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> words,
                                    std::string_view or_else = {});
  std::size_t required_choice(std::string_view key, std::span<const std::string_view> words);

  /// Returns the entries of a list, which may have any type. Returns nothing if the key was not given or is not a list.
  std::optional<std::vector<TomlItem>> items(std::string_view key);
  /// Returns the value of a key as the JSON object `{"value": ...}`. Returns an empty text if the key was not given.
  std::string as_json(std::string_view key) const;
  /// Returns the whole table as JSON.
  std::string as_json() const;

  /// Returns a table within this table. Returns an empty table if there is none with this name.
  TomlTable table(std::string_view key);
  /// Returns the tables `[[key]]` in the order of the file.
  /// \param shape text for the required type in messages
  /// \param are_numbered true: messages contain the index of the table, such as "key[1]"
  std::vector<TomlTable> tables(std::string_view key, std::string_view shape = "a list of tables",
                                bool are_numbered = false);

  enum class Shape { nothing, text, number, list, table, other };
  /// Returns the type of the value of a key, or Shape::nothing if the key was not given.
  Shape shape_of(std::string_view key) const;
  /// Returns the value of a key as text for messages, such as -3, "text", a table or a list.
  /// \pre the key was given
  std::string shown(std::string_view key) const;
  /// Returns the former names that were replaced in the whole input, in the order of the list given to parse_toml().
  const std::vector<RenamedInput>& renamed() const;
  /// Returns the names of all keys and tables, in the order of the file. Keys that overrides set come last.
  std::vector<std::string> names() const;
  /// Returns the names of all keys and tables, sorted by name.
  std::vector<std::string> sorted_names() const;
  /// Position of a value in the input. Positions compare in the order in which the values were written.
  struct Position {
    /// 0 for a value in the file; for a value in an override, the number of the override, from 1.
    std::size_t source = 0;
    std::size_t line = 0;
    std::size_t column = 0;
    friend auto operator<=>(const Position&, const Position&) = default;
  };
  Position position(std::string_view key) const;

  /// Checks that all keys of this table, and of the tables that it has returned, have been requested.
  /// \throw InputError for the first key, in the order of the file, that was not requested and is thus unknown
  void finish() const;

  struct Impl;  ///< implementation, which uses toml++
  explicit TomlTable(std::shared_ptr<Impl> hidden);

 private:
  std::shared_ptr<Impl> impl_;
};

/// Maximum size in bytes of a text whose lines may have any number of dots. In a longer text, the number of dots in a
/// line is limited. toml++ uses one level of recursion for each level of a tree when it destroys the tree. Two bytes of
/// a dotted key `a.a.a...` make one level, so 64 KiB of such a key exceed a stack of 8 MiB.
inline constexpr std::size_t kShortTomlBytes = 16384;
inline constexpr std::size_t kMaxDesignBytes = std::size_t{1} << 20;  ///< designs and studies

/// Returns the key if the override has the form `KEY=`, which removes the key. Otherwise returns nothing.
std::optional<std::string_view> unset_key(std::string_view override_text);

/// Parses the text of a TOML file and applies overrides to it.
/// \param source_name name of the file in messages
/// \param max_bytes maximum length of the text in bytes
/// \param overrides texts of the form KEY=VALUE, which set a key, or KEY=, which remove a key. Messages about an
/// override quote the override instead of the name of the file.
/// \param names former names, which are replaced by current names in the text and in the overrides. They are replaced
/// in the order of the list. A renamed table must therefore precede the renamed keys that it contains.
/// \throw InputError if the text is not TOML, is longer than `max_bytes`, or has keys that nest too deeply
/// \throw InputError if an override is neither KEY=VALUE nor KEY=
/// \throw InputError if a table contains both a name and its former name
TomlTable parse_toml(std::string_view text, const std::string& source_name, std::size_t max_bytes = kMaxTextBytes,
                     std::span<const std::string> overrides = {}, std::span<const TomlRename> names = {});

/// Returns `text` as a TOML string in double quotes, with escapes.
std::string toml_text(std::string_view text);

}  // namespace retrace

#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/toml_file.h"
#include "studies/design/design_document.h"

namespace retrace::studies {

using Range = NumberRange;

inline constexpr Range kPositive{.low = 0.0, .low_included = false};
inline constexpr Range kNotNegative{.low = 0.0};

/// A word that a key may have, and what it stands for.
template <class Value>
struct Choice {
  std::string_view name;
  Value value;
};

/// All choices of a list, for the functions below.
template <class Value, std::size_t size>
std::span<const Choice<Value>> all(const std::array<Choice<Value>, size>& choices) {
  return choices;
}

/// Reads one table of a design, checks every value it hands out and remembers which keys were asked for.
/// Every function throws InputError with file, line and key if what was given is not what is allowed.
class TableReader {
 public:
  /// The table `name`, which reads as empty if it is absent; an empty `name` is the top level.
  TableReader(const DesignDocument& document, std::string_view name);
  /// A table that is not at the top level, such as an entry of a list of tables; `name` stands for it in messages.
  /// \pre `table` belongs to the document
  TableReader(const DesignDocument& document, std::string name, const toml::table& table);

  bool has(std::string_view key) const { return find(key) != nullptr; }
  InputLocation where(std::string_view key) const;
  [[noreturn]] void fail(std::string_view key, std::string_view text) const;

  std::optional<double> number(std::string_view key, const Range& range);
  double required_number(std::string_view key, const Range& range);
  /// A number or a list of one or more numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, const Range& range);
  /// A list of one or more pairs of numbers. \param shape of a pair, for messages: "[wavelength_nm, power]" \pre it is
  /// a list
  std::vector<std::array<double, 2>> number_pairs(std::string_view key, std::string_view shape, const Range& first,
                                                  const Range& second);
  /// How many entries the list of that name has; nothing if the key has no list.
  std::optional<std::size_t> list_size(std::string_view key) const;
  bool is_text(std::string_view key) const;
  std::optional<std::string> text(std::string_view key);
  /// The name of a file. Relative ones are taken from the folder of the design, those of an override (and of a design
  /// on standard input) from the working directory. The document remembers it (DesignDocument::files()).
  std::optional<std::filesystem::path> file(std::string_view key);
  /// Adds to the files that the document names one that was not read by file().
  void add_file(const std::filesystem::path& file) { document_.add_file(file); }
  /// The node of a key, which counts as asked for; null if it was not given.
  const toml::node* node(std::string_view key) { return take(key); }
  /// The value of a key that was given, as a message shows it.
  std::string shown_value(std::string_view key) const;

  /// \param or_else what the key may have instead of a word, for messages: " or a list of four numbers"
  template <class Value>
  std::optional<Value> choice(std::string_view key, std::span<const Choice<Value>> choices,
                              std::string_view or_else = {}) {
    const std::vector<std::string_view> names = names_of(choices);
    const std::optional<std::size_t> index = choice_index(key, names, or_else);
    return index ? std::optional<Value>(choices[*index].value) : std::nullopt;
  }
  template <class Value>
  Value required_choice(std::string_view key, std::span<const Choice<Value>> choices) {
    if (!has(key)) fail_missing(key, choice_text(names_of(choices)));
    return *choice(key, choices);
  }

  /// Throws for each of `keys` that was given: it has no meaning here. `why` says where it has.
  void refuse(std::initializer_list<std::string_view> keys, std::string_view why);
  /// The same for keys whose 0 says "none": 0 is let pass.
  void refuse_unless_zero(std::initializer_list<std::string_view> keys, std::string_view why);
  /// Counts `keys`, which check_keys() has checked, as asked for.
  void skip(std::initializer_list<std::string_view> keys) { taken_.insert(keys.begin(), keys.end()); }
  /// Throws for the first key, in file order, that no call above has asked for.
  void finish() const;

 private:
  const toml::node* find(std::string_view key) const;
  const toml::node* take(std::string_view key);
  std::string full_name(std::string_view key) const;
  double checked_number(std::string_view key, const toml::node& node, const Range& range) const;
  std::optional<std::string> text_or(std::string_view key, std::string_view or_else);
  std::optional<std::size_t> choice_index(std::string_view key, std::span<const std::string_view> names,
                                          std::string_view or_else);
  [[noreturn]] void fail_missing(std::string_view key, std::string_view allowed) const;
  static std::string choice_text(std::span<const std::string_view> names);

  template <class Value>
  static std::vector<std::string_view> names_of(std::span<const Choice<Value>> choices) {
    std::vector<std::string_view> names;
    for (const Choice<Value>& choice : choices) names.push_back(choice.name);
    return names;
  }

  const DesignDocument& document_;
  std::string name_;
  const toml::table* table_ = nullptr;  ///< null if the design has no such table
  std::set<std::string, std::less<>> taken_;
};

}  // namespace retrace::studies

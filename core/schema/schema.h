#pragma once

// Describes file formats as constant data: their keys, the allowed values, and the members of C++ objects that store
// the values. Readers, writers, JSON Schema and the key tables of the documentation are generated from these data.

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/number_range.h"
#include "core/text.h"

namespace retrace::schema {

/// Table of named numbers or words. The author of the file chooses the names.
using Named = std::map<std::string, std::variant<double, std::string>>;

/// Value of a key. Words are stored as std::string and whole numbers as double. std::monostate means that the key is
/// not given.
using Value = std::variant<std::monostate, bool, double, std::string, std::vector<double>,
                           std::vector<std::vector<double>>, std::vector<std::string>, Named>;

/// Functions that read the value of a key from a C++ object and store it there. They are created with
/// core/schema/access.h. In these functions, a word is represented by its index in the list of words of the key.
/// Formats that are only read as documents have no such functions.
struct Access {
  Value (*get)(const void* object) = nullptr;  ///< returns std::monostate if the object has no value for the key
  void (*set)(void* object, const Value& value) = nullptr;  ///< \pre the value is of the key's kind
};

// Kinds of values. Numbers are finite. The unit of a number is the suffix of the name of its key, or of its table.

struct Number {
  NumberRange range;
  /// Narrower range of reasonable numbers. Numbers outside of it are also refused, because computations with them would
  /// have too few significant digits. Messages about numbers outside of `range` do not mention this range.
  NumberRange plausible = {};
};
/// An integer.
/// \pre the bounds of the range are integers of a magnitude up to 2^53
struct Integer {
  NumberRange range;
};
struct Flag {};
/// Word that was allowed in former versions of a format, and the word that replaces it.
struct FormerWord {
  std::string_view former;
  std::string_view current;
};
struct Word {
  std::span<const std::string_view> words;
  std::string_view further_allowed = {};  ///< text in messages for other allowed values: " or a list of four numbers"
  std::span<const FormerWord> former = {};
};
struct Text {
  std::string_view what = "a string";  ///< text for the allowed values in messages
};
/// Name of a file. Relative names are relative to the folder of the file that contains the key.
struct File {
  std::string_view what;  ///< description of the file, such as "an STL file"
};
/// One of a list of words, or the name of a file with a given extension.
struct WordOrFile {
  std::span<const std::string_view> words;
  std::string_view ending;   ///< extension of the file
  std::string_view allowed;  ///< text for the allowed values in messages
};
/// A number, or a list of one or more numbers.
struct NumberOrNumbers {
  NumberRange range;
  bool is_integer = false;  ///< true if all numbers must be integers
  std::size_t max_count =
      std::numeric_limits<std::size_t>::max();  ///< maximum length of the list; only used for requests
  bool may_be_empty = false;                    ///< true if the list may be empty; only used for requests
};
/// A list of exactly `count` numbers.
struct Numbers {
  std::size_t count;
  NumberRange range;
  std::string_view what = "numbers";  ///< text for the numbers in messages
  bool is_integer = false;            ///< true if all numbers must be integers; only used for requests
};
/// A list of one or more terms, each of which consists of `count` numbers.
struct Terms {
  std::size_t count;
};
/// A list of lists of exactly `columns` numbers.
struct NumberRows {
  std::size_t columns;
  NumberRange range;
  std::size_t min_rows;   ///< minimum number of rows
  std::size_t max_rows;   ///< maximum number of rows
  std::string_view what;  ///< text for the rows in messages, such as "points"
};
/// A list of one or more pairs of numbers.
struct Pairs {
  NumberRange first;
  NumberRange second;
  std::string_view shape;  ///< text for a pair in messages, such as "[wavelength_nm, power]"
  /// Minimum number of pairs for the JSON Schema; the code that reads the format has its own check.
  std::size_t min_count = 1;
};
/// A list of one or more texts.
struct Texts {};
/// A text, or a list of one or more texts.
struct TextOrTexts {
  std::string_view what;  ///< text for the allowed values in messages
};
/// A list of one or more finite numbers, texts or lists. The value contains the TOML text of each entry.
struct Anything {};
/// A table with one or more numbers or words.
struct ByName {
  std::variant<Number, Word> each;               ///< kind of each value
  std::span<const std::string_view> names = {};  ///< required names; if empty, the author of the file chooses the names
  std::string_view what = "a table";             ///< text for the allowed values in messages
};
using Kind = std::variant<Number, Integer, Flag, Word, Text, File, WordOrFile, NumberOrNumbers, Numbers, Terms,
                          NumberRows, Pairs, Texts, TextOrTexts, Anything, ByName>;

/// TOML type of a value. If a key has several rows, the type can determine the row that applies.
enum class Form { other, number, text, list, table };
/// Returns true if a value of the type `form` can be of the kind `kind`.
bool accepts(const Kind& kind, Form form);

/// Marks a key that must be given.
struct Required {};
/// Marks a key without a default value: if the key is not given, its member of the object is not changed.
struct None {};
/// Marks a key without a constant default. Other code computes its default value.
struct Computed {
  std::string_view sentence;  ///< description of the default for the documentation
};
/// Default value of a key. For a key whose value is a word, the default is the text of the word.
using Default = std::variant<Required, None, Computed, bool, double, std::string_view, std::span<const double>>;
inline constexpr Required kRequired;
inline constexpr None kNone;

/// Condition on another key, under which a key is allowed. The other key is searched in the same table first, and then
/// in the tables that contain this table. It may also be in an inner table, such as "element.kind".
struct Condition {
  enum class Is { one_of, none_of, given, absent };
  std::string_view key;  ///< path of the other key
  Is is = Is::one_of;
  std::span<const std::string_view> words = {};  ///< words for one_of and none_of
  /// Message if the condition does not hold; if empty, a standard message is used.
  std::string_view refusal = {};
};
/// List of conditions, all of which must hold.
using When = std::span<const Condition>;

/// Description of a key. A key may have several rows. At most one of them applies to a file; it is selected by the
/// conditions of the rows and by the type of the value.
struct Row {
  constexpr Row(std::string_view of_key, Kind of_kind, Default by_default, std::string_view sentence, Access by = {},
                When only_when = {})
      : key(of_key), kind(of_kind), default_spec(by_default), meaning(sentence), access(by), when(only_when) {}
  constexpr Row(std::string_view of_key, Kind of_kind, Default by_default, std::string_view sentence, When only_when,
                bool may_be_zero = false)
      : Row(of_key, of_kind, by_default, sentence, Access{}, only_when) {
    zero_is_none = may_be_zero;
  }

  std::string_view key;
  Kind kind;
  Default default_spec;
  std::string_view meaning;  ///< description for the documentation, one sentence
  Access access;
  When when;
  bool zero_is_none = false;  ///< true if the value 0 is allowed, and ignored, where the conditions do not hold
  /// Name of the key in former versions of the format, or empty. All rows of a key have the same former name.
  std::string_view former = {};
};
inline constexpr bool kZeroIsNone = true;

/// Rule that exactly one of `keys` must be given.
struct OneOf {
  std::span<const std::string_view> keys;
  std::string_view complaint;  ///< message if none of the keys is given
};
/// Function that throws an InputError about a key.
/// \param key path of the key relative to the table of the rule. If it is empty, the error is about the first of the
/// rule's keys that the input contains. If the input contains none of them, the error is about the table.
/// \param complaint message
using Refuse = std::function<void(std::string_view key, const std::string& complaint)>;
/// Rule that refuses some combinations of values that are allowed individually.
struct Check {
  /// Paths of the keys in the rule, relative to the table; if empty, the rule is about the whole table.
  std::span<const std::string_view> keys;
  std::string_view meaning;  ///< the rule in one sentence, for the documentation
  /// Function that checks the rule.
  /// \param object object of the table; for formats that are only read as documents, the document
  void (*check)(const void* object, const Refuse& refuse);
};
/// Rule that one key, called the winner, takes precedence over other keys, which then have no effect. If the input
/// contains one of these other keys, a warning names this key and the winner.
struct Precedence {
  Condition winner;                        ///< condition on the winner under which the rule applies
  std::span<const std::string_view> keys;  ///< keys without effect if `winner` holds; paths relative to the table
  std::string_view effect;                 ///< text after "has no effect" in warnings: "on the refractive index"
  std::string_view meaning;                ///< the rule in one sentence, for the documentation
  /// True if it is normal that a file contains both the winner and some of `keys`. Such a file causes no warning. A
  /// warning is given only if an override (`--set`) sets one of `keys` and the winner is set by the file or by an
  /// earlier override.
  bool is_refinement = false;
};
using Rule = std::variant<OneOf, Check, Precedence>;

enum class Presence {
  always,
  optional,
  implied,  ///< a table that is not given is treated as an empty table
  list      ///< any number of tables with this name, including none
};

/// Notation of a table in a file.
enum class Layout {
  headed,  ///< [name]
  in_line  ///< name = { ... }
};

/// Functions that give access to the objects of a table within the object of the table that contains it (the parent).
struct Child {
  std::size_t (*count)(const void* parent);                  ///< returns the number of objects
  const void* (*at)(const void* parent, std::size_t index);  ///< returns an object
  void* (*add)(void* parent);                                ///< adds an object and returns it
};

/// Description of a table of a file. The root table is the whole file.
struct Table {
  std::string_view name;     ///< name of the table; empty for the root table
  std::string_view meaning;  ///< description for the documentation, one sentence
  std::span<const Row> rows = {};
  std::span<const Table> tables = {};
  std::span<const Rule> rules = {};
  Child child = {};
  Presence presence = Presence::always;
  Layout layout = Layout::headed;
  std::string_view shape = {};  ///< text for the required type in messages; empty: "a table" or "a list of tables"
  std::string_view default_text = "none";  ///< text for the default of an optional table in the documentation
  When when = {};
  bool is_open = false;          ///< true if unknown keys are allowed, because another reader checks them
  std::string_view former = {};  ///< name of the table in former versions of the format, or empty
};

struct Format {
  std::string_view name;  ///< name of the format, such as "process"
  std::string_view id;    ///< value of the key `schema`, such as "retrace.process/1"
  std::string_view title;
  Table root;
  bool id_is_optional = false;
};

/// Returns the unit that the suffix of a name gives, such as "mm/min" for `feed_mm_per_min`. Returns an empty text if
/// the name has no such suffix.
std::string_view unit_of(std::string_view name);

/// Returns the allowed values of a key as text for messages, such as "> 0 and <= 100" or "a list of 3 numbers".
std::string allowed(const Kind& kind);

/// Returns the default value of a key, or std::monostate if it has none.
Value default_value(const Row& row);

/// A path of a key or table, split into two parts.
struct SplitPath {
  std::string_view around;  ///< path of the table that contains the key or table; empty for the root table
  std::string_view name;    ///< name of the key or table
};
/// Splits a path such as "element.base_mm" at its last dot.
SplitPath split_path(std::string_view path);

/// Returns the table at a path, or null if there is no such table. An empty path is the root.
const Table* table_at(const Table& root, std::string_view path);

using retrace::path_in;
/// Returns the path of an entry of a list of tables, such as "hole[1]". Indices start at 0.
std::string path_of_entry(std::string_view list, std::size_t index);

}  // namespace retrace::schema

#pragma once

// What a file format is, as constant data: its keys, what each may be, and where it goes. Readers, writers, JSON Schema
// and the tables of the documentation walk these rows.

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/number_range.h"

namespace retrace::schema {

/// Numbers or words under names that the file chooses freely.
using Named = std::map<std::string, std::variant<double, std::string>>;

/// A value of a file. A word is its text, a whole number a double, nothing a key that is not given.
using Value = std::variant<std::monostate, bool, double, std::string, std::vector<double>,
                           std::vector<std::vector<double>>, std::vector<std::string>, Named>;

/// How a value comes from an object and goes into it (core/schema/access.h makes both), where a word is its index among
/// the words of its key. A value that an object does not have, or that another key says, is got as nothing. Formats
/// that are read as documents alone have none.
struct Access {
  Value (*get)(const void* object) = nullptr;
  void (*set)(void* object, const Value& value) = nullptr;  ///< \pre the value is of the key's kind
};

// What a key may be. Numbers are finite; their unit is the suffix of the key, or of the table around it.

struct Number {
  NumberRange range;
  NumberRange sane = {};  ///< the same to be told only where it is missed: beyond it numbers have too few digits
};
/// \pre the range's ends are whole and within 2^53
struct Whole {
  NumberRange range;
};
struct Flag {};
struct Word {
  std::span<const std::string_view> words;
  std::string_view or_else = {};  ///< what else the key may have, for messages: " or a list of four numbers"
};
struct Text {
  std::string_view what = "a string";  ///< that it must be, for messages
};
/// The name of a file: relative ones are taken from the folder of the file that names it.
struct File {
  std::string_view what;  ///< that it is, such as "an STL file"
};
/// A word, or the name of a file with that ending.
struct WordOrFile {
  std::span<const std::string_view> words;
  std::string_view ending;
  std::string_view allowed;  ///< what a message says that the key must be
};
/// A number, or a list of one or more numbers.
struct NumberOrNumbers {
  NumberRange range;
  bool is_whole = false;  ///< each
};
/// A list of exactly so many numbers.
struct Numbers {
  std::size_t count;
  NumberRange range;
  std::string_view what = "numbers";  ///< that they are, for messages
};
/// A list of one or more numbers, so many for each of its terms.
struct Terms {
  std::size_t count;
};
/// A list of lists of exactly `columns` numbers.
struct NumberRows {
  std::size_t columns;
  NumberRange range;
  std::size_t least;
  std::size_t most;
  std::string_view what;  ///< that the rows are, such as "points"
};
/// A list of one or more pairs of numbers.
struct Pairs {
  NumberRange first;
  NumberRange second;
  std::string_view shape;  ///< of a pair, such as "[wavelength_nm, power]"
  std::size_t least = 1;   ///< pairs, for JSON Schema: readers may say more of a list that is too short
};
/// A list of one or more texts.
struct Texts {};
/// A text, or a list of one or more texts.
struct TextOrTexts {
  std::string_view what;  ///< that it must be, for messages
};
/// A list of one or more finite numbers, texts or lists. Its value has the TOML text of each.
struct Anything {};
/// A table of numbers or words, of one or more names; of exactly these names if there are any.
struct ByName {
  std::variant<Number, Word> each;
  std::span<const std::string_view> names = {};
  std::string_view what = "a table";  ///< that it must be, for messages
};
using Kind = std::variant<Number, Whole, Flag, Word, Text, File, WordOrFile, NumberOrNumbers, Numbers, Terms,
                          NumberRows, Pairs, Texts, TextOrTexts, Anything, ByName>;

/// The form of a value, in which rows of one key may differ.
enum class Form { other, number, text, list, table };
/// Whether a value of that form may be of the kind.
bool takes(const Kind& kind, Form form);

/// The key must be given.
struct Required {};
/// Without the key its object stays as it was made.
struct None {};
/// The same, and a sentence says what then holds.
struct Computed {
  std::string_view sentence;
};
/// What holds without a key; of a word: the word.
using Default = std::variant<Required, None, Computed, bool, double, std::string_view, std::span<const double>>;
inline constexpr Required kRequired;
inline constexpr None kNone;

/// What another key must be for a key to mean something. That key is looked for in the same table and then in those
/// around it; "element.kind" is the key of a table there.
struct Condition {
  enum class Is { one_of, none_of, given, absent };
  std::string_view key;
  Is is = Is::one_of;
  std::span<const std::string_view> words = {};  ///< of one_of and none_of
  std::string_view refusal =
      {};  ///< what is said of a key that was given all the same, if it needs more than the condition
};
/// All of them must hold.
using When = std::span<const Condition>;

/// A key of a table. There may be several rows of one key, of which at most one serves a file by its conditions and the
/// form of what was given.
struct Row {
  constexpr Row(std::string_view of_key, Kind of_kind, Default by_default, std::string_view sentence, Access by = {},
                When only_when = {})
      : key(of_key), kind(of_kind), otherwise(by_default), meaning(sentence), access(by), when(only_when) {}
  constexpr Row(std::string_view of_key, Kind of_kind, Default by_default, std::string_view sentence, When only_when,
                bool may_be_zero = false)
      : Row(of_key, of_kind, by_default, sentence, Access{}, only_when) {
    zero_is_none = may_be_zero;
  }

  std::string_view key;
  Kind kind;
  Default otherwise;
  std::string_view meaning;  ///< one sentence
  Access access;
  When when;
  bool zero_is_none = false;  ///< 0 is let pass where the conditions do not hold
};
inline constexpr bool kZeroIsNone = true;

/// Exactly one of `keys` must be given.
struct OneOf {
  std::span<const std::string_view> keys;
  std::string_view complaint;  ///< what the message says if none is
};
/// Throws an InputError that says what is wrong with a key, by its path from the table whose rule it is; without one,
/// with the rule's first key that was given, or with the table.
using Refuse = std::function<void(std::string_view key, const std::string& complaint)>;
/// What must hold between values that are allowed each by itself.
struct Check {
  std::span<const std::string_view> keys;  ///< that it ties, by their paths from the table; none: all of the table
  std::string_view meaning;                ///< one sentence
  /// \param object that of the table; of formats that are read as documents alone: the document
  void (*check)(const void* object, const Refuse& refuse);
};
/// Rule that one key, called the winner, takes precedence over other keys, which then have no effect. If the input
/// gives such a key without effect, a warning names this key and the winner.
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
  implied,  ///< one that is not given is an empty one
  list      ///< any number of tables of that name, none included
};

/// How a table is written.
enum class Layout {
  headed,  ///< [name]
  in_line  ///< name = { ... }
};

/// How the object of a table comes from that of the table around it.
struct Child {
  std::size_t (*count)(const void* parent);
  const void* (*at)(const void* parent, std::size_t index);
  void* (*add)(void* parent);  ///< the one that is to be filled
};

/// Keys and tables under a name. The values of a root's object are the whole file's.
struct Table {
  std::string_view name;     ///< empty: the root
  std::string_view meaning;  ///< one sentence
  std::span<const Row> rows = {};
  std::span<const Table> tables = {};
  std::span<const Rule> rules = {};
  Child child = {};
  Presence presence = Presence::always;
  Layout layout = Layout::headed;
  std::string_view shape = {};          ///< what it must be, for messages, if not a table or tables
  std::string_view otherwise = "none";  ///< what holds without an optional table
  When when = {};
  bool is_open = false;  ///< names that it does not have are another reader's and let pass
};

struct Format {
  std::string_view name;  ///< "process"
  std::string_view id;    ///< "retrace.process/1": what the key `schema` says
  std::string_view title;
  Table root;
  bool id_is_optional = false;
};

/// The unit that the suffix of a name stands for, such as "mm/min" of `feed_mm_per_min`; empty without one.
std::string_view unit_of(std::string_view name);

/// What a key may be, as messages say it: "> 0 and <= 100", "a list of 3 numbers".
std::string allowed(const Kind& kind);

/// The value that a key has by default; nothing if it has none.
Value default_value(const Row& row);

/// A path as that of the table around a key or table, empty at the top, and its own name.
struct SplitPath {
  std::string_view around;
  std::string_view name;
};
SplitPath split_path(std::string_view path);

/// The table of that path, "" the root itself; null if there is none.
const Table* table_at(const Table& root, std::string_view path);

/// The path of a key or table within the one that `around` is the path of.
std::string path_in(std::string_view around, std::string_view name);
/// The path of an entry of a list of tables, from 0: "hole[1]".
std::string path_of_entry(std::string_view list, std::size_t index);

}  // namespace retrace::schema

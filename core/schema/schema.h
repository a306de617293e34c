#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/number_range.h"

// What a file format is, as constant data: its keys, what each may be, and where it goes. Readers, writers, JSON Schema
// and the tables of the documentation walk these rows.

namespace retrace::schema {

/// A value on its way between a file and an object. A word is its index among the words of its key, a whole number a
/// double, nothing a key that is not given.
using Value = std::variant<std::monostate, bool, double, std::string, std::vector<double>,
                           std::vector<std::vector<double>>, std::vector<std::string>>;

/// How a value comes from an object and goes into it (core/schema/access.h makes both). A value that an object does not
/// have, or that another key says, is got as nothing.
struct Access {
  Value (*get)(const void* object);
  void (*set)(void* object, const Value& value);  ///< \pre the value is of the key's kind
};

// What a key may be. Numbers are finite; their unit is the suffix of the key, or of the table around it.

struct Number {
  NumberRange range;
};
/// \pre the range's ends are whole and within 2^53
struct Whole {
  NumberRange range;
};
struct Flag {};
struct Word {
  std::span<const std::string_view> words;
};
struct Text {};
/// A list of exactly so many numbers.
struct Numbers {
  std::size_t count;
  NumberRange range;
};
/// A list of lists of exactly `columns` numbers.
struct NumberRows {
  std::size_t columns;
  NumberRange range;
  std::size_t least;
  std::size_t most;
  std::string_view what;  ///< that the rows are, such as "points"
};
/// A list of one or more texts.
struct Texts {};
using Kind = std::variant<Number, Whole, Flag, Word, Text, Numbers, NumberRows, Texts>;

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

/// A condition on another key, which has one of `words`. That key is looked for in the same table and then in those
/// around it; "element.kind" is the key of a table there.
struct When {
  std::string_view key;  ///< empty: always
  std::span<const std::string_view> words;
};

/// A key of a table. There may be several rows of one key, if at most one of their conditions holds.
struct Row {
  std::string_view key;
  Kind kind;
  Default otherwise;
  std::string_view meaning;  ///< one sentence
  Access access;
  When when = {};
};

/// Exactly one of `keys` must be given.
struct OneOf {
  std::span<const std::string_view> keys;
  std::string_view complaint;  ///< what the message says if none or several are
};
/// What must hold between values that are allowed each by itself.
struct Check {
  std::span<const std::string_view> keys;        ///< the first that was given is blamed; none: the table
  std::string_view meaning;                      ///< one sentence
  std::string (*complaint)(const void* object);  ///< what is wrong; empty: it holds
};
using Rule = std::variant<OneOf, Check>;

enum class Presence {
  always,
  optional,
  list  ///< any number of tables of that name, none included
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
  std::string_view shape = "a table";   ///< what it must be, for messages
  std::string_view otherwise = "none";  ///< what holds without an optional table
  When when = {};
};

struct Format {
  std::string_view name;  ///< "process"
  std::string_view id;    ///< "retrace.process/1": what the key `schema` says
  std::string_view title;
  Table root;
};

/// The unit that the suffix of a name stands for, such as "mm/min" of `feed_mm_per_min`; empty without one.
std::string_view unit_of(std::string_view name);

/// What a key may be, as messages say it: "> 0 and <= 100", "a list of 3 numbers".
std::string allowed(const Kind& kind);

/// The value that a key has by default; nothing if it has none.
Value default_value(const Row& row);

/// A table and its object within the tables around it.
struct Level {
  const Table& table;
  const void* object;
  const Level* around = nullptr;
};

/// Whether the condition holds. \throw std::logic_error if it names no word of these tables
bool holds(const When& when, const Level& level);

}  // namespace retrace::schema

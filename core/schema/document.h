#pragma once

// Values that were read from a file. They are accessed by the paths of their keys. The line of each value is stored, so
// that messages of later checks can refer to it.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"
#include "core/toml_file.h"

namespace retrace::schema {

/// Values of a file, each with its file and line. Keys are given by their paths, such as "element.base_mm" or
/// "surface.scratches[0].facet". Keys that are not given have the default values of the format.
/// \pre for all functions with a path: the format has this key or table
class Document {
 public:
  /// Input from which the document was read.
  struct Origin {
    std::string text;                    ///< text of the file
    std::vector<std::string> overrides;  ///< texts of the form KEY=VALUE or KEY=
  };

  /// \param table description of the table to which the paths are relative; it must outlive the document
  /// \param place position of this table in the file, for messages
  /// \param folder folder to which relative file names in the document refer
  explicit Document(const Table& table, InputLocation place = {}, std::filesystem::path folder = {});

  const Table& table() const { return *table_; }
  /// Returns true if the key or table was given.
  bool has(std::string_view path) const { return given_.contains(path); }
  /// Returns the number of tables in a list of tables. For a single table, returns 1 if it was given and 0 otherwise.
  std::size_t count(std::string_view path) const;
  /// Returns the given value or the default of a key, or std::monostate if there is neither.
  Value value(std::string_view path) const;

  // The following functions return the value of a key as a given type. The key must have a value of this type.
  double number(std::string_view path) const { return std::get<double>(value(path)); }
  bool flag(std::string_view path) const { return std::get<bool>(value(path)); }
  std::string text(std::string_view path) const { return std::get<std::string>(value(path)); }
  /// Returns true if the value is a list.
  bool is_list(std::string_view path) const;
  /// Returns the numbers of a list. A single number is returned as a list of one number.
  std::vector<double> numbers(std::string_view path) const;
  std::vector<std::vector<double>> rows(std::string_view path) const {
    return std::get<std::vector<std::vector<double>>>(value(path));
  }
  /// Returns the value if it is a number, and nothing otherwise.
  std::optional<double> number_if(std::string_view path) const;
  /// Returns the value if it is a text, and an empty text otherwise.
  std::string text_if(std::string_view path) const;
  /// Returns the value of a key as an index into the list of words that the key allows.
  std::size_t index(std::string_view path) const;
  template <class Enum>
  Enum choice(std::string_view path) const {
    return static_cast<Enum>(index(path));
  }
  std::vector<std::string> texts(std::string_view path) const {
    return std::get<std::vector<std::string>>(value(path));
  }
  const Named& named(std::string_view path) const { return std::get<Named>(given_.find(path)->second.value); }
  /// Returns the path of the file that a key names, relative to the working directory.
  /// \pre the key was given
  std::filesystem::path file(std::string_view path) const;
  /// Returns the paths of all keys that name a file, sorted.
  std::vector<std::string> keys_of_files() const;
  /// Returns the files that the keys of keys_of_files() name, in the same order.
  std::vector<std::filesystem::path> files() const;

  /// Returns the name of the file in messages.
  const std::string& source() const { return location_.file; }
  /// Returns the input from which the document was read. It is empty if the document was not read from a text.
  const Origin& origin() const { return origin_; }
  void set_origin(Origin origin) { origin_ = std::move(origin); }
  /// Returns the former names that the input contains instead of current ones.
  const std::vector<RenamedInput>& renamed() const { return renamed_; }
  void set_renamed(std::vector<RenamedInput> renamed) { renamed_ = std::move(renamed); }
  /// Returns the value of a key that is a text, as it was written in the input: a former word is not replaced.
  std::string text_as_written(std::string_view path) const;
  /// Returns the position (file, line, key) of a key. If the key was not given, the line is that of its table.
  InputLocation where(std::string_view path) const;
  [[noreturn]] void fail(std::string_view path, std::string_view text) const { throw InputError(where(path), text); }

  /// Returns the row (the description of a key) that applies to a key because its conditions hold. Returns null if no
  /// row applies.
  const Row* row(std::string_view path) const;
  /// Returns true if all conditions of a key or table hold.
  /// \param around path of the table that contains the key or table
  bool holds(When when, std::string_view around) const { return refused_by(when, around) == nullptr; }
  /// Returns the first condition that does not hold, or null if all conditions hold.
  const Condition* refused_by(When when, std::string_view around) const;

  /// Records that the input contains a key, a table or an entry of a list.
  /// \param path path of the key, table or entry, such as "element.base_mm"
  /// \param value value of the key; empty for a table or an entry of a list
  /// \param place file and line of the key
  /// \param source 0 if the key comes from the file; otherwise the number, from 1, of the override that sets it
  void set(const std::string& path, Value value, InputLocation place = {}, std::size_t source = 0);
  /// Returns the number, from 1, of the override that sets a key. Returns 0 if the key is set by the file or is not
  /// set.
  std::size_t source_of(std::string_view path) const;
  /// Removes a key, which then counts as not given.
  /// \pre the key was given
  void drop(std::string_view path) { given_.erase(given_.find(path)); }

  /// Returns the path of the key to which a condition refers, see Condition.
  /// \param key key of the condition
  /// \param around path of the table or key that has the condition
  /// \throw std::logic_error if the format has no such key
  std::string path_of(std::string_view key, std::string_view around) const;

 private:
  struct Given {
    Value value;
    InputLocation location;
    std::size_t source = 0;
  };

  const Table* table_;
  InputLocation location_;
  std::filesystem::path folder_;
  Origin origin_;
  std::vector<RenamedInput> renamed_;
  std::map<std::string, Given, std::less<>> given_;
};

}  // namespace retrace::schema

#pragma once

// A file as it was read: its values by the paths of their keys, with the line that each came from, so that later checks
// can still point at it.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"

namespace retrace::schema {

/// What a file says: the values that it gave, each with its place, under the paths of their keys, such as
/// "element.base_mm" or "surface.scratches[0].facet". Values that were not given are those of the format's defaults.
/// \pre of every function with a path: the format has that key or table
class Document {
 public:
  /// What it was read from.
  struct Origin {
    std::string text;
    std::vector<std::string> overrides;  ///< each KEY=VALUE
  };

  /// \param table whose keys the paths are; it must outlive the document. \param place of that table
  /// \param folder that names of files are meant from
  explicit Document(const Table& table, InputLocation place = {}, std::filesystem::path folder = {});

  const Table& table() const { return *table_; }
  /// Whether the file gave that key or table.
  bool has(std::string_view path) const { return given_.contains(path); }
  /// How many tables a list has; of a single table 1 if it was given.
  std::size_t count(std::string_view path) const;
  /// What was given or holds by default; nothing if neither is so.
  Value value(std::string_view path) const;

  // The same of a key of that kind that was given, is required or has a default.
  double number(std::string_view path) const { return std::get<double>(value(path)); }
  bool flag(std::string_view path) const { return std::get<bool>(value(path)); }
  std::string text(std::string_view path) const { return std::get<std::string>(value(path)); }
  /// Whether the value is a list.
  bool is_list(std::string_view path) const;
  /// A single number is a list of one.
  std::vector<double> numbers(std::string_view path) const;
  std::vector<std::vector<double>> rows(std::string_view path) const {
    return std::get<std::vector<std::vector<double>>>(value(path));
  }
  /// Nothing if there is no such value.
  std::optional<double> number_if(std::string_view path) const;
  /// Empty if there is no such value.
  std::string text_if(std::string_view path) const;
  /// The index of the word among those of its key.
  std::size_t index(std::string_view path) const;
  template <class Enum>
  Enum choice(std::string_view path) const {
    return static_cast<Enum>(index(path));
  }
  std::vector<std::string> texts(std::string_view path) const {
    return std::get<std::vector<std::string>>(value(path));
  }
  const Named& named(std::string_view path) const { return std::get<Named>(given_.find(path)->second.value); }
  /// The file that a key names, from the working directory. \pre it was given
  std::filesystem::path file(std::string_view path) const;
  /// Every key that names a file, in their order, and the files.
  std::vector<std::string> keys_of_files() const;
  std::vector<std::filesystem::path> files() const;

  /// What messages call the file.
  const std::string& source() const { return place_.file; }
  /// Of a document that was read from a file; otherwise empty.
  const Origin& origin() const { return origin_; }
  void set_origin(Origin origin) { origin_ = std::move(origin); }
  /// Where a key was given, or would be missed.
  InputLocation where(std::string_view path) const;
  [[noreturn]] void fail(std::string_view path, std::string_view text) const { throw InputError(where(path), text); }

  /// The row that serves a key; none if its conditions do not hold for any.
  const Row* row(std::string_view path) const;
  /// Whether the conditions of a key or table within the table `around` hold.
  bool holds(When when, std::string_view around) const { return refused_by(when, around) == nullptr; }
  /// The first of the conditions that does not hold; null if all do.
  const Condition* refused_by(When when, std::string_view around) const;

  /// Records that the input contains a key, a table or an entry of a list.
  /// \param path path of the key, table or entry, such as "element.base_mm"
  /// \param value value of the key; empty for a table or an entry of a list
  /// \param place file and line of the key
  /// \param source 0 if the key comes from the file; otherwise the number, from 1, of the override that sets it
  void set(const std::string& path, Value value, InputLocation place = {}, std::size_t source = 0);
  /// Returns the number, from 1, of the override that sets a key. Returns 0 if the file sets the key or nothing does.
  std::size_t source_of(std::string_view path) const;
  /// Takes a key back. \pre it was given
  void drop(std::string_view path) { given_.erase(given_.find(path)); }

  /// The path of the key that a condition within the table or key `around` means.
  /// \throw std::logic_error if the format has none
  std::string path_of(std::string_view key, std::string_view around) const;

 private:
  struct Given {
    Value value;
    InputLocation place;
    std::size_t source = 0;
  };

  const Table* table_;
  InputLocation place_;
  std::filesystem::path folder_;
  Origin origin_;
  std::map<std::string, Given, std::less<>> given_;
};

}  // namespace retrace::schema

#pragma once

// Internal to studies/design: toml++ stays inside this folder. The library is linked, not used header-only (its build
// settings come with the CMake target), because its parser's asserts are live in any header-only build without NDEBUG.
#include <toml++/toml.h>

#include <compare>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"

namespace retrace::studies {

/// A design file as a TOML tree with the `--set` overrides applied, every value still knowing where it came from.
class DesignDocument {
 public:
  /// \throw InputError for text that is not TOML, that is longer than `max_bytes`, or an override that is not
  /// KEY=VALUE.
  DesignDocument(std::string_view text, std::string_view source_name, std::span<const std::string> overrides);

  /// toml++ recurses once per level when it destroys a tree, and two bytes of `a.a.a...` make a level: 64 KiB of it run
  /// out of an 8 MiB stack. A design file has about one KiB.
  static constexpr std::size_t max_bytes = 16384;

  const toml::table& root() const { return root_; }

  /// Where `node` was written: file and line, or the override's text. `key` is the name to show.
  InputLocation location(const toml::node& node, std::string_view key) const;
  /// Where to report that `key` is missing from `table` (null: the table is missing too): the line of the table's head.
  InputLocation location_of_missing(const toml::node* table, std::string_view key) const;

  /// The folder from which paths in `node` are meant: the design file's; empty for overrides.
  std::filesystem::path folder(const toml::node& node) const;

  /// Remembers a file that a key names: what readers take as the name of a file, they hand in here.
  void add_file(std::filesystem::path file) const { files_.push_back(std::move(file)); }
  /// Files that were named by the keys that have been read, from the working directory.
  const std::vector<std::filesystem::path>& files() const { return files_; }

  /// Orders nodes as they were written: the file from top to bottom, then the overrides.
  struct Position {
    std::size_t source = 0;
    std::size_t line = 0;
    std::size_t column = 0;
    friend auto operator<=>(const Position&, const Position&) = default;
  };
  Position position(const toml::node& node) const;

 private:
  void apply_override(const std::string& text);
  std::size_t source_index(const toml::node& node) const;

  std::string file_;
  std::filesystem::path folder_;
  toml::table root_;
  std::vector<toml::source_path_ptr> sources_;  ///< the file, then one a `--set`
  mutable std::vector<std::filesystem::path> files_;
};

}  // namespace retrace::studies

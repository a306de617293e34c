#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace retrace::layering {

using Names = std::set<std::string>;
/// Folders or rooms (subfolders). The value of each name is the set of names that it may include.
using Order = std::map<std::string, Names>;

/// Order of folders, and of the rooms in a folder. Files directly in a folder with rooms are below all of its rooms.
struct Rules {
  Order folders;
  std::map<std::string, Order> rooms;  ///< key: name of the folder
  /// Rooms of studies/ that may include fabrication/, directly or indirectly. All other rooms must not depend on tools.
  Names studies_that_see_fabrication;
};

/// Reads the rules from a JSON file.
/// \throw std::runtime_error if a folder or room is listed before one that it may include
Rules read_rules(const std::filesystem::path& file);

/// An include, or the use of a type or namespace, that violates the order of folders and rooms.
struct Violation {
  std::string file;  ///< path relative to the root of the tree
  int line = 0;
  std::string text;
};

/// Returns the violation as one line in the format of compilers: `file:line: text`.
std::string to_string(const Violation& violation);

/// Checks every source file below `root` for includes that violate the order of folders and rooms, and for external
/// libraries that the file may not use. The use of a type counts like an include of the header that declares it, if
/// only one folder or room declares a type of this name.
/// \throw std::runtime_error if `root` is not a source tree (there is no core/, or no file to check)
std::vector<Violation> check_tree(const std::filesystem::path& root, const Rules& rules);

}  // namespace retrace::layering

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace retrace::layering {

/// An include that violates the order of folders and rooms (subfolders).
struct Violation {
  std::string file;  ///< path relative to the root of the tree
  int line = 0;
  std::string text;
};

/// Returns the violation as one line in the format of compilers: `file:line: text`.
std::string to_string(const Violation& violation);

/// Checks the includes of every source file below `root`: which folders and rooms (subfolders) a file may include, and
/// in which files an external library may be used.
/// \throw std::runtime_error if `root` is not a source tree (there is no core/, or no file to check)
std::vector<Violation> check_tree(const std::filesystem::path& root);

/// Returns a text with one line for each folder, from the highest to the lowest: its floor, its name and the folders
/// that it may include.
std::string layer_picture();

}  // namespace retrace::layering

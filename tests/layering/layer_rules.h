#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace retrace::layering {

/// An include that the order of folders and rooms forbids.
struct Violation {
  std::string file;  ///< relative to the tree's root
  int line = 0;
  std::string text;
};

/// One line, as a compiler would write it: `file:line: text`.
std::string to_string(const Violation& violation);

/// Checks every source file below `root` against the house's order: which folder and which room of it may see which,
/// and where a library may be named. \throw std::runtime_error if `root` is no such tree (no core/, or nothing to
/// check).
std::vector<Violation> check_tree(const std::filesystem::path& root);

/// A line for each folder, the highest first: its floor, its name and what it may include.
std::string layer_picture();

}  // namespace retrace::layering

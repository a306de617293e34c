#pragma once

// Contents of files that a caller has in memory. They are used instead of the files with these names.

#include <map>
#include <string>

#include "core/atomic_file.h"

namespace retrace {

/// Contents of files by file name. If a name is in the map, the file of this name is not read.
using FileTexts = std::map<std::string, std::string>;

/// Returns the content of a file, from `texts` if it contains the file, and otherwise from the file system.
/// \throw InputError like read_file()
inline std::string text_of_file(const std::string& file, const FileTexts& texts,
                                std::size_t max_bytes = kMaxTextBytes) {
  const auto given = texts.find(file);
  return given == texts.end() ? read_file(file, max_bytes) : given->second;
}

}  // namespace retrace

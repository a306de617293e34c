#pragma once

// Texts that stand for files: who has a file's content in memory hands it on under a name.

#include <map>
#include <string>

#include "core/atomic_file.h"

namespace retrace {

/// Contents by the names of the files that they stand for, which are then not read.
using FileTexts = std::map<std::string, std::string>;

/// The content of a file, given or read. \throw InputError as read_file()
inline std::string text_of_file(const std::string& file, const FileTexts& texts,
                                std::size_t most_bytes = kMostTextBytes) {
  const auto given = texts.find(file);
  return given == texts.end() ? read_file(file, most_bytes) : given->second;
}

}  // namespace retrace

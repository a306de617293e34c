#pragma once

// Reads design files, applies --set overrides, and varies designs that were read.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/design/design.h"

namespace retrace::studies {

/// Reads and checks a design file; "-" is standard input.
/// \param overrides Each text `key=value`, such as `element.base_mm=0.4`, replaces the value in the file. A value that
///        is invalid as TOML is read as a string, such as `array.arrangement=offset`. The text `key=` removes the key.
///        If several texts have the same key, the last one applies.
/// \throw InputError naming file, line, key, what was given and what is allowed, on one line.
Design read_design(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// The same for the text of a design file; `source_name` stands for the file in messages and in Design::source.
Design parse_design(std::string_view text, const std::string& source_name, std::span<const std::string> overrides = {});

/// A design with some keys at other values: it is read again, so that all that is checked of designs holds of it.
/// \pre if it is from a file, it is as that file says \param overrides as of read_design() \throw InputError likewise
Design with(const Design& design, std::span<const std::string> overrides);

/// File whose name is the value of a key of a design.
struct NamedFile {
  std::filesystem::path file;
  std::string key;
  InputLocation where;  ///< position of the key
};

/// Returns the files whose names are values of keys of a design. Reading stops at the first key with an error. The text
/// need not be a valid design.
std::vector<NamedFile> files_named(std::string_view text, const std::string& source_name,
                                   std::span<const std::string> overrides = {});

/// The text of a TOML file as read_design() reads it: "-" is standard input, and no more is read of it or of any other
/// file without an end than shows that it is too long. \throw InputError
std::string read_toml_text(const std::filesystem::path& file);

}  // namespace retrace::studies

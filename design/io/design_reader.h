#pragma once

// Reads design files, applies overrides of the option --set, and creates variants of designs.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "design/design.h"

namespace retrace::design {

/// Reads and checks a design file; "-" is standard input.
/// \param overrides list of `key=value`, such as `element.base_mm=0.4`. Each replaces the value in the file. A value
///        that is invalid as TOML is read as a string, such as `array.arrangement=offset`. The text `key=` removes the
///        key. If several texts have the same key, the last one applies.
/// \throw InputError with a message on one line that contains file, line, key, the allowed values and the given value
Design read_design(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// Reads and checks the text of a design file. `source_name` is the name of the file in messages and in Design::source.
Design parse_design(std::string_view text, const std::string& source_name, std::span<const std::string> overrides = {});

/// Returns a variant of a design with other values of some keys. The variant is read again, so that all checks of
/// designs are applied to it.
/// \pre if the design was read from a file, the Design object has not been modified since then
/// \param overrides as for read_design()
/// \throw InputError under the same conditions as read_design()
Design with(const Design& design, std::span<const std::string> overrides);

/// Sets the file position of a key of the design. Messages about the key report this position.
void set_where(Design& design, const std::string& key, InputLocation place);

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

/// Returns the text of a TOML file; "-" is standard input. Files above the size limit are refused without being read to
/// their end.
/// \throw InputError if the file cannot be read or is too long
std::string read_toml_text(const std::filesystem::path& file);

}  // namespace retrace::design

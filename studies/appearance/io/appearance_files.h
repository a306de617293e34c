#pragma once

// Writes the reflection of a part as a material, for renderers and simulators, and the document of `retrace export` to
// it.

#include <optional>
#include <string>

#include "studies/appearance/appearance.h"

namespace retrace::studies {

enum class AppearanceFormat { table, radiance, glsl };

/// By the ending of a file's name, in small or capital letters: .json, .xml or .glsl; none for other files.
std::optional<AppearanceFormat> appearance_format(const std::string& file);

/// A material in a format: what its files hold, and how far it is from the photometer.
struct AppearanceText {
  std::string text;
  std::string values;                    ///< of a table: the file beside it, CSV; empty for other formats
  std::string what;                      ///< one line about what the format makes of the table; empty for the table
  std::optional<AppearanceError> error;  ///< of lobes
};

/// \param values_name of the file beside it
/// \pre result.complete
AppearanceText appearance_text(const AppearanceResult& result, AppearanceFormat format, const std::string& values_name);

/// The document `retrace.export/1` of a material.
std::string appearance_json(const AppearanceResult& result, const AppearanceText& text, const std::string& file);

/// The figures as a table for the terminal.
std::string appearance_table(const AppearanceResult& result, const AppearanceText& text);

}  // namespace retrace::studies

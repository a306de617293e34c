#pragma once

// Writes the reflection of a part as a material for renderers and simulators, and the document of `retrace export`.

#include <optional>
#include <string>

#include "studies/appearance/appearance.h"

namespace retrace::studies {

enum class AppearanceFormat { table, radiance, glsl };

/// Returns the format for which the ending of a file's name stands, in lower or upper case: .json, .xml or .glsl.
/// Returns nothing for other endings.
std::optional<AppearanceFormat> appearance_format(const std::string& file);

/// Material in a file format: contents of its files, and its error compared with the photometer.
struct AppearanceText {
  std::string text;
  std::string values;                    ///< CSV file that belongs to a table; empty for other formats
  std::string what;                      ///< one line on how the format approximates the table; empty for the table
  std::optional<AppearanceError> error;  ///< error of the fitted lobes
};

/// Returns the material in a format.
/// \param values_name name of the CSV file that belongs to a table
/// \pre result.complete
AppearanceText appearance_text(const AppearanceResult& result, AppearanceFormat format, const std::string& values_name);

/// Returns the document `retrace.export/1` of a material.
std::string appearance_json(const AppearanceResult& result, const AppearanceText& text, const std::string& file);

/// Returns the figures of a material as a table for the terminal.
std::string appearance_table(const AppearanceResult& result, const AppearanceText& text);

}  // namespace retrace::studies

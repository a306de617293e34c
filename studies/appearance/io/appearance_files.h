#pragma once

// Writes the reflection of a part in formats that renderers and simulators use as materials. Also writes the document
// and the table of `retrace export`.

#include <optional>
#include <string>

#include "studies/appearance/appearance.h"

namespace retrace::studies {

enum class AppearanceFormat { table, radiance, glsl };

/// Returns the format that belongs to the ending of a file name: .json, .xml or .glsl, in lower or upper case. Returns
/// nothing for other endings.
std::optional<AppearanceFormat> appearance_format(const std::string& file);

/// Material in a file format: contents of its files, and its error compared with the photometer.
struct AppearanceText {
  std::string text;
  std::string values;  ///< CSV file that belongs to a table; empty for other formats
  std::string
      approximation;  ///< one line on how the format approximates the table; empty if the format is the table itself
  std::optional<AppearanceError> error;  ///< error of the fitted lobes
};

/// Returns the material in a format.
/// \param values_name name of the CSV file that belongs to a table
/// \pre result.complete
AppearanceText appearance_text(const AppearanceResult& result, AppearanceFormat format, const std::string& values_name);

/// Returns the document `retrace.export/2` of a material.
std::string appearance_json(const AppearanceResult& result, const AppearanceText& text, const std::string& file);

/// Returns the main values of a material as a table for the terminal.
std::string appearance_table(const AppearanceResult& result, const AppearanceText& text);

}  // namespace retrace::studies

#pragma once

// Reads height maps of instruments: text grids, lists of points, SDF, and the Gwyddion formats GSF and GWY.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/warning.h"
#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Information from the user about a file. It takes precedence over the contents of the file.
struct HeightMapOptions {
  std::optional<double> x_pixel_um;         ///< distance between neighbours along x
  std::optional<double> y_pixel_um;         ///< distance between neighbours along y
  std::optional<std::string> height_unit;   ///< m, mm, um, nm or pm
  std::optional<std::string> lateral_unit;  ///< m, mm, um, nm or pm; for files that contain lengths without a unit
  std::optional<std::size_t> channel;       ///< channel of a Gwyddion file; default: the first
  /// true if error messages about a missing spacing or unit may suggest an option of `retrace metrology`
  bool suggests_options = true;
};

struct HeightMapFile {
  HeightMap map;
  std::string format;  ///< such as "Gwyddion native (GWY)"
  Warnings warnings;
};

/// Maximum number of points in a map: 5000 x 5000. Larger files are refused.
inline constexpr std::size_t kMaxPoints = 25'000'000;
/// Minimum number of points along x.
inline constexpr std::size_t kMinColumns = 8;

/// Reads a height map or profile: text grids, lists of points, SDF (ISO 25178-71, ASCII), and the Gwyddion formats GSF
/// and GWY. The format is detected from the content. There is one exception: in a `.xyz` file, three columns are a list
/// of points.
/// \throw InputError with the file, the line (in text files) and the allowed values
HeightMapFile read_height_map(const std::filesystem::path& file, const HeightMapOptions& options);

/// Reads a height map from the content of a file with the name `name`.
HeightMapFile parse_height_map(std::string_view content, const std::string& name, const HeightMapOptions& options);

}  // namespace retrace::surface_models

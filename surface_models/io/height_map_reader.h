#pragma once

// Reads height maps of instruments: text grids and point lists, SDF, and Gwyddion's GSF and GWY.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// What the user says of a file; it goes before what the file itself says.
struct HeightMapOptions {
  std::optional<double> x_pixel_um;         ///< distance of neighbours along x
  std::optional<double> y_pixel_um;         ///< and along y
  std::optional<std::string> height_unit;   ///< m, mm, um, nm or pm
  std::optional<std::string> lateral_unit;  ///< the same words, for files that give lengths without a unit
  std::optional<std::size_t> channel;       ///< of a Gwyddion file; default: the first
  bool can_be_given = true;                 ///< whether messages may ask for these as options of retrace metrology
};

struct HeightMapFile {
  HeightMap map;
  std::string format;  ///< such as "Gwyddion native (GWY)"
  Warnings warnings;
};

/// Most points of a map: 5000 x 5000. Larger files are refused.
inline constexpr std::size_t kMostPoints = 25'000'000;
/// Fewest points along x.
inline constexpr std::size_t kLeastColumns = 8;

/// Reads a height map or profile: text grids and point lists, SDF (ISO 25178-71, ASCII), Gwyddion's GSF and GWY. The
/// format is told from the content, but for `.xyz`, which makes three columns a list of points.
/// \throw InputError naming file, line where it is text, and what is allowed
HeightMapFile read_height_map(const std::filesystem::path& file, const HeightMapOptions& options);

/// The same for the content of a file called `name`.
HeightMapFile parse_height_map(std::string_view content, const std::string& name, const HeightMapOptions& options);

}  // namespace retrace::surface_models

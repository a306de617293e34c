#pragma once

// Tables of a file that describe a freeform surface, and keys that define its machined region.

#include <cstddef>
#include <span>
#include <string>

#include "core/schema/conditions.h"
#include "core/schema/document.h"
#include "core/schema/schema.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::geometry {

inline constexpr std::string_view kTurnedPartId = "retrace.turned_part/1";
inline constexpr std::size_t kMaxLenslets = 100000;

/// Returns the tables [base], [boundary], [extrapolation] and [lenslets].
std::span<const schema::Table> surface_tables();

/// Reads the surface that these tables describe.
/// \throw InputError with file, line and key
FreeformSurface read_surface(const schema::Document& file);
/// Returns the location in the file that is named in error messages about the whole surface.
InputLocation surface_location(const schema::Document& file);

/// Keys of the table [path] that define the machined region of the surface.
inline constexpr schema::Words kStrategies = {"spiral", "raster"};
inline constexpr schema::Condition kSpiralOnly[] = {schema::is("strategy", schema::only(kStrategies, "spiral"))};
inline constexpr schema::Condition kRasterOnly[] = {schema::is("strategy", schema::only(kStrategies, "raster"))};
inline constexpr schema::Row kStrategyRow = {"strategy", schema::Word{kStrategies}, "spiral",
                                             "Pattern of the tool path over the part."};
inline constexpr NumberRange kRegionSize = {.low = 0.0, .low_included = false, .high = 1e4};
inline constexpr schema::Row kRegionRadiusRow = {"radius_mm", schema::Number{kRegionSize}, schema::kRequired,
                                                 "Radius of the part, which is round.", kSpiralOnly};
inline constexpr schema::Row kRegionSizeRow = {
    "size_mm", schema::Numbers{2, kRegionSize}, schema::kRequired,
    "Size of the part: `[size across the lines of the raster (X), size along these lines (Y)]`.", kRasterOnly};

/// Data of a turned part that ray tracing needs: the surface and its machined region.
struct TurnedEntrance {
  FreeformSurface surface;
  bool is_round = true;
  double radius_mm = 0.0;       ///< radius of a round region
  Vec2 size_mm = Vec2::Zero();  ///< size of a rectangular region
};

/// Reads the surface and the machined region from the file of a turned part. Keys about the tool, its path and the
/// required accuracy are ignored. The surface must be finite and must not be vertical within the region.
/// \throw InputError with file, line and key
TurnedEntrance parse_turned_entrance(std::string_view text, const std::string& source_name);

}  // namespace retrace::geometry

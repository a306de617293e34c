#pragma once

// The tables of a file that describe a freeform surface, and the region over which it is made.

#include <cstddef>
#include <span>
#include <string>

#include "core/schema/conditions.h"
#include "core/schema/document.h"
#include "core/schema/schema.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::geometry {

inline constexpr std::string_view kTurnedPartId = "retrace.turned_part/1";
inline constexpr std::size_t kMostLenslets = 100000;

/// [base], [boundary], [extrapolation] and [lenslets].
std::span<const schema::Table> surface_tables();

/// The surface that these tables say. \throw InputError with file, line and key
FreeformSurface read_surface(const schema::Document& file);
/// The table that is blamed for what is wrong with the whole surface.
InputLocation surface_place(const schema::Document& file);

/// Rows of [path] that say over which region the surface is made.
inline constexpr schema::Words kStrategies = {"spiral", "raster"};
inline constexpr schema::Condition kSpiralOnly[] = {schema::is("strategy", schema::only(kStrategies, "spiral"))};
inline constexpr schema::Condition kRasterOnly[] = {schema::is("strategy", schema::only(kStrategies, "raster"))};
inline constexpr schema::Row kStrategyRow = {"strategy", schema::Word{kStrategies}, "spiral",
                                             "How the tool goes over the part."};
inline constexpr NumberRange kRegionSize = {.low = 0.0, .low_included = false, .high = 1e4};
inline constexpr schema::Row kRegionRadiusRow = {"radius_mm", schema::Number{kRegionSize}, schema::kRequired,
                                                 "From the part's rim to the centre.", kSpiralOnly};
inline constexpr schema::Row kRegionSizeRow = {"size_mm", schema::Numbers{2, kRegionSize}, schema::kRequired,
                                               "`[across the lines (X), along them (Y)]`.", kRasterOnly};

/// A turned part as light meets it: its surface, and where that is made.
struct TurnedFront {
  FreeformSurface surface;
  bool is_round = true;
  double radius_mm = 0.0;       ///< of a round region
  Vec2 size_mm = Vec2::Zero();  ///< of a rectangular one
};

/// Reads what a turned part's file says of its surface and region; of the tool, how it moves and what is asked of the
/// result, nothing. The surface is finite and has no vertical slope there. \throw InputError with file, line and key
TurnedFront parse_turned_front(std::string_view text, const std::string& source_name);

}  // namespace retrace::geometry

#pragma once

// Flat lenses of zones as data, with the planing mill or lathe that is to make them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"

namespace retrace::fabrication {

/// A flat lens of zones: flat on one side, stepped hyperbolas on the side of the focus. Lengths in mm, of a cylindrical
/// lens across its zones, of a round one along the radius. Lengths > 0, index > 1.
struct ZoneLens {
  double focal_length_mm = 0.0;  ///< from the middle of the stepped face
  double wavelength_mm = 0.0;    ///< in air
  double refractive_index = 0.0;
  double half_width_mm = 0.0;
};

/// A milling machine that planes: its spindle stands still, which it allows in fast feed alone, so that every move is
/// of one axis and no shorter than the least that fast feed makes. X across the zones, Y along them, Z up.
struct PlaningMill {
  double fast_feed_mm_per_min = 0.0;
  double frame_s = 0.0;  ///< that a frame takes beside its move
  double grid_mm = 0.01;
  double least_x_mm = 13.0;
  double least_y_mm = 13.0;
  double least_z_mm = 6.0;
  double travel_x_mm = 350.0;
  double travel_y_mm = 1500.0;
  double travel_z_mm = 400.0;
  double most_hours = 8.0;
  double run_out_mm = 20.0;  ///< by which strokes begin and end beside the part
  double clear_mm = 14.0;    ///< height above the blank of moves over it
};

/// Senses in which a spindle turns: M3 and M4 of ISO 6983-1, where clockwise drives a right-hand screw away from the
/// headstock.
enum class SpindleDirection { clockwise, counterclockwise };
inline constexpr std::string_view kSpindleDirectionWords[] = {"clockwise", "counterclockwise"};

/// A lathe: X is the radius, Z along the axis, both at a time. Words are those of the nose's lowest point.
struct PlaningLathe {
  double feed_mm_per_min = 0.0;
  double depth_of_cut_mm = 1.0;  ///< of a pass
  double clear_mm = 2.0;
  double nose_radius_mm = 0.0;  ///< of the tool
  std::int32_t spindle_rpm = 0;
  SpindleDirection spindle_direction = SpindleDirection::clockwise;
  /// Program line that starts the spindle, for dialects without spindle words; empty: none.
  std::string spindle_start;
  /// Program line that stops the spindle; given if and only if spindle_start is given.
  std::string spindle_stop;
  InputLocation spindle_start_at;    ///< location of spindle_start in the file
  bool has_unchecked_lines = false;  ///< true: spindle_start and spindle_stop are not checked
};

/// A flat optical element that is to be planed or turned.
struct PlanedPart {
  std::string source;
  std::string title;
  ZoneLens lens;
  double length_mm = 0.0;     ///< along the zones of a cylindrical lens; mill only
  double tolerance_mm = 0.0;  ///< of depth (mill), of distance (lathe)
  std::optional<PlaningMill> mill;
  std::optional<PlaningLathe> lathe;  ///< one of the two
};

}  // namespace retrace::fabrication

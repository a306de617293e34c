#pragma once

// Data of flat zone lenses and of the planing mill or lathe that makes them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/warning.h"

namespace retrace::fabrication {

/// Flat zone lens: one side is flat. The side that faces the focus has a stepped profile, and each step is a piece of a
/// hyperbola. Widths are across the zones of a cylindrical lens, or along the radius of a round lens. All lengths are
/// positive, and the index is above 1.
struct ZoneLens {
  double focal_length_mm = 0.0;  ///< distance of the focus from the centre of the stepped face
  double wavelength_mm = 0.0;    ///< wavelength in air
  double refractive_index = 0.0;
  double half_width_mm = 0.0;
};

/// Milling machine used for planing, with a spindle that does not rotate. The machine permits a stationary spindle only
/// in fast feed (rapid moves). Every move is therefore along one axis, and has at least the minimum length of fast
/// feed. X is across the zones, Y is along them, and Z is up.
struct PlaningMill {
  double fast_feed_mm_per_min = 0.0;
  double frame_s = 0.0;  ///< frame time: additional time that each move takes
  double grid_mm = 0.01;
  double min_move_x_mm = 13.0, min_move_y_mm = 13.0, min_move_z_mm = 6.0;
  double travel_x_mm = 350.0, travel_y_mm = 1500.0, travel_z_mm = 400.0;
  double max_hours = 8.0;
  double overrun_mm = 20.0;    ///< distance from the part at which strokes begin and end
  double clearance_mm = 14.0;  ///< height of moves above the blank
};

/// Direction of rotation of a spindle: M3 (clockwise) and M4 of ISO 6983-1. Clockwise rotation drives a right-hand
/// screw away from the headstock.
enum class SpindleDirection { clockwise, counterclockwise };
inline constexpr std::string_view kSpindleDirectionWords[] = {"clockwise", "counterclockwise"};

/// Lathe: X is the radius, and Z is along the axis. Both axes can move at the same time. Positions refer to the lowest
/// point of the nose.
struct PlaningLathe {
  double feed_mm_per_min = 0.0;
  double depth_of_cut_mm = 1.0;  ///< maximum depth of cut of a pass
  double clearance_mm = 2.0;
  double nose_radius_mm = 0.0;  ///< nose radius of the tool
  std::int32_t spindle_rpm = 0;
  SpindleDirection spindle_direction = SpindleDirection::clockwise;
  /// Program line that starts the spindle, for dialects without codes for the spindle. It is empty if the part file
  /// does not define the line.
  std::string spindle_start;
  /// Program line that stops the spindle. The part file defines either both lines of the spindle or none of them.
  std::string spindle_stop;
  InputLocation spindle_start_at;    ///< location of spindle_start in the file
  bool has_unchecked_lines = false;  ///< true: spindle_start and spindle_stop are not checked
};

/// Flat optical element that is planed or turned.
struct PlanedPart {
  std::string source;
  std::string title;
  ZoneLens lens;
  double length_mm = 0.0;     ///< length along the zones of a cylindrical lens; mill only
  double tolerance_mm = 0.0;  ///< tolerance of the depth (mill) or of the distance from the profile (lathe)
  std::optional<PlaningMill> mill;
  std::optional<PlaningLathe> lathe;  ///< exactly one of mill and lathe is given
  Warnings warnings;                  ///< warnings about the file of the part
};

}  // namespace retrace::fabrication

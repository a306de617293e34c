#pragma once

// Options of the path of a turning tool, and limits of the machine.

#include <array>
#include <optional>

namespace retrace::fabrication::turning {

enum class Strategy { spiral, raster };
/// Spacing of points along a path: equal angles of the spindle, or equal lengths along the cut.
enum class Sampling { angle, arc };
/// Kind of tool servo. Slow: the slide Z makes the whole motion. Fast: Z follows the mean over a turn, and a fast tool
/// servo adds the difference.
enum class Servo { slow, fast };

struct PathOptions {
  Strategy strategy = Strategy::spiral;
  double radius_mm = 1.0;   ///< spiral: radius of the part
  double overrun_mm = 0.0;  ///< spiral: distance of the tool from the rim of the part at the start
  double width_mm = 0.0;    ///< raster: length of the lines
  double height_mm = 0.0;   ///< raster: size of the part across the lines
  double feed_mm = 5e-3;    ///< feed per turn, or distance between lines
  Servo servo = Servo::slow;
  Sampling sampling = Sampling::angle;
  int points_per_turn = 360;  ///< number of points per turn, for Sampling::angle
  double arc_mm = 5e-3;       ///< distance of points, for Sampling::arc and for rasters
  double spindle_rpm = 60.0;
  double cutting_mm_per_min = 60.0;  ///< raster: cutting speed
  double clearance_mm = 1.0;         ///< clearance above the highest point, for moves without cutting
  double blend_mm = 1e-6;            ///< maximum deviation from the path between moves, due to blending
  double approach_mm_per_min = 5.0;  ///< feed of the downward move to the start of a cut
  /// Angular acceleration of C at both ends of a spiral, between rest and the speed of the spindle. The acceleration is
  /// infinite if no value is given.
  std::optional<double> spin_deg_per_s2 = std::nullopt;
  /// Maximum deviation of cubic moves from a spiral, for controls with such moves. If no value is given, straight moves
  /// are used for all controls.
  std::optional<double> cubic_error_nm = std::nullopt;
};

/// Limits of an axis. Empty values mean no limit.
struct AxisLimits {
  std::optional<double> low_mm, high_mm;
  std::optional<double> speed_mm_per_s;
  std::optional<double> acceleration_mm_per_s2;
  std::optional<double> jerk_mm_per_s3;
};
struct TurningMachine {
  std::array<AxisLimits, 3> axes;  ///< limits of X, Y and Z
  std::optional<double> spindle_rpm;
  std::optional<double> c_acceleration_deg_per_s2;
  std::optional<double> blocks_per_s;  ///< maximum number of blocks that the control executes per second
  AxisLimits servo;                    ///< limits of the stroke of a fast tool servo
};

}  // namespace retrace::fabrication::turning

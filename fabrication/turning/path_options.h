#pragma once

// What is asked of the path of a turning tool, and the limits of the machine that follows it.

#include <array>
#include <optional>

namespace retrace::fabrication::turning {

enum class Strategy { spiral, raster };
/// How points follow each other along a path: by equal angles of the spindle, or by equal lengths along the cut.
enum class Sampling { angle, arc };
/// Slow: the slide Z makes the whole motion. Fast: Z follows the mean over a turn, a fast tool servo adds the rest.
enum class Servo { slow, fast };

struct PathOptions {
  Strategy strategy = Strategy::spiral;
  Sampling sampling = Sampling::angle;
  Servo servo = Servo::slow;
  double radius_mm = 1.0;     ///< spiral: of the part
  double overrun_mm = 0.0;    ///< spiral: beyond it, where the tool starts
  double width_mm = 0.0;      ///< raster: length of the lines
  double height_mm = 0.0;     ///< raster: across the lines
  double feed_mm = 5e-3;      ///< a turn, or from line to line
  int points_per_turn = 360;  ///< by angle
  double arc_mm = 5e-3;       ///< by length; in a raster always
  double spindle_rpm = 60.0;
  double cutting_mm_per_min = 60.0;  ///< raster
  double clear_mm = 1.0;             ///< above the highest point, for moves without cutting
  double blend_mm = 1e-6;            ///< by which a control may leave the path where moves meet
  double approach_mm_per_min = 5.0;  ///< down to where a cut begins
  /// Of C, from a standstill to the spindle's speed and back at the ends of a spiral; nothing: at once.
  std::optional<double> spin_deg_per_s2 = std::nullopt;
  /// By which cubics between points with velocities may leave a spiral, for controls that have such moves; nothing:
  /// they too get straight moves.
  std::optional<double> cubic_error_nm = std::nullopt;
};

/// Limits of a machine; nothing: none.
struct AxisLimits {
  std::optional<double> low_mm;
  std::optional<double> high_mm;
  std::optional<double> speed_mm_per_s;
  std::optional<double> acceleration_mm_per_s2;
  std::optional<double> jerk_mm_per_s3;
};
struct TurningMachine {
  std::array<AxisLimits, 3> axes;  ///< X, Y, Z
  std::optional<double> spindle_rpm;
  std::optional<double> c_acceleration_deg_per_s2;
  std::optional<double> blocks_per_s;  ///< that the control carries out at most
  AxisLimits servo;                    ///< of a fast tool servo: its stroke
};

}  // namespace retrace::fabrication::turning

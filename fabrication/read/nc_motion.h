#pragma once

// Executes an NC program: converts calls, modal settings and axis words to straight moves and dwells.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Position in a program.
struct NcLocation {
  std::int32_t line = 0;       ///< line number
  std::int32_t call_line = 0;  ///< in a subroutine: line of the call in the main program; 0 in the main program
};

/// Straight move of the axes, or one straight segment of a cubic move.
struct NcMotion {
  NcMove move = NcMove::rapid;
  NcLocation location;
  std::uint8_t moved = 0;  ///< bit i: the position of axis i changes
  std::uint8_t known = 0;  ///< bit i: the position of axis i before the move is known; otherwise `from` contains 0
  AxisPositions from;
  AxisPositions to;
  /// Feed of a linear move; 0 if the program gives no feed or gives the time of the move.
  double feed_mm_per_min = 0.0;
  /// Time of a linear move for which the program gives either the time or a feed of all axes together (Aerotech); 0 for
  /// all other moves.
  double duration_s = 0.0;
  bool is_exact_stop = true;  ///< true: the axes stop at the end point
  bool is_continued = false;  ///< true for each segment of a cubic move except its last one
  std::uint8_t shortest = 0;  ///< bit i: axis i takes the shortest path to an angle of 0 to 360 degrees
  std::uint8_t absolute = 0;  ///< bit i: axis i has an absolute position in the program
  std::uint8_t decimals = 0;  ///< maximum number of decimals of the axis words (NcBlock::decimals)
  /// Maximum rounding error of each axis of `to`, in mm or degrees: half of the last decimal of its word.
  std::array<double, kNcAxes> rounding{};
  double rate_rounding = 0.0;  ///< maximum relative error of path_speed_per_min() due to rounded numbers

  /// Returns the path length of X, Y and Z in mm. If only rotary axes move, returns their path length in degrees.
  double path_length() const;
  /// Returns the speed along the path in mm or degrees per minute. It is the feed, or path_length() divided by the
  /// duration.
  double path_speed_per_min() const { return duration_s > 0.0 ? 60.0 * path_length() / duration_s : feed_mm_per_min; }
};

/// Modal settings that a program has made so far. An empty value means that the program has not made the setting and
/// uses the initial state of the control.
struct NcSettings {
  std::optional<bool> absolute;
  std::optional<double> unit_mm;
  std::optional<double> feed_time_s;
  std::optional<bool> exact_stop;
  std::optional<double> blend_mm;   ///< path tolerance of blending; empty if the program does not give it
  std::uint16_t settings_made = 0;  ///< bits of nc_setting for the settings that the program has made
  std::optional<NcSpindle> spindle;
  std::optional<double> spindle_rpm;
  std::optional<bool> mist_on;
};

/// Receiver of the events of an executed program, in their order.
class NcSink {
 public:
  virtual ~NcSink() = default;
  virtual void motion(const NcMotion& motion, const NcSettings& settings) = 0;
  virtual void dwell(double seconds, const NcLocation& place, const AxisPositions& position) = 0;
  /// Called if a block sets spindle, mist, exact stop or bits of nc_setting, before the move of this block.
  virtual void state(const NcSettings&, const NcLocation&) {}
  /// Called if the program stops for the operator, after the move of this block. The passed settings are the settings
  /// before the stop. After an unconditional stop, spindle and mist are unknown, and all settings must be repeated.
  virtual void stop(NcStop, const NcSettings&, const NcLocation&) {}
};

/// End of a program.
struct NcEnd {
  bool is_complete = true;  ///< true: the program reached its end, and nothing is missing
  std::int32_t line = 0;    ///< line at which an incomplete program stops
  std::string reason;
  NcSettings settings;  ///< settings at the end
};

/// Maximum distance between a cubic move and the straight segments that approximate it, for linear and rotary axes.
inline constexpr double kCubicToleranceMm = 2e-7;
inline constexpr double kCubicToleranceDeg = 2e-7;

/// Maximum number of blocks that are executed, including repeated calls of subroutines.
inline constexpr std::int64_t kMaxNcBlocks = 50'000'000;

/// Executes a program: calls, modal settings, absolute and incremental positions. A cubic move has positions,
/// velocities and a time. Each of its axes follows a cubic polynomial, which the sink receives as straight segments.
/// \throw InputError naming file and line in the following cases:
/// - a linear move in inverse time mode has no F > 0,
/// - axes move before G0 or G1,
/// - an axis with unknown position has an incremental word,
/// - subroutines call each other without end,
/// - a cubic move takes no time, omits a moving axis, or does not end at rest
NcEnd run_nc(const NcProgram& program, NcSink& sink);

}  // namespace retrace::fabrication

#pragma once

// Carries out an NC program that was read: calls, modal settings and axis words become straight moves and dwells.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Where in a program something happens.
struct NcPlace {
  std::int32_t line = 0;       ///< of the word that does it
  std::int32_t call_line = 0;  ///< of the call in the main program that led there; 0 in the main program itself
};

/// One straight move of the axes, or a straight piece of one by a cubic.
struct NcMotion {
  NcMove move = NcMove::rapid;
  NcPlace place;
  std::uint8_t moved = 0;  ///< bit i: axis i has another position afterwards
  std::uint8_t known = 0;  ///< bit i: the position of axis i before the move is known; 0 is assumed where it is not
  AxisPositions from;
  AxisPositions to;
  /// Feed of a linear move; 0 if the program gives no feed or gives the time of the move.
  double feed_mm_per_min = 0.0;
  double duration_s = 0.0;    ///< time of a linear move if the program gives it instead of a feed; otherwise 0
  bool is_exact_stop = true;  ///< the move ends in its end point
  bool goes_on = false;       ///< a piece of a move by a cubic, and not its last
  std::uint8_t shortest = 0;  ///< bit i: axis i goes the shortest way to a place within a turn
  std::uint8_t absolute = 0;  ///< bit i: axis i goes to the place that its word counts
  std::uint8_t decimals = 0;  ///< NcBlock::decimals
  /// Maximum rounding error of each axis of `to`, in mm or degrees: half of the last decimal of its word.
  std::array<double, kNcAxes> rounding{};
  double rate_rounding = 0.0;  ///< maximum relative error of path_speed_per_min() due to rounded numbers in the program

  /// Returns the path length of X, Y and Z in mm, or that of the rotary axes in degrees if only these move.
  double path_length() const;
  /// Returns the speed along the path in mm or degrees per minute: the given feed, or path_length() divided by the
  /// given time.
  double path_speed_per_min() const { return duration_s > 0.0 ? 60.0 * path_length() / duration_s : feed_mm_per_min; }
};

/// Modal settings that a program has made so far. Nothing: it has not, and relies on what the controller starts with.
struct NcSettings {
  std::optional<bool> absolute;
  std::optional<double> unit_mm;
  std::optional<double> feed_time_s;
  std::optional<bool> exact_stop;
  std::optional<double> blend_mm;  ///< of blending: by which the path may be left; nothing: the program does not say
  std::uint16_t said = 0;          ///< bits of nc_said
  std::optional<NcSpindle> spindle;
  std::optional<double> spindle_rpm;
  std::optional<bool> mist_on;
};

/// What becomes of a program, in its order.
class NcSink {
 public:
  virtual ~NcSink() = default;
  virtual void motion(const NcMotion& motion, const NcSettings& settings) = 0;
  virtual void dwell(double seconds, const NcPlace& place, const AxisPositions& position) = 0;
  /// A block says something of spindle, mist, exact stops or by bits of nc_said, before it moves.
  virtual void state(const NcSettings&, const NcPlace&) {}
  /// The program stops for the operator, behind what its block moves. \param settings that it stops with: where it
  /// always does, nothing is known behind it of spindle and mist, and what was said must be said again
  virtual void stop(NcStop, const NcSettings&, const NcPlace&) {}
};

/// How a program ended.
struct NcEnd {
  bool is_complete = true;  ///< it reached its end, and nothing was missing
  std::int32_t line = 0;    ///< where it stopped if not
  std::string reason;
  NcSettings settings;  ///< that the program leaves behind
};

/// By which straight pieces are beside the cubic that they stand for, at most.
inline constexpr double kCubicPieceMm = 2e-7;
inline constexpr double kCubicPieceDeg = 2e-7;

/// Maximum number of blocks that are executed, including repeated calls of subroutines.
inline constexpr std::int64_t kMostNcBlocks = 50'000'000;

/// Carries out a program: calls, modal settings, absolute and incremental words. A move by places, velocities and time
/// goes along the cubic of each axis that has them at both ends; the sink gets it in straight pieces.
/// \throw InputError naming file and line: a linear move under inverse time without F > 0, axes that move before G0 or
/// G1, an incremental word for an axis whose position is not yet known, subroutines that call each other without end;
/// a move by velocities that takes no time, that leaves out an axis which still moves, or that nothing brings to a
/// standstill
NcEnd run_nc(const NcProgram& program, NcSink& sink);

}  // namespace retrace::fabrication

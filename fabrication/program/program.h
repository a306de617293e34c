#pragma once

// Data types for NC programs that do not depend on a dialect. The planner creates these programs, and a writer for each
// dialect converts them to text. All positions are integers.

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fabrication/machine/control.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Positions of linear axes in whole nanometres, so that sums have no rounding errors.
using Nanometres = std::int64_t;
/// Positions of rotary axes in units of 1e-7 degrees.
using RotaryUnits = std::int64_t;

inline constexpr double kNanometresPerMm = 1e6;
inline constexpr double kRotaryUnitsPerDeg = 1e7;

inline double millimetres(Nanometres nm) {
  return static_cast<double>(nm) / kNanometresPerMm;
}
Nanometres nanometres(double mm);
inline double degrees(RotaryUnits units) {
  return static_cast<double>(units) / kRotaryUnitsPerDeg;
}
RotaryUnits rotary_units(double deg);
/// Rounds a value to the nearest whole multiple of a step.
inline std::int64_t to_step(double units, std::int64_t step) {
  return std::llround(units / static_cast<double>(step)) * step;
}

/// X, Y and Z in whole nanometres.
using LinearPosition = Eigen::Matrix<Nanometres, 3, 1>;
inline geometry::Vec3 millimetres(const LinearPosition& place) {
  return {millimetres(place.x()), millimetres(place.y()), millimetres(place.z())};
}

/// Axes of a program. The tilting axis kTilt is A or B, depending on the machine.
enum Axis : std::size_t { kX, kY, kZ, kTilt, kC };
inline constexpr std::size_t kAxes = 5;

/// Positions of a move for each axis: nanometres for X, Y and Z, and rotary units for the tilting axis and C. An axis
/// without a value does not move.
using AxisWords = std::array<std::optional<std::int64_t>, kAxes>;

/// Returns positions for X, Y and Z only.
AxisWords linear_words(const LinearPosition& place);
/// Updates the axis positions `at` by a move. Axes without a position in `to` do not change.
void go_to(AxisWords& at, const AxisWords& to);

/// Purpose of a move. In a rapid move, the axes move as fast as possible.
enum class Motion : std::uint8_t { plunge, plough, retract, translate, rapid };
inline constexpr std::string_view kMotionWords[] = {"plunge", "plough", "retract", "translate", "rapid"};

/// Straight move. Its values are positions in the main program and increments in subroutines.
struct Move {
  Motion motion = Motion::rapid;
  AxisWords to{};
  double feed_mm_per_min = 0.0;  ///< feed of a move that is neither rapid nor timed
  double seconds = 0.0;          ///< duration of a timed move; 0: not timed
};

struct Dwell {
  std::int32_t ms = 0;
};

using Step = std::variant<Move, Dwell>;

/// Returns a move of a subroutine, with words only for the axes that move.
Move increment(Motion motion, const LinearPosition& by, double feed_mm_per_min);

/// Subroutine of cutting moves by increments of X, Y and Z. It is called with the tool at its start point.
struct Subroutine {
  int number = 0;     ///< number in the program, from 101
  std::string title;  ///< description in one line
  std::vector<Step> steps;
};

/// End point and bounding box of a subroutine's moves, relative to its start.
struct MoveExtent {
  LinearPosition end = LinearPosition::Zero();
  LinearPosition low = LinearPosition::Zero();
  LinearPosition high = LinearPosition::Zero();
};
MoveExtent extent_of(const Subroutine& subroutine);

/// Comment in the program text.
struct Comment {
  std::string text;
};
/// Message on the screen of the control.
struct Message {
  std::string text;
};
/// Call of a subroutine at an element, after rapid moves to its start. A visit of an element is one call for each pass.
struct CycleCall {
  std::int32_t element = 0;
  std::uint32_t subroutine = 0;  ///< index in Program::subroutines
  LinearPosition start = LinearPosition::Zero();
  int pass = 1;    ///< number of this pass, from 1, in the order of cutting
  int passes = 1;  ///< number of parallel passes that the width of the element requires
};
/// Velocities of axes, in mm/s and degrees/s.
using Velocities = std::array<double, kAxes>;

/// Path of timed moves without stops between them. It begins at the present axis positions.
struct Path {
  std::vector<Move> moves;
  /// Velocities of all axes at the end of each move. Each axis then follows a cubic polynomial of time, which is
  /// determined by the positions and velocities at both ends of a move. The path starts and ends at rest, and all moves
  /// have the same axes. If the list is empty, the moves are straight.
  std::vector<Velocities> end_velocities = {};
  double blend_mm = 1e-6;  ///< maximum deviation from the path between moves, for controls that support a tolerance
};
/// Optional stop, at which the operator may stop the program.
struct OptionalStop {};

/// Stop, at which the program waits for the operator with mist and spindle off. After a stop, the program repeats all
/// settings and makes no assumption about axis positions.
struct Stop {
  std::string text;  ///< message for the operator
};

using Item = std::variant<Comment, Message, OptionalStop, Stop, Move, CycleCall, Path>;

/// Rotation of the spindle while a program cuts.
struct Spindle {
  std::int32_t rpm = 0;
  bool is_clockwise = true;  ///< M3 of ISO 6983-1, otherwise M4
  /// Program line that starts the spindle in a dialect without codes for the spindle; empty if there is no such line.
  std::string start_text;
  std::string stop_text;             ///< program line that stops the spindle
  bool has_unchecked_lines = false;  ///< true: start_text and stop_text are not checked
};

/// Self-contained program. It prepares the machine, executes `items` in their order, and ends the program. Texts are
/// single lines of ASCII without brackets, quotes, semicolons and percent signs.
struct Program {
  std::string name;  ///< file name without extension
  std::vector<std::string> header;
  std::optional<Spindle> spindle;  ///< rotates during all items; empty: the spindle does not rotate
  /// True: mist from the first cut until the next rapid move that moves only Z, if the control has mist.
  bool has_mist = true;
  bool needs_mist = false;  ///< true: the control must have mist
  std::vector<Subroutine> subroutines;
  std::vector<Item> items;
  char tilt_letter = 'A';  ///< letter of the tilting axis
  Control control;
};

/// Returns the rapid moves to the start of a visit, with only the positions that change. There are at most two moves. Z
/// moves first if it rises, and last if it falls. The path therefore stays above an inclined blank.
std::vector<Move> approach(const AxisWords& from, const CycleCall& visit);

/// Straight move of a program with absolute positions.
struct PlannedMove {
  Move move;
  AxisWords at{};             ///< positions of all axes after the move; empty: not known yet
  double dwell_s = 0.0;       ///< dwell time after the move
  std::int32_t element = -1;  ///< element that is visited; -1: none

  bool is_rapid() const { return move.motion == Motion::rapid; }
  bool is_rotary() const { return is_rapid() && (move.to[kTilt] || move.to[kC]); }
};

/// Calls `sink` for every move of the program, in order. A dwell belongs to the preceding move. Rotary axes start at 0.
void for_each_move(const Program& program, const std::function<void(const PlannedMove&)>& sink);

}  // namespace retrace::fabrication

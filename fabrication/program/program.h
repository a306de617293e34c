#pragma once

// A program between planner and writers, free of any dialect: what is done in which order, in whole units.

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fabrication/machine/control.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Positions of linear axes in whole nanometres: sums of them do not drift.
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
/// The nearest whole multiple of a step.
inline std::int64_t to_step(double units, std::int64_t step) {
  return std::llround(units / static_cast<double>(step)) * step;
}

/// X, Y and Z in whole nanometres.
using Place = Eigen::Matrix<Nanometres, 3, 1>;
inline geometry::Vec3 millimetres(const Place& place) {
  return {millimetres(place.x()), millimetres(place.y()), millimetres(place.z())};
}

/// Axes of a program. The one that tilts is A or B, as the machine has it.
enum Axis : std::size_t { kX, kY, kZ, kTilt, kC };
inline constexpr std::size_t kAxes = 5;

/// Words of a move by axis: nanometres of X, Y and Z, rotary units of the others. Nothing: the axis stays.
using Words = std::array<std::optional<std::int64_t>, kAxes>;

/// A word for each of X, Y and Z.
Words linear_words(const Place& place);
/// Axes with a word go there, the others stay.
void go_to(Words& at, const Words& to);

/// What a move is for. A rapid one is as fast as the axes go.
enum class Motion : std::uint8_t { plunge, plough, retract, translate, rapid };

/// One straight move: to positions, in subroutines by increments.
struct Move {
  Motion motion = Motion::rapid;
  Words to{};
  double feed_mm_per_min = 0.0;  ///< of a move that is neither rapid nor timed
  double seconds = 0.0;          ///< > 0: the move takes that time
};

struct Dwell {
  std::int32_t ms = 0;
};

using Step = std::variant<Move, Dwell>;

/// A move of a subroutine: words for the axes that it moves.
Move increment(Motion motion, const Place& by, double feed_mm_per_min);

/// A routine of cutting moves by increments of X, Y and Z, called where it starts.
struct Subroutine {
  int number = 0;     ///< 101 and up
  std::string title;  ///< one line for people
  std::vector<Step> steps;
};

/// Where a subroutine ends and how far it reaches, relative to its start.
struct Reach {
  Place end = Place::Zero();
  Place low = Place::Zero();
  Place high = Place::Zero();
};
Reach reach_of(const Subroutine& subroutine);

/// A line for people in the text.
struct Comment {
  std::string text;
};
/// A line for people on the controller's screen.
struct Message {
  std::string text;
};
/// One element is visited: rapid moves to the start of a subroutine, and the call.
struct Visit {
  std::int32_t element = 0;
  std::uint32_t subroutine = 0;  ///< index in Program::subroutines
  Place start = Place::Zero();
  int pass = 1;    ///< number of this pass, from 1, in the order of cutting
  int passes = 1;  ///< number of parallel passes that the width of the element requires
};
/// Velocities of axes, in mm/s and degrees/s.
using Velocities = std::array<double, kAxes>;

/// Timed moves that follow each other without stopping. They begin where the axes are.
struct Path {
  std::vector<Move> moves;
  /// Of each move, at its end: each axis then goes by the cubic over time that has its places and velocities at both
  /// ends, from a standstill at first to one at last, and all moves have words for the same axes. Empty: straight
  /// moves.
  std::vector<Velocities> end_velocities = {};
  double blend_mm = 1e-6;  ///< by which a control may leave the path where moves meet, if it can be told
};
/// The operator may stop here.
struct OptionalStop {};

/// The program waits until the operator lets it go on, mist and spindle off. Behind it nothing holds of what stood
/// before: it is prepared anew, and no axis is taken to be anywhere.
struct Stop {
  std::string text;  ///< for the operator
};

using Item = std::variant<Comment, Message, OptionalStop, Stop, Move, Visit, Path>;

/// How the spindle turns while a program cuts.
struct Spindle {
  std::int32_t rpm = 0;
  bool is_clockwise = true;  ///< M3 of ISO 6983-1, otherwise M4
  std::string start_text;    ///< program line that starts the spindle in a dialect without spindle words; empty: none
  std::string stop_text;     ///< program line that stops the spindle
  bool has_unchecked_lines = false;  ///< true: start_text and stop_text are not checked
};

/// A program that runs alone: preparation, `items` in their order, end. Texts are one line of ASCII without brackets,
/// quotes, semicolons and percent signs.
struct Program {
  std::string name;  ///< of the file, without its ending
  std::vector<std::string> header;
  std::optional<Spindle> spindle;  ///< turns from before the first item to behind the last; nothing: stands still
  bool has_mist = true;            ///< from the first cut to the next rapid move of Z alone, if the control has words
  bool needs_mist = false;         ///< it must have them
  std::vector<Subroutine> subroutines;
  std::vector<Item> items;
  char tilt_letter = 'A';  ///< of the axis that tilts
  Control control;
};

/// The rapid moves that bring the tool to the start of a visit: Z alone first where it rises, last where it falls.
/// At most two, so that the path stays above a blank that rises towards +Y or falls. Only words that change.
std::vector<Move> approach(const Words& from, const Visit& visit);

/// One straight move as the program asks for it, its words absolute.
struct PlannedMove {
  Move move;
  Words at{};                 ///< of all axes afterwards; nothing: not known yet
  double dwell_s = 0.0;       ///< after the move
  std::int32_t element = -1;  ///< that is visited; -1: none

  bool is_rapid() const { return move.motion == Motion::rapid; }
  bool is_rotary() const { return is_rapid() && (move.to[kTilt] || move.to[kC]); }
};

/// Calls `sink` for every move of the program, in order. Dwells belong to the move before them. Rotary axes begin at 0.
void for_each_move(const Program& program, const std::function<void(const PlannedMove&)>& sink);

}  // namespace retrace::fabrication

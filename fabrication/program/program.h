#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace retrace::fabrication {

/// Positions of linear axes in whole nanometres: sums of them do not drift.
using Nanometres = std::int64_t;
/// Positions of rotary axes in units of 1e-7 degrees. The axis that tilts is called `a` here, whether it is A or B.
using RotaryUnits = std::int64_t;

inline constexpr double kNanometresPerMm = 1e6;

inline double millimetres(Nanometres nm) {
  return static_cast<double>(nm) / kNanometresPerMm;
}
inline constexpr double kRotaryUnitsPerDeg = 1e7;

/// What a move of a subroutine is for.
enum class Motion { plunge, plough, retract, translate };

/// One straight incremental move at a feed. A chisel never moves along X while it cuts.
struct Increment {
  Motion motion = Motion::plunge;
  Nanometres y_nm = 0;
  Nanometres z_nm = 0;
  double feed_mm_per_min = 0.0;
  Nanometres x_nm = 0;
};

struct Dwell {
  std::int32_t ms = 0;
};

using Step = std::variant<Increment, Dwell>;

/// A routine of cutting moves, called where it starts.
struct Subroutine {
  int number = 0;     ///< 101 and up
  std::string title;  ///< one line for people
  std::vector<Step> steps;
};

/// Where a subroutine ends and how far it reaches, relative to its start.
struct Reach {
  Nanometres y_end_nm = 0;
  Nanometres z_end_nm = 0;
  Nanometres y_low_nm = 0;
  Nanometres y_high_nm = 0;
  Nanometres z_low_nm = 0;
  Nanometres z_high_nm = 0;
  Nanometres x_end_nm = 0;
  Nanometres x_low_nm = 0;
  Nanometres x_high_nm = 0;
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
/// Rapid move of Z alone.
struct Raise {
  Nanometres z_nm = 0;
};
/// Rapid move of the rotary axes alone.
struct Turn {
  RotaryUnits a = 0;
  RotaryUnits c = 0;
};
/// One element is visited: rapid moves to the start of a subroutine, and the call.
struct Visit {
  std::int32_t element = 0;
  std::uint32_t subroutine = 0;  ///< index in Program::subroutines
  Nanometres x_nm = 0;
  Nanometres y_nm = 0;
  Nanometres z_nm = 0;
};
/// A point of a continuous path.
struct TracePoint {
  Nanometres x_nm = 0;
  Nanometres y_nm = 0;
  Nanometres z_nm = 0;
  RotaryUnits c = 0;
  double seconds = 0.0;  ///< since the point before it; > 0
};
/// A path of X, Y, Z and C that is followed without stopping, each point reached at its time: rapid moves to its first
/// point without Z, down to it at the feed, then the others.
struct Trace {
  std::vector<TracePoint> points;  ///< 2 or more
  double approach_feed_mm_per_min = 0.0;
};
/// The operator may stop here.
struct OptionalStop {};

using Item = std::variant<Comment, Message, Raise, Turn, Visit, Trace, OptionalStop>;

/// A program that runs alone, free of any dialect: preparation, `items` in their order, end. Texts are one line of
/// ASCII without brackets, quotes, semicolons and percent signs.
struct Program {
  std::string name;  ///< of the file, without its ending
  std::vector<std::string> header;
  std::vector<Subroutine> subroutines;
  std::vector<Item> items;
  char tilt_letter = 'A';  ///< of the axis that tilts
};

/// Positions of all axes.
struct Position {
  std::optional<Nanometres> x_nm;  ///< nothing: not known yet
  std::optional<Nanometres> y_nm;
  std::optional<Nanometres> z_nm;
  RotaryUnits a = 0;
  RotaryUnits c = 0;
};

/// A rapid move of linear axes: only the words that change. Z never goes down together with another axis.
struct Rapid {
  std::optional<Nanometres> x_nm;
  std::optional<Nanometres> y_nm;
  std::optional<Nanometres> z_nm;
};

/// The rapid moves that bring the tool to the start of a visit: Z alone first where it rises, last where it falls.
/// At most two, so that the path stays above a blank that rises towards +Y or falls.
std::vector<Rapid> approach(const Position& from, const Visit& visit);

/// One straight move as the program asks for it, in absolute positions.
struct PlannedMove {
  bool rapid = true;
  bool rotary = false;
  Motion motion = Motion::translate;  ///< of a feed move
  Position to;
  double feed_mm_per_min = 0.0;  ///< 0 for rapids
  double dwell_s = 0.0;          ///< after the move
  double trace_s = 0.0;          ///< time of a move of a trace; 0 for others
  std::int32_t element = -1;     ///< that is visited; -1: none
};

/// Calls `sink` for every move of the program, in order. Dwells belong to the move before them.
void for_each_move(const Program& program, const std::function<void(const PlannedMove&)>& sink);

}  // namespace retrace::fabrication

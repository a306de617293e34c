#pragma once

// NC programs as read from text, in terms that all dialects share: blocks with axis words, modal settings and calls.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::fabrication {

/// The languages of controllers that can be read.
enum class NcDialect { rs274ngc, sinumerik, fanuc, pmac, a3200, automation1 };

/// Words of the command line, in the order of the enumerators.
inline constexpr std::string_view kNcDialectWords[] = {"rs274ngc", "sinumerik", "fanuc",
                                                       "pmac",     "a3200",     "automation1"};

/// Whether mist, stops and the spindle of a lathe are lines that the files of machine and part give (NcTexts).
constexpr bool has_own_texts(NcDialect dialect) {
  return dialect == NcDialect::pmac || dialect == NcDialect::a3200 || dialect == NcDialect::automation1;
}

/// Whether moves by places, velocities and times say how long it is since such moves began.
constexpr bool has_times_since_begin(NcDialect dialect) {
  return dialect == NcDialect::a3200;
}

/// Whether a feed is the speed of all axes of a line together, mm and degrees alike, where rotary axes move too.
constexpr bool has_feeds_of_all_axes(NcDialect dialect) {
  return dialect == NcDialect::a3200 || dialect == NcDialect::automation1;
}

/// Axes in the order of words here: X, Y, Z, A, C, B. Which of A and B there is, the machine says.
inline constexpr std::size_t kNcAxes = 6;
inline constexpr std::string_view kNcAxisLetters = "XYZACB";
inline constexpr std::size_t kFirstRotaryAxis = 3;

enum class NcMove : std::uint8_t { rapid, linear };

/// What a program asks of the spindle: M5, M3, M4, or the lines of an NcTexts.
enum class NcSpindle : std::uint8_t { stopped, clockwise, counterclockwise, started_by_text, stopped_by_text };

/// Lines of a program that the integrator of the machine has given a meaning, for dialects that has_own_texts() names.
/// Empty: there is none.
struct NcTexts {
  std::string spindle_start;
  std::string spindle_stop;
  std::string mist_on;
  std::string mist_off;
  std::string optional_stop;
  std::string stop = {};
};

/// What a block waits for: nothing, the operator if a switch asks for it, the operator always.
enum class NcStop : std::uint8_t { none, optional, always };

/// What a program says of the control's state, whose value is nothing that moves depend on: a bit each.
namespace nc_said {
inline constexpr std::uint16_t kWorkOffset = 1U << 0U;         ///< the first work offset is chosen
inline constexpr std::uint16_t kShiftOff = 1U << 1U;           ///< other shifts of the zero are cancelled
inline constexpr std::uint16_t kRadiusOff = 1U << 2U;          ///< compensation of the tool's radius
inline constexpr std::uint16_t kLengthOff = 1U << 3U;          ///< offsets of the tool's length
inline constexpr std::uint16_t kTransformationOff = 1U << 4U;  ///< the control's own kinematics
inline constexpr std::uint16_t kRotationOff = 1U << 5U;        ///< turned coordinates
inline constexpr std::uint16_t kMirrorOff = 1U << 6U;          ///< mirrored coordinates
inline constexpr std::uint16_t kFineStop = 1U << 7U;           ///< exact stops wait for the axes, not for their targets
inline constexpr std::uint16_t kFeedAxes = 1U << 8U;           ///< feeds are those of X, Y and Z together
// Those that have a value too.
inline constexpr std::uint16_t kUnit = 1U << 9U;
inline constexpr std::uint16_t kDistance = 1U << 10U;  ///< absolute or incremental
inline constexpr std::uint16_t kFeedTime = 1U << 11U;
inline constexpr std::uint16_t kExactStop = 1U << 12U;
// Of controls whose feeds have a mode and a time each, and whose rounding of corners is no part of blending.
inline constexpr std::uint16_t kFeedMode = 1U << 13U;     ///< feeds are speeds, neither times nor per turn
inline constexpr std::uint16_t kRoundingOff = 1U << 14U;  ///< no arcs between lines
}  // namespace nc_said

/// Returns the maximum rounding error of a number that is written with `decimals` decimals: half of its last decimal.
double half_decimal(std::uint8_t decimals);

/// A setting that a block may make. Nothing: the block does not say.
template <class Value>
using Setting = std::optional<Value>;

/// What a line says of a move by places, velocities and time, beside its places.
struct NcCubic {
  std::array<double, kNcAxes> velocities{};  ///< at the move's end, as written
  double time_s = 0.0;                       ///< of the move, or since such moves began
};

/// What one line of a program asks for, whatever the dialect. Everything is carried out in this order: settings,
/// dwell, move, stop, call, return, end.
struct NcBlock {
  std::int32_t line = 0;  ///< in the file, from 1
  std::uint8_t axes = 0;  ///< bit i: the block has a word for axis i
  std::array<double, kNcAxes> words{};
  std::array<std::uint8_t, kNcAxes> axis_decimals{};  ///< number of decimals of the word of each axis
  Setting<NcMove> move;
  /// True: afterwards no motion mode is active, and axis words are an error until a block sets `move`.
  bool cancels_move = false;
  Setting<bool> absolute;
  Setting<double> unit_mm;      ///< of linear words: 1 or 25.4
  Setting<double> feed;         ///< as written
  bool clears_feed = false;     ///< true: the control discards the feed of earlier blocks
  double rate_rounding = 0.0;   ///< maximum relative rounding error of `feed` or `move_time_s`
  Setting<double> feed_time_s;  ///< time unit of a feed in seconds: 60 for mm/min
  Setting<bool> inverse_time;   ///< feeds are one over the time of their move, per minute
  Setting<double> move_time_s;  ///< time of this and the following moves, until a feed says otherwise
  Setting<bool> exact_stop;     ///< false: blocks are blended
  Setting<double> blend_mm;     ///< by which blended blocks may leave the path at most
  std::uint16_t says = 0;       ///< bits of nc_said; those with a value follow from it
  std::uint8_t shortest = 0;    ///< bit i: axis i goes the shortest way to its word, which lies within a turn
  std::uint8_t increments = 0;  ///< bit i: axis i moves by its word, whatever the mode is
  std::uint8_t decimals = 0;    ///< of the words of axes, at most, where dialects count them
  Setting<NcSpindle> spindle;
  Setting<double> spindle_rpm;  ///< S
  Setting<bool> mist_on;
  Setting<double> dwell_s;
  NcStop stop = NcStop::none;
  std::int32_t call = -1;      ///< index of a subroutine
  std::int32_t cubic = -1;     ///< index of what the line says of a move by velocities
  bool begins_cubics = false;  ///< times of such moves count from here
  bool returns = false;
  bool ends = false;

  void say(std::uint16_t what) { says = static_cast<std::uint16_t>(says | what); }
};

struct NcSubroutine {
  std::string name;
  std::size_t first = 0;  ///< block
  std::size_t last = 0;   ///< block behind the last
  bool is_whole = false;  ///< its end was found
};

/// A program as read, before anything moves.
struct NcProgram {
  std::string file;
  NcDialect dialect = NcDialect::rs274ngc;
  std::vector<NcBlock> blocks;  ///< of main program and subroutines, in the order of the file
  std::vector<NcSubroutine> subroutines;
  std::vector<NcCubic> cubics;
  std::size_t main_first = 0;
  std::size_t main_last = 0;  ///< block behind the last of the main program
  std::int32_t lines = 0;
  int coordinate_system = 0;  ///< of a Power PMAC, that the program speaks of; 0: of none
  /// Behind which the operator stopped it, the first time that it was carried out; 0: it ran to its end.
  std::int32_t stop_line = 0;
  /// What is missing of a file that stops in the middle; nothing if it is whole.
  std::optional<std::string> truncated;

  /// Keeps what a block says of a move by velocities.
  void set_cubic(NcBlock& block, const NcCubic& cubic) {
    block.cubic = static_cast<std::int32_t>(cubics.size());
    cubics.push_back(cubic);
  }
};

/// Longest line of a program, and longest program, that is read.
inline constexpr std::size_t kLongestNcLine = 1024;
inline constexpr std::size_t kLongestNcBytes = std::size_t{1} << 30;

/// Reads the text of a program. Whatever the dialect's rules do not cover here is refused, never skipped.
/// \param file names it in messages \param texts lines of such dialects, letter by letter
/// \throw InputError naming file and line: a word that is not understood, a line that is too long, text that is none
NcProgram parse_nc(std::string_view text, const std::string& file, NcDialect dialect, const NcTexts& texts = {});

/// The dialect that a text is written in, from the words that only one of them has.
/// \throw InputError if the text is empty, binary, or shows none
NcDialect recognise_dialect(std::string_view text, const std::string& file);

}  // namespace retrace::fabrication

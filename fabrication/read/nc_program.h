#pragma once

// NC programs in a form that is common to all dialects: blocks with axis words, modal settings and calls.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::fabrication {

/// Dialects that can be read.
enum class NcDialect { rs274ngc, sinumerik, fanuc, pmac, a3200, automation1 };

/// Names of the dialects on the command line, in the order of the enumerators.
inline constexpr std::string_view kNcDialectWords[] = {"rs274ngc", "sinumerik", "fanuc",
                                                       "pmac",     "a3200",     "automation1"};

/// Returns true if the machine file and the part file define the program lines for mist, stops and spindle (NcTexts).
constexpr bool has_own_texts(NcDialect dialect) {
  return dialect == NcDialect::pmac || dialect == NcDialect::a3200 || dialect == NcDialect::automation1;
}

/// Returns true if the time of a cubic move counts from the start of the cubic moves, and not from the previous move.
constexpr bool has_times_since_begin(NcDialect dialect) {
  return dialect == NcDialect::a3200;
}

/// Returns true if a feed is the speed of all linear and rotary axes together. One degree counts as 1 mm.
constexpr bool has_feeds_of_all_axes(NcDialect dialect) {
  return dialect == NcDialect::a3200 || dialect == NcDialect::automation1;
}

/// Number of axes. Their order is X, Y, Z, A, C, B, and a machine has either A or B.
inline constexpr std::size_t kNcAxes = 6;
inline constexpr std::string_view kNcAxisLetters = "XYZACB";
inline constexpr std::size_t kFirstRotaryAxis = 3;

enum class NcMove : std::uint8_t { rapid, linear };

/// State of the spindle: set by M5, M3 or M4, or by a line of NcTexts.
enum class NcSpindle : std::uint8_t { stopped, clockwise, counterclockwise, started_by_text, stopped_by_text };

/// Program lines whose meaning the machine file or the part file defines, for dialects with has_own_texts(). A text is
/// empty if there is no such line.
struct NcTexts {
  std::string spindle_start;
  std::string spindle_stop;
  std::string mist_on;
  std::string mist_off;
  std::string optional_stop;
  std::string stop = {};
};

/// Kind of stop that a block makes: none, optional (depends on a switch of the control), or unconditional.
enum class NcStop : std::uint8_t { none, optional, always };

/// Bits for the settings that a program has made.
namespace nc_setting {
inline constexpr std::uint16_t kWorkOffset = 1U << 0U;         ///< the first work offset is selected
inline constexpr std::uint16_t kShiftOff = 1U << 1U;           ///< other zero offsets are cancelled
inline constexpr std::uint16_t kRadiusOff = 1U << 2U;          ///< compensation of the tool radius is off
inline constexpr std::uint16_t kLengthOff = 1U << 3U;          ///< offsets of the tool length are off
inline constexpr std::uint16_t kTransformationOff = 1U << 4U;  ///< kinematic transformations of the control are off
inline constexpr std::uint16_t kRotationOff = 1U << 5U;        ///< rotation of coordinates is off
inline constexpr std::uint16_t kMirrorOff = 1U << 6U;          ///< mirroring of coordinates is off
inline constexpr std::uint16_t kFineStop = 1U << 7U;           ///< exact stops wait for the actual axis positions
inline constexpr std::uint16_t kFeedAxes = 1U << 8U;           ///< feeds apply to X, Y and Z together
// Bits of settings whose values are stored in NcBlock and NcSettings.
inline constexpr std::uint16_t kUnit = 1U << 9U;
inline constexpr std::uint16_t kDistance = 1U << 10U;  ///< choice of absolute or incremental positions
inline constexpr std::uint16_t kFeedTime = 1U << 11U;
inline constexpr std::uint16_t kExactStop = 1U << 12U;
// Bits of settings that only some controls have.
inline constexpr std::uint16_t kFeedMode = 1U << 13U;     ///< feeds are speeds (not inverse time, not per revolution)
inline constexpr std::uint16_t kRoundingOff = 1U << 14U;  ///< rounding of corners by arcs is off
}  // namespace nc_setting

/// Returns the maximum rounding error of a number that is written with `decimals` decimals: half of its last decimal.
double half_decimal(std::uint8_t decimals);

/// Setting that a block may make. It is empty if the block does not make the setting.
template <class Value>
using Setting = std::optional<Value>;

/// Velocities and time of a cubic move. Its positions are in NcBlock.
struct NcCubic {
  std::array<double, kNcAxes> velocities{};  ///< velocities at the end of the move, in the units of the program
  double time_s = 0.0;  ///< duration of the move, or time since the start of the cubic moves (has_times_since_begin())
};

/// Content of one line of a program, independent of the dialect. Its items are executed in this order: settings, dwell,
/// move, stop, call, return, end.
struct NcBlock {
  std::int32_t line = 0;  ///< line number in the file, from 1
  std::uint8_t axes = 0;  ///< bit i: the block has a word for axis i
  std::array<double, kNcAxes> words{};
  std::array<std::uint8_t, kNcAxes> axis_decimals{};  ///< number of decimals of the word of each axis
  Setting<NcMove> move;
  /// True: no motion mode is active after this block. Axis words are then an error until a block sets `move`.
  bool cancels_move = false;
  Setting<bool> absolute;
  Setting<double> unit_mm;          ///< unit of linear positions: 1 or 25.4 mm
  Setting<double> feed;             ///< F word, in the units of the program
  bool clears_feed = false;         ///< true: the control discards the feed of earlier blocks
  double rate_rounding = 0.0;       ///< maximum relative rounding error of `feed` or `move_time_s`
  Setting<double> feed_time_s;      ///< time unit of a feed in seconds: 60 for mm/min
  Setting<bool> inverse_time;       ///< true: F is the inverse of the move's duration, in 1/min
  Setting<double> move_time_s;      ///< duration of this move and of the following moves until the next feed
  Setting<bool> exact_stop;         ///< false: blocks are blended
  Setting<double> blend_mm;         ///< maximum deviation from the path in blending
  std::uint16_t settings_made = 0;  ///< bits of nc_setting for settings that have no value of their own in this struct
  std::uint8_t shortest = 0;        ///< bit i: axis i takes the shortest path to an angle of 0 to 360 degrees
  std::uint8_t increments = 0;      ///< bit i: the word of axis i is an increment even if positions are absolute
  std::uint8_t decimals = 0;        ///< maximum number of decimals of the axis words, for dialects that limit it
  Setting<NcSpindle> spindle;
  Setting<double> spindle_rpm;  ///< S word
  Setting<bool> mist_on;
  Setting<double> dwell_s;
  NcStop stop = NcStop::none;
  std::int32_t call = -1;      ///< index of the called subroutine; -1 if the block has no call
  std::int32_t cubic = -1;     ///< index of the cubic move in NcProgram::cubics; -1 if the block has none
  bool begins_cubics = false;  ///< true: the times of cubic moves count from this block
  bool returns = false;
  bool ends = false;

  void mark_setting(std::uint16_t what) { settings_made = static_cast<std::uint16_t>(settings_made | what); }
};

struct NcSubroutine {
  std::string name;
  std::size_t first = 0;     ///< index of the first block
  std::size_t last = 0;      ///< index after the last block
  bool is_complete = false;  ///< true if the end of the subroutine was found
};

/// NC program as read from a file.
struct NcProgram {
  std::string file;
  NcDialect dialect = NcDialect::rs274ngc;
  std::vector<NcBlock> blocks;  ///< blocks of main program and subroutines, in the order of the file
  std::vector<NcSubroutine> subroutines;
  std::vector<NcCubic> cubics;
  std::size_t main_first = 0;
  std::size_t main_last = 0;  ///< index after the last block of the main program
  std::int32_t lines = 0;     ///< number of lines of the file
  int coordinate_system = 0;  ///< number of the coordinate system of a Power PMAC; 0 if not given
  /// Line after which the operator stopped the program when it was executed for the first time. It is 0 if the program
  /// ran to its end.
  std::int32_t stop_line = 0;
  /// Description of the missing part if the file is incomplete; empty if the file is complete.
  std::optional<std::string> truncated;

  /// Adds a cubic move to a block.
  void set_cubic(NcBlock& block, const NcCubic& cubic) {
    block.cubic = static_cast<std::int32_t>(cubics.size());
    cubics.push_back(cubic);
  }
};

/// Maximum length of a line, and maximum size of a program, in bytes.
inline constexpr std::size_t kMaxNcLineBytes = 1024;
inline constexpr std::size_t kLongestNcBytes = std::size_t{1} << 30;

/// Reads the text of a program. Words that are not supported are refused and never ignored.
/// \param file name of the file in error messages
/// \param texts exact program lines for dialects with has_own_texts()
/// \throw InputError naming file and line for unknown words, lines that are too long, and binary data
NcProgram parse_nc(std::string_view text, const std::string& file, NcDialect dialect, const NcTexts& texts = {});

/// Determines the dialect of a text from words that exist only in one dialect.
/// \throw InputError if the text is empty or binary, or if the dialect cannot be determined
NcDialect recognise_dialect(std::string_view text, const std::string& file);

}  // namespace retrace::fabrication

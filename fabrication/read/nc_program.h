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
enum class NcDialect { rs274ngc, sinumerik, fanuc, pmac };

/// Words of the command line, in the order of the enumerators.
inline constexpr std::string_view kNcDialectWords[] = {"rs274ngc", "sinumerik", "fanuc", "pmac"};

/// Axes in the order of words here: X, Y, Z, A, C, B. Which of A and B there is, the machine says.
inline constexpr std::size_t kNcAxes = 6;
inline constexpr std::string_view kNcAxisLetters = "XYZACB";

enum class NcMove : std::uint8_t { rapid, linear };

/// What a program asks of the spindle: M5, M3, M4, or the lines of an NcSpindleTexts.
enum class NcSpindle : std::uint8_t { stopped, clockwise, counterclockwise, started_by_text, stopped_by_text };

/// Lines that start and stop the spindle of a control that has no words of its own for it. Empty: there is none.
struct NcSpindleTexts {
  std::string start;
  std::string stop;
};

/// A setting that a block may make. Nothing: the block does not say.
template <class Value>
using Setting = std::optional<Value>;

/// What one line of a program asks for, whatever the dialect. Everything is carried out in this order: settings,
/// dwell, move, stop, call, return, end.
struct NcBlock {
  std::int32_t line = 0;  ///< in the file, from 1
  std::uint8_t axes = 0;  ///< bit i: the block has a word for axis i
  std::array<double, kNcAxes> words{};
  Setting<NcMove> move;
  Setting<bool> absolute;
  Setting<double> unit_mm;         ///< of linear words: 1 or 25.4
  Setting<double> feed;            ///< as written
  Setting<double> feed_time_s;     ///< time that a feed is per: 60 for mm/min
  Setting<bool> inverse_time;      ///< feeds are one over the time of their move, per minute
  Setting<double> move_time_s;     ///< time of this and the following moves, until a feed says otherwise
  Setting<bool> exact_stop;        ///< false: blocks are blended
  Setting<bool> workpiece_offset;  ///< G54 chosen
  Setting<bool> compensation_off;  ///< of the tool's radius or length
  Setting<NcSpindle> spindle;
  Setting<double> spindle_rpm;  ///< S
  Setting<bool> mist_on;
  Setting<double> dwell_s;
  std::int32_t call = -1;  ///< index of a subroutine
  bool returns = false;
  bool ends = false;
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
  std::size_t main_first = 0;
  std::size_t main_last = 0;  ///< block behind the last of the main program
  std::int32_t lines = 0;
  /// What is missing of a file that stops in the middle; nothing if it is whole.
  std::optional<std::string> truncated;
};

/// Longest line of a program, and longest program, that is read.
inline constexpr std::size_t kLongestNcLine = 1024;
inline constexpr std::size_t kLongestNcBytes = std::size_t{1} << 30;

/// Reads the text of a program. Whatever the dialect's rules do not cover here is refused, never skipped.
/// \param file names it in messages \param spindle lines that a PMAC is to take as they are, letter by letter
/// \throw InputError naming file and line: a word that is not understood, a line that is too long, text that is none
NcProgram parse_nc(std::string_view text, const std::string& file, NcDialect dialect,
                   const NcSpindleTexts& spindle = {});

/// The dialect that a text is written in, from the words that only one of them has.
/// \throw InputError if the text is empty, binary, or shows none
NcDialect recognise_dialect(std::string_view text, const std::string& file);

}  // namespace retrace::fabrication

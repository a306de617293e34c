#pragma once

// What programs must know of a machine's control: how finely it takes words, and what it has words for at all.

#include <cstdint>
#include <string>
#include <string_view>

namespace retrace::fabrication {

/// Least increments of words, in the units of programs: positions are rounded to whole multiples before they are
/// solved, so that nothing is lost when they are written.
struct Increments {
  std::int64_t linear_nm = 1;
  std::int64_t rotary_units = 1;  ///< of 1e-7 degrees
};

/// Words of machine files, in the order of the enumerators: least increments of 1e-3, 1e-4, 1e-5 and 1e-6 mm or
/// degrees.
enum class IncrementSystem : std::uint8_t { b, c, d, e };
inline constexpr std::string_view kIncrementSystemWords[] = {"B", "C", "D", "E"};

/// The control of a machine. Each dialect takes what concerns it.
struct Control {
  IncrementSystem increment_system = IncrementSystem::e;  ///< of a Fanuc
  bool has_rotation = false;                              ///< of a Fanuc: G68 turns coordinates, G69 cancels it
  bool has_mirror = false;                                ///< of a Fanuc: G51.1 mirrors them, G50.1 cancels it
  std::string modulo_axes = "C";  ///< letters of rotary axes that a Sinumerik counts within a turn
  int coordinate_system = 1;      ///< of a Power PMAC
  std::string mist_on;            ///< lines of a Power PMAC or an Aerotech control; empty: it has none
  std::string mist_off;
  std::string optional_stop;
  std::string stop;
  bool has_unchecked_lines = false;  ///< true: the four lines above are not checked
  bool rapids_are_straight = false;  ///< axes arrive together; otherwise each goes at its own speed
};

/// Purpose of a program line that the machine file defines: an output, such as mist or the spindle, or a stop.
enum class LineUse : std::uint8_t { output, stop };

/// Checks the characters of a program line that the machine file defines for a Power PMAC or an Aerotech control.
/// \return an empty text if the line has 1 to 200 printable ASCII characters, no // and no blanks at its ends;
///        otherwise an error message
std::string unfit_line(std::string_view text);

/// Returns true if a line only sets an output or a variable, or calls an M code that the machine builder defines. A
/// line for a stop may also be M0 or M1.
/// \param dialect dialect of the program; empty: any dialect
bool is_harmless_line(std::string_view text, LineUse use, std::string_view dialect = {});

/// Returns an error message with the allowed forms of a line. Returns an empty text if is_harmless_line() is true.
std::string unknown_line(std::string_view text, LineUse use, std::string_view dialect = {});

/// Those of a Fanuc's increment system.
Increments increments_of(IncrementSystem system);

}  // namespace retrace::fabrication

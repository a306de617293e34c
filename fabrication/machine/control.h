#pragma once

// Properties of a machine's control that programs depend on: resolution of positions, and available functions.

#include <cstdint>
#include <string>
#include <string_view>

namespace retrace::fabrication {

/// Least increments of the control. Planned positions are whole multiples of these increments, so writing the positions
/// to a program does not change them.
struct Increments {
  std::int64_t linear_nm = 1;     ///< increment of linear axes, in nm
  std::int64_t rotary_units = 1;  ///< increment of rotary axes, in units of 1e-7 degrees
};

/// Increment system of a Fanuc control. The least increments are 1e-3 (B), 1e-4 (C), 1e-5 (D) and 1e-6 (E) mm or
/// degrees.
enum class IncrementSystem : std::uint8_t { b, c, d, e };
inline constexpr std::string_view kIncrementSystemWords[] = {"B", "C", "D", "E"};

/// Control of a machine. Each dialect uses only some of these properties.
struct Control {
  IncrementSystem increment_system = IncrementSystem::e;  ///< Fanuc: resolution of positions
  bool has_rotation = false;      ///< Fanuc: the control can rotate coordinates (G68 on, G69 off)
  bool has_mirror = false;        ///< Fanuc: the control can mirror coordinates (G51.1 on, G50.1 off)
  std::string modulo_axes = "C";  ///< Sinumerik: letters of the modulo axes, whose positions are 0 to 360 degrees
  int coordinate_system = 1;      ///< Power PMAC: number of the coordinate system
  std::string mist_on;            ///< Power PMAC or Aerotech: program line that switches the mist on; empty: no mist
  std::string mist_off;           ///< program line that switches the mist off
  std::string optional_stop;      ///< program line of an optional stop
  std::string stop;               ///< program line of a stop
  /// True: the four program lines above may contain any text, even text that moves axes.
  bool has_unchecked_lines = false;
  bool rapids_are_straight = false;  ///< true: axes of a rapid move arrive together; false: each has its own speed
};

/// Purpose of a program line that the machine file defines: it switches an output (mist, spindle), or is a stop.
enum class LineUse : std::uint8_t { output, stop };

/// Checks the characters of a program line that the machine file defines for a Power PMAC or an Aerotech control.
/// \return an empty text if the line has 1 to 200 printable ASCII characters, no // and no blanks at its ends;
///        otherwise an error message
std::string line_error(std::string_view text);

/// Returns true if a line neither moves axes nor waits. Such a line sets an output or a variable, or calls an M code of
/// the machine builder. A line for a stop may also be M0 or M1.
/// \param dialect dialect of the program; empty: any dialect
bool is_harmless_line(std::string_view text, LineUse use, std::string_view dialect = {});

/// Returns an error message with the allowed forms of a line. Returns an empty text if is_harmless_line() is true.
std::string line_form_error(std::string_view text, LineUse use, std::string_view dialect = {});

/// Returns the least increments of a Fanuc increment system.
Increments increments_of(IncrementSystem system);

}  // namespace retrace::fabrication

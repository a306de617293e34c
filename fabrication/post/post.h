#pragma once

// Writes programs as NC text. Each program becomes one complete file in a dialect.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fabrication/machine/control.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Dialect of NC text.
struct Dialect {
  std::string_view name;     ///< name in commands
  std::string_view ending;   ///< file extension, with the dot
  std::string_view comment;  ///< description in lists
};

/// Returns all dialects. The first one is the reference dialect.
std::span<const Dialect> dialects();

/// Returns the program as one complete file of a dialect: header, preparation, subroutines, moves, end.
/// \pre a spindle has start and stop texts if the dialect has no spindle words
/// \throw InputError for an unknown dialect
std::string nc_text(const Program& program, std::string_view dialect);

/// Returns the settings of the control that programs require but cannot make. The result is a list of lines that begin
/// with "Needs: ".
/// \throw InputError for an unknown dialect
std::vector<std::string> control_needs(std::string_view dialect, const Control& control);

/// Checks that the control supports all items of a program.
/// \throw InputError naming the key of the machine file if it does not
void check_supported(const Program& program, std::string_view dialect);

/// Returns the increments to which a control rounds positions in a dialect. The planner should round positions to these
/// increments.
/// \throw InputError for an unknown dialect
Increments position_increments(std::string_view dialect, const Control& control);

/// Returns the letters of the rotary axes that take the shortest path to a programmed angle in a dialect.
/// \throw InputError for an unknown dialect
std::string shortest_axes(std::string_view dialect, const Control& control);

/// Returns true if a dialect supports paths with velocities at the ends of their moves.
/// \throw InputError for an unknown dialect
bool supports_cubics(std::string_view dialect);

/// Returns the file extension of a dialect.
/// \throw InputError for an unknown dialect
std::string_view ending_of(std::string_view dialect);

}  // namespace retrace::fabrication

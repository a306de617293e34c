#pragma once

// Writers of NC text: a program as one complete file of a dialect.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fabrication/machine/control.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// A dialect of NC text.
struct Dialect {
  std::string_view name;     ///< as commands call it
  std::string_view ending;   ///< of its files, with the dot
  std::string_view comment;  ///< what is said of it in lists
};

/// All dialects, the reference first.
std::span<const Dialect> dialects();

/// The program as one complete file of that dialect: header, preparation, subroutines, moves, end.
/// \pre a spindle has its texts where the dialect has no words for it
/// \throw InputError for a dialect that is not known
std::string nc_text(const Program& program, std::string_view dialect);

/// What must hold on the control that no program can say, as lines for people that begin with "Needs: ".
/// \throw InputError likewise
std::vector<std::string> control_needs(std::string_view dialect, const Control& control);

/// That the control has words for all that the program says. \throw InputError naming the key of the machine file
void check_words(const Program& program, std::string_view dialect);

/// To what a control takes words in that dialect: positions are best rounded to it before others are solved.
/// \throw InputError likewise
Increments word_increments(std::string_view dialect, const Control& control);

/// Returns the letters of the rotary axes that take the shortest path to a programmed angle in a dialect.
/// \throw InputError for an unknown dialect
std::string shortest_axes(std::string_view dialect, const Control& control);

/// Whether paths may have velocities at the ends of their moves in that dialect. \throw InputError likewise
bool takes_cubics(std::string_view dialect);

/// The ending of a dialect's files. \throw InputError likewise
std::string_view ending_of(std::string_view dialect);

}  // namespace retrace::fabrication

#pragma once

// Writes NC programs that cut nothing. The quantities of TimeCalibration are determined from the measured times of
// these programs.

#include <string_view>
#include <vector>

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::studies {

/// Returns four programs, each of which spends its time on one kind of move. `times-steps` has short slow moves, whose
/// time is determined by settling and ramps. `times-strokes` has rapid moves that are too short to reach the rapid
/// speed, so that accelerations determine the time. `times-ways` has rapid moves that reach this speed. `times-turns`
/// has rotations of the rotary axes. Like programs that cut, all four programs begin with Z at the machine's safe
/// height. Z stays there, and X and Y stay within a quarter of their travel about its centre.
std::vector<fabrication::Program> time_programs(const fabrication::Machine& machine, std::string_view dialect);

}  // namespace retrace::studies

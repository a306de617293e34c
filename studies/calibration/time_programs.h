#pragma once

// Programs that cut nothing and take times from which TimeCalibration's quantities follow.

#include <string_view>
#include <vector>

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::studies {

/// Four programs that spend their time on one thing each: `times-steps` short slow moves, whose time is settling and
/// ramps; `times-strokes` rapid moves too short for the rapid speed, which accelerations decide; `times-ways` rapid
/// moves that reach it; `times-turns` turns of the rotary axes. All of them begin as every program does, with Z at the
/// machine's safe height, and stay there, X and Y within a quarter of their travel about its middle.
std::vector<fabrication::Program> time_programs(const fabrication::Machine& machine, std::string_view dialect);

}  // namespace retrace::studies

#pragma once

// Machining time of single moves, from rapid speeds, feeds and the axes' accelerations, jerks and settling.

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Time of a linear move of the machine by (x, y, z) mm until all axes stand still: exact stop after every block, as
/// the programs ask for. \param feed_mm_per_min along the path; nothing: a rapid move
double linear_move_s(const Machine& machine, const geometry::Vec3& by_mm, std::optional<double> feed_mm_per_min);

/// Time of a rotary move by (a, c) degrees, both axes together, until they stand still.
double rotary_move_s(const Machine& machine, double a_deg, double c_deg);

}  // namespace retrace::fabrication

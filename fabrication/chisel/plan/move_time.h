#pragma once

// Machining time of single moves, from rapid speeds, feeds and the axes' accelerations, jerks and settling.

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Returns the time, in s, of a linear move by (x, y, z) mm that ends with an exact stop. All planned programs move in
/// this way.
/// \param feed_mm_per_min feed along the path; empty: a rapid move
double linear_move_s(const Machine& machine, const geometry::Vec3& by_mm, std::optional<double> feed_mm_per_min);

/// Time of a rotary move by (a, c) degrees, both axes together, until they stand still.
double rotary_move_s(const Machine& machine, double a_deg, double c_deg);

}  // namespace retrace::fabrication

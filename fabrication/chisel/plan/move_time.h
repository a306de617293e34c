#pragma once

// Computes the machining time of single moves from rapid speeds, feeds, accelerations, jerks and settling times.

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Returns the time, in s, of a linear move by (x, y, z) mm that ends with an exact stop. All moves of planned programs
/// end with an exact stop.
/// \param feed_mm_per_min feed along the path; empty: a rapid move
double linear_move_s(const Machine& machine, const geometry::Vec3& by_mm, std::optional<double> feed_mm_per_min);

/// Returns the time, in s, of a rotary move by (a, c) degrees including settling. Both axes move at the same time.
double rotary_move_s(const Machine& machine, double a_deg, double c_deg);

}  // namespace retrace::fabrication

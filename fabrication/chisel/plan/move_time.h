#pragma once

// Machining time of single moves, from rapid speeds, feeds and accelerations of the axes.

#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Time from rest to rest over a distance: exact stop after every block, as the programs ask for. Constant
/// acceleration. \pre distance >= 0, speed and acceleration > 0
double rest_to_rest_s(double distance, double speed, double acceleration);

/// Time of a linear move of the machine by (x, y, z) mm, all axes together.
/// \param feed_mm_per_min along the path; nothing: as fast as the axes' rapid traverse allows
double linear_move_s(const Machine& machine, const geometry::Vec3& by_mm, std::optional<double> feed_mm_per_min);

/// Time of a rotary move by (a, c) degrees, both axes together.
double rotary_move_s(const Machine& machine, double a_deg, double c_deg);

}  // namespace retrace::fabrication

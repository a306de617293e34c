#pragma once

// The rows of the validation by what they are about. Each file has its own.

#include <vector>

#include "studies/validation/validation.h"

namespace retrace::studies {

/// Retroreflective efficiency, total reflection, apertures, errors of angle, diffraction.
std::vector<ValidationRow> light_validation();
/// Balls with mirrors.
std::vector<ValidationRow> ball_validation();
/// Materials, roughness of facets, scatter.
std::vector<ValidationRow> surface_validation();
/// Kinematics, cuts, machining times.
std::vector<ValidationRow> chisel_validation();
/// Cutting forces.
std::vector<ValidationRow> force_validation();
/// Turned and planed surfaces.
std::vector<ValidationRow> turning_validation();

}  // namespace retrace::studies

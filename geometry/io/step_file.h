#pragma once

// Writes solids as STEP for CAD programs. The conversion is in a separate module that uses OpenCASCADE.

#include <string>

#include "geometry/part/exact_solid.h"

namespace retrace::geometry {

/// Minimum edge length for STEP export. OpenCASCADE treats points nearer than 1e-7 mm as equal.
inline constexpr double kMinStepEdgeMm = 1e-6;

/// Returns the solid as STEP AP214: one manifold solid with shared edges, in mm. Its faces are planes, except for a
/// curved entrance face. Equal solids give equal texts, because the time stamp is empty.
/// \param name name of the product
/// \throw InputError if an edge is shorter than kMinStepEdgeMm
/// \throw OutputError if the module with OpenCASCADE is missing, because retrace was built without it
std::string step_text(const ExactSolid& solid, const std::string& name);

/// Predicted cost of step_text().
struct StepCost {
  double megabytes = 0.0;
  double seconds = 0.0;  ///< on a processor of 2020
};
StepCost predicted_step_cost(const ExactSolid& solid);

}  // namespace retrace::geometry

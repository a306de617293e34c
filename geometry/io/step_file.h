#pragma once

// Writes faceted solids as STEP for CAD programs. The conversion is in a separate module that uses OpenCASCADE.

#include <string>

#include "geometry/part/faceted_solid.h"

namespace retrace::geometry {

/// Minimum edge length for STEP export. OpenCASCADE treats points nearer than 1e-7 mm as equal.
inline constexpr double kMinStepEdgeMm = 1e-6;

/// Returns the solid as STEP AP214: one manifold solid of plane faces with shared edges, in mm. Equal solids give equal
/// texts, because the time stamp is empty.
/// \param name name of the product
/// \throw InputError if an edge is shorter than kMinStepEdgeMm
/// \throw OutputError if the module with OpenCASCADE is missing, because retrace was built without it
std::string step_text(const FacetedSolid& solid, const std::string& name);

}  // namespace retrace::geometry

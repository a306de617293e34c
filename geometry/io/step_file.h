#pragma once

// Writes faceted solids as STEP, for CAD programs; OpenCASCADE does it in a module of its own.

#include <string>

#include "geometry/part/faceted_solid.h"

namespace retrace::geometry {

/// Shortest edge that STEP export takes: OpenCASCADE holds points nearer than 1e-7 mm for one.
inline constexpr double kShortestStepEdgeMm = 1e-6;

/// The solid as STEP AP214: one manifold solid of plane faces with shared edges, in millimetres. The same solid gives
/// the same text: its time stamp is none. \param name of the product
/// \throw InputError if an edge is shorter than kShortestStepEdgeMm
/// \throw OutputError where the module with OpenCASCADE is missing: retrace may be built without
std::string step_text(const FacetedSolid& solid, const std::string& name);

}  // namespace retrace::geometry

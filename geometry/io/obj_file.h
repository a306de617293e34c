#pragma once

// Writes boundary meshes as Wavefront OBJ.

#include <string>
#include <string_view>

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// Returns the mesh as Wavefront OBJ in mm and double precision, with one group for each role of its faces.
/// \param title one line of text for a comment
std::string obj_text(const BoundaryMesh& mesh, std::string_view title);

}  // namespace retrace::geometry

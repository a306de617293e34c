#pragma once

// The part of any design, built from elements or from a plate, or read from a mesh and checked.

#include <string>
#include <vector>

#include "geometry/part/part.h"
#include "geometry/part/triangle_mesh.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// The part that a design describes: built from its elements, or read from its mesh and checked (CGAL): a mesh must be
/// closed and free of self-intersections. Of an open mesh with `allow_open`, openings are closed by flat pieces.
/// \param warnings gets what the user should know of a mesh; null: not wanted
/// \throw InputError naming file and line
geometry::Part part_of_design(const Design& design, std::vector<std::string>* warnings);

/// The mesh of a design as part_of_design() takes it, outward. \pre it is a mesh or a plate
geometry::TriangleMesh mesh_of_design(const Design& design, std::vector<std::string>* warnings);

}  // namespace retrace::studies

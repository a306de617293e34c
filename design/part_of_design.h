#pragma once

// Builds the part of any design from its elements or its plate, or reads it from a mesh and checks the mesh.

#include "core/warning.h"
#include "design/design.h"
#include "geometry/part/part.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::design {

/// Returns the part of a design. It is built from the elements, or read from the mesh and checked with CGAL. A mesh
/// must be closed and free of self-intersections. With `allow_open`, openings are closed by flat patches.
/// \param warnings receives warnings about a mesh; may be null
/// \throw InputError that names file and line
geometry::Part part_of_design(const Design& design, Warnings* warnings);

/// Returns the mesh of a design after the checks of part_of_design(), with normals that point outwards.
/// \pre the design is a mesh or a plate
geometry::TriangleMesh mesh_of_design(const Design& design, Warnings* warnings);

}  // namespace retrace::design

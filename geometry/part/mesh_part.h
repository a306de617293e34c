#pragma once

// Makes a traceable part of a closed triangle mesh from a file, and closes openings of meshes that are not.

#include "geometry/part/closed_boundary.h"
#include "geometry/part/part.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// A mesh whose openings are closed, and how many there were.
struct ClosedMesh {
  TriangleMesh mesh;
  std::size_t openings = 0;
  std::size_t open_edges = 0;
};

/// Closes every opening of a mesh by triangles from its border to its border's middle: flat where the border is flat.
/// \throw InputError if a border branches, so that there is no telling what it encloses
ClosedMesh with_openings_closed(const TriangleMesh& mesh);

/// The mesh as a boundary, all of one role: for check_boundary().
BoundaryMesh boundary_of(const TriangleMesh& mesh);

/// The mesh with every triangle turned over.
TriangleMesh turned_over(const TriangleMesh& mesh);

/// A part whose shape is a closed mesh, in the mesh's own x and y; z counts from the highest point of its back. Its
/// entrance face is the highest level face of the mesh, with a convex outline; everything else lies below it and within
/// its outline, so that the sides are upright. Facets are the mesh's triangles: level ones are flat back, upright ones
/// walls, the others retro facets.
///
/// Vertices within 1e-6 of the mesh's size of the entrance face's plane or of a side are put there: meshes come in
/// single precision.
/// \pre the mesh is closed, outward and does not cross itself (check_boundary())
/// \throw InputError if it is no such part
Part part_of_mesh(const TriangleMesh& mesh);

}  // namespace retrace::geometry

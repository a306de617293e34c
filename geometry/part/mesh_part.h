#pragma once

// Makes a traceable part of a closed triangle mesh from a file, and closes openings of meshes that are not.

#include <optional>

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

/// Finds two adjacent triangles of opposite orientation, which traverse their common edge in the same direction.
/// Returns the midpoint of this edge, or nothing if there is no such edge. Edges of openings are ignored.
std::optional<Vec3> mixed_winding(const TriangleMesh& mesh);

/// The mesh with every triangle turned over.
TriangleMesh turned_over(const TriangleMesh& mesh);

/// Returns a part that has the shape of a closed mesh. The x and y coordinates are those of the mesh; z is 0 at the
/// highest point of the back. The highest face of the mesh must be horizontal and have a convex outline; it becomes the
/// entrance face. The rest of the mesh must be below the entrance face and within its outline. The sides are therefore
/// vertical.
///
/// The facets are the plane regions of the back, whatever their triangulation. Horizontal regions become flat back,
/// vertical regions become walls, and all other regions become retro facets. A region that is not convex is stored as
/// several facets in the same plane. elements_of_regions() determines which facets form an element.
///
/// Meshes are often stored in single precision. A vertex near the plane of the entrance face or of a side is therefore
/// moved onto this plane; the maximum distance is about 1e-6 of the size of the mesh. Vertices of the back are also
/// moved onto the planes of their facets, typically by less than 5e-7 of the largest coordinate.
/// \pre the mesh is closed, its normals point outward, and it does not intersect itself (check_boundary())
/// \throw InputError if the mesh does not have the shape described above
Part part_of_mesh(const TriangleMesh& mesh);

}  // namespace retrace::geometry

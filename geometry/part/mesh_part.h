#pragma once

// Builds a part for ray tracing from a closed triangle mesh, and closes the openings of a mesh that is not closed.

#include <optional>

#include "geometry/part/closed_boundary.h"
#include "geometry/part/part.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Mesh whose openings were closed, with the number of openings and of their edges.
struct ClosedMesh {
  TriangleMesh mesh;
  std::size_t openings = 0;
  std::size_t open_edges = 0;
};

/// Closes each opening of a mesh with triangles from its border to the centroid of the border. A plane border gets a
/// plane cover.
/// \throw InputError if a border branches, because the enclosed area is then undefined
ClosedMesh with_openings_closed(const TriangleMesh& mesh);

/// Returns the mesh as input for check_boundary(). All triangles get the same role.
BoundaryMesh boundary_of(const TriangleMesh& mesh);

/// Finds two adjacent triangles of opposite orientation. Such triangles traverse their common edge in the same
/// direction. Returns the midpoint of this edge, or nothing if there is no such edge. Edges of openings are ignored.
std::optional<Vec3> mixed_winding(const TriangleMesh& mesh);

/// Returns the mesh with the orientation of every triangle reversed.
TriangleMesh with_reversed_orientation(const TriangleMesh& mesh);

/// Builds a part that has the shape of a closed mesh. The x and y coordinates of the mesh are kept. The mesh is shifted
/// along z so that the highest point of the back has z = 0. The highest face of the mesh becomes the entrance face: it
/// must be one horizontal face, which may have notches and holes. The rest of the mesh must be below the entrance face
/// and within its outline, and the sides are therefore vertical.
///
/// The facets are the plane regions of the back; how a region is triangulated has no effect. Horizontal regions become
/// flat back, vertical regions become walls, and all other regions become retro facets. A region that is not convex is
/// stored as several facets in the same plane. elements_of_regions() determines which facets form an element.
///
/// Meshes are often stored in single precision, which is the default of `rounding_mm`. A vertex near the plane of the
/// entrance face or of a side is therefore moved onto that plane. The maximum distance is about 1e-6 of the size of the
/// mesh. Vertices of the back are also moved onto the planes of their facets, typically by less than 5e-7 of the
/// largest coordinate. \param rounding_mm maximum error of a vertex \pre the mesh is closed, its normals point outward,
/// and it does not intersect itself (check_boundary()) \throw InputError if the mesh does not have the shape described
/// above
Part part_of_mesh(const TriangleMesh& mesh, std::optional<double> rounding_mm = {});

}  // namespace retrace::geometry

#pragma once

// Entrance surfaces that are given as triangle meshes. Determines the triangles through which light enters, and checks
// that they cover the part without holes, overlaps or steps.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/entrance/entrance_surface.h"
#include "geometry/entrance/mesh_tiling.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Triangles of a mesh that form the entrance surface.
enum class MeshSide {
  top,  ///< triangles that face +z
  /// triangles that face -z, with reversed orientation: the mesh is the counterpart (such as a mould) of the part
  bottom
};

/// Triangles of a mesh that form the entrance surface of a part, and the result of checking their coverage.
struct MeshCover {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corner indices, in an order such that the normals face +z
  double fraction = 0.0;         ///< total area of the triangles inside the outline / area of the outline (plan view)
  std::optional<TilingGap> gap;  ///< first discontinuity found, in the mesh frame; empty if there is none

  /// Returns true if the triangles cover the outline without holes or overlaps, and their heights are continuous.
  bool is_exact() const;
};

/// Determines the triangles of the requested side that are located within the outline of a part, in plan view. Checks
/// that they cover the outline without gaps.
/// \param move_mm translation from the frame of the mesh to the frame of the part
MeshCover cover_of_mesh(const TriangleMesh& mesh, MeshSide side, const Vec3& move_mm, const Polygon& outline);

/// Returns the entrance surface of a part from a mesh, as triangles that face +z.
/// \param move_mm translation from the frame of the mesh to that of the part
/// \throw InputError unless the triangles cover the outline exactly once and neighbours share complete sides.
///     Holes, overlaps, steps, corners on sides, and vertical or overhanging triangles are reported with their position
///     in the frame of the mesh
SurfacePatch entrance_of_mesh(const TriangleMesh& mesh, MeshSide side, const Vec3& move_mm, const Polygon& outline);

/// Returns the range of heights and slopes of an entrance surface from a mesh. Corresponds to entrance_range() for
/// exact surfaces.
EntranceRange range_of_entrance_mesh(const SurfacePatch& patch, const Polygon& outline);

/// Clips the triangles of an entrance mesh to the outline of a part. The returned polygons are convex in plan and
/// counter-clockwise seen from above. Their corners are moved onto a side of the outline if the distance to this side
/// is within the rounding errors of single precision.
std::vector<std::vector<Vec3>> entrance_mesh_polygons(const SurfacePatch& patch, const Polygon& outline);

}  // namespace retrace::geometry

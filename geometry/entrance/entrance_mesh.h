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

/// Triangles of a mesh through which light enters a part, and how they cover it.
struct MeshCover {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< oriented such that they face +z
  double fraction = 0.0;                                ///< covered area divided by the area of the outline
  std::optional<TilingGap> gap;                         ///< first gap, in the frame of the mesh

  /// Returns true if the triangles cover the part exactly once.
  bool is_exact() const;
};

/// Determines the triangles that cover the outline of a part.
/// \param move_mm translation from the frame of the mesh to that of the part
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

}  // namespace retrace::geometry

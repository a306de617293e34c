#pragma once

// Entrance surfaces given as triangle meshes: which triangles light enters through, and whether they cover the part
// without holes, overlaps or steps.

#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Which triangles of a mesh are the entrance surface.
enum class MeshSide {
  top,    ///< those that look towards +z
  bottom  ///< those that look towards -z, turned over: the mesh is the counterpart of the part
};

/// The front of a part from a mesh, as triangles that look towards +z.
/// \param move_mm from the mesh's frame into the part's
/// \throw InputError unless they cover the outline once, each beside the next along whole sides: holes, overlaps,
/// steps, corners on sides and triangles that stand upright or hang over are named with their place in the mesh's frame
SurfacePatch entrance_of_mesh(const TriangleMesh& mesh, MeshSide side, const Vec3& move_mm, const Polygon& outline);

/// entrance_range() of a mesh.
EntranceRange range_of_entrance_mesh(const SurfacePatch& patch, const Polygon& outline);

}  // namespace retrace::geometry

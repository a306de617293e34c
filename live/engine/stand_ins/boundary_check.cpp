// Replaces the mesh checks by functions that report an error, because CGAL is not part of the web engine. Only meshes
// from files need these checks.
#include "geometry/check/boundary_check.h"

#include "geometry/check/mesh_union.h"
#include "live/engine/stand_ins/absent.h"

namespace retrace::geometry {

BoundaryReport check_boundary(const BoundaryMesh&) {
  live::fail_as_absent("no meshes");
}

std::optional<MeshUnion> union_of_bodies(const TriangleMesh&) {
  live::fail_as_absent("no meshes");
}

}  // namespace retrace::geometry

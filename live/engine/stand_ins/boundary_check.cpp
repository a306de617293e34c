// In place of CGAL: only meshes from files are checked.
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

#include "design/part_of_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/named_file.h"
#include "core/number_format.h"
#include "design/design_part.h"
#include "design/mesh_keys.h"
#include "design/zone_elements.h"
#include "geometry/check/boundary_check.h"
#include "geometry/check/mesh_union.h"
#include "geometry/direction.h"
#include "geometry/io/mesh_file.h"
#include "geometry/io/step_solid.h"
#include "geometry/part/faceted_solid.h"
#include "geometry/part/mesh_part.h"
#include "geometry/part/plate.h"
#include "geometry/part/zones.h"

namespace retrace::design {
namespace {

// Relative tolerance of the thickness of a mesh. STL files have single precision, and thicknesses may be rounded values
// from drawings.
constexpr double kSameThickness = 1e-4;
// Maximum distance by which the vertices of a solid are moved onto the planes of their faces, mm. CAD programs treat
// points nearer than this as equal.
constexpr double kMaxSettling_mm = 1e-3;
// Error of a vertex of a solid in double precision, relative to the largest coordinate.
constexpr double kDoubleRounding = 1e-12;

void tell(Warnings* warnings, const Design& design, std::string_view id, const std::string& text) {
  if (warnings != nullptr)
    warnings->push_back({id, fmt::format("{}: {}: {}", design.source_name(), design.mesh()->file.string(), text)});
}

geometry::TriangleMesh closed(const Design& design, geometry::TriangleMesh mesh, Warnings* warnings) {
  geometry::BoundaryReport report = geometry::check_boundary(geometry::boundary_of(mesh));
  if (report.is_closed) return mesh;
  if (const auto p = geometry::mixed_winding(mesh))
    throw InputError(
        fmt::format("all triangles must be counter-clockwise seen from outside, or all clockwise, but two neighbouring "
                    "triangles near ({}, {}, {}) mm have different orientations: unify the orientation of the faces in "
                    "the program that made the mesh",
                    fixed(p->x(), 3), fixed(p->y(), 3), fixed(p->z(), 3)));
  if (!design.mesh()->allow_open)
    throw InputError("the mesh is not closed; set allow_open = true in [part] to close its openings with flat patches");
  geometry::ClosedMesh mended = geometry::with_openings_closed(mesh);
  tell(warnings, design, "openings_closed",
       fmt::format("the mesh is not closed: {} opening{} with {} edges {} closed with flat patches; results apply to "
                   "the repaired mesh",
                   mended.openings, mended.openings == 1 ? "" : "s", mended.open_edges,
                   mended.openings == 1 ? "was" : "were"));
  return std::move(mended.mesh);
}

/// Returns the union of all bodies of a mesh. The bodies may touch, intersect or contain each other.
/// \param report result of check_boundary() for this mesh
/// \pre the mesh is closed and manifold
geometry::TriangleMesh united(const Design& design, const geometry::TriangleMesh& mesh,
                              const geometry::BoundaryReport& report, Warnings* warnings) {
  std::string fault = "does not enclose one volume";
  if (const auto& p = report.crossing_mm)
    fault = fmt::format("crosses itself near ({}, {}, {}) mm", fixed(p->x(), 3), fixed(p->y(), 3), fixed(p->z(), 3));
  std::optional<geometry::MeshUnion> all = geometry::union_of_bodies(mesh);
  if (!all)
    throw InputError(
        fmt::format("the mesh {}, and its bodies cannot be united: each body must be a closed surface that does not "
                    "cross itself; repair the mesh in the program that made it",
                    fault));
  tell(warnings, design, "bodies_united",
       fmt::format("the mesh {}; results apply to the union of its {} bodies", fault, all->bodies));
  return std::move(all->mesh);
}

geometry::TriangleMesh checked(const Design& design, geometry::TriangleMesh mesh, Warnings* warnings) {
  mesh = closed(design, std::move(mesh), warnings);
  if (geometry::volume_mm3(geometry::boundary_of(mesh)) < 0.0) {
    tell(warnings, design, "triangles_reversed",
         "the triangles of the mesh face inwards; their orientation was reversed");
    mesh = geometry::with_reversed_orientation(mesh);
  }
  const geometry::BoundaryReport report = geometry::check_boundary(geometry::boundary_of(mesh));
  if (report.ok()) return mesh;
  if (report.is_manifold) return united(design, mesh, report, warnings);
  if (!design.mesh()->allow_open)
    throw InputError("the mesh touches itself along edges; set allow_open = true in [part] to trace it unchanged");
  tell(warnings, design, "touching_edges", "the mesh touches itself along edges; it is traced unchanged");
  return mesh;
}

/// Formats a number with three significant digits.
std::string rounded_text(double value) {
  return shortest(std::stod(fmt::format("{:.2e}", value)));
}

/// Adds a warning if the size of a mesh suggests that its unit is not mm. STL files do not state their unit.
void warn_of_unit(const Design& design, const geometry::TriangleMesh& mesh, Warnings* warnings) {
  // Parts smaller than kSmallestMm are probably given in metres, and parts larger than kLargestMm in micrometres.
  constexpr double kSmallestMm = 0.1;
  constexpr double kLargestMm = 1000.0;
  geometry::Vec3 lower = mesh.vertices.front();
  geometry::Vec3 upper = lower;
  for (const geometry::Vec3& p : mesh.vertices) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const double size_mm = (upper - lower).maxCoeff();
  if (size_mm >= kSmallestMm && size_mm <= kLargestMm) return;
  const bool is_small = size_mm < kSmallestMm;
  const double probable_scale = is_small ? 1000.0 : 0.001;
  const bool is_tried = mesh_keys_of(design).scale == probable_scale;
  tell(warnings, design, "unlikely_unit",
       fmt::format("the largest dimension of the mesh is {} mm; {}", rounded_text(size_mm),
                   is_tried ? "check scale in [part]"
                            : fmt::format("if the unit of the file is the {}, set scale = {} in [part]",
                                          is_small ? "metre" : "micrometre", shortest(probable_scale))));
}

/// Returns the rotation that the keys `rotate_deg` and `facing` describe.
Eigen::Matrix3d part_from_file(const MeshKeys& keys) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  const auto rotate = [&](const geometry::Vec3& axis, double angle_deg) {
    if (angle_deg != 0.0) rotation = geometry::rotation_about(axis, Angle::from_deg(angle_deg)) * rotation;
  };
  rotate(geometry::Vec3::UnitX(), keys.rotate_deg[0]);
  rotate(geometry::Vec3::UnitY(), keys.rotate_deg[1]);
  rotate(geometry::Vec3::UnitZ(), keys.rotate_deg[2]);
  if (keys.faces_down) rotate(geometry::Vec3::UnitX(), 180.0);
  return rotation;
}

/// Mesh of a file in the orientation of the part.
struct OrientedMesh {
  geometry::TriangleMesh mesh;
  std::optional<double> rounding_mm;  ///< maximum error of a vertex; empty: that of single precision
};

OrientedMesh oriented_mesh(const Design& design, const MeshKeys& keys, Warnings* warnings) {
  geometry::MeshOfFile read = geometry::read_mesh_file(design.mesh()->file, keys.scale);
  if (read.trailing_bytes > 0)
    tell(warnings, design, "trailing_bytes",
         fmt::format("the file has {} bytes after the last triangle, which are ignored", read.trailing_bytes));
  warn_of_unit(design, read.mesh, warnings);
  if (keys.weld_mm > 0.0) read.mesh = geometry::welded(read.mesh, keys.weld_mm);
  const Eigen::Matrix3d rotation = part_from_file(keys);
  if (!rotation.isIdentity(0.0))
    for (geometry::Vec3& p : read.mesh.vertices) p = rotation * p;
  return {std::move(read.mesh), {}};
}

OrientedMesh oriented_solid(const Design& design, const MeshKeys& keys, Warnings* warnings) {
  geometry::SolidMesh solid = geometry::read_step_solid(design.mesh()->file, keys.chord_mm);
  const Eigen::Matrix3d rotation = part_from_file(keys);
  double largest_mm = 0.0;
  for (geometry::Vec3& p : solid.mesh.vertices) {
    p = rotation * p;
    largest_mm = std::max(largest_mm, p.cwiseAbs().maxCoeff());
  }
  for (std::optional<geometry::FacetPlane>& plane : solid.planes)
    if (plane) plane->normal = rotation * plane->normal;
  const double apart_mm = geometry::snap_to_face_planes(solid, kMaxSettling_mm);
  if (const std::size_t curved = solid.curved_faces(); curved > 0)
    tell(warnings, design, "curved_faces",
         fmt::format("{} curved face{} of the solid {} traced as triangles within {} mm of the exact surface", curved,
                     curved == 1 ? "" : "s", curved == 1 ? "is" : "are", shortest(keys.chord_mm)));
  return {std::move(solid.mesh), std::max(kDoubleRounding * largest_mm, 2.0 * apart_mm)};
}

/// Reads the mesh or the solid of a design, and checks it.
/// \pre the part of the design is a mesh or a solid
OrientedMesh checked_mesh(const Design& design, Warnings* warnings) {
  const MeshKeys keys = mesh_keys_of(design);
  return read_named(design.where(mesh_file_key(design)), [&] {
    OrientedMesh oriented =
        keys.is_solid ? oriented_solid(design, keys, warnings) : oriented_mesh(design, keys, warnings);
    oriented.mesh = read_named({design.mesh()->file.string(), 0, ""},
                               [&] { return checked(design, std::move(oriented.mesh), warnings); });
    return oriented;
  });
}

void check_thickness(const Design& design, const geometry::Part& part) {
  const double given_mm = design.thickness_mm();
  if (given_mm == 0.0 || std::abs(given_mm - part.thickness_mm) <= kSameThickness * part.thickness_mm) return;
  throw InputError(fmt::format("body.thickness_mm must be left out or equal the thickness of the mesh, {} mm, got {}",
                               fixed_apart(part.thickness_mm, given_mm, 6), shortest(given_mm)));
}

}  // namespace

geometry::TriangleMesh mesh_of_design(const Design& design, Warnings* warnings) {
  if (const Plate* const plate = std::get_if<Plate>(&design.shape))
    return geometry::box_mesh({plate->size_mm[0], plate->size_mm[1]}, plate->thickness_mm);
  return checked_mesh(design, warnings).mesh;
}

geometry::Part part_of_design(const Design& design, Warnings* warnings) {
  if (const Plate* const plate = std::get_if<Plate>(&design.shape))
    return geometry::build_plate({plate->size_mm[0], plate->size_mm[1]}, plate->thickness_mm);
  if (design.zoned()) return geometry::build_part(zones_of(design));
  if (!design.mesh()) return part_of(design);
  const OrientedMesh oriented = checked_mesh(design, warnings);
  try {
    geometry::Part part = geometry::part_of_mesh(oriented.mesh, oriented.rounding_mm);
    check_thickness(design, part);
    if (design.entrance && !part.entrance_pieces.empty())
      throw InputError("must have a convex entrance face without holes if the design has an [entrance_surface]");
    return part;
  } catch (const InputError& error) {
    throw InputError(design.where(mesh_file_key(design)),
                     fmt::format("{}: {}", design.mesh()->file.string(), error.what()));
  }
}

}  // namespace retrace::design

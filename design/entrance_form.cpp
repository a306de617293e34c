#include "design/entrance_form.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/named_file.h"
#include "core/overloaded.h"
#include "geometry/direction.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/io/substrate_rows.h"
#include "geometry/surface/step_surface.h"

namespace retrace::design {

using geometry::Vec2, geometry::Vec3;

namespace {

/// Returns the size of the smallest features of a shape, or infinity if it is unknown. At an edge between two faces,
/// the curvature is infinite, and a search for the size would not end.
double finest_mm(const geometry::EntranceShape& shape) {
  constexpr double kFeaturesAcross = 16.0;
  const auto* const face = std::get_if<geometry::StepFace>(&shape);
  if (face == nullptr || face->surface->patches.face_count() == 1) return std::numeric_limits<double>::infinity();
  return face->surface->size_mm.maxCoeff() / kFeaturesAcross;
}

/// Maximum radius of a cylinder or sphere that is described by its centre. The position of the surface would have a
/// large rounding error for larger radii.
constexpr double kMaxExactRadiusMm = 1e5;

/// Returns the rotation from the frame of the entrance surface to the frame of the part.
Eigen::Matrix3d part_from_surface_of(const EntranceForm& form) {
  return geometry::rotation_of(form.inclination) *
         geometry::rotation_about(Vec3::UnitZ(), Angle::from_deg(form.rotation_deg));
}

/// Position of the centre of curvature of a surface and direction from there to the surface.
struct Curvature {
  Vec3 centre_mm;
  Vec3 towards;
};

/// \param normal normal of the surface at its vertex, towards the light
/// \param radius_mm radius of curvature; > 0 if the surface is convex towards the light
Curvature curvature_at(const Vec3& vertex_mm, const Vec3& normal, double radius_mm) {
  return {vertex_mm - radius_mm * normal, radius_mm > 0.0 ? normal : Vec3(-normal)};
}

}  // namespace

std::shared_ptr<const geometry::EntranceSurface> surface_of(const EntranceForm& form, const Vec3& origin_mm) {
  return std::make_shared<const geometry::EntranceSurface>(
      geometry::FreeformSurface(geometry::height_of(form.shape), std::nullopt, {}, {}),
      geometry::SurfacePose{origin_mm, part_from_surface_of(form)}, finest_mm(form.shape));
}

std::optional<geometry::FaceSurface> closed_form_of(const EntranceForm& form, const Vec3& origin_mm) {
  using Found = std::optional<geometry::FaceSurface>;
  const Eigen::Matrix3d axes = part_from_surface_of(form);
  const Vec3 normal = axes.col(2);
  return std::visit(
      Overloaded{[&](const geometry::PlaneEntrance&) {
                   return Found(geometry::ExactPlane{origin_mm, normal});
                 },
                 [&](const geometry::CylinderEntrance& cylinder) {
                   if (cylinder.conic != 0.0 || std::abs(cylinder.radius_mm) > kMaxExactRadiusMm) return Found();
                   const Curvature at = curvature_at(origin_mm, normal, cylinder.radius_mm);
                   return Found(geometry::ExactCylinder{at.centre_mm, axes.col(1), at.towards,
                                                        std::abs(cylinder.radius_mm), cylinder.radius_mm > 0.0});
                 },
                 [&](const geometry::SphereEntrance& sphere) {
                   if (sphere.conic != 0.0 || std::abs(sphere.radius_mm) > kMaxExactRadiusMm) return Found();
                   const Curvature at = curvature_at(origin_mm, normal, sphere.radius_mm);
                   return Found(geometry::ExactSphere{at.centre_mm, at.towards, std::abs(sphere.radius_mm),
                                                      sphere.radius_mm > 0.0});
                 },
                 [](const geometry::BiconicEntrance&) { return Found(); },
                 [](const geometry::FormulaEntrance&) { return Found(); },
                 [](const geometry::StepFace&) { return Found(); }},
      form.shape);
}

void find_offset(Design& design) {
  if (!design.elements() || !design.part().substrate) return;
  geometry::PartSpec& part = design.part();
  auto* const offset = std::get_if<geometry::OffsetSubstrate>(&part.substrate->shape);
  if (offset == nullptr) return;
  const Vec2 half_mm = 0.5 * Vec2(part.array.x_length_mm, part.array.y_length_mm);
  const std::optional<std::array<double, 2>>& given = design.entrance->centre_mm;
  const Vec2 centre_mm = given ? Vec2((*given)[0], (*given)[1]) - half_mm : Vec2(Vec2::Zero());
  const auto surface = surface_of(*design.entrance->form(), {centre_mm.x(), centre_mm.y(), 0.0});
  read_named(design.where(design.entrance_key()), [&] {
    // Error messages need positions in the part frame. The position of the substrate is relative to the centre of the
    // part.
    const Vec2 middle_mm = centre_mm + half_mm;
    geometry::check_folds(*surface_of(*design.entrance->form(), {middle_mm.x(), middle_mm.y(), 0.0}),
                          geometry::to_polygon({Vec2::Zero(), 2.0 * half_mm}));
  });
  offset->entrance_mm = [surface](const Vec2& position_mm) { return surface->at(position_mm).height_mm; };
  const geometry::SubstrateMeasures measures = read_named(design.where(geometry::substrate_shape_key(*part.substrate)),
                                                          [&] { return geometry::check_substrate(part); });
  part.thickness_mm = measures.highest_mm - measures.lowest_mm + offset->wall_mm;
}

}  // namespace retrace::design

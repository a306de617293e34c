#include "geometry/entrance/entrance_shape.h"

#include "core/overloaded.h"
#include "geometry/direction.h"

namespace retrace::geometry {

FormulaEntrance parse_entrance_formula(const std::string& text, const InputLocation& where) {
  return {std::make_shared<const Formula>(parse_formula(text, {"x", "y", "r", "theta"}, where))};
}

Sag height_of(const EntranceShape& shape) {
  Sag sag;
  std::visit(Overloaded{[](const PlaneEntrance&) {},
                        [&](const CylinderEntrance& cylinder) {
                          sag.asphere = {-1.0 / cylinder.radius_mm, cylinder.conic, {}, Asphere::Across::x};
                        },
                        [&](const SphereEntrance& sphere) {
                          sag.asphere = {-1.0 / sphere.radius_mm, sphere.conic, {}};
                        },
                        [&](const BiconicEntrance& biconic) {
                          sag.biconic = {{-1.0 / biconic.radii_mm[0], -1.0 / biconic.radii_mm[1]}, biconic.conics};
                        },
                        [&](const FormulaEntrance& formula) { sag.formula = *formula.height_mm; },
                        [&](const StepFace& face) { sag.patches = patches_of(face); }},
             shape);
  return sag;
}

Eigen::Matrix3d rotation_of(const EntranceInclination& inclination) {
  const Vec2 along = direction_at(Angle::from_deg(inclination.azimuth_deg));
  return rotation_about({along.y(), -along.x(), 0.0}, Angle::from_deg(inclination.pin_angle_deg));
}

Vec3 reference_axis_of(const EntranceInclination& inclination) {
  return direction_at(Angle::from_deg(inclination.incidence_deg - inclination.pin_angle_deg),
                      Angle::from_deg(inclination.azimuth_deg));
}

}  // namespace retrace::geometry

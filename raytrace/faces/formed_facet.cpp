#include "raytrace/faces/formed_facet.h"

#include <cmath>

#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {

FacetFrame::FacetFrame(const Vec3& normal, double offset_mm, const Vec2& centroid_mm)
    : origin_mm(centroid_mm.x(), centroid_mm.y(), (offset_mm - normal.head<2>().dot(centroid_mm)) / normal.z()),
      horizontal(normal.cross(Vec3::UnitZ()).normalized()),
      down(normal.cross(horizontal)) {}

Vec3 formed_normal(const Optics& optics, const Vec3& normal, const FacetFrame& frame, const Vec3& point,
                   const Vec3& direction, bool inside) {
  const Vec2 slope = optics.facet_form.slope(frame.local(point));
  const Vec3 formed = (normal - slope.x() * frame.horizontal - slope.y() * frame.down).normalized();
  const Vec3 against = inside ? Vec3(-formed) : formed;
  const Vec3 plane_against = inside ? Vec3(-normal) : normal;
  const double cos_incidence = -against.dot(direction);
  if (!(cos_incidence > 0.0) || !(mirrored(direction, against).dot(plane_against) > 0.0)) return normal;
  const double ratio = optics.ratio_at_back(inside);
  const double cos2 = 1.0 - ratio * ratio * (1.0 - cos_incidence * cos_incidence);
  if (cos2 > 0.0 && !(refracted(direction, against, ratio, cos_incidence, std::sqrt(cos2)).dot(plane_against) < 0.0))
    return normal;
  return formed;
}

}  // namespace retrace::raytrace

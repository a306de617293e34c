#include "raytrace/exact/lit_face.h"

#include <cmath>

namespace retrace::raytrace {

double horizontal_area(const Corners& corners) {
  FlatPolygon plan;
  for (const Vec3& p : corners) plan.push_back(p.head<2>());
  return std::abs(area(plan));
}

LitFace::LitFace(const BeamScene& scene) {
  const LightSetup& setup = scene.setup;
  Corners face;
  for (const Vec2& p : scene.part.outline)
    face.push_back({p.x() - scene.centre_mm.x(), p.y() - scene.centre_mm.y(), setup.thickness_mm});
  const double face_mm2 = horizontal_area(face);
  reached = setup.stops.has_chamfer() ? cut_to_outline(std::move(face), setup.stops.clear_face()) : std::move(face);
  if (setup.stops.has_mount()) reached = cut_to_outline(reached, setup.stops.face_through_mount(setup.to_source));
  reflected = reached;
  if (setup.stops.has_mount())
    reflected = cut_to_outline(reflected, setup.stops.face_through_mount(setup.entry.reflected_direction));
  reached_fraction = horizontal_area(reached) / face_mm2;
  reflected_fraction = horizontal_area(reflected) / face_mm2;
}

}  // namespace retrace::raytrace

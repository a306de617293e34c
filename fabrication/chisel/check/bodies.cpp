#include "fabrication/chisel/check/bodies.h"

#include <ccd/ccd.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace retrace::fabrication {
namespace {

using geometry::Vec3;

using Points = std::span<const Vec3>;

/// Computes the support point of a body: its farthest point in a direction.
void support(const void* body, const ccd_vec3_t* direction, ccd_vec3_t* result) {
  const Points& points = *static_cast<const Points*>(body);
  const Vec3 along(direction->v[0], direction->v[1], direction->v[2]);
  const auto further = [&](const Vec3& a, const Vec3& b) { return a.dot(along) < b.dot(along); };
  const Vec3& furthest = *std::max_element(points.begin(), points.end(), further);
  ccdVec3Set(result, furthest.x(), furthest.y(), furthest.z());
}

void centre(const void* body, ccd_vec3_t* result) {
  const Points& points = *static_cast<const Points*>(body);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  sum /= static_cast<double>(points.size());
  ccdVec3Set(result, sum.x(), sum.y(), sum.z());
}

Eigen::AlignedBox3d box_of(Points points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

}  // namespace

bool hulls_meet(Points a, Points b) {
  if (!box_of(a).intersects(box_of(b))) return false;
  ccd_t settings;
  CCD_INIT(&settings);
  settings.support1 = support;
  settings.support2 = support;
  settings.center1 = centre;
  settings.center2 = centre;
  settings.max_iterations = 1000;
  return ccdMPRIntersect(&a, &b, &settings) != 0;
}

std::vector<PlacedBody> tool_bodies(const Machine& machine, const ToolWedge& wedge, double diamond_mm) {
  PlacedBody diamond{"diamond", {}};
  for (const double side : {-1.0, 1.0}) {
    const Vec3 end = side * wedge.half_width_mm * wedge.edge;
    diamond.points_mm.push_back(end);
    for (const Vec3& face : wedge.rays) diamond.points_mm.emplace_back(end + face * (diamond_mm / face.z()));
  }
  std::vector<PlacedBody> bodies = {std::move(diamond)};
  for (const MachineBody& body : machine.bodies) {
    if (body.link != KinematicLink::tool) continue;
    PlacedBody placed{body.name, body.points_mm.value};
    for (Vec3& p : placed.points_mm) p -= wedge.tip_mm;
    bodies.push_back(std::move(placed));
  }
  return bodies;
}

std::vector<PlacedBody> stationary_bodies(const Machine& machine, const RotaryPose& pose) {
  std::vector<PlacedBody> bodies;
  for (const MachineBody& body : machine.bodies) {
    if (body.link == KinematicLink::tool) continue;
    const bool turns_about_c = body.link == KinematicLink::workpiece;
    const RigidMotion motion = machine_from_workpiece(machine, {pose.a_deg, turns_about_c ? pose.c_deg : 0.0});
    PlacedBody placed{body.name, body.points_mm.value};
    for (Vec3& p : placed.points_mm) p = motion.point(p);
    bodies.push_back(std::move(placed));
  }
  return bodies;
}

std::vector<BodyContact> contacts(std::span<const PlacedBody> tool, std::span<const PlacedBody> stationary,
                                  Points tips_mm) {
  std::vector<BodyContact> found;
  std::vector<Vec3> swept;
  for (const PlacedBody& moving : tool) {
    swept.clear();
    for (const Vec3& p : moving.points_mm)
      for (const Vec3& tip : tips_mm) swept.push_back(tip + p);
    for (const PlacedBody& other : stationary)
      if (hulls_meet(swept, other.points_mm)) found.push_back({moving.name, other.name});
  }
  return found;
}

}  // namespace retrace::fabrication

#include "raytrace/exact/beam_reach.h"

#include <algorithm>
#include <utility>

#include "core/infinity.h"

namespace retrace::raytrace {
namespace {

// Maximum length, in element sizes, of one step of a nearly horizontal beam.
constexpr double kReachInElements = 4.0;
// Maximum step length, in element sizes, of a beam that represents several copies. It is shorter than kReachInElements,
// so that fewer copies reach a border within the step.
constexpr double kReachOfShared = 2.0;
// Limit, in element sizes, for the distance that a descending beam travels until all its corners are in the layer of
// elements. Up to this limit, the length of a step is measured from the point where the highest corner enters the
// layer. Beyond this limit, it is measured from the point where the lowest corner enters. A horizontal beam above the
// layer never enters it and meets no facet.
constexpr double kFarInElements = 64.0;

/// Returns the minimum and maximum distance from a beam's corners to the sides and, if it rises, to the entrance face.
std::pair<double, double> distances_to_hull(const LightSetup& setup, const Beam& beam) {
  double least = kInfinity;
  double greatest = 0.0;
  for (const Vec3& p : beam.corners) {
    double t = beam.direction.z() > 0.0 ? (setup.thickness_mm - p.z()) / beam.direction.z() : kInfinity;
    for (const auto& side : setup.sides) {
      const double towards = side.normal.dot(beam.direction);
      if (towards > kMinIncidenceCosine) t = std::min(t, (side.offset_mm - side.normal.dot(p)) / towards);
    }
    least = std::min(least, t);
    greatest = std::max(greatest, t);
  }
  return {least, greatest};
}

}  // namespace

Horizon horizon_of(const BeamScene& scene, const Beam& beam) {
  const LightSetup& setup = scene.setup;
  const double size_mm = scene.part.size_mm;
  double low = kInfinity;
  double high = -kInfinity;
  for (const Vec3& p : beam.corners) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  const double dz = beam.direction.z();
  const double slack = 1e-6 * size_mm;
  if (dz > -kMinIncidenceCosine && low >= setup.top_mm - scene.merge_mm) return {};
  // Distance at which all corners of the beam are in the layer. If it exceeds kFarInElements, it is replaced by the
  // distance at which the lowest corner enters the layer.
  double first = 0.0;
  double last = kInfinity;
  if (dz > 0.0) last = (setup.top_mm - low) / dz;
  if (dz < 0.0) {
    first = std::max(0.0, (high - setup.top_mm) / -dz);
    if (first > kFarInElements * size_mm) first = std::max(0.0, (low - setup.top_mm) / -dz);
    last = (high + setup.depth_mm + slack) / -dz;
  }
  const bool is_shared = beam.instance_offsets && !setup.infinite();
  const double reach = first + (is_shared ? kReachOfShared : kReachInElements) * size_mm;
  if (last <= reach) return {last, false};
  if (setup.infinite()) return {reach, true};
  // A beam may leave a finite part through its outer faces. If this happens within `reach`, the horizon must include
  // the exit of the last corner, because the candidates contain only facets and not the outer faces.
  const auto [first_exit, last_exit] = distances_to_hull(setup, beam);
  return reach < first_exit ? Horizon{reach, true} : Horizon{std::min(last, last_exit), false};
}

Plane plane_at(const Horizon& horizon, const Beam& beam) {
  double nearest = kInfinity;
  for (const Vec3& p : beam.corners) nearest = std::min(nearest, beam.direction.dot(p));
  return {beam.direction, nearest + horizon.t};
}

PlanBox sweep_in_layer(const BeamScene& scene, const Beam& beam, const Horizon& horizon) {
  // Due to rounding, a corner of a beam that starts at the top of the layer may be slightly above it. For a nearly
  // horizontal beam, the computed entry into the layer would then be many elements further on, and facets before it
  // would be missed. The top is therefore raised by the tolerance `merge_mm`.
  const double top_mm = scene.setup.top_mm + scene.merge_mm;
  PlanBox plan;
  for (const Vec3& p : beam.corners) {
    const double above = p.z() - top_mm;
    const bool falls_in = above > 0.0 && beam.direction.z() < 0.0;
    const double from = falls_in ? std::min(horizon.t, above / -beam.direction.z()) : 0.0;
    plan.include((p + from * beam.direction).head<2>());
    plan.include((p + horizon.t * beam.direction).head<2>());
  }
  // If the beam's polygon intersects the top of the layer, its points on the plane of the top are included as well.
  for (const Vec3& p : cut(beam.corners, {-Vec3::UnitZ(), -top_mm})) plan.include(p.head<2>());
  return plan;
}

PlanBox sweep_of(const BeamScene& scene, const Beam& beam) {
  const Horizon horizon = horizon_of(scene, beam);
  const double dz = beam.direction.z();
  PlanBox box;
  if (beam.inside && horizon.t == 0.0 && dz <= kMinIncidenceCosine) return {-box.lower, -box.upper};
  for (const Vec3& p : beam.corners) {
    box.include(p.head<2>());
    box.include((p + horizon.t * beam.direction).head<2>());
    if (beam.inside && !horizon.limited && dz > 0.0)
      box.include((p + (scene.setup.thickness_mm - p.z()) / dz * beam.direction).head<2>());
  }
  return box;
}

}  // namespace retrace::raytrace

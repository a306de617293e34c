#include "raytrace/exact/scattered_rays.h"

#include <algorithm>
#include <cmath>

#include "raytrace/paths/textured_facet.h"

namespace retrace::raytrace {
namespace {

// Rays begin off their facet by this share of an element, as no facet is told to leave them alone.
constexpr double kClearance = 1e-9;
// Numbers of the rays of one round; those of the next follow.
constexpr std::uint32_t kRaysOfRound = 1U << 26;

}  // namespace

Vec3 point_of(const Corners& corners, const Vec2& u) {
  const auto twice_area = [&](std::size_t k) {
    return (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).norm();
  };
  double whole = 0.0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) whole += twice_area(k);
  double left = u.x() * whole;
  std::size_t triangle = 1;
  while (triangle + 2 < corners.size() && left >= twice_area(triangle)) left -= twice_area(triangle++);
  const double across = std::sqrt(std::clamp(left / twice_area(triangle), 0.0, 1.0));
  return corners[0] +
         across * ((1.0 - u.y()) * (corners[triangle] - corners[0]) + u.y() * (corners[triangle + 1] - corners[0]));
}

ScatteredLightByRays::ScatteredLightByRays(const BeamTracer& tracer, const BackSurface& surface, const Optics& optics,
                                           const Illumination& illumination, const std::vector<double>& cones_deg)
    : setup_(tracer.part(), surface, tracer.centre_mm(), optics, illumination, cones_deg, PathPolicy{}) {}

std::unique_ptr<ScatteredReplicate> ScatteredLightByRays::replicate(RandomKey key, std::uint32_t number,
                                                                    std::uint32_t round,
                                                                    const Cancellation* cancel) const {
  return std::make_unique<ScatteredRays>(setup_, key, number, round, cancel);
}

ScatteredRays::ScatteredRays(const PathSetup& setup, RandomKey key, std::uint32_t replicate, std::uint32_t round,
                             const Cancellation* cancel)
    : setup_(setup),
      key_(key),
      replicate_(replicate),
      number_(round * kRaysOfRound),
      cancel_(cancel),
      tally_(setup.cone_chord2.size()),
      walker_(setup, tally_) {}

void ScatteredRays::launch(const std::vector<ScatterSite>& sites, double most_power) {
  double power = 0.0;
  for (const ScatterSite& site : sites) power += site.scattered;
  if (power <= 0.0) return;
  const double count = std::ceil(power / most_power);
  const double each = power / count;
  const double offset = unit_interval(philox(key_, replicate_, number_++)[0]);
  double passed = 0.0;
  double taken = 0.0;
  for (const ScatterSite& site : sites) {
    passed += site.scattered / each;
    const double until = &site == &sites.back() ? count : std::floor(passed + offset);
    for (; taken < until; ++taken) {
      if (is_cancelled(cancel_)) return;
      launch_one(site, each);
    }
  }
}

void ScatteredRays::launch_one(const ScatterSite& site, double power) {
  const Optics& optics = setup_.optics;
  const std::uint32_t number = number_++;
  std::uint32_t choices = 0;
  surface_models::RandomStream random(key_, replicate_, number, choices++);
  const double x = random.next();
  Vec3 position = point_of(site.corners, {x, random.next()});
  Ray ray{site.direction, site.light, site.inside, false};
  ray.light.scale(power / site.scattered * site.share *
                  std::exp(-optics.absorption_per_mm * site.path_length.at(position)));
  const TexturedReturn back = meet_textured_facet(optics, site.normal, ray, 0.0, random);
  double scattered = 0.0;
  for (std::size_t k = 0; k < back.count; ++k)
    if (back.rays[k].scattered) scattered += back.rays[k].light.power();
  // The power of a beam is that of its mean: what a place has more or less is what the material took before.
  tally_.other[Account::truncated] += back.truncated;
  tally_.other[Account::absorbed] += power - scattered - back.truncated;
  if (scattered <= 0.0) return;
  double left = random.next() * scattered;
  const Ray* chosen = nullptr;
  for (std::size_t k = 0; k < back.count && left >= 0.0; ++k) {
    if (!back.rays[k].scattered) continue;
    chosen = &back.rays[k];
    left -= chosen->light.power();
  }
  ray = *chosen;
  ray.light.scale(scattered / ray.light.power());
  position += (ray.inside ? -kClearance : kClearance) * setup_.depth_mm * site.normal;
  if (setup_.infinite())
    for (const Eigen::Index axis : {0, 1})
      position[axis] -= setup_.period_mm[axis] * std::floor(position[axis] / setup_.period_mm[axis] + 0.5);
  walker_.resume(position, ray, key_, replicate_, number, choices);
}

}  // namespace retrace::raytrace

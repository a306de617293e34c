#include "raytrace/exact/scattered_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "raytrace/faces/textured_facet.h"

namespace retrace::raytrace {
namespace {

// Distance of a ray's start from its facet, as a fraction of the element depth. It prevents the ray from meeting the
// facet from which the ray starts.
constexpr double kClearance = 1e-9;
// Maximum number of rays per round. The number of the first ray of a round is a multiple of this number, so that
// different rounds use different random numbers.
constexpr std::uint32_t kRaysOfRound = 1U << 26;
// Maximum fraction of an ordinary ray's power that may fall into the widest cone if additional rays to the source are
// used. An ordinary ray starts in a random direction of the scattering lobe. Above this fraction, ordinary rays sample
// the cone well enough.
constexpr double kNarrow = 0.1;
// Power of a ray to the source, as a fraction of an ordinary ray's power, below which Russian roulette is applied.
constexpr double kMinPowerFraction = 0.05;

/// Returns the solid angle of the widest cone in air, in sr.
double solid_angle(const PathSetup& setup) {
  return std::numbers::pi * setup.cone_chord2.back();
}

/// Returns the ratio of a small solid angle inside the part to the solid angle into which it is refracted in air.
/// \param out direction in air of light that leaves the part
double narrowing(const PathSetup& setup, const Vec3& out) {
  const double n = setup.optics.index;
  return out.z() / (n * n * std::sqrt(1.0 - out.head<2>().squaredNorm() / (n * n)));
}

}  // namespace

/// A path from a point of a facet through the part into the widest cone about the direction to the source. On this
/// path, the light is only reflected until it leaves through the entrance face.
class PathToSource {
 public:
  /// \param turn matrix of all reflections on the path, from PathWalker::mirrors_to_entrance()
  PathToSource(const PathSetup& setup, Eigen::Matrix3d turn) : setup_(setup), turn_(std::move(turn)) {}

  /// Returns the direction at the start of the path for light that leaves the part in the direction `out`.
  Vec3 direction_to(const Vec3& out) const {
    const Vec2 across = out.head<2>() / setup_.optics.index;
    return turn_.transpose() * Vec3(across.x(), across.y(), std::sqrt(1.0 - across.squaredNorm()));
  }

  /// Returns true if light that starts in this direction leaves the part within the cone.
  bool leads_back(const Vec3& direction) const {
    const Vec3 inside = turn_ * direction;
    const Vec2 across = setup_.optics.index * inside.head<2>();
    const double rest = 1.0 - across.squaredNorm();
    return inside.z() > 0.0 && rest > 0.0 &&
           setup_.cone_of({across.x(), across.y(), std::sqrt(rest)}) < setup_.cone_chord2.size();
  }

  /// Returns a random direction in air, uniformly distributed in the cone.
  Vec3 draw(surface_models::RandomStream& random) const {
    const double less = 0.5 * setup_.cone_chord2.back() * random.next();  // 1 - cos
    const double sine = std::sqrt(less * (2.0 - less)), turn = 2.0 * std::numbers::pi * random.next();
    const Vec3 along = setup_.to_source.unitOrthogonal();
    return (1.0 - less) * setup_.to_source +
           sine * (std::cos(turn) * along + std::sin(turn) * setup_.to_source.cross(along));
  }

 private:
  const PathSetup& setup_;
  Eigen::Matrix3d turn_;
};

namespace {

/// Returns the path from a scattering site to the source. Returns nothing if there is none, or if ordinary rays sample
/// the cone well enough.
/// \param met light that meets the facet
/// \param power power of an ordinary ray from this site
std::optional<PathToSource> way_to_source(const PathSetup& setup, const PathWalker& walker, const Vec3& position,
                                          const Vec3& normal, const Ray& met, double power) {
  if (!met.inside || surface_models::first_order_model(setup.optics.facet_scatter) == nullptr) return std::nullopt;
  // The power in the cone is tested first, because the search for reflections takes longer. It is estimated for the
  // specular direction, in which the scattering lobe has its maximum.
  const Vec3 specular = mirrored(met.direction, normal);
  const double density = diffracted_once_into(setup.optics, normal, met, specular).light.power();
  const double in_cone = density * narrowing(setup, setup.to_source) * solid_angle(setup);
  if (in_cone <= 0.0 || in_cone >= kNarrow * power) return std::nullopt;
  const auto turn = walker.mirrors_to_entrance(position, specular);
  return turn ? std::optional<PathToSource>(std::in_place, setup, *turn) : std::nullopt;
}

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
      walker_(setup, tally_),
      single_ray_tally_(setup.cone_chord2.size()),
      single_ray_walker_(setup, single_ray_tally_) {}

void ScatteredRays::launch(const std::vector<ScatterSite>& sites, double max_power) {
  double power = 0.0;
  for (const ScatterSite& site : sites) power += site.scattered;
  if (power <= 0.0) return;
  const double count = std::ceil(power / max_power);
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
  const Vec3 home = point_of(site.corners, {x, random.next()});
  Ray met{site.direction, site.light, site.inside, false};
  met.light.scale(power / site.scattered * site.area_fraction *
                  std::exp(-optics.absorption_per_mm * site.path_length.at(home)));
  const TexturedReturn back = meet_textured_facet(optics, site.normal, met, 0.0, random);
  double scattered = 0.0;
  for (std::size_t k = 0; k < back.count; ++k)
    if (back.rays[k].scattered) scattered += back.rays[k].light.power();
  // The sites are weighted with the mean transmittance of the beam. The absorption on the path to this point differs
  // from the mean, and the difference is added to `absorbed`.
  tally_.other[Account::truncated] += back.truncated;
  tally_.other[Account::absorbed] += power - scattered - back.truncated;
  if (scattered <= 0.0) return;
  double left = random.next() * scattered;
  std::size_t chosen = 0;
  for (std::size_t k = 0; k < back.count && left >= 0.0; ++k) {
    if (!back.rays[k].scattered) continue;
    chosen = k;
    left -= back.rays[k].light.power();
  }
  Ray ray = back.rays[chosen];
  ray.light.scale(scattered / ray.light.power());
  Vec3 position = home;
  if (site.instance_offsets) {
    const auto place = static_cast<std::size_t>(random.next() * static_cast<double>(site.instance_offsets->size()));
    position.head<2>() += (*site.instance_offsets)[place];
  }
  const auto off_facet = [&](bool inside) {
    Vec3 at = position + (inside ? -kClearance : kClearance) * setup_.depth_mm * site.normal;
    if (setup_.infinite())
      for (const Eigen::Index axis : {0, 1})
        at[axis] -= setup_.period_mm[axis] * std::floor(at[axis] / setup_.period_mm[axis] + 0.5);
    return at;
  };
  const Vec3 start = off_facet(ray.inside);
  const Vec3 inside = ray.inside ? start : off_facet(true);
  const auto way = way_to_source(setup_, walker_, inside, site.normal, met, power);
  if (way) score(*way, inside, site.normal, met, power, number, choices);
  if (way && back.diffracted_once == chosen && ray.inside && way->leads_back(ray.direction))
    follow_scored(start, ray, number, choices);
  else
    walker_.resume(start, ray, key_, replicate_, number, choices);
}

/// Traces an ordinary ray from a site for which score() has traced a ray to the source. The ray to the source already
/// represents the light that is diffracted one time and reaches the cones. If the ordinary ray ends in a cone, its
/// power is therefore added to the light outside of the cones.
void ScatteredRays::follow_scored(const Vec3& position, const Ray& ray, std::uint32_t number, std::uint32_t& choices) {
  single_ray_tally_.clear();
  single_ray_walker_.resume(position, ray, key_, replicate_, number, choices);
  for (std::size_t cone = 0; cone < setup_.cone_chord2.size(); ++cone)
    single_ray_tally_.scattered.back() += std::exchange(single_ray_tally_.scattered[cone], Stokes{});
  tally_.add(single_ray_tally_);
}

/// Traces a ray that represents all light of this site that is diffracted one time towards the widest cone. The same
/// light is added to the light outside of the cones by follow_scored(). The power of this ray that reaches a cone is
/// therefore subtracted from the light outside of the cones.
void ScatteredRays::score(const PathToSource& path, const Vec3& position, const Vec3& normal, const Ray& met,
                          double power, std::uint32_t number, std::uint32_t& choices) {
  surface_models::RandomStream random(key_, replicate_, number, choices++);
  const Vec3 out = path.draw(random);
  if (out.z() <= 0.0) return;
  Ray ray = diffracted_once_into(setup_.optics, normal, met, path.direction_to(out));
  if (!ray.inside) return;
  ray.light.scale(narrowing(setup_, out) * solid_angle(setup_));
  const double chance = ray.light.power() / (kMinPowerFraction * power);
  if (chance <= 0.0 || random.next() >= chance) return;
  if (chance < 1.0) ray.light.scale(1.0 / chance);
  single_ray_tally_.clear();
  single_ray_walker_.resume(position, ray, key_, replicate_, number, choices);
  for (std::size_t cone = 0; cone < setup_.cone_chord2.size(); ++cone) {
    tally_.scattered[cone] += single_ray_tally_.scattered[cone];
    tally_.scattered.back() += -1.0 * single_ray_tally_.scattered[cone];
  }
  tally_.segments += single_ray_tally_.segments;
}

}  // namespace retrace::raytrace

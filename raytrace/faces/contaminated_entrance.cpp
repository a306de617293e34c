#include "raytrace/faces/contaminated_entrance.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "surface_models/scatter/slope_distribution.h"

namespace retrace::raytrace {
namespace {

using std::numbers::pi;
using surface_models::RandomStream;

// Maximum number of reflections within a drop, or between dust and face, that are traced.
constexpr int kMaxReflections = 256;
constexpr double kNeverBoth = std::numeric_limits<double>::infinity();

/// Changes the direction of a ray and rotates its polarization with it.
void turn(Ray& ray, const Vec3& direction) {
  ray.light.s_axis = Eigen::Quaterniond::FromTwoVectors(ray.direction, direction) * ray.light.s_axis;
  ray.direction = direction;
  ray.scattered = true;
}

/// Changes the direction of a ray by adding `by` to its direction cosines along the face. The ray is unchanged if the
/// sum is outside of the unit disc. This rule makes the scattering reciprocal: the densities for a pair of directions
/// and for the reversed pair are equal.
void shift(Ray& ray, const Vec2& by) {
  const Vec2 along = ray.direction.head<2>() + by;
  const double left = 1.0 - along.squaredNorm();
  if (left <= 0.0) return;
  turn(ray, Vec3(along.x(), along.y(), std::copysign(std::sqrt(left), ray.direction.z())));
}

Vec2 uniform_in_disc(RandomStream& random) {
  const double radius = std::sqrt(random.next());
  const double angle = 2.0 * pi * random.next();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Scatters a ray according to Lambert's law. The direction cosines along the face are uniformly distributed over the
/// unit disc. The scattered light is unpolarized.
void scatter_evenly(Ray& ray, bool up, RandomStream& random) {
  const Vec2 along = uniform_in_disc(random);
  const double z = std::sqrt(std::max(1e-300, 1.0 - along.squaredNorm()));
  ray.direction = Vec3(along.x(), along.y(), up ? z : -z).normalized();
  ray.light = {{ray.light.power(), 0.0, 0.0, 0.0}, ray.direction.unitOrthogonal()};
  ray.scattered = true;
}

/// A spherical cap over the unit disc.
struct Cap {
  double radius = 1.0;    ///< radius of the sphere
  double centre_z = 0.0;  ///< z of the centre of the sphere, <= 0

  explicit Cap(double contact_angle_rad)
      : radius(1.0 / std::sin(contact_angle_rad)), centre_z(-radius * std::cos(contact_angle_rad)) {}

  Vec3 normal_at(const Vec3& p) const { return Vec3(p.x(), p.y(), p.z() - centre_z).normalized(); }
  /// Returns the distance from a point inside the sphere to the sphere along a direction.
  double way_out(const Vec3& from, const Vec3& direction) const {
    const Vec3 at(from.x(), from.y(), from.z() - centre_z);
    const double b = at.dot(direction);
    const double c = std::min(0.0, at.squaredNorm() - radius * radius);
    return -b + std::sqrt(b * b - c);
  }
};

}  // namespace

struct ContaminatedEntrance::Event {
  double split_power = 0.0;
  RandomStream& random;
  EntranceScatter& result;
};

struct ContaminatedEntrance::Branches {
  Ray reflected, transmitted;
};

Optics entrance_as_facet(const Optics& optics) {
  Optics facet = optics;
  facet.mirror_facets = false;
  facet.back_index = 1.0;
  facet.facet_layers = optics.entrance_layers;
  facet.facet_scatter = optics.entrance.roughness;
  return facet;
}

ContaminatedEntrance::ContaminatedEntrance(const Optics& optics)
    : optics_(optics), as_facet_(entrance_as_facet(optics)) {}

void ContaminatedEntrance::meet(const Ray& ray, double split_power, RandomStream& random,
                                EntranceScatter& result) const {
  const EntranceCondition& face = optics_.entrance;
  Event event{split_power, random, result};
  const double spots = face.covered_fraction();
  if (!(spots > 0.0)) return meet_clean(ray, event);
  Ray beside = ray;
  Ray onto = ray;
  beside.light.scale(1.0 - spots);
  onto.light.scale(spots);
  const Branch branch = choose_branch(beside.light, onto.light, split_power, [&] { return random.next(); });
  if (branch != Branch::transmitted) meet_clean(beside, event);
  if (branch == Branch::reflected) return;
  const double which = random.next() * spots;
  if (which < face.dust.coverage) return meet_dust(onto, event);
  if (which < face.dust.coverage + face.scratches.coverage) return meet_scratch(onto, event);
  meet_drop(onto, event);
}

void ContaminatedEntrance::meet_clean(const Ray& ray, Event& event) const {
  if (ray.inside) return meet_face(ray, event);
  pass_haze(ray, event, [&](const Ray& passed) { meet_face(passed, event); });
}

/// Processes a ray at the face itself, between the haze and the body. Both branches are traced if each has enough
/// power, as at a facet.
void ContaminatedEntrance::meet_face(const Ray& ray, Event& event) const {
  if (optics_.entrance.is_rough()) {
    const TexturedReturn back = meet_textured_facet(as_facet_, Vec3::UnitZ(), ray, event.split_power, event.random);
    event.result.absorbed += back.absorbed;
    event.result.truncated += back.truncated;
    for (std::size_t k = 0; k < back.count; ++k) send(back.rays[k], event);
    return;
  }
  Branches face = at_face(ray, event);
  const Branch branch = choose_branch(face.reflected.light, face.transmitted.light, event.split_power,
                                      [&] { return event.random.next(); });
  if (branch != Branch::transmitted) send(face.reflected, event);
  if (branch != Branch::reflected) send(face.transmitted, event);
}

void ContaminatedEntrance::send(const Ray& ray, Event& event) const {
  if (ray.inside) return event.result.rays.push_back(ray);
  pass_haze(ray, event, [&](const Ray& passed) { event.result.rays.push_back(passed); });
}

/// Traces a ray through the haze in front of the face, from or towards the face.
/// \param on is called for each ray that leaves the haze
template <class On>
void ContaminatedEntrance::pass_haze(const Ray& ray, Event& event, const On& on) const {
  const Haze& haze = optics_.entrance.haze;
  if (!(haze.fraction > 0.0)) return on(ray);
  Ray kept = ray;
  Ray thrown = ray;
  kept.light.scale(1.0 - haze.fraction);
  thrown.light.scale(haze.fraction);
  const Branch branch = choose_branch(kept.light, thrown.light, event.split_power, [&] { return event.random.next(); });
  if (branch != Branch::transmitted) on(kept);
  if (branch == Branch::reflected) return;
  shift(thrown, haze.spread * std::sqrt(0.5) * surface_models::normal_pair(event.random));
  on(thrown);
}

/// Returns the branches of the clean face by Fresnel's formulas.
/// \param ray ray that travels upwards inside the part, or downwards outside of it
ContaminatedEntrance::Branches ContaminatedEntrance::at_face(const Ray& ray, Event& event) const {
  const Vec3 against = ray.inside ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitZ());
  const double cos_incidence = -against.dot(ray.direction);
  const materials::FresnelCoefficients f = fresnel_at_entrance(optics_, ray.inside, cos_incidence);
  const double ratio = ray.inside ? optics_.index : 1.0 / optics_.index;
  Light light = ray.light;
  light.rotate_basis_to_interface(ray.direction, against);
  Branches face{ray, ray};
  face.reflected.light = light.reflected(f);
  face.reflected.direction = mirrored(ray.direction, against);
  face.transmitted.light = light.transmitted(f);
  face.transmitted.inside = !ray.inside;
  if (!f.total_reflection)
    face.transmitted.direction = refracted(ray.direction, against, ratio, cos_incidence, f.cos_refracted);
  event.result.absorbed += absorbed_at_entrance(optics_, light, face.reflected.light, face.transmitted.light);
  return face;
}

Ray ContaminatedEntrance::one_of(Branches branches, Event& event) const {
  const Branch branch = choose_branch(branches.reflected.light, branches.transmitted.light, kNeverBoth,
                                      [&] { return event.random.next(); });
  return branch == Branch::reflected ? branches.reflected : branches.transmitted;
}

/// Processes a ray at a position under dust. All light that leaves the face passes the dust. Light that the dust sends
/// back meets the face again.
void ContaminatedEntrance::meet_dust(Ray ray, Event& event) const {
  const Dust& dust = optics_.entrance.dust;
  if (ray.inside) ray = one_of(at_face(ray, event), event);
  for (int k = 0; k < kMaxReflections; ++k) {
    if (ray.inside) return event.result.rays.push_back(ray);
    const double met = ray.light.power();
    ray.light.scale(dust.albedo);
    event.result.absorbed += met - ray.light.power();
    if (!(ray.light.power() > 0.0)) return;
    const bool goes_on = event.random.next() < dust.forward_fraction;
    scatter_evenly(ray, (ray.direction.z() > 0.0) == goes_on, event.random);
    if (ray.direction.z() > 0.0) return event.result.rays.push_back(ray);
    ray = one_of(at_face(ray, event), event);
  }
  event.result.truncated += ray.light.power();
}

/// Processes a ray at a position under a scratch. The scratch changes the direction of the ray in the air, before the
/// ray meets the face and after it leaves the face.
void ContaminatedEntrance::meet_scratch(Ray ray, Event& event) const {
  const FineScratches& scratches = optics_.entrance.scratches;
  const double along = scratches.azimuth_rad ? *scratches.azimuth_rad : pi * event.random.next();
  const Vec2 across(-std::sin(along), std::cos(along));
  const auto pass = [&](Ray& passing) {
    shift(passing, scratches.spread * std::sqrt(0.5) * surface_models::normal_pair(event.random).x() * across);
  };
  if (!ray.inside) pass(ray);
  ray = one_of(at_face(ray, event), event);
  if (!ray.inside) pass(ray);
  event.result.rays.push_back(ray);
}

/// Processes light that leaves a drop into the air. It leaves the part, or meets the face next to the drop.
void ContaminatedEntrance::leave_drop(Ray ray, Event& event) const {
  ray.inside = false;
  ray.scattered = true;
  if (ray.direction.z() >= 0.0) return event.result.rays.push_back(ray);
  meet_clean(ray, event);
}

/// Processes a ray at a random point of the base of a drop. Lengths are in units of the radius of the base.
void ContaminatedEntrance::meet_drop(Ray ray, Event& event) const {
  const Drops& drops = optics_.entrance.drops;
  const double water = optics_.entrance.water_index;
  const Cap cap(drops.contact_angle_rad);
  const Vec2 base = uniform_in_disc(event.random);
  Vec3 at(base.x(), base.y(), 0.0);
  // Continues the ray with a random branch at a plane with these coefficients. Returns true for the transmitted branch.
  const auto passes = [&](const materials::FresnelCoefficients& f, const Vec3& against, double ratio) {
    const double cos_incidence = -against.dot(ray.direction);
    ray.light.rotate_basis_to_interface(ray.direction, against);
    Light reflected = ray.light.reflected(f);
    Light transmitted = ray.light.transmitted(f);
    event.result.absorbed += absorbed_at_entrance(optics_, ray.light, reflected, transmitted);
    const Branch branch = choose_branch(reflected, transmitted, kNeverBoth, [&] { return event.random.next(); });
    const bool is_through = branch == Branch::transmitted;
    ray.light = is_through ? transmitted : reflected;
    ray.direction = is_through ? refracted(ray.direction, against, ratio, cos_incidence, f.cos_refracted)
                               : mirrored(ray.direction, against);
    return is_through;
  };
  const auto passes_base = [&](bool from_body) {
    const Vec3 against = from_body ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitZ());
    return passes(fresnel_under_drop(optics_, from_body, -against.dot(ray.direction)), against,
                  from_body ? optics_.index / water : water / optics_.index);
  };
  if (ray.inside) {
    if (!passes_base(true)) return event.result.rays.push_back(ray);
  } else {
    at -= cap.way_out(at, -ray.direction) * ray.direction;
    const Vec3 normal = cap.normal_at(at);
    const double cos_incidence = -normal.dot(ray.direction);
    if (!passes(materials::fresnel(1.0 / water, cos_incidence), normal, 1.0 / water)) return leave_drop(ray, event);
  }
  for (int k = 0; k < kMaxReflections; ++k) {
    const double to_cap = cap.way_out(at, ray.direction);
    const double to_base = ray.direction.z() < 0.0 ? at.z() / -ray.direction.z() : kNeverBoth;
    at += std::min(to_cap, to_base) * ray.direction;
    if (to_base <= to_cap) {
      at.z() = 0.0;
      if (!passes_base(false)) continue;
      ray.inside = true;
      ray.scattered = true;
      return event.result.rays.push_back(ray);
    }
    const Vec3 against = -cap.normal_at(at);
    const double cos_incidence = -against.dot(ray.direction);
    if (passes(materials::fresnel(water, cos_incidence), against, water)) return leave_drop(ray, event);
  }
  event.result.truncated += ray.light.power();
}

void add_entrance_reflection(const LightSetup& setup, const Ray& ray, Tally& tally) {
  std::vector<Stokes>& account = ray.scattered ? tally.scattered : tally.entrance_reflected;
  Light light = ray.light;
  tally.add(setup.pass_shells_outward(light, ray.direction), Account::returned_elsewhere);
  account[setup.cone_of(ray.direction)] += in_source_axes(light, ray.direction);
  if (setup.score != nullptr) setup.score->add(ray.direction, light.power(), tally.score);
}

}  // namespace retrace::raytrace

#include "raytrace/balls/ball_walker.h"

#include <algorithm>
#include <cmath>

#include "materials/fresnel.h"

namespace retrace::raytrace {
namespace {

/// Returns the unit normal that faces the ray.
Vec3 against(const Vec3& direction, const Vec3& normal) {
  return normal.dot(direction) > 0.0 ? Vec3(-normal) : normal;
}

}  // namespace

void BallWalker::trace(const Vec3& origin_mm, const Vec3& direction, const Light& light, const RandomCounters& chance) {
  random_ = chance;
  draws_ = 0;
  Ray ray;
  ray.position_mm = origin_mm;
  ray.direction = direction;
  ray.light = light;
  waiting_.assign(1, ray);
  for (std::uint32_t events = 0; !waiting_.empty(); ++events) {
    const Ray next = waiting_.back();
    waiting_.pop_back();
    if (events < policy_.max_events)
      follow(next);
    else
      tally_.other[Account::truncated] += next.light.power();
  }
}

void BallWalker::enqueue(Ray ray) {
  if (ray.light.power() < policy_.cutoff)
    tally_.other[Account::truncated] += ray.light.power();
  else
    waiting_.push_back(std::move(ray));
}

void BallWalker::enqueue_branches(Ray one, Ray other) {
  const double both = one.light.power() + other.light.power();
  const double less = std::min(one.light.power(), other.light.power());
  if (less >= policy_.split_power) {
    enqueue(std::move(one));
    enqueue(std::move(other));
    return;
  }
  const double chance = unit_interval(philox(random_.key, random_.replicate, random_.ray, draws_++)[0]);
  Ray& taken = chance * both < one.light.power() ? one : other;
  if (taken.light.power() > 0.0) taken.light.scale(both / taken.light.power());
  enqueue(std::move(taken));
}

void BallWalker::follow(const Ray& ray) {
  ++tally_.segments;
  switch (ray.medium) {
    case Medium::air: return follow_in_air(ray);
    case Medium::ball: return follow_in_ball(ray);
    case Medium::spacer: return follow_in_spacer(ray);
  }
}

void BallWalker::follow_in_air(const Ray& ray) {
  const Vec3 centre = ray.at_ball ? lattice_.centre_mm(ray.ball) : Vec3::Zero();
  const BallLattice::SearchResult way =
      lattice_.follow(centre + ray.position_mm, ray.direction, ray.at_ball ? &ray.ball : nullptr);
  if (way.hit) {
    Ray at = ray;
    at.ball = way.hit->ball;
    at.at_ball = true;
    const Vec3 normal = way.hit->from_centre_mm / layer_.radius_mm();
    return meet(at, way.hit->from_centre_mm, normal, {Medium::air, Medium::ball, 1.0 / setup_.optics.index});
  }
  if (way.is_abandoned) {
    tally_.other[Account::truncated] += ray.light.power();
  } else if (way.is_rising) {
    leave(ray);
  } else {
    tally_.other[Account::transmitted] += ray.light.power();  // the light meets the black area between the balls
  }
}

void BallWalker::leave(const Ray& ray) {
  const std::size_t cone = setup_.cone_of(ray.direction);
  (ray.entered ? tally_.returned : tally_.entrance_reflected)[cone] += in_source_axes(ray.light, ray.direction);
  if (setup_.score != nullptr) setup_.score->add(ray.direction, ray.light.power(), tally_.score);
}

void BallWalker::follow_in_ball(const Ray& ray) {
  const double length = -2.0 * ray.position_mm.dot(ray.direction);
  Vec3 position = ray.position_mm + length * ray.direction;
  position *= layer_.radius_mm() / position.norm();
  Ray at = ray;
  const double before = ray.light.power();
  at.light.scale(std::exp(-setup_.optics.absorption_per_mm * length));
  tally_.other[Account::absorbed] += before - at.light.power();
  const Vec3 normal = position / layer_.radius_mm();
  if (normal.z() > 0.0)
    meet(at, position, normal, {Medium::ball, Medium::air, setup_.optics.index});
  else
    meet_back(at, position, normal);
}

void BallWalker::meet_back(const Ray& ray, const Vec3& position_mm, const Vec3& normal) {
  if (layer_.mirror_offset_mm > 0.0)
    return meet(ray, position_mm, normal, {Medium::ball, Medium::spacer, setup_.optics.ratio_at_back(true)});
  if (is_mirrored(normal)) return meet_mirror(ray, position_mm, normal, true);
  // The back of the ball is uncoated here. Light that leaves through it does not return.
  Ray at = ray;
  at.light.rotate_basis_to_interface(ray.direction, normal);
  const double cosine = std::abs(normal.dot(ray.direction));
  const auto f = materials::fresnel(setup_.optics.ratio_at_back(true), cosine);
  const double before = at.light.power();
  at.light = at.light.reflected(f);
  tally_.other[Account::transmitted] += before - at.light.power();
  at.position_mm = position_mm;
  at.direction = mirrored(ray.direction, normal);
  enqueue(std::move(at));
}

bool BallWalker::is_mirrored(const Vec3& normal) const {
  const bool has_mirror = setup_.optics.mirror_facets || setup_.optics.facet_layers.is_opaque();
  return has_mirror && -normal.z() >= std::cos(Angle::from_deg(layer_.mirror_half_angle_deg).rad()) - 1e-12;
}

void BallWalker::meet_mirror(Ray ray, const Vec3& position_mm, const Vec3& normal, bool from_ball) {
  ray.light.rotate_basis_to_interface(ray.direction, normal);
  const double before = ray.light.power();
  const auto f = fresnel_at_mirror(setup_.optics, from_ball ? setup_.optics.index : setup_.optics.back_index,
                                   std::abs(normal.dot(ray.direction)));
  ray.light = ray.light.reflected(f);
  tally_.other[Account::absorbed] += before - ray.light.power();
  ray.position_mm = position_mm;
  ray.direction = mirrored(ray.direction, normal);
  enqueue(std::move(ray));
}

void BallWalker::follow_in_spacer(const Ray& ray) {
  const double rho = layer_.mirror_radius_mm();
  const double towards = -ray.position_mm.dot(ray.direction);
  const double reach2 = towards * towards - ray.position_mm.squaredNorm();
  const double radius = layer_.radius_mm();
  const bool inwards = towards > 0.0;
  // The ray travels either from the ball outward to the bowl, or from the bowl inward to the ball. The bowl is
  // concentric with the ball, so that a ray from the ball meets the ball again after its reflection.
  const double length = inwards ? towards - std::sqrt(std::max(0.0, reach2 + radius * radius))
                                : towards + std::sqrt(std::max(0.0, reach2 + rho * rho));
  Vec3 position = ray.position_mm + length * ray.direction;
  position *= (inwards ? radius : rho) / position.norm();
  const Vec3 normal = position.normalized();
  if (inwards && normal.z() < 0.0)
    return meet(ray, position, normal, {Medium::spacer, Medium::ball, setup_.optics.ratio_at_back(false)});
  if (!inwards && is_mirrored(normal)) return meet_mirror(ray, position, normal, false);
  // The light passes the edge of the bowl, or meets the black area between the balls.
  tally_.other[Account::transmitted] += ray.light.power();
}

void BallWalker::meet(const Ray& ray, const Vec3& position_mm, const Vec3& normal, const Interface& between) {
  Ray passed = ray;
  passed.position_mm = position_mm;
  passed.light.rotate_basis_to_interface(ray.direction, normal);
  const Vec3 facing = against(ray.direction, normal);
  const double cosine = std::min(1.0, -facing.dot(ray.direction));
  const materials::FresnelCoefficients f = materials::fresnel(between.index_ratio, cosine);
  Ray reflected = passed;
  reflected.medium = between.reflected;
  reflected.direction = mirrored(ray.direction, normal);
  passed.medium = between.transmitted;
  passed.entered = true;
  reflected.light = reflected.light.reflected(f);
  if (f.total_reflection) return enqueue(reflected);
  passed.direction = refracted(ray.direction, facing, between.index_ratio, cosine, f.cos_refracted);
  if (setup_.optics.lossless_entrance) return enqueue(passed);
  passed.light = passed.light.transmitted(f);
  enqueue_branches(passed, reflected);
}

}  // namespace retrace::raytrace

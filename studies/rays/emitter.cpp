#include "studies/rays/emitter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/random.h"

namespace retrace::studies {
namespace {

// Philox stream of the random positions and directions.
constexpr std::uint32_t kEmitterStream = 19;

/// Returns the Cartesian coordinates of a point in polar coordinates.
/// \param turns angle in full turns
geometry::Vec2 polar(double radius, double turns) {
  const double angle = 2.0 * std::numbers::pi * turns;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Returns the radius r, in units of the beam radius, within which the fraction u of a Gaussian beam's power lies. The
/// fraction outside r is exp(-2 r^2).
double gaussian_radius(double u) {
  return std::sqrt(-0.5 * std::log1p(-u));
}

/// Returns the half-angle of the cone around the axis into which the fraction `u` of the power is emitted.
double polar_angle_rad(EmitterKind kind, double half_angle_rad, double u) {
  switch (kind) {
    case EmitterKind::lambertian: return std::asin(std::sqrt(u) * std::sin(half_angle_rad));
    case EmitterKind::gaussian: {
      // The Gaussian distribution of angles is truncated at 90 degrees.
      const double cut = half_angle_rad > 0.0 ? std::pow(0.5 * std::numbers::pi / half_angle_rad, 2.0) : 0.0;
      const double most = half_angle_rad > 0.0 ? -std::expm1(-2.0 * cut) : 0.0;
      return half_angle_rad * gaussian_radius(most * u);
    }
    case EmitterKind::collimated: break;
  }
  // This form avoids the cancellation in 1 - cos at small angles.
  return 2.0 * std::asin(std::sqrt(u) * std::sin(0.5 * half_angle_rad));
}

}  // namespace

EmitterKind emitter_from_name(std::string_view name) {
  const auto found = std::find(kEmitterNames.begin(), kEmitterNames.end(), name);
  return static_cast<EmitterKind>(found - kEmitterNames.begin());
}

EmitterSource::EmitterSource(const Emitter& emitter) : emitter_(emitter) {
  info_.rays = emitter.rays;
  info_.has_radiant = !emitter.is_luminous;
  info_.has_luminous = emitter.is_luminous;
  const std::string_view name = kEmitterNames[static_cast<std::size_t>(emitter.kind)];
  info_.text(RayText::light_source) = U"emitter of retrace, " + std::u32string(name.begin(), name.end());
}

double EmitterSource::fraction_read() const {
  return static_cast<double>(rays_read_) / static_cast<double>(emitter_.rays);
}

bool EmitterSource::read(std::size_t max_rays, std::vector<SetRay>& rays) {
  rays.clear();
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(max_rays, emitter_.rays - rays_read_));
  rays.reserve(count);
  for (std::size_t k = 0; k < count; ++k) rays.push_back(ray(rays_read_ + k));
  rays_read_ += count;
  return count > 0;
}

/// Returns a random starting point of a ray, in the frame of the source.
/// \param u, v independent random numbers, uniform in [0, 1)
Vec3 EmitterSource::position(double u, double v) const {
  if (emitter_.period_mm) return (u - 0.5) * (*emitter_.period_mm)[0] + (v - 0.5) * (*emitter_.period_mm)[1];
  const double radius = emitter_.kind == EmitterKind::gaussian ? gaussian_radius(u) : std::sqrt(u);
  const geometry::Vec2 on_disc = polar(0.5 * emitter_.disc_mm * radius, v);
  return {on_disc.x(), on_disc.y(), 0.0};
}

SetRay EmitterSource::ray(std::uint64_t number) const {
  const auto low = static_cast<std::uint32_t>(number);
  const auto high = static_cast<std::uint32_t>(number >> 32);
  const auto words = philox({emitter_.seed, kEmitterStream}, low, high);
  const double angle =
      polar_angle_rad(emitter_.kind, Angle::from_deg(emitter_.half_angle_deg).rad(), unit_interval(words[2]));
  const geometry::Vec2 across = polar(std::sin(angle), unit_interval(words[3]));
  SetRay ray;
  ray.position_mm = position(unit_interval(words[0]), unit_interval(words[1]));
  ray.direction = Vec3(across.x(), across.y(), std::cos(angle)).normalized();
  const double power = emitter_.power / static_cast<double>(emitter_.rays);
  (emitter_.is_luminous ? ray.luminous_lm : ray.radiant_w) = power;
  return ray;
}

}  // namespace retrace::studies

#include "surface_models/scatter/abg.h"

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "surface_models/scatter/phase_lobe.h"

namespace retrace::surface_models {
namespace {

using std::numbers::pi;
constexpr double kLargestShift = 2.0;
// Maximum total scatter of a smooth surface, approximately its squared phase: (4 pi n s / w)^2 << 1 (Stover, Optical
// Scattering, 3rd ed., SPIE 2012).
constexpr double kMaxSmoothScatter = 0.1;

}  // namespace

Abg::Abg(double a, double b, double g) : a_(a), b_(b), g_(g) {
  if (!(a > 0.0)) throw InputError({"", 0, "a"}, "must be > 0, got " + shortest(a));
  if (!(b > 0.0)) throw InputError({"", 0, "b"}, "must be > 0, got " + shortest(b));
  if (!(g > 0.0)) throw InputError({"", 0, "g"}, "must be > 0, got " + shortest(g));
  shoulder_ = std::min(std::pow(b, 1.0 / g), kLargestShift);
  const auto ring = [this](double r) { return 2.0 * pi * r * bsdf_per_sr(r); };
  // Beyond shoulder_, the r at which r^g equals B, the integration variable is the logarithm of r. The reason is that
  // shoulder_ may be very small.
  boost::math::quadrature::tanh_sinh<double> quadrature;
  total_ = quadrature.integrate(ring, 0.0, shoulder_);
  if (shoulder_ < kLargestShift)
    total_ += quadrature.integrate([&](double log_r) { return std::exp(log_r) * ring(std::exp(log_r)); },
                                   std::log(shoulder_), std::log(kLargestShift));
  if (total_ > 1.0)
    throw InputError({"", 0, "a"}, "must be <= " + shortest(a / total_) +
                                       " for the given values of b and g, because otherwise the scattered light would "
                                       "exceed the incident light; got " +
                                       shortest(a));
}

/// Returns the integral of r^(1 - g).
double Abg::tail_integral(double from, double to) const {
  const double power = 2.0 - g_;
  const double log_ratio = std::log(to / from);
  return std::pow(from, power) * (power == 0.0 ? log_ratio : std::expm1(power * log_ratio) / power);
}

/// Draws |dbeta| with the density r / (B + r^g). Proposals have the density r / max(B, r^g), which is at least as large
/// and at most twice as large.
double Abg::sample_shift(RandomStream& random) const {
  const double core = 0.5 * shoulder_ * shoulder_ / b_;
  const double tail = shoulder_ < kLargestShift ? tail_integral(shoulder_, kLargestShift) : 0.0;
  for (;;) {
    const double drawn = random.next() * (core + tail);
    double r = 0.0;
    if (drawn < core) {
      r = shoulder_ * std::sqrt(drawn / core);
    } else {
      const double power = 2.0 - g_;
      const double scaled = (drawn - core) / std::pow(shoulder_, power);
      r = shoulder_ * std::exp(power == 0.0 ? scaled : std::log1p(power * scaled) / power);
    }
    const double r_g = std::pow(r, g_);
    if (random.next() * (b_ + r_g) < std::max(b_, r_g)) return r;
  }
}

std::optional<Vec2> Abg::sample_scattered(const ScatterEvent& event, const Facet&, Lobe lobe,
                                          RandomStream& random) const {
  const auto specular = specular_direction(event, Vec3::UnitZ(), lobe);
  // Shifts up to 2 are drawn from the BSDF. Light that would leave the unit disc becomes specular.
  if (!specular || random.next() >= total_) return std::nullopt;
  const double shift = sample_shift(random);
  const double angle = 2.0 * pi * random.next();
  const Vec2 beta = specular->head<2>() + shift * Vec2(std::cos(angle), std::sin(angle));
  if (beta.squaredNorm() >= 1.0) return std::nullopt;
  return beta;
}

double Abg::scattered_density(const ScatterEvent& event, const Facet&, Lobe lobe, const Vec2& beta) const {
  const auto specular = specular_direction(event, Vec3::UnitZ(), lobe);
  if (!specular || beta.squaredNorm() >= 1.0) return 0.0;
  return bsdf_per_sr((beta - specular->head<2>()).norm());
}

double Abg::specular_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  const auto specular = specular_direction(event, Vec3::UnitZ(), lobe);
  if (!specular) return 0.0;
  return 1.0 - integrate_over_disc(specular->head<2>(), shoulder_,
                                   [&](const Vec2& beta) { return scattered_density(event, facet, lobe, beta); });
}

Warnings Abg::warnings(double, double) const {
  if (total_ <= kMaxSmoothScatter) return {};
  return {
      {"strong_scatter",
       "up to " + shortest(std::round(1e3 * total_) / 10.0) +
           " % of the light is scattered by the model abg, but this model is valid only for smooth surfaces (up to " +
           shortest(100.0 * kMaxSmoothScatter) +
           " %): the scatter of rougher surfaces depends on the angle of incidence"}};
}

}  // namespace retrace::surface_models

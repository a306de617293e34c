#include "surface_models/scatter/phase_lobe.h"

#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <numbers>

#include "surface_models/scatter/phase.h"

namespace retrace::surface_models {

double log_factorial(int order) {
  // Boost's lgamma is used, because std::lgamma writes to a global variable.
  static const std::array<double, 128> table = [] {
    std::array<double, 128> made{};
    for (std::size_t k = 1; k < made.size(); ++k) made[k] = boost::math::lgamma(static_cast<double>(k) + 1.0);
    return made;
  }();
  const auto index = static_cast<std::size_t>(order);
  return index < table.size() ? table[index] : boost::math::lgamma(order + 1.0);
}

std::optional<PhaseLobe> PhaseLobe::make(const ScatterEvent& event, Lobe lobe, double sq_nm) {
  const auto specular = specular_direction(event, Vec3::UnitZ(), lobe);
  if (!specular) return std::nullopt;
  PhaseLobe made;
  made.specular_ = *specular;
  made.cos_in_ = event.cos_in();
  const double wave_number = 2.0 * std::numbers::pi * sq_nm / event.wavelength_nm;
  made.phase_per_cos_in_ = wave_number * event.index_from;
  made.phase_per_cos_out_ = lobe == Lobe::reflection ? wave_number * event.index_from : -wave_number * event.index_to;
  const double at_edge = made.phase_per_cos_in_ * made.cos_in_;
  const double at_normal = at_edge + made.phase_per_cos_out_;
  made.highest_ = std::max(at_edge * at_edge, at_normal * at_normal);
  made.lowest_ = at_edge * at_normal <= 0.0 ? 0.0 : std::min(at_edge * at_edge, at_normal * at_normal);
  return made;
}

double PhaseLobe::specular_fraction() const {
  return specular_fraction_of_phase(std::sqrt(variance(specular_beta())));
}

double PhaseLobe::scattered_fraction() const {
  return scattered_fraction_of_phase(std::sqrt(variance(specular_beta())));
}

double PhaseLobe::variance(const Vec2& beta) const {
  const double cos_out = std::sqrt(std::max(0.0, 1.0 - beta.squaredNorm()));
  const double phase = phase_per_cos_in_ * cos_in_ + phase_per_cos_out_ * cos_out;
  return phase * phase;
}

double PhaseLobe::order_probability(int order, double variance) {
  if (variance <= 0.0) return order == 0 ? 1.0 : 0.0;
  return std::exp(order * std::log(variance) - variance - log_factorial(order));
}

int PhaseLobe::first_order(double variance) {
  return std::max(0, static_cast<int>(variance - 10.0 * std::sqrt(variance)) - 16);
}

int PhaseLobe::last_order(double variance) {
  return static_cast<int>(variance + 10.0 * std::sqrt(variance)) + 16;
}

double PhaseLobe::envelope(int order) const {
  return order_probability(order, std::clamp(static_cast<double>(order), lowest_, highest_));
}

double PhaseLobe::envelope_sum(int first) const {
  double sum = 0.0;
  for (int m = first; m <= last_order(highest_); ++m) {
    const double term = envelope(m);
    sum += term;
    if (m > highest_ && term < 1e-17 * sum) break;
  }
  return sum;
}

int PhaseLobe::pick_order(double cumulative, int first) const {
  const int last = last_order(highest_);
  for (int m = first; m < last; ++m) {
    cumulative -= envelope(m);
    if (cumulative < 0.0) return m;
  }
  return last;
}

double integrate_over_disc(const Vec2& centre, double width, const std::function<double(const Vec2&)>& f) {
  using boost::math::quadrature::gauss_kronrod;
  constexpr unsigned kDepth = 5;
  constexpr double kTolerance = 1e-7;
  const double offset = centre.norm();
  const Vec2 axis = offset > 0.0 ? Vec2(centre / offset) : Vec2(Vec2::UnitX());
  const Vec2 across(-axis.y(), axis.x());
  const auto ring = [&](double r) {
    // Points at the angle phi from the outward axis are inside if cos phi <= limit.
    const double limit = offset > 0.0 && r > 0.0 ? (1.0 - r * r - offset * offset) / (2.0 * r * offset) : 1.0;
    if (limit <= -1.0) return 0.0;
    const double first = std::acos(std::min(limit, 1.0));
    const auto both_sides = [&](double phi) {
      const Vec2 along = centre + r * std::cos(phi) * axis;
      const Vec2 aside = r * std::sin(phi) * across;
      return f(along + aside) + f(along - aside);
    };
    return r * gauss_kronrod<double, 15>::integrate(both_sides, first, std::numbers::pi, kDepth, kTolerance);
  };
  // The edge of the disc causes a kink in the radius. The other borders only help the adaptive rule.
  std::array<double, 6> borders = {0.0, 3.0 * width, 10.0 * width, 40.0 * width, 1.0 - offset, 1.0 + offset};
  std::sort(borders.begin(), borders.end());
  double sum = 0.0;
  for (std::size_t k = 1; k < borders.size(); ++k) {
    const double begin = borders[k - 1], end = std::min(borders[k], 1.0 + offset);
    if (end <= begin) continue;
    const double rough = gauss_kronrod<double, 15>::integrate(ring, begin, end, 0);
    // A very small outer contribution is not integrated adaptively, because its relative accuracy is irrelevant.
    sum += rough < 1e-12 * sum ? rough : gauss_kronrod<double, 15>::integrate(ring, begin, end, kDepth, kTolerance);
  }
  return sum;
}

}  // namespace retrace::surface_models

#include "surface_models/scatter/harvey_shack.h"

#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "surface_models/scatter/phase.h"

namespace retrace::surface_models {
namespace {

using std::numbers::pi;

void require(bool holds, const char* key, const char* allowed, double given) {
  if (!holds) throw InputError({"", 0, key}, std::string(allowed) + ", got " + shortest(given));
}

/// Gaussian waves of this correlation length have the slope of waves of period `length_um`.
double equivalent_correlation_um(double length_um) {
  return length_um / pi;
}

/// Share of the variance of heights in spatial frequencies below n / w.
double share_that_scatters(double correlation_um, double index, double wavelength_nm) {
  const double x = pi * correlation_um * 1e3 * index / wavelength_nm;
  return -std::expm1(-x * x);
}

/// Variance along each axis of the shift of direction cosines that one spatial frequency of a Gaussian PSD makes.
double shift_variance(double correlation_um, double index, double wavelength_nm) {
  const double deviation = wavelength_nm / (std::sqrt(2.0) * pi * index * correlation_um * 1e3);
  return deviation * deviation;
}

/// Areal, of Gaussian heights with a Gaussian autocorrelation: of their spatial frequencies below n / w.
double roughness_rms_slope(const Roughness& r, double index, double wavelength_nm) {
  const double x = pi * r.correlation_length_um * 1e3 * index / wavelength_nm;
  const double share = -std::expm1(-x * x) - x * x * std::exp(-x * x);
  return 2e-3 * r.sq_nm / r.correlation_length_um * std::sqrt(std::max(0.0, share));
}

}  // namespace

HarveyShack::HarveyShack(const Roughness& roughness)
    : roughness_(roughness),
      slopes_(SlopeShape::beckmann, waviness_rms_slope(roughness.waviness_sq_nm, roughness.waviness_length_um)) {
  const Roughness& r = roughness;
  require(r.sq_nm >= 0.0, "roughness_sq_nm", "must be >= 0", r.sq_nm);
  require(r.sq_nm == 0.0 || r.correlation_length_um > 0.0, "correlation_length_um",
          "must be > 0 where roughness_sq_nm is", r.correlation_length_um);
  require(r.waviness_sq_nm >= 0.0, "waviness_sq_nm", "must be >= 0", r.waviness_sq_nm);
  require(r.waviness_sq_nm == 0.0 || r.waviness_length_um > 0.0, "waviness_length_um",
          "must be > 0 where waviness_sq_nm is", r.waviness_length_um);
  require_modelled_slope(slopes_.rms_slope(), "waviness");
}

Facet HarveyShack::sample_facet(const ScatterEvent& event, RandomStream& random) const {
  const double phase =
      reflection_phase_rad(roughness_.waviness_sq_nm, event.index_from, event.cos_in(), event.wavelength_nm);
  if (phase * phase < kSlopePhase2) return {};
  return {slopes_.sample_visible_normal(-event.direction_in, random), true};
}

HarveyShack::Band HarveyShack::band(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  const double index = event.index_of(lobe);
  const auto square = [](double x) { return x * x; };
  Band made;
  double rough2 = 0.0, wavy2 = 0.0;
  if (roughness_.sq_nm > 0.0) {
    const double length = roughness_.correlation_length_um;
    rough2 = square(roughness_.sq_nm) * share_that_scatters(length, index, event.wavelength_nm);
    made.roughness_variance = shift_variance(length, index, event.wavelength_nm);
  }
  if (roughness_.waviness_sq_nm > 0.0 && !facet.is_tilted) {
    const double length = equivalent_correlation_um(roughness_.waviness_length_um);
    wavy2 = square(roughness_.waviness_sq_nm) * share_that_scatters(length, index, event.wavelength_nm);
    made.waviness_variance = shift_variance(length, index, event.wavelength_nm);
  }
  made.sq_nm = std::sqrt(rough2 + wavy2);
  made.roughness_share = rough2 > 0.0 ? rough2 / (rough2 + wavy2) : 0.0;
  return made;
}

double HarveyShack::specular_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  const auto phase_lobe = PhaseLobe::make(event, lobe, band(event, facet, lobe).sq_nm);
  return phase_lobe ? phase_lobe->specular_share() : 0.0;
}

double HarveyShack::scattered_share(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  const auto phase_lobe = PhaseLobe::make(event, lobe, band(event, facet, lobe).sq_nm);
  return phase_lobe ? phase_lobe->scattered_share() : 0.0;
}

PhaseTexture HarveyShack::phase_texture(const ScatterEvent& event, Lobe lobe) const {
  const auto specular = specular_direction(event, Vec3::UnitZ(), lobe);
  if (!specular) return {};
  const Band what = band(event, {}, lobe);
  // By how much a height on the side that the light goes to lengthens its way; the texture's own side is the
  // material's.
  const double length_per_height = lobe == Lobe::reflection
                                       ? 2.0 * event.index_from * event.cos_in()
                                       : event.index_from * event.cos_in() - event.index_to * -specular->z();
  const double outwards = event.inside_material ? 1.0 : -1.0;
  const double rms_rad = outwards * 2.0 * pi * length_per_height * what.sq_nm / event.wavelength_nm;
  PhaseTexture phases;
  if (what.roughness_share > 0.0)
    phases.terms[0] = {rms_rad * std::sqrt(what.roughness_share), 1e-3 * roughness_.correlation_length_um};
  if (roughness_.waviness_sq_nm > 0.0)
    phases.terms[1] = {rms_rad * std::sqrt(std::max(0.0, 1.0 - what.roughness_share)),
                       1e-3 * equivalent_correlation_um(roughness_.waviness_length_um)};
  return phases;
}

std::optional<Vec2> HarveyShack::draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                                RandomStream& random) const {
  const Band what = band(event, facet, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, what.sq_nm);
  if (!phase_lobe) return std::nullopt;
  return phase_lobe->sample_scattered(random, [&](int order, RandomStream& numbers) -> Vec2 {
    int rough = order;
    if (what.roughness_share < 1.0) {
      rough = 0;
      for (int k = 0; k < order; ++k) rough += numbers.next() < what.roughness_share ? 1 : 0;
    }
    const double variance = rough * what.roughness_variance + (order - rough) * what.waviness_variance;
    return std::sqrt(variance) * normal_pair(numbers);
  });
}

/// Density of the sum of `order` shifts at the squared distance `shift2`.
double HarveyShack::shift_density(const Band& band, int order, double shift2) {
  const auto gaussian = [shift2](double variance) {
    return std::exp(-0.5 * shift2 / variance) / (2.0 * pi * variance);
  };
  if (band.roughness_share == 1.0) return gaussian(order * band.roughness_variance);
  if (band.roughness_share == 0.0) return gaussian(order * band.waviness_variance);
  // Each of them is one of the roughness with the probability of its share: binomial.
  const double log_rough = std::log(band.roughness_share), log_wavy = std::log1p(-band.roughness_share);
  double sum = 0.0;
  for (int rough = 0; rough <= order; ++rough) {
    const int wavy = order - rough;
    const double probability = std::exp(log_factorial(order) - log_factorial(rough) - log_factorial(wavy) +
                                        rough * log_rough + wavy * log_wavy);
    sum += probability * gaussian(rough * band.roughness_variance + wavy * band.waviness_variance);
  }
  return sum;
}

double HarveyShack::unscaled_density(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec2& beta) const {
  const Band what = band(event, facet, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, what.sq_nm);
  if (!phase_lobe || beta.squaredNorm() >= 1.0) return 0.0;
  const double shift2 = (beta - phase_lobe->specular_beta()).squaredNorm();
  return phase_lobe->density(beta, 1, [&](int order) { return shift_density(what, order, shift2); });
}

double HarveyShack::scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                      const Vec2& beta) const {
  const Band what = band(event, facet, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, what.sq_nm);
  if (!phase_lobe || what.sq_nm == 0.0) return 0.0;
  const double width = std::sqrt(std::max(what.roughness_variance, what.waviness_variance));
  const double sum = integrate_over_disc(phase_lobe->specular_beta(), width,
                                         [&](const Vec2& at) { return unscaled_density(event, facet, lobe, at); });
  return sum > 0.0 ? phase_lobe->scattered_share() * unscaled_density(event, facet, lobe, beta) / sum : 0.0;
}

void HarveyShack::require_in_range(double index, double wavelength_nm) const {
  if (roughness_.sq_nm > 0.0)
    require_modelled_slope(roughness_rms_slope(roughness_, index, wavelength_nm), "roughness");
}

std::vector<std::string> HarveyShack::warnings(double index, double wavelength_nm) const {
  std::vector<std::string> found;
  const Roughness& r = roughness_;
  const double wave_um = 1e-3 * wavelength_nm / index;
  if (r.sq_nm > 0.0) {
    if (r.correlation_length_um < wave_um)
      found.push_back("correlation length " + shortest(r.correlation_length_um) +
                      " um is below the wavelength in the material: the phase model of roughness does not hold");
    const double slope = roughness_rms_slope(r, index, wavelength_nm);
    if (slope > kLargestSlope)
      found.push_back("rms slope of the roughness " + fixed(slope, 3) + " is above " + shortest(kLargestSlope) +
                      ": multiple reflection is left out");
    if (reflection_phase_rad(r.sq_nm, index, 1.0, wavelength_nm) > 2.0 * pi)
      found.push_back("roughness " + shortest(std::round(100.0 * r.sq_nm) / 100.0) +
                      " nm is above half a wavelength in the material: microfacet is the model for it");
  }
  if (slopes_.rms_slope() > kLargestSlope)
    found.push_back("rms slope of the waviness " + fixed(slopes_.rms_slope(), 3) + " is above " +
                    shortest(kLargestSlope) + ": multiple reflection is left out");
  if (r.waviness_sq_nm > 0.0 && r.waviness_length_um < 5.0 * wave_um)
    found.push_back("waviness of period " + shortest(r.waviness_length_um) +
                    " um is shorter than five wavelengths in the material: it is roughness");
  return found;
}

}  // namespace retrace::surface_models

#include "surface_models/scatter/harvey_shack.h"

#include <numbers>

#include "core/error.h"
#include "core/number_format.h"
#include "surface_models/scatter/phase.h"

namespace retrace::surface_models {
namespace {

using std::numbers::pi;

// Maximum squared phase at normal incidence for first-order theory. At this value, 5 % of the scattered light is
// diffracted more than once.
constexpr double kMaxFirstOrderPhase2 = 0.1;

void require(bool holds, const char* key, const char* allowed, double given) {
  if (!holds) throw InputError({"", 0, key}, std::string(allowed) + ", got " + shortest(given));
}

// Minimum correlation length in um for which no warning is given, for roughness with a lay (different correlation
// lengths along x and y). The phase model is used for such roughness. Below this length, the model overestimates
// scatter by 9 % at 45 degrees (docs/theory/scatter.md).
constexpr double kLongOfLay = 2.0;

/// Returns the correlation length of Gaussian waves that have the same rms slope as waves with the period `length_um`.
double equivalent_correlation_um(double length_um) {
  return length_um / pi;
}

/// Returns pi l n / w: the correlation length l in wavelengths w / n, times pi.
double length_in_waves(double correlation_um, double index, double wavelength_nm) {
  return pi * correlation_um * 1e3 * index / wavelength_nm;
}

/// Returns the correlation lengths along x and along y.
Vec2 correlation_lengths_um(const Roughness& r) {
  return {r.correlation_length_um, r.is_isotropic() ? r.correlation_length_um : r.y_correlation_length_um};
}

/// Returns the mean of f(t, u) over the directions of spatial frequency vectors. The spectrum is a Gaussian with
/// elliptical contours, which follow from the two correlation lengths. If v is the variance of the spatial frequencies
/// in a direction, t is (n / w)^2 / (2 v) in this direction. u is the variance of the slopes in this direction, in
/// units of 2 Sq^2 / um^2. The integrand is smooth and periodic, so equal steps are accurate.
template <class F>
double mean_over_directions(const Vec2& lengths_um, double index, double wavelength_nm, const F& f) {
  constexpr int kSteps = 64;
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 0.5 * pi * (k + 0.5) / kSteps;
    const Vec2 ahead = Vec2(std::cos(angle), std::sin(angle)).cwiseQuotient(lengths_um);
    const double inverse = ahead.squaredNorm();
    const double x = length_in_waves(1.0, index, wavelength_nm);
    sum += f(x * x / inverse, inverse);
  }
  return sum / kSteps;
}

/// Returns the fraction of the variance of heights at spatial frequencies below n / w.
double fraction_that_scatters(double correlation_um, double index, double wavelength_nm) {
  const double x = length_in_waves(correlation_um, index, wavelength_nm);
  return -std::expm1(-x * x);
}

double fraction_that_scatters(const Vec2& lengths_um, double index, double wavelength_nm) {
  constexpr double kAll = 7.0;  // exp(-7^2) is below the rounding error
  const double shortest_um = lengths_um.minCoeff();
  if (lengths_um.x() == lengths_um.y() || length_in_waves(shortest_um, index, wavelength_nm) > kAll)
    return fraction_that_scatters(shortest_um, index, wavelength_nm);
  return mean_over_directions(lengths_um, index, wavelength_nm, [](double t, double) { return -std::expm1(-t); });
}

/// Returns the variance, along each axis, of the shift of direction cosines by one spatial frequency of a Gaussian PSD.
double shift_variance(double correlation_um, double index, double wavelength_nm) {
  const double deviation = wavelength_nm / (std::sqrt(2.0) * pi * index * correlation_um * 1e3);
  return deviation * deviation;
}

/// Returns the areal rms slope of Gaussian heights with a Gaussian autocorrelation. Only spatial frequencies below n /
/// w are included.
double roughness_rms_slope(const Roughness& r, double index, double wavelength_nm) {
  const auto band = [](double t) { return -std::expm1(-t) - t * std::exp(-t); };
  if (r.is_isotropic()) {
    const double x = length_in_waves(r.correlation_length_um, index, wavelength_nm);
    return 2e-3 * r.sq_nm / r.correlation_length_um * std::sqrt(std::max(0.0, band(x * x)));
  }
  const double mean = mean_over_directions(correlation_lengths_um(r), index, wavelength_nm,
                                           [&](double t, double inverse) { return inverse * band(t); });
  return 2e-3 * r.sq_nm * std::sqrt(std::max(0.0, mean));
}

double wave_number_per_nm(double wavelength_nm) {
  return 2.0 * pi / wavelength_nm;
}

/// \param k_out component of the wave vector of the scattered light along the facet, in units of the wave number in
/// air; its length is less than `index`
/// \param along direction of the component of the incident wave vector along the facet; a unit vector
DiffractedOnce leaving_light(const Vec2& k_out, const Vec2& along, double index, Lobe lobe,
                             const Polarisation2& coherency) {
  const double k = k_out.norm();
  const Vec2 ahead = k > 0.0 ? Vec2(k_out / k) : along;
  return {direction_of(k_out / index, lobe), Vec3(ahead.y(), -ahead.x(), 0.0), coherency, lobe};
}

}  // namespace

struct HarveyShack::Side {
  DielectricInterface interface;
  std::array<std::optional<FirstOrderFraction>, 2> fractions;  ///< for roughness and for waviness

  Side(const Roughness& r, double from, double to, double wavelength_nm) : interface(from, to) {
    const double wave_number_per_um = 1e3 * wave_number_per_nm(wavelength_nm);
    if (r.sq_nm > 0.0) fractions[0].emplace(interface, wave_number_per_um * r.correlation_length_um);
    if (r.waviness_sq_nm > 0.0)
      fractions[1].emplace(interface, wave_number_per_um * equivalent_correlation_um(r.waviness_length_um));
  }
};

struct HarveyShack::Media {
  Side inside, outside;
};

HarveyShack::HarveyShack(const Roughness& roughness, const Dielectrics& media) : HarveyShack(roughness) {
  if (!roughness.is_isotropic()) return;
  const double w = media.wavelength_nm;
  media_ = std::make_shared<const Media>(
      Media{Side(roughness, media.index, media.back_index, w), Side(roughness, media.back_index, media.index, w)});
}

const HarveyShack::Side& HarveyShack::side_of(const ScatterEvent& event) const {
  return event.inside_material ? media_->inside : media_->outside;
}

std::array<HarveyShack::Part, 2> HarveyShack::parts(const Facet& facet) const {
  return {Part{roughness_.sq_nm, roughness_.correlation_length_um},
          Part{facet.is_tilted ? 0.0 : roughness_.waviness_sq_nm,
               equivalent_correlation_um(roughness_.waviness_length_um)}};
}

std::array<double, 2> HarveyShack::first_order_fractions(const ScatterEvent& event, const Facet& facet) const {
  const Side& side = side_of(event);
  const double k = event.index_from * event.direction_in.head<2>().norm();
  const double wave_number = wave_number_per_nm(event.wavelength_nm);
  const std::array<Part, 2> heights = parts(facet);
  std::array<double, 2> scattered{};
  for (std::size_t n = 0; n < heights.size(); ++n) {
    if (!(heights[n].sq_nm > 0.0)) continue;
    const std::array<double, 2> share = side.fractions[n]->at(k);
    const double height = wave_number * heights[n].sq_nm;
    for (std::size_t pol : {0U, 1U}) scattered[pol] += height * height * share[pol];
  }
  return scattered;
}

DiffractionMeans HarveyShack::diffraction_means(const ScatterEvent& event, const Facet& facet,
                                                const materials::FresnelCoefficients& fresnel) const {
  const std::array<double, 2> scattered = first_order_fractions(event, facet);
  // The scattered power is removed from the specular light on both sides: the reflected and the transmitted light. It
  // is divided between them in proportion to their power times their phase variance, as for long correlation lengths.
  const double reflected_path = 2.0 * event.index_from * event.cos_in();
  const double transmitted_path = event.index_from * event.cos_in() - event.index_to * fresnel.cos_refracted;
  const double a_r = reflected_path * reflected_path, a_t = transmitted_path * transmitted_path;
  DiffractionMeans means;
  for (std::size_t pol : {0U, 1U}) {
    const double t = std::norm(pol == 0 ? fresnel.t_s : fresnel.t_p);
    const double phases = (1.0 - t) * a_r + t * a_t;
    if (!(phases > 0.0)) continue;
    means.reflected[pol] = scattered[pol] * a_r / phases;
    means.transmitted[pol] = t > 0.0 ? scattered[pol] * a_t / phases : 0.0;
  }
  return means;
}

std::optional<DiffractedOnce> HarveyShack::draw_diffracted_once(const ScatterEvent& event, const Facet& facet,
                                                                const Vec3& s_axis, const Polarisation2& coherency,
                                                                RandomStream& random) const {
  constexpr int kMaxTries = 1000000;
  const Side& side = side_of(event);
  const Vec2 along(-s_axis.y(), s_axis.x());  // z x s
  const double k_in = event.index_from * event.direction_in.head<2>().norm();
  const double most = std::max(event.index_from, event.index_to);
  const double bound = side.interface.bound(k_in, coherency);
  const std::array<Part, 2> heights = parts(facet);
  const double variance_of_first = heights[0].sq_nm * heights[0].sq_nm;
  const double all = variance_of_first + heights[1].sq_nm * heights[1].sq_nm;
  if (!(bound > 0.0) || !(all > 0.0)) return std::nullopt;
  for (int tries = 0; tries < kMaxTries; ++tries) {
    const Part& part = heights[random.next() * all < variance_of_first ? 0 : 1];
    const double deviation = std::sqrt(2.0) / (1e3 * part.length_um * wave_number_per_nm(event.wavelength_nm));
    const Vec2 k_out = k_in * along + deviation * normal_pair(random);
    double left = random.next() * bound;
    if (k_out.squaredNorm() >= most * most) continue;
    for (const Lobe lobe : {Lobe::reflection, Lobe::transmission}) {
      const double index = event.index_of(lobe);
      if (k_out.squaredNorm() >= index * index) continue;
      const Polarisation2 f = side.interface.amplitudes(k_in, along, k_out, lobe);
      const Polarisation2 out = f * coherency * f.adjoint();
      const double power = out.trace().real();
      left -= power;
      if (left >= 0.0) continue;
      return leaving_light(k_out, along, index, lobe, out / power);
    }
  }
  return std::nullopt;
}

DiffractedOnce HarveyShack::scattered_once(const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& s_axis,
                                           const Polarisation2& coherency, const Vec2& k_out) const {
  const Vec2 along(-s_axis.y(), s_axis.x());
  const double k_in = event.index_from * event.direction_in.head<2>().norm();
  const double wave_number = wave_number_per_nm(event.wavelength_nm);
  double spectrum = 0.0;
  for (const Part& part : parts(facet)) {
    if (!(part.sq_nm > 0.0)) continue;
    const double length = 1e3 * part.length_um * wave_number, height = part.sq_nm * wave_number;
    spectrum += height * height * length * length / (4.0 * pi) *
                std::exp(-0.25 * length * length * (k_out - k_in * along).squaredNorm());
  }
  const Polarisation2 f = side_of(event).interface.amplitudes(k_in, along, k_out, lobe);
  return leaving_light(k_out, along, event.index_of(lobe), lobe, spectrum * (f * coherency * f.adjoint()));
}

DiffractedOnce HarveyShack::diffracted_once_into(const ScatterEvent& event, const Facet& facet, const Vec3& s_axis,
                                                 const Polarisation2& coherency, const Vec3& direction) const {
  const Lobe lobe = direction.z() > 0.0 ? Lobe::reflection : Lobe::transmission;
  const double index = event.index_of(lobe);
  const std::array<double, 2> shares = first_order_fractions(event, facet);
  const double all = shares[0] * coherency(0, 0).real() + shares[1] * coherency(1, 1).real();
  DiffractedOnce into = scattered_once(event, facet, lobe, s_axis, coherency, index * direction.head<2>());
  into.coherency *= all > 0.0 ? index * index / all : 0.0;
  return into;
}

double HarveyShack::diffracted_once_density(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                            const Vec3& s_axis, const Polarisation2& coherency,
                                            const Vec2& beta) const {
  if (beta.squaredNorm() >= 1.0) return 0.0;
  const double index = event.index_of(lobe);
  return index * index * scattered_once(event, facet, lobe, s_axis, coherency, index * beta).coherency.trace().real();
}

HarveyShack::HarveyShack(const Roughness& roughness)
    : roughness_(roughness),
      slopes_(SlopeShape::beckmann, waviness_rms_slope(roughness.waviness_sq_nm, roughness.waviness_length_um)) {
  const Roughness& r = roughness;
  require(r.sq_nm >= 0.0, "roughness_sq_nm", "must be >= 0", r.sq_nm);
  require(r.sq_nm == 0.0 || r.correlation_length_um > 0.0, "correlation_length_um",
          "must be > 0 if roughness_sq_nm is > 0", r.correlation_length_um);
  require(r.y_correlation_length_um >= 0.0, "y_correlation_length_um", "must be >= 0", r.y_correlation_length_um);
  require(r.waviness_sq_nm >= 0.0, "waviness_sq_nm", "must be >= 0", r.waviness_sq_nm);
  require(r.waviness_sq_nm == 0.0 || r.waviness_length_um > 0.0, "waviness_length_um",
          "must be > 0 if waviness_sq_nm is > 0", r.waviness_length_um);
  require_slope_in_range(slopes_.rms_slope(), "waviness");
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
    const Vec2 lengths_um = correlation_lengths_um(roughness_);
    rough2 = square(roughness_.sq_nm) * fraction_that_scatters(lengths_um, index, event.wavelength_nm);
    made.roughness_variance = {shift_variance(lengths_um.x(), index, event.wavelength_nm),
                               shift_variance(lengths_um.y(), index, event.wavelength_nm)};
  }
  if (roughness_.waviness_sq_nm > 0.0 && !facet.is_tilted) {
    const double length = equivalent_correlation_um(roughness_.waviness_length_um);
    wavy2 = square(roughness_.waviness_sq_nm) * fraction_that_scatters(length, index, event.wavelength_nm);
    made.waviness_variance.setConstant(shift_variance(length, index, event.wavelength_nm));
  }
  made.sq_nm = std::sqrt(rough2 + wavy2);
  made.roughness_fraction = rough2 > 0.0 ? rough2 / (rough2 + wavy2) : 0.0;
  return made;
}

double HarveyShack::specular_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  const auto phase_lobe = PhaseLobe::make(event, lobe, band(event, facet, lobe).sq_nm);
  return phase_lobe ? phase_lobe->specular_fraction() : 0.0;
}

double HarveyShack::scattered_fraction(const ScatterEvent& event, const Facet& facet, Lobe lobe) const {
  const auto phase_lobe = PhaseLobe::make(event, lobe, band(event, facet, lobe).sq_nm);
  return phase_lobe ? phase_lobe->scattered_fraction() : 0.0;
}

PhaseTexture HarveyShack::phase_texture(const ScatterEvent& event, Lobe lobe) const {
  const auto specular = specular_direction(event, Vec3::UnitZ(), lobe);
  if (!specular) return {};
  const Band what = band(event, {}, lobe);
  // Change of the optical path per height, where heights are positive towards the side to which the light goes. The
  // texture defines heights as positive out of the material.
  const double length_per_height = lobe == Lobe::reflection
                                       ? 2.0 * event.index_from * event.cos_in()
                                       : event.index_from * event.cos_in() - event.index_to * -specular->z();
  const double outwards = event.inside_material ? 1.0 : -1.0;
  const double rms_rad = outwards * 2.0 * pi * length_per_height * what.sq_nm / event.wavelength_nm;
  PhaseTexture phases;
  if (what.roughness_fraction > 0.0)
    phases.terms[0] = {rms_rad * std::sqrt(what.roughness_fraction), 1e-3 * roughness_.correlation_length_um};
  if (roughness_.waviness_sq_nm > 0.0)
    phases.terms[1] = {rms_rad * std::sqrt(std::max(0.0, 1.0 - what.roughness_fraction)),
                       1e-3 * equivalent_correlation_um(roughness_.waviness_length_um)};
  return phases;
}

std::optional<Vec2> HarveyShack::draw_scattered(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                                RandomStream& random, int min_orders) const {
  const Band what = band(event, facet, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, what.sq_nm);
  if (!phase_lobe) return std::nullopt;
  return phase_lobe->sample_scattered(
      random,
      [&](int order, RandomStream& numbers) -> Vec2 {
        int rough = order;
        if (what.roughness_fraction < 1.0) {
          rough = 0;
          for (int k = 0; k < order; ++k) rough += numbers.next() < what.roughness_fraction ? 1 : 0;
        }
        const Vec2 variance = rough * what.roughness_variance + (order - rough) * what.waviness_variance;
        return variance.cwiseSqrt().cwiseProduct(normal_pair(numbers));
      },
      min_orders);
}

/// Returns the density of the sum of `order` shifts at `shift`.
double HarveyShack::shift_density(const Band& band, int order, const Vec2& shift) {
  const auto gaussian = [&shift](const Vec2& variance) {
    return std::exp(-0.5 * shift.cwiseAbs2().cwiseQuotient(variance).sum()) / (2.0 * pi * std::sqrt(variance.prod()));
  };
  if (band.roughness_fraction == 1.0) return gaussian(order * band.roughness_variance);
  if (band.roughness_fraction == 0.0) return gaussian(order * band.waviness_variance);
  // Each of the `order` shifts is caused either by roughness or by waviness. The number of shifts by roughness
  // therefore has a binomial distribution.
  const double log_rough = std::log(band.roughness_fraction), log_wavy = std::log1p(-band.roughness_fraction);
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
  const Vec2 shift = beta - phase_lobe->specular_beta();
  return phase_lobe->density(beta, 1, [&](int order) { return shift_density(what, order, shift); });
}

double HarveyShack::scattered_density(const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                      const Vec2& beta) const {
  const Band what = band(event, facet, lobe);
  const auto phase_lobe = PhaseLobe::make(event, lobe, what.sq_nm);
  if (!phase_lobe || what.sq_nm == 0.0) return 0.0;
  const double width = std::sqrt(std::max(what.roughness_variance.maxCoeff(), what.waviness_variance.maxCoeff()));
  const double sum = integrate_over_disc(phase_lobe->specular_beta(), width,
                                         [&](const Vec2& at) { return unscaled_density(event, facet, lobe, at); });
  return sum > 0.0 ? phase_lobe->scattered_fraction() * unscaled_density(event, facet, lobe, beta) / sum : 0.0;
}

void HarveyShack::require_in_range(double index, double wavelength_nm) const {
  if (roughness_.sq_nm > 0.0)
    require_slope_in_range(roughness_rms_slope(roughness_, index, wavelength_nm), "roughness");
}

Warnings HarveyShack::warnings(double index, double wavelength_nm) const {
  Warnings found;
  const Roughness& r = roughness_;
  const double wave_um = 1e-3 * wavelength_nm / index;
  if (r.sq_nm > 0.0) {
    // Between dielectrics, light that is diffracted once is computed accurately for any correlation length. The
    // fraction of the scattered light that is diffracted two times is about half of the phase variance.
    const double phase = reflection_phase_rad(r.sq_nm, index, 1.0, wavelength_nm);
    const double shortest_um = correlation_lengths_um(r).minCoeff();
    if (!r.is_isotropic() && shortest_um >= wave_um && shortest_um < kLongOfLay)
      found.push_back({"lay_beyond_model", "correlation length " + shortest(shortest_um) +
                                               " um of roughness with a lay is below " + shortest(kLongOfLay) +
                                               " um: at total reflection the phase model overestimates its scatter"});
    if (shortest_um < wave_um && (media_ == nullptr || phase * phase > kMaxFirstOrderPhase2))
      found.push_back({"correlation_below_wavelength",
                       "correlation length " + shortest(shortest_um) +
                           " um is below the wavelength in the material: the phase model of roughness is not valid" +
                           (media_ == nullptr ? "" : ", and the heights are too large for first-order theory")});
    const double slope = roughness_rms_slope(r, index, wavelength_nm);
    if (slope > kMaxSlopeWithoutWarning)
      found.push_back(
          {"steep_roughness", "the rms slope of the roughness is " + fixed_apart(slope, kMaxSlopeWithoutWarning, 3) +
                                  ", which is above " + shortest(kMaxSlopeWithoutWarning) +
                                  ": light that is reflected several times on the surface is not modelled"});
    if (reflection_phase_rad(r.sq_nm, index, 1.0, wavelength_nm) > 2.0 * pi)
      found.push_back(
          {"roughness_beyond_model", "roughness " + shortest(std::round(100.0 * r.sq_nm) / 100.0) +
                                         " nm is above half a wavelength in the material: use the model microfacet"});
  }
  if (slopes_.rms_slope() > kMaxSlopeWithoutWarning)
    found.push_back({"steep_waviness", "the rms slope of the waviness is " +
                                           fixed_apart(slopes_.rms_slope(), kMaxSlopeWithoutWarning, 3) +
                                           ", which is above " + shortest(kMaxSlopeWithoutWarning) +
                                           ": light that is reflected several times on the surface is not modelled"});
  if (r.waviness_sq_nm > 0.0 && r.waviness_length_um < 5.0 * wave_um)
    found.push_back(
        {"short_waviness", "waviness of period " + shortest(r.waviness_length_um) +
                               " um is shorter than five wavelengths in the material: specify it as roughness"});
  return found;
}

}  // namespace retrace::surface_models

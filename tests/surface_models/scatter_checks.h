#pragma once

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "surface_models/fft.h"
#include "surface_models/scatter/scatter_model.h"
#include "surface_models/scatter/slope_distribution.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

// Events, height maps and statistical checks for tests of scatter models.

namespace retrace::testing::scatter_checks {

using namespace surface_models;

inline constexpr double kIndex = 1.4917;
inline constexpr double kRadians = std::numbers::pi / 180.0;

/// Returns an event whose plane of incidence is oblique to the axes.
inline ScatterEvent event_at(double incidence_deg, double index_from, double index_to, double wavelength_nm = 550.0) {
  const double t = incidence_deg * kRadians, p = 0.4;
  ScatterEvent event;
  event.direction_in = {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), -std::cos(t)};
  event.index_from = index_from;
  event.index_to = index_to;
  event.wavelength_nm = wavelength_nm;
  event.inside_material = index_from > index_to;
  return event;
}
inline ScatterEvent inside(double incidence_deg, double wavelength_nm = 550.0) {
  return event_at(incidence_deg, kIndex, 1.0, wavelength_nm);
}
inline ScatterEvent outside(double incidence_deg, double wavelength_nm = 550.0) {
  return event_at(incidence_deg, 1.0, kIndex, wavelength_nm);
}

struct Case {
  std::string name;
  ScatterEvent event;
  Lobe lobe;
};

/// Returns cases for both sides, both lobes, and total reflection.
inline const std::vector<Case>& cases() {
  static const std::vector<Case> all = {{"normal, inside, reflected", inside(0.0), Lobe::reflection},
                                        {"30, inside, reflected", inside(30.0), Lobe::reflection},
                                        {"54.74, total reflection", inside(54.74), Lobe::reflection},
                                        {"80, total reflection", inside(80.0), Lobe::reflection},
                                        {"30, inside, transmitted", inside(30.0), Lobe::transmission},
                                        {"normal, outside, reflected", outside(0.0), Lobe::reflection},
                                        {"70, outside, reflected", outside(70.0), Lobe::reflection},
                                        {"40, outside, transmitted", outside(40.0), Lobe::transmission}};
  return all;
}

inline RandomStream stream(std::uint32_t seed, std::uint32_t sample) {
  return {{seed, 77}, sample, 0, 0};
}

/// Density of directions per area in the plane of direction cosines.
using Density = std::function<double(const Vec2&)>;
/// One draw of a direction. It is empty if the drawn light does not belong to the density, for example specular light.
using Draw = std::function<std::optional<Vec2>(RandomStream&)>;

/// Bins for directions: sectors of rings around the specular direction, and one bin for all other directions.
class Rings {
 public:
  static constexpr int kSectors = 8;

  Rings(const Vec2& centre, double width) : centre_(centre) {
    for (const double r : {0.0, 0.3, 0.6, 0.9, 1.2, 1.6, 2.0, 2.5, 3.2, 4.5, 7.0}) edges_.push_back(r * width);
  }
  std::size_t size() const { return (edges_.size() - 1) * kSectors; }

  /// Returns the number of the bin, or size() if `beta` is in no bin.
  std::size_t bin_of(const Vec2& beta) const {
    const Vec2 shift = beta - centre_;
    const auto edge = std::upper_bound(edges_.begin(), edges_.end(), shift.norm());
    if (edge == edges_.end()) return size();
    const double turn = std::atan2(shift.y(), shift.x()) / (2.0 * std::numbers::pi);
    const int sector = static_cast<int>((turn < 0.0 ? turn + 1.0 : turn) * kSectors) % kSectors;
    return static_cast<std::size_t>(edge - edges_.begin() - 1) * kSectors + static_cast<std::size_t>(sector);
  }

  double integral(std::size_t bin, const Density& density) const {
    using boost::math::quadrature::gauss;
    const double first = 2.0 * std::numbers::pi / kSectors * static_cast<double>(bin % kSectors);
    const double from = edges_[bin / kSectors], to = edges_[bin / kSectors + 1];
    return gauss<double, 30>::integrate(
        [&](double angle) {
          const Vec2 along(std::cos(angle), std::sin(angle));
          const double inward = centre_.dot(along);
          const double border = -inward + std::sqrt(1.0 - centre_.squaredNorm() + inward * inward);
          if (border <= from) return 0.0;
          // The radius is end - u^2, because densities may increase towards the border of the disc as 1 / cosine.
          const double end = std::min(to, border);
          return gauss<double, 15>::integrate(
              [&](double u) {
                const double r = end - u * u;
                return 2.0 * u * r * density(centre_ + r * along);
              },
              0.0, std::sqrt(end - from));
        },
        first, first + 2.0 * std::numbers::pi / kSectors);
  }

 private:
  Vec2 centre_;
  std::vector<double> edges_;
};

/// Returns the p-value of a chi-square test: the probability of at least the observed chi-square if the draws follow
/// the density. Bins with fewer than ten expected draws are merged with the bin of all other directions.
/// \param full_draws number of draws in a long run. Otherwise, it is a quarter of this number, unless fewer than 2000
/// draws would then be expected in the rings, which would leave few bins.
inline double chi_square_p(const Rings& rings, const Density& density, const Draw& draw, std::uint32_t seed,
                           std::uint32_t full_draws = 100000) {
  std::vector<double> expected(rings.size() + 1, 0.0), seen(rings.size() + 1, 0.0);
  for (std::size_t bin = 0; bin < rings.size(); ++bin) expected[bin] = rings.integral(bin, density);
  const double inside_rings = std::accumulate(expected.begin(), expected.end(), 0.0);
  expected.back() = 1.0 - inside_rings;
  const bool are_few = 0.25 * full_draws * inside_rings < 2000.0;
  const std::uint32_t draws = are_few ? full_draws : test::sample_size(full_draws / 4, full_draws);
  for (double& count : expected) count *= draws;
  for (std::uint32_t k = 0; k < draws; ++k) {
    RandomStream random = stream(seed, k);
    const auto beta = draw(random);
    seen[beta ? rings.bin_of(*beta) : rings.size()] += 1.0;
  }
  double chi2 = 0.0, rest_expected = expected.back(), rest_seen = seen.back();
  int bins = 0;
  for (std::size_t bin = 0; bin < rings.size(); ++bin) {
    if (expected[bin] < 10.0) {
      rest_expected += expected[bin];
      rest_seen += seen[bin];
      continue;
    }
    chi2 += (seen[bin] - expected[bin]) * (seen[bin] - expected[bin]) / expected[bin];
    ++bins;
  }
  EXPECT_GE(bins, 8);
  if (rest_expected < 10.0) {
    EXPECT_LT(rest_seen, 40.0);
    --bins;
  } else {
    chi2 += (rest_seen - rest_expected) * (rest_seen - rest_expected) / rest_expected;
  }
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(bins), chi2));
}

/// Returns the integral over the unit disc in polar coordinates about its center. The rule is independent of the
/// library's rule.
inline double disc_integral(const Density& density, int rings = 600, int sectors = 600) {
  double sum = 0.0;
  for (int k = 0; k < rings; ++k) {
    const double t = 0.5 * std::numbers::pi * (k + 0.5) / rings;
    for (int j = 0; j < sectors; ++j) {
      const double p = 2.0 * std::numbers::pi * (j + 0.5) / sectors;
      sum += std::sin(t) * std::cos(t) * density(std::sin(t) * Vec2(std::cos(p), std::sin(p)));
    }
  }
  return sum * 0.5 * std::numbers::pi / rings * 2.0 * std::numbers::pi / sectors;
}

inline Draw draw_of(const ScatterModel& model, const ScatterEvent& event, Lobe lobe) {
  return [=](RandomStream& random) -> std::optional<Vec2> {
    const auto drawn = sample(model, event, Facet{}, lobe, random);
    if (!drawn || drawn->is_specular) return std::nullopt;
    return Vec2(drawn->direction.head<2>());
  };
}

/// Returns a fast form of a density that the model computes by quadrature. The fast form is the unscaled density of the
/// model, scaled so that both agree in one direction.
template <class Model>
Density scaled_density(const Model& model, const ScatterEvent& event, Lobe lobe) {
  const Vec2 at = specular_direction(event, Vec3::UnitZ(), lobe)->template head<2>() * 0.99;
  const double scale = model.scattered_density(event, {}, lobe, at) / model.unscaled_density(event, {}, lobe, at);
  return [=](const Vec2& beta) { return scale * model.unscaled_density(event, {}, lobe, beta); };
}

inline HeightMap flat(std::size_t points, double pixel_um) {
  HeightMap map;
  map.columns = map.rows = points;
  map.x_pixel_um = map.y_pixel_um = pixel_um;
  map.heights_nm.assign(points * points, 0.0);
  return map;
}

/// Returns a map of Gaussian heights with Gaussian autocorrelation along both axes. Its Sq is exactly the given value.
inline HeightMap random_map(std::size_t points, double pixel_um, double sq_nm, double x_length_um, double y_length_um) {
  HeightMap map = flat(points, pixel_um);
  RealFft fft(points, points);
  RandomStream random = stream(20, 0);
  for (double& z : fft.field()) z = normal_pair(random).x();
  fft.forward();
  const double step = 1.0 / (static_cast<double>(points) * pixel_um);
  for (std::size_t r = 0; r < points; ++r)
    for (std::size_t c = 0; c < fft.spectrum_columns(); ++c) {
      const double fx = step * static_cast<double>(c);
      const double fy =
          step * (2 * r > points ? static_cast<double>(r) - static_cast<double>(points) : static_cast<double>(r));
      const double x = std::numbers::pi * x_length_um * fx, y = std::numbers::pi * y_length_um * fy;
      fft.spectrum()[r * fft.spectrum_columns() + c] *= std::exp(-0.5 * (x * x + y * y));
    }
  fft.spectrum()[0] = 0.0;
  fft.inverse();
  map.heights_nm.assign(fft.field().begin(), fft.field().end());
  const double scale = sq_nm / HeightMapScatter(map, 550.0).sq_nm();
  for (double& z : map.heights_nm) z *= scale;
  return map;
}

/// Returns the fraction of draws that are specular. Each draw has the weight 1.
inline double specular_draws(const ScatterModel& model, const ScatterEvent& event, Lobe lobe, std::uint32_t seed,
                             std::uint32_t draws) {
  double specular = 0.0;
  for (std::uint32_t k = 0; k < draws; ++k) {
    RandomStream random = stream(seed, k);
    const auto drawn = sample(model, event, {}, lobe, random);
    EXPECT_TRUE(drawn);
    if (!drawn) return NAN;
    EXPECT_EQ(drawn->weight, 1.0);
    specular += drawn->is_specular ? 1.0 : 0.0;
  }
  return specular / draws;
}

/// Compares the specular fraction with closed form 7 in docs/theory/closed_forms.md, both by the formula and by
/// drawing. The fraction is exp(-q^2), with the phase q = 4 pi n s cos t / w in reflection and 2 pi s (n1 cos t1 - n2
/// cos t2) / w in transmission.
inline void expect_closed_form_share(const ScatterModel& model, double sq_nm, const Case& c, std::uint32_t seed,
                                     std::size_t comparisons) {
  constexpr std::uint32_t kDraws = 50000;
  const ScatterEvent& e = c.event;
  const double sine = e.index_from * std::sqrt(1.0 - e.cos_in() * e.cos_in()) / e.index_of(c.lobe);
  const double out = e.index_of(c.lobe) * std::sqrt(1.0 - sine * sine);
  const double paths = e.index_from * e.cos_in() + (c.lobe == Lobe::reflection ? out : -out);
  const double phase = 2.0 * std::numbers::pi * sq_nm * paths / e.wavelength_nm;
  const double p = std::exp(-phase * phase);
  EXPECT_NEAR(specular_fraction(model, e, {}, c.lobe), p, 1e-9) << c.name;
  EXPECT_NEAR(specular_draws(model, e, c.lobe, seed, kDraws), p,
              normal_bound(comparisons) * std::sqrt(p * (1.0 - p) / kDraws) + 1e-9)
      << c.name;
}

}  // namespace retrace::testing::scatter_checks

#pragma once

// The scattered lobe of generalized Harvey-Shack theory as a sum over orders of diffraction: what harvey_shack.h and
// height_map_scatter.h have in common.

#include <functional>
#include <optional>

#include "surface_models/scatter/random_stream.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

/// Logarithm of order!, from a table for the orders that matter. \pre order >= 0
double log_factorial(int order);

/// The scattered light about one specular direction in the generalized Harvey-Shack theory (Krywonos, Harvey, Choi, J.
/// Opt. Soc. Am. A 28, 1121 (2011); two media: Harvey, Choi et al., Proc. SPIE 7794 (2010)).
///
/// Light that leaves with cosine c carries the random phase of variance a = (2 pi s / w)^2 (n1 c1 + n1 c)^2, or
/// (n1 c1 - n2 c)^2 in transmission. Expanding the surface transfer function exp(-a (1 - C / s^2)) in powers of a says
/// that it has been diffracted m times, with Poisson's probability exp(-a) a^m / m!, each time by a spatial frequency
/// drawn from the normalised PSD: in direction cosines, by w / n times that frequency. m = 0 is the specular light.
class PhaseLobe {
 public:
  /// \param event in the frame of the facet
  /// \param sq_nm rms height of the spatial frequencies that scatter
  /// \return nothing where the lobe has no specular direction (total reflection)
  static std::optional<PhaseLobe> make(const ScatterEvent& event, Lobe lobe, double sq_nm);

  double specular_share() const;
  double scattered_share() const;
  const Vec3& specular() const { return specular_; }
  Vec2 specular_beta() const { return specular_.head<2>(); }

  /// Draws the direction cosines of light that has been diffracted `first` times or more. `diffract(m, random)` draws
  /// the sum of m shifts of direction cosines. Exact: proposals that go evanescent are drawn again, so that those that
  /// do not carry all.
  template <class Diffract>
  std::optional<Vec2> sample_scattered(RandomStream& random, Diffract&& diffract, int first = 1) const {
    const double total = envelope_sum(first);
    for (int tries = 0; total > 0.0 && tries < kMaxTries; ++tries) {
      const int order = pick_order(random.next() * total, first);
      const Vec2 beta = specular_beta() + diffract(order, random);
      if (beta.squaredNorm() >= 1.0) continue;
      if (random.next() * envelope(order) < order_probability(order, variance(beta))) return beta;
    }
    return std::nullopt;
  }

  /// Sum over m >= `first` of the probability of m at `beta` times `shift_density(m)`, the density of the sum of m
  /// shifts there.
  template <class ShiftDensity>
  double density(const Vec2& beta, int first, ShiftDensity&& shift_density) const {
    const double a = variance(beta);
    const int begin = std::max(first, first_order(a));
    double probability = order_probability(begin, a);
    double sum = 0.0;
    for (int m = begin; m <= last_order(a); ++m) {
      sum += probability * shift_density(m);
      probability *= a / (m + 1);
    }
    return sum;
  }

  /// Variance of the phase of light that leaves with direction cosines `beta`.
  double variance(const Vec2& beta) const;
  /// Poisson's probability.
  static double order_probability(int order, double variance);

 private:
  static constexpr int kMaxTries = 1000000;

  /// Orders outside these two have probabilities that add less than 1e-16.
  static int first_order(double variance);
  static int last_order(double variance);
  /// Upper bound of the probability of `order` over all directions.
  double envelope(int order) const;
  double envelope_sum(int first) const;
  int pick_order(double cumulative, int first) const;

  Vec3 specular_;
  double phase_per_cos_in_ = 0.0;   ///< rad
  double phase_per_cos_out_ = 0.0;  ///< rad, negative in transmission
  double cos_in_ = 0.0;
  double lowest_ = 0.0, highest_ = 0.0;  ///< variance over all directions
};

/// Integral of `f` over the unit disc of direction cosines, in polar coordinates about `centre` (|centre| < 1), where
/// `f` is concentrated within a few `width`. Relative error about 1e-6 for smooth f.
double integrate_over_disc(const Vec2& centre, double width, const std::function<double(const Vec2&)>& f);

}  // namespace retrace::surface_models

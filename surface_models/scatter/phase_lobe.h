#pragma once

// Scattered lobe of the generalized Harvey-Shack theory as a sum over orders of diffraction. Used by harvey_shack.h and
// height_map_scatter.h.

#include <functional>
#include <optional>

#include "surface_models/scatter/random_stream.h"
#include "surface_models/scatter/scatter_event.h"

namespace retrace::surface_models {

/// Returns the logarithm of order!, from a table for common orders.
/// \pre order >= 0
double log_factorial(int order);

/// Scattered light about one specular direction in the generalized Harvey-Shack theory (Krywonos, Harvey, Choi, J. Opt.
/// Soc. Am. A 28, 1121 (2011); two media: Harvey, Choi et al., Proc. SPIE 7794 (2010)).
///
/// Light that leaves with the cosine c has a random phase of the variance a = (2 pi s / w)^2 (n1 c1 + n1 c)^2 in
/// reflection, or with (n1 c1 - n2 c)^2 in transmission. The surface transfer function exp(-a (1 - C / s^2)) is
/// expanded in powers of a.
/// Term m is light that was diffracted m times. Its probability is exp(-a) a^m / m! (Poisson). Each diffraction shifts
/// the direction cosines by w / n times a spatial frequency, which is drawn from the normalised PSD. The term m = 0 is
/// the specular light.
class PhaseLobe {
 public:
  /// \param event in the frame of the facet
  /// \param sq_nm rms height of the spatial frequencies that scatter
  /// \return nothing if the lobe has no specular direction (total reflection)
  static std::optional<PhaseLobe> make(const ScatterEvent& event, Lobe lobe, double sq_nm);

  double specular_fraction() const;
  double scattered_fraction() const;
  const Vec3& specular() const { return specular_; }
  Vec2 specular_beta() const { return specular_.head<2>(); }

  /// Draws the direction cosines of light that was diffracted at least `first` times. Evanescent proposals are drawn
  /// again, so that the propagating directions carry all power.
  /// \param diffract diffract(m, random) draws the sum of m shifts of the direction cosines
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

  /// Returns the sum over m >= `first` of the probability of order m at `beta` times `shift_density(m)`, the density of
  /// the sum of m shifts.
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

  /// Returns the variance of the phase of light that leaves with the direction cosines `beta`.
  double variance(const Vec2& beta) const;
  /// Returns the probability of an order (Poisson).
  static double order_probability(int order, double variance);

 private:
  static constexpr int kMaxTries = 1000000;

  /// Return the first and the last order of the sum. The probabilities of all other orders add to less than 1e-16.
  static int first_order(double variance);
  static int last_order(double variance);
  /// Returns an upper bound of the probability of `order` over all directions.
  double envelope(int order) const;
  double envelope_sum(int first) const;
  int pick_order(double cumulative, int first) const;

  Vec3 specular_;
  double phase_per_cos_in_ = 0.0;   ///< rad
  double phase_per_cos_out_ = 0.0;  ///< rad, negative in transmission
  double cos_in_ = 0.0;
  double lowest_ = 0.0, highest_ = 0.0;  ///< minimum and maximum variance over all directions
};

/// Returns the integral of `f` over the unit disc of direction cosines, in polar coordinates about `centre` (|centre| <
/// 1). `f` must be concentrated within a few `width` of the centre. The relative error is about 1e-6 for smooth f.
double integrate_over_disc(const Vec2& centre, double width, const std::function<double(const Vec2&)>& f);

}  // namespace retrace::surface_models

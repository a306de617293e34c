#pragma once

// Means over independent replicates of a random run, and standard errors estimated from the spread of the replicates.

#include <cstdint>
#include <vector>

#include "raytrace/light/ledger.h"
#include "raytrace/light/light_setup.h"
#include "raytrace/light/stokes.h"

namespace retrace::raytrace {

/// RRE and ledger for one acceptance cone.
struct ConeResult {
  double half_angle_deg = 0.0;
  double rre = 0.0;
  /// Standard error of `rre` without corrections. It is estimated from the differences between replicates.
  double spread = 0.0;
  /// Standard error of `rre` with corrections. result_of() sets it to `spread`. The engines then enlarge it, so that
  /// the interval `rre` +- 1.96 `std_error` contains the true value in 95 % of cases.
  double std_error = 0.0;
  Stokes stokes;  ///< Stokes parameters of the retroreflected light, with source_axis() as first axis
  Ledger ledger;
};

struct MonteCarloResult {
  std::vector<ConeResult> cones;  ///< in the order given
  /// Sums of the score over the light that leaves, per unit of incident power, and their standard errors.
  std::vector<double> score;
  std::vector<double> score_error;
  /// Area of the incident beam divided by the area of the entrance face, both in plan. It differs from 1 only behind
  /// shells that change the direction of light. Only MonteCarlo::trace() sets it.
  double beam_area_ratio = 1.0;
  std::uint64_t rays = 0;
  std::uint64_t segments = 0;
  std::uint64_t misses = 0;
  bool reached_target = true;
  bool complete = true;  ///< false if cancelled: the results contain only rays traced so far, and none if rays is 0
};

/// Returns the means over independent replicates, and standard errors estimated from their spread.
/// \param rays_per_replicate number of rays in each tally; each ray has the incident power 1
MonteCarloResult result_of(const std::vector<Tally>& replicates, std::uint32_t rays_per_replicate,
                           const std::vector<double>& cones_deg);

/// Returns the standard error of a mean over rays: sqrt(spread^2 + (1.53 largest / rays)^2). The second term allows for
/// paths that no ray has taken.
///
/// Assume that paths of some kind carry a fraction q of the light. The probability that no ray takes such a path is
/// exp(-q rays). It is 5 % for q = 3 / rays (the rule of three). The mean may then be too low by 3 largest / rays. This
/// value must be covered by 1.96 standard errors, which gives the factor 3 / 1.96 = 1.53 (docs/theory/monte_carlo.md).
/// \param spread standard deviation of the mean, estimated from the differences between replicates
/// \param rays number of rays of equal power; for rays with powers p_i, the effective number (sum p_i)^2 / sum p_i^2
/// \param largest maximum value that a single ray can contribute
double with_unsampled_paths(double spread, double rays, double largest = 1.0);

/// Returns the factor by which a standard error from this number of replicates is multiplied. After that, 1.96 standard
/// errors correspond to a confidence of 95 %. The factor is the ratio of the 97.5 % quantiles of Student's t
/// distribution and of the normal distribution.
double student_factor(std::size_t replicates);

/// Returns the largest standard error of all cones.
double largest_error(const MonteCarloResult& result);

}  // namespace retrace::raytrace

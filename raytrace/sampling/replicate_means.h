#pragma once

// Means over independent replicates of a sampled run, and standard errors from their spread.

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
  /// Standard error of `rre`, which is the mean over replicates, estimated from the differences between replicates.
  double spread = 0.0;
  /// Standard error of `rre`. result_of() sets `std_error` to `spread`. The engines then enlarge `std_error` until the
  /// interval `rre` +- 1.96 `std_error` contains the true value in 95 % of cases.
  double std_error = 0.0;
  Stokes stokes;  ///< Stokes parameters of the retroreflected light, with source_axis() as first axis
  Ledger ledger;
};

struct MonteCarloResult {
  std::vector<ConeResult> cones;  ///< in the order given
  /// Of the directions that were scored: sums over what leaves, per unit of incident power, and standard errors.
  std::vector<double> score;
  std::vector<double> score_error;
  std::uint64_t rays = 0;
  std::uint64_t segments = 0;
  std::uint64_t misses = 0;
  bool reached_target = true;
  bool complete = true;  ///< false if it was cancelled: the figures are then of what was traced, none if rays is 0
};

/// Means over independent replicates, and standard errors from their spread.
/// \param rays_per_replicate that each tally is the sum of; of incident power 1 each
MonteCarloResult result_of(const std::vector<Tally>& replicates, std::uint32_t rays_per_replicate,
                           const std::vector<double>& cones_deg);

/// Returns the standard error of a mean over rays, sqrt(spread^2 + (1.53 largest / rays)^2). The second term is an
/// allowance for paths that no ray has taken.
///
/// Suppose that paths of some kind carry a fraction q of the light. The probability that no ray takes such a path is
/// exp(-q rays), which is 5 % for q = 3 / rays (the rule of three). The mean may then be too low by 3 largest / rays.
/// 1.96 standard errors must cover this value. The factor is therefore 3 / 1.96 = 1.53 (docs/theory/monte_carlo.md).
/// \param spread standard deviation of the mean, estimated from the differences between replicates
/// \param rays number of rays of equal power; for rays of powers p_i, the effective number (sum p_i)^2 / sum p_i^2
/// \param largest maximum value that one ray can contribute
double with_unseen(double spread, double rays, double largest = 1.0);

/// By how much the standard error of so few replicates is to be widened for 1.96 of it to hold the truth in 95 of 100
/// cases: the 97.5 % point of Student's distribution over that of the normal one.
double student_factor(std::size_t replicates);

/// The standard error of the cone where it is largest.
double largest_error(const MonteCarloResult& result);

}  // namespace retrace::raytrace

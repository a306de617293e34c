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
  double std_error = 0.0;  ///< from the spread of independent replicates
  Stokes stokes;           ///< of what is retroreflected, along source_axis()
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

/// By how much the standard error of so few replicates is to be widened for 1.96 of it to hold the truth in 95 of 100
/// cases: the 97.5 % point of Student's distribution over that of the normal one.
double student_factor(std::size_t replicates);

/// The standard error of the cone where it is largest.
double largest_error(const MonteCarloResult& result);

}  // namespace retrace::raytrace

#pragma once

// Search for the maximum of a function whose values have random errors. Early steps use values with large errors, and
// later steps use more accurate values. Candidates are compared by differences between values that use common random
// numbers.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "studies/optimise/searched_function.h"

namespace retrace::studies {

/// Maximum change of a parameter by rounding, as a multiple of the distance between neighbouring points of the scan.
inline constexpr double kRoundingBox = 1.5;
/// Maximum distance from the start at which SearchedFunction::peaks_near() searches, as a multiple of the distance
/// between neighbouring points of the scan.
inline constexpr double kPeakBox = 3.0;

/// Settings of search_with_noise().
struct NoisySearchSettings {
  /// Values of ErrorLevel::scale for the scan, for the refinement and for the last comparison.
  double scan_scale = 16.0, refinement_scale = 4.0, last_scale = 2.0;
  std::uint32_t last_replicates = 4;  ///< number of replicates of each point in the last comparison
  std::size_t max_combinations = 3;   ///< maximum number of combinations of discrete values that are refined
  std::size_t max_finalists = 3;      ///< maximum number of points in the last comparison
  std::size_t max_iterations = 12;    ///< maximum number of fitted models for each combination of discrete values
  /// distance between neighbouring points of the scan, as a fraction of the interval
  double spacing = 1.0 / 64.0;
  /// Maximum loss of the objective by rounding if the function has no random errors, as a fraction of the objective.
  double rounding_loss = 1e-6;
};

/// Result of search_with_noise().
struct NoisyOptimum {
  std::optional<SearchPoint> best;  ///< best point; empty if no observed point satisfies all limits
  /// Another point near the observed points may have an objective that is larger by up to this amount, with a
  /// confidence of 95 %. The amount includes the loss by rounding. It is 0 if the function has no random errors.
  double resolution = 0.0;
  bool has_noise = false;        ///< true if the observed values have random errors
  std::size_t observations = 0;  ///< number of observations, where each replicate of a point counts
};

/// Maximizes a function under constraints. The search has these steps:
/// 1. It observes all points of the scan with a large error.
/// 2. Near the best points, it fits quadratic models of the objective and of the constraints. It observes the maximum
/// of the objective's model with a smaller error and repeats this step until the predicted gain is below the error.
/// 3. It compares the last candidates replicate by replicate.
/// 4. It replaces the best point by a point with fewer digits if their objectives do not differ significantly.
/// A function without random errors is searched by the same steps, but each point is observed only one time.
/// \param scan points of the scan, one list for each combination of discrete values
NoisyOptimum search_with_noise(SearchedFunction& function, const std::vector<std::vector<SearchPoint>>& scan,
                               const NoisySearchSettings& settings);

/// Returns a limited number of points from `peaks` that are nearest to `at`, the nearest point first.
std::vector<SearchPoint> nearest_of(std::vector<SearchPoint> peaks, const SearchPoint& at);

/// Returns the mean difference between the objectives of two points, and the standard error of this mean.
/// \param a objective of the first point for each replicate
/// \param b objective of the second point for each replicate, computed with the random numbers of `a`
/// \pre both lists have the same length, which is at least 1
Estimate paired_difference(const std::vector<Estimate>& a, const std::vector<Estimate>& b);

}  // namespace retrace::studies

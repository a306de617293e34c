#pragma once

// Search for the maximum of a function whose values contain random errors. Early steps use large errors, and later
// steps use smaller errors. Candidates are compared by the differences of values that use common random numbers.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "studies/optimise/searched_function.h"

namespace retrace::studies {

/// Maximum change of a value by rounding, as a multiple of the distance between neighbouring points of the scan.
inline constexpr double kRoundingBox = 1.5;
/// Maximum distance between a start and the points of SearchedFunction::peaks_near(), as a multiple of the distance
/// between neighbouring points of the scan.
inline constexpr double kPeakBox = 3.0;

/// Settings of a search.
struct NoisySearchSettings {
  /// Values of ErrorLevel::scale for the first scan, for the refinement and for the last comparison.
  double scan_scale = 16.0, refinement_scale = 4.0, last_scale = 2.0;
  std::uint32_t last_replicates = 4;  ///< number of replicates of the last comparison
  std::size_t max_combinations = 3;   ///< number of combinations of discrete values that are refined
  std::size_t max_finalists = 3;      ///< number of points of the last comparison before rounding
  std::size_t max_iterations = 12;    ///< maximum number of fits for each combination
  double spacing = 1.0 / 64.0;        ///< distance between neighbouring points of the scan
  /// Maximum loss of the objective by rounding for a function without random errors, as a fraction of the objective.
  double rounding_loss = 1e-6;
};

/// Result of a search.
struct NoisyOptimum {
  std::optional<SearchPoint> best;  ///< empty if no observed point satisfies the limits
  /// Upper limit of the difference between the maximum near the observed points and the objective at the best point,
  /// with a confidence of 95 %. The limit includes the loss by rounding. It is 0 if observations have no random errors.
  double resolution = 0.0;
  bool has_noise = false;        ///< true if observations have random errors
  std::size_t observations = 0;  ///< number of observed trials
};

/// Searches for the maximum of a function whose constraints are satisfied. First, the points of the scan are observed
/// with a large error. Near the best points, quadratic models of the objective and of the constraints are fitted to the
/// observations. The maximum of the objective's model is observed with a smaller error. The refinement ends when the
/// model predicts differences below the error. The last candidates are compared replicate by replicate. Finally, the
/// best point is replaced by a point with rounder values if the errors do not distinguish the two points. If a function
/// has no random errors, the same steps are made without repetitions. Tests compare both numbers of observations.
/// \param scan points of the scan for each combination of discrete values
NoisyOptimum search_with_noise(SearchedFunction& function, const std::vector<std::vector<SearchPoint>>& scan,
                               const NoisySearchSettings& settings);

/// Returns the points of `peaks` that are nearest to `at`, the nearest point first. Their number is limited.
std::vector<SearchPoint> nearest_of(std::vector<SearchPoint> peaks, const SearchPoint& at);

/// Returns the mean difference of the objective between two points, and the standard error of this mean.
/// \param a objectives of the first point, one for each replicate
/// \param b objectives of the second point with the same random numbers
/// \pre both lists have the same length >= 1
Estimate paired_difference(const std::vector<Estimate>& a, const std::vector<Estimate>& b);

}  // namespace retrace::studies

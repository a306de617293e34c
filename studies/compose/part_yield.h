#pragma once

// Random parts with zones whose cells have angle errors, and the areas of zones that are optimal for the worst of these
// parts. This file does not depend on optics.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "compute/linear/linear_programme.h"
#include "core/progress.h"
#include "studies/compose/error_response.h"

namespace retrace::studies {

/// Goals of the cells in random parts, indexed by part, zone and goal.
using RandomParts = std::vector<std::vector<std::vector<double>>>;

/// Returns random parts. The angle errors of each zone are random, Gaussian and independent, and they are equal in all
/// cells of the zone.
/// \param responses response of each zone; it already includes the mean effect of further errors that differ from cell
/// to cell
RandomParts random_parts(const std::vector<ErrorResponse>& responses, double sigma_arcmin, std::size_t parts,
                         std::uint32_t seed);

/// Returns the minimum goal of each part for the given fractions of the area.
std::vector<double> min_goals_of(const RandomParts& parts, const std::vector<double>& fractions);

/// Returns the mean of the worst values.
/// \param fraction fraction of the values that counts as the worst, above 0 and at most 1
double mean_of_worst(std::vector<double> values, double fraction);

/// Computes the fractions of the area for which the mean minimum goal of the worst parts is largest. This mean is the
/// conditional value at risk. The problem is a linear programme (Rockafellar and Uryasev 2000) with a row for each part
/// and each goal that may be the minimum.
/// \param bounds bounds of each fraction
/// \return nothing if the computation was cancelled or no fractions are allowed
std::optional<std::vector<double>> best_fractions(const RandomParts& parts, double worst_fraction,
                                                  const compute::Bounds& bounds, const Cancellation* cancel);

/// Cells and their fractions of the area, the largest first.
using CellFractions = std::vector<std::pair<std::size_t, double>>;

/// Searches for the best set of at most `max_zones` cells and for their fractions of the area. The best set has the
/// largest minimum goal of a part, averaged over the worst parts. All sets are tried, so the number of cells must be
/// small.
/// \param parts random parts with one zone for each cell
/// \return nothing if the computation was cancelled or no set is allowed
std::optional<CellFractions> best_set(const RandomParts& parts, double worst_fraction, std::size_t max_zones,
                                      const compute::Bounds& bounds, const Cancellation* cancel);

/// Returns a copy of the random parts that has only the given zones, in the given order.
RandomParts parts_of(const RandomParts& parts, const std::vector<std::size_t>& zones);

}  // namespace retrace::studies

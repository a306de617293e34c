#pragma once

// What errors of angle make of a part of zones: parts that are drawn at random, and the shares that are best for the
// worst of them. Knows nothing of optics.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "studies/compose/error_response.h"
#include "studies/compose/linear_programme.h"

namespace retrace::studies {

/// Goals of each zone's cells in parts that were made: by part, zone and goal.
using DrawnParts = std::vector<std::vector<std::vector<double>>>;

/// Parts whose zones have errors of their own, Gaussian and independent, the same for all cells of a zone.
/// \param responses of the zones, with what spreads from cell to cell in them
DrawnParts drawn_parts(const std::vector<ErrorResponse>& responses, double sigma_arcmin, std::size_t parts,
                       std::uint32_t seed);

/// The least goal of each part that is mixed in these shares.
std::vector<double> leasts_of(const DrawnParts& parts, const std::vector<double>& shares);

/// The mean of the worst of some values: of a share of them, above 0, to 1.
double mean_of_worst(std::vector<double> values, double share);

/// The shares whose parts have the largest mean of the worst of their least goals, a linear programme (Rockafellar and
/// Uryasev 2000): a row for each part and goal that comes into question. \param bounds of a share \return nothing if it
/// was cancelled or no shares are allowed
std::optional<std::vector<double>> best_shares(const DrawnParts& parts, double worst_share, const Bounds& bounds,
                                               const Cancellation* cancel);

/// Cells and their shares, the largest first.
using CellShares = std::vector<std::pair<std::size_t, double>>;

/// Searches for the set of at most `most_zones` cells, and their fractions of the area, for which best_shares() has the
/// best result. All sets of cells are tried, so that there must be few cells.
/// \param parts random parts with one zone for each cell
/// \return nothing if the computation was cancelled or no set is allowed
std::optional<CellShares> best_set(const DrawnParts& parts, double worst_share, std::size_t most_zones,
                                   const Bounds& bounds, const Cancellation* cancel);

/// Returns a copy of the random parts that has only the given zones, in the given order.
DrawnParts parts_of(const DrawnParts& parts, const std::vector<std::size_t>& zones);

}  // namespace retrace::studies

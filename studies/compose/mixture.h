#pragma once

// Computes the best fractions of the area for given cells. The coefficients of a part are area-weighted means of its
// cells' coefficients. The problem is therefore a linear programme. This file does not depend on optics.

#include <cstddef>
#include <limits>
#include <vector>

#include "compute/linear/linear_programme.h"
#include "core/progress.h"

namespace retrace::studies {

/// Values of a part that consists of only one kind of cell.
struct MixedCell {
  std::vector<double> goals;  ///< values whose minimum is maximized
  std::vector<double> means;  ///< values whose means over the part must be within bounds
  double cost = 0.0;          ///< reduction of the merit
};

/// Rules for the fractions of the area.
struct MixtureRules {
  std::vector<compute::Bounds> means = {};                          ///< bounds of the part's means
  double min_fraction = 0.0;                                        ///< minimum fraction of a cell that is used; 0..1
  double max_fraction = 1.0;                                        ///< maximum fraction of each cell; above 0
  std::size_t max_zones = std::numeric_limits<std::size_t>::max();  ///< maximum number of cells that are used
};

/// Dual prices of a mixture: the change of its merit per unit of a constraint. They show which other cell would improve
/// the mixture.
struct MixturePrices {
  std::vector<double> goals;  ///< price of each goal of the part; the sum is 1
  std::vector<double> means;  ///< price of each active bound of a mean; 0 if no bound is active
  double area = 0.0;          ///< price of the constraint that the fractions add up to 1
};

/// Returns the gain of a cell: the increase of the mixture's merit per unit of area that the cell replaces, at the
/// mixture's prices. A mixture with the cell gains at most this value times the fraction of the cell. If no cell has a
/// positive gain, no mixture of the cells is better.
double gain(const MixturePrices& prices, const MixedCell& cell);

struct ZoneFraction {
  std::size_t cell = 0;
  double fraction = 0.0;
};

struct Mixture {
  enum class Kind {
    optimal,     ///< no mixture of these cells is better
    best_found,  ///< the limit on tried sets of cells was reached; `bound` limits the possible improvement
    infeasible,  ///< no mixture satisfies the bounds; `prices.means` are Farkas multipliers
    interrupted
  };
  Kind kind = Kind::infeasible;
  std::vector<ZoneFraction> zones;  ///< cells and their fractions, the largest first
  double min_goal = 0.0;            ///< minimum goal
  double merit = 0.0;               ///< minimum goal minus the cost of the cells
  double bound = 0.0;               ///< upper bound of the merit of any allowed mixture of these cells
  std::vector<double> goals;        ///< goals of the mixture
  std::vector<double> means;
  /// Dual prices of the linear programme that has only the cells of the mixture. If the rules have no limit on zones
  /// and no minimum fraction, they are also dual prices of the linear programme with all cells.
  MixturePrices prices;
  bool is_feasible() const { return kind == Kind::optimal || kind == Kind::best_found; }
};

/// Computes the mixture with the largest merit: the minimum goal minus the cost. A limit on zones and a minimum
/// fraction are enforced by branch and bound over sets of cells. The search is based on the following fact: at any dual
/// prices, a set that is better than the best set found so far contains a cell with a positive gain.
/// \param max_sets maximum number of tried sets
/// \pre all cells have the same number of goals, at least one, and as many means as the rules
Mixture best_mixture(const std::vector<MixedCell>& cells, const MixtureRules& rules,
                     const Cancellation* cancel = nullptr, std::size_t max_sets = 10'000);

/// Rounds the area fractions of a mixture to multiples of a step. Each fraction is rounded up or down. Among all
/// combinations that satisfy the rules, the mixture with the largest merit is returned. If there is no such
/// combination, `mixture` is returned. The upper bound of the merit and the dual prices are copied from `mixture`.
/// \param steps number of steps into which the whole area is divided
/// \pre the mixture is feasible
Mixture rounded_mixture(const std::vector<MixedCell>& cells, const MixtureRules& rules, const Mixture& mixture,
                        std::size_t steps);

}  // namespace retrace::studies

#pragma once

// The best shares of given cells, of which a part is mixed: coefficients of cells add up, weighted by their shares of
// the area, so that the shares are a linear programme. Knows nothing of optics.

#include <cstddef>
#include <limits>
#include <vector>

#include "core/progress.h"
#include "studies/compose/linear_programme.h"

namespace retrace::studies {

/// What a part is that is all of one kind of cell.
struct MixedCell {
  std::vector<double> goals;  ///< each is to be large
  std::vector<double> means;  ///< each is to be within bounds, over the part
  double cost = 0.0;          ///< what it takes from the merit
};

/// What shares may be.
struct MixtureRules {
  std::vector<Bounds> means = {};                                    ///< of the part
  double least_share = 0.0;                                          ///< of a cell that is there; 0..1
  double most_share = 1.0;                                           ///< of each cell; above 0
  std::size_t most_zones = std::numeric_limits<std::size_t>::max();  ///< cells that are there
};

/// What one more of something is worth: by how much the merit of a mixture grows. Together they tell which cell would
/// help.
struct MixturePrices {
  std::vector<double> goals;  ///< what asking one more of the part there would cost; they add to 1
  std::vector<double> means;  ///< what one more of the bound that a mean touches is worth; 0 where it touches none
  double share = 0.0;         ///< what one more of the whole area is worth
};

/// What a share of a cell adds to the merit of the mixture of those prices, per unit, in place of what is there: no
/// mixture with it gains more than that times the share, and one with cells that all gain nothing is none the better.
double gain(const MixturePrices& prices, const MixedCell& cell);

struct ZoneShare {
  std::size_t cell = 0;
  double share = 0.0;
};

struct Mixture {
  enum class Kind {
    optimal,     ///< no mixture of these cells is better
    best_found,  ///< the limit on mixtures that are tried was reached: `bound` says what may be left
    infeasible,  ///< no mixture holds the bounds: `prices.means` are Farkas's multipliers
    interrupted
  };
  Kind kind = Kind::infeasible;
  std::vector<ZoneShare> zones;  ///< the largest first
  double least = 0.0;            ///< of the goals
  double merit = 0.0;            ///< that less the cost of the shares
  double bound = 0.0;            ///< on the merit of any mixture of these cells that the rules allow
  std::vector<double> goals;     ///< of the mixture
  std::vector<double> means;
  MixturePrices prices;  ///< among the cells of the mixture; without a limit on zones or a least share: among all
  bool is_there() const { return kind == Kind::optimal || kind == Kind::best_found; }
};

/// The mixture whose least goal, less its cost, is largest. A limit on zones and a least share are held by branch and
/// bound over sets of cells: whatever prices are taken, a better set has a cell that is better by them. \param
/// most_sets that are tried \pre cells of equally many goals, one or more, and means as many as the rules
Mixture best_mixture(const std::vector<MixedCell>& cells, const MixtureRules& rules,
                     const Cancellation* cancel = nullptr, std::size_t most_sets = 10'000);

}  // namespace retrace::studies

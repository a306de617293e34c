#pragma once

// Composes a part whose zones have different cells. The study selects designs of a family and their fractions of the
// area, so that the minimum of all goals is as large as possible. `retrace compose` runs this study.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "studies/compose/mixture.h"
#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Standard deviations of random errors of the angles between facets, in minutes of arc. All errors are Gaussian and
/// independent.
struct ErrorSpread {
  double cell_sigma_arcmin = 0.0;  ///< standard deviation from cell to cell; these errors average out over a zone
  double zone_sigma_arcmin = 0.0;  ///< standard deviation from zone to zone; all cells of a zone have the same error
  std::size_t parts = 1024;        ///< number of random parts
  /// Fraction of the random parts that counts as the worst. If it is given, a further part is optimized for these worst
  /// parts.
  std::optional<double> worst_fraction;
};

struct ComposeRequest {
  std::vector<std::string> goals;            ///< quantities whose minimum is maximized
  std::vector<Constraint> cell_constraints;  ///< constraints that each cell of the family must satisfy
  std::vector<Constraint> part_constraints;  ///< constraints on means over the part
  /// Costs, such as the price of an hour of machining. Each pair contains a quantity and the amount by which the merit
  /// decreases per unit of the quantity's mean. Costs are inputs, whereas the dual prices (MixturePrices) are results.
  std::vector<std::pair<std::string, double>> price;
  /// Quantity whose mean is one axis of the Pareto front. The minimum goal is the other axis.
  std::optional<FrontAxis> front;
  std::size_t front_points = 9;
  std::optional<double> min_goal;  ///< minimum goal that a part must reach
  double min_area_fraction = 0.0;  ///< minimum fraction of the area for a zone
  double max_area_fraction = 1.0;
  std::optional<std::size_t> max_zones;  ///< maximum number of zones; no limit if empty
  /// Number of equal steps into which the whole area is divided. The area fractions of the best part are multiples of
  /// one step. Empty: the largest step is used that lowers the merit by less than its standard error.
  std::optional<std::size_t> area_steps;
  std::size_t scan = 65;           ///< number of cells in the first scan, for each combination of discrete values
  std::size_t rounds = 4;          ///< maximum number of searches with dual prices
  std::size_t starts = 3;          ///< number of cells at which each search with dual prices starts
  int evaluations_per_start = 20;  ///< maximum number of evaluated cell designs per search
  std::optional<ErrorSpread> errors;
};

/// Cell of the family: a design that has been evaluated.
struct FamilyCell {
  std::uint64_t point = 0;  ///< number of the point in the store
  PointValues values;
  MixedCell mixed;  ///< values of the goals, in the order of the request, and values whose means over the part are
                    ///< used: first those for `part_constraints`, then that for `front`
  std::vector<double> goal_errors = {};  ///< standard errors of the goals
};

struct Zone {
  FamilyCell cell;
  double area_fraction = 0.0;
};

/// Best part with a limited number of zones.
struct PartOfZones {
  std::vector<Zone> zones;    ///< zones, the largest first
  Mixture mixture;            ///< mixture whose cells are indices in Composition::catalogue
  std::size_t max_zones = 0;  ///< maximum number of zones
};

/// Part on the Pareto front of two values: the mean of a quantity, and the minimum goal.
struct FrontPart {
  double mean = 0.0;
  double min_goal = 0.0;
  std::vector<Zone> zones;
};

/// Yield of random parts.
struct PartYield {
  std::vector<double> min_goals;    ///< minimum goal of each part, in ascending order
  std::optional<std::size_t> good;  ///< number of parts that reach ComposeRequest::min_goal
  std::optional<double>
      mean_of_worst;  ///< mean of the minimum goal over the fraction ErrorSpread::worst_fraction of the parts
};

/// Composition that is optimized for the worst random parts: the mean of the minimum goal over these parts is maximal.
/// Its cells are chosen from the best compositions of all numbers of zones.
struct RobustPart {
  std::vector<Zone> zones;  ///< zones, the largest first
  PartYield yield;
};

/// Effects on a part if the angles between its facets have errors.
struct ErrorEffects {
  std::vector<double> goals;  ///< goals of the part with errors from cell to cell only
  /// Derivatives of the minimum goal with respect to the angle errors, per arcmin, indexed by zone and angle. They
  /// include the effect of re-optimized areas.
  std::vector<std::vector<double>> slopes;
  PartYield yield;
  std::optional<RobustPart> robust_part;
  /// Error of the part's goals that arises because the goals of cells are approximated by polynomials in the angle
  /// errors. It is the area-weighted mean of the maximum errors that were found for the cells of the zones.
  double approximation_error = 0.0;
};

/// Proof of optimality of the part.
enum class Proof {
  family,     ///< the whole family was evaluated, and no part composed of its cells is better
  catalogue,  ///< no part composed of the evaluated cells is better
  none        ///< the search among the evaluated cells ended at a limit
};

struct Composition {
  std::vector<FamilyCell> catalogue;  ///< all cells that satisfy the constraints, in the order of their evaluation
  std::optional<PartOfZones> best;    ///< none if no mixture satisfies the bounds
  std::string infeasible_reason;      ///< bounds that exclude all mixtures; empty if there is a best part
  /// Indices of those bounds over the part (see ComposeRequest::part_constraints) that together exclude all mixtures.
  /// Empty if there is a best part, or if the mixtures are excluded for other reasons, such as limits on zones.
  std::vector<std::size_t> infeasible_bounds;
  /// Cell of the best part that has only one kind of cell. Its search ignores the prices and the constraints on means.
  std::optional<FamilyCell> single;
  Proof proof = Proof::none;
  bool has_converged = false;         ///< true if the last search by dual prices found no cell with a positive gain
  double unlimited_merit = 0.0;       ///< merit without limits on the number and the areas of zones
  std::vector<PartOfZones> by_zones;  ///< best parts of at most 1, 2, ... zones, up to one zone more than `best` has
  std::vector<FrontPart> front;
  std::optional<ErrorEffects> errors;
  std::size_t failed = 0;  ///< number of designs that could not be computed
  std::string first_failure;
  std::size_t evaluations = 0;
  bool complete = true;
};

/// Returns the zones of the composition that is optimized for the worst random parts. Returns an empty list if there is
/// none.
std::vector<Zone> robust_zones(const Composition& composition);

/// Returns the layout of the store for the evaluated cells. It does not depend on the constraints and objectives of
/// the study, so that compositions with other goals can use the same store.
compute::StoreLayout compose_layout(const Study& study);

/// Returns the cells of the first scan as points of a sweep, so that they can be computed before the search.
/// \throw InputError for too many combinations of discrete values
Sweep compose_scan(const Study& study, const ComposeRequest& request);

/// Chooses the best part after an interrupted search, from all cells in the store. These include the cells that the
/// search has evaluated.
/// \pre compose() has returned an incomplete composition
void choose_best_so_far(const Study& study, const ComposeRequest& request, compute::ResultStore& store,
                        Composition& composition);

/// Searches for the mixture of cells that makes the best part:
/// 1. The family of cells is scanned, and optimise() improves the best cells of the scan.
/// 2. Cells are added that improve the mixture according to the dual prices of its linear programme (column
/// generation). This step ends when no further cell improves the mixture.
/// Cells that are already in the store are not computed again, and the result is the same. An interrupted search
/// returns its catalogue of cells without a part. While the search runs, `observer` receives the best part so far that
/// consists of one kind of cell.
/// \throw OutputError under the same conditions as ResultStore::record()
Composition compose(const Study& study, const ComposeRequest& request, compute::ResultStore& store,
                    OptimiseObserver* observer, const Cancellation* cancel);

}  // namespace retrace::studies

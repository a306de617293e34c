#pragma once

// Searches the parameters of a study for the best design under constraints. Also computes by how much each parameter
// may deviate before the objective becomes worse.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compute/store/store.h"
#include "core/progress.h"
#include "studies/quantity/constraint.h"
#include "studies/quantity/study.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// Objective that is maximized: a weighted sum of quantities. Negative weights minimize a quantity.
struct Objective {
  std::vector<std::pair<std::string, double>> weights;
  bool uses_minimum = false;  ///< true: the minimum of the weighted quantities replaces their sum
};

/// Axis of the Pareto front.
struct FrontAxis {
  std::string quantity;
  bool is_maximized = true;  ///< true: large values are good; false: small values are good
};

struct OptimiseRequest {
  Objective objective;
  std::vector<Constraint> constraints;
  std::vector<FrontAxis> front;
  std::size_t scan = 65;               ///< number of designs in the first scan, for each combination of discrete values
  std::vector<std::string> band_keys;  ///< keys whose tolerance bands are requested
  double band_loss = 0.01;             ///< relative loss of the objective at which a tolerance band ends
  /// true: the parameters of the best design are rounded to values with few digits
  bool is_rounded = true;
  /// True: designs are evaluated at several levels of accuracy (ErrorLevel). The store then contains the level of each
  /// result.
  bool has_levels = true;
};

/// Evaluated design with its results.
struct Variant {
  std::uint64_t number = 0;  ///< number of the design's point in the result store
  PointValues values;        ///< values of the parameters, in the order of the study
  bool failed = false;
  std::string reason;  ///< error message if the computation failed
  std::vector<compute::StoredOutput> outputs;
  std::optional<double> objective;  ///< none if the computation failed or a quantity has no value
  double objective_error = 0.0;     ///< standard error of the objective
  std::vector<std::size_t> broken;  ///< indices of the violated constraints
  bool feasible() const { return objective.has_value() && broken.empty(); }
  /// Returns the objective minus twice its standard error. Designs with random errors are compared by this value.
  /// \pre the design has an objective
  double cautious_objective() const { return *objective - 2.0 * objective_error; }
};

/// Design that was not chosen, and the reason.
struct Rejected {
  Variant variant;
  std::string role;  ///< relation to the chosen design
  std::string why;
};

/// Range of a key within which the relative loss of the objective is below `band_loss`.
struct ToleranceBand {
  std::string key;
  double nominal = 0.0;
  /// Maximum decrease of the value (`down`) and maximum increase (`up`). None if the value cannot be changed so far
  /// that the objective loses `band_loss`.
  std::optional<double> down;
  std::optional<double> up;
};

/// Number of evaluated designs that violate a constraint, and smallest violation of that constraint.
struct Exclusion {
  std::size_t designs = 0;  ///< number of designs that violate the constraint
  /// Smallest violation over all evaluated designs; infinite if the constrained quantity has no value for any design.
  double min_violation = std::numeric_limits<double>::infinity();
};

struct Optimum {
  std::optional<Variant> best;    ///< none if no design is feasible
  std::string infeasible_reason;  ///< text that explains why no design is feasible; empty if there is a best design
  /// Effect of each constraint, in the order of the constraints. Empty if there is a best design.
  std::vector<Exclusion> exclusions;
  std::vector<Variant> front;  ///< Pareto front: feasible designs that no other design dominates
  /// All evaluated designs in the order of their first evaluation. Each design has its most accurate results.
  std::vector<Variant> designs;
  /// Another design near the evaluated designs may be better than `best` by up to this amount, with a confidence of 95
  /// %. It is 0 if the objective has no random error.
  double resolution = 0.0;
  std::vector<Rejected> rejected;
  /// Cheaper alternative to the best design. Among the designs of the Pareto front that lose at most 1 % of the
  /// objective, it is the best on the first axis that is not part of the objective.
  std::optional<Variant> cheaper;
  std::vector<ToleranceBand> bands;
  std::string method;  ///< method of the refinement: "exact slopes", "no slopes" or "paired comparison"
  std::size_t budget_failures =
      0;  ///< number of designs that failed because the budget of memory or beams was exhausted
  std::string budget_failure_reason;  ///< error message of the first design that `budget_failures` counts
  bool complete = true;
};

/// Receives the number of designs that have been evaluated.
class OptimiseObserver {
 public:
  virtual ~OptimiseObserver() = default;
  virtual void at(std::size_t evaluated) = 0;
  /// Reports a feasible design that is better than all previously reported designs. Designs are compared by
  /// Variant::cautious_objective(). Two threads never call this function at the same time.
  virtual void at_best(const Variant& best) { static_cast<void>(best); }
  /// Reports the progress of a group of designs that are evaluated together.
  /// \param fraction finished fraction of the group; 0 when the group begins
  /// \param designs number of designs in the group
  virtual void at_group(double fraction, std::size_t designs) {
    static_cast<void>(fraction);
    static_cast<void>(designs);
  }
};

compute::StoreLayout optimise_layout(const Study& study);

/// Returns the designs of the first scan as points of a sweep, so that they can be computed before the search. The
/// search then finds them in the store.
/// \throw InputError for too many combinations of discrete values
Sweep optimise_scan(const Study& study, const OptimiseRequest& request);

/// Searches for the best design. The search has these steps:
/// 1. A scan evaluates every combination of discrete values, each with a set of values of the continuous parameters.
/// 2. For a single continuous parameter, bisection locates the values at which a constraint begins to be violated.
/// 3. The best designs are refined, within the intervals of the parameters and the constraints.
/// 4. The parameters are rounded if the objective does not decrease significantly.
/// If quantities have random errors, search_with_noise() replaces steps 2 to 4. Designs in the store are not computed
/// again, and the result does not depend on whether they were stored. After an interruption, the result contains all
/// designs of the store.
/// \throw OutputError if a result cannot be stored
Optimum optimise(const Study& study, const OptimiseRequest& request, compute::ResultStore& store,
                 OptimiseObserver* observer, const Cancellation* cancel);

}  // namespace retrace::studies

#pragma once

// Searches the parameters of a study for the best candidate under constraints, and how far each parameter may be off
// before the objective suffers.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "studies/quantity/constraint.h"
#include "studies/quantity/study.h"
#include "studies/store/store.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// What is to be as large as it can be: a weighted sum of quantities, negative weights for what is to be small.
struct Objective {
  std::vector<std::pair<std::string, double>> weights;
  bool is_least = false;  ///< the least of the weighted quantities, in place of their sum
};

/// A quantity of the Pareto front.
struct FrontAxis {
  std::string quantity;
  bool largest = true;  ///< is best
};

struct OptimiseRequest {
  Objective objective;
  std::vector<Constraint> constraints;
  std::vector<FrontAxis> front;
  std::size_t scan = 65;              ///< designs of the first look, for each combination of discrete values
  std::vector<std::string> bands_of;  ///< keys whose tolerance bands are requested
  double band_loss = 0.01;            ///< relative loss of the objective that ends a band
};

/// A design that was looked at.
struct Variant {
  std::uint64_t number = 0;  ///< of its point in the store
  PointValues values;        ///< of the parameters, in their order
  bool failed = false;
  std::string reason;  ///< why it failed
  std::vector<StoredOutput> outputs;
  std::optional<double> objective;  ///< none if it failed or a quantity of it has no value
  std::vector<std::size_t> broken;  ///< constraints, by number
  bool feasible() const { return objective.has_value() && broken.empty(); }
};

/// A design that was not chosen, and why.
struct Rejected {
  Variant variant;
  std::string role;  ///< how it stands to the chosen one
  std::string why;
};

/// How far a key may be off before the objective has lost `band_loss`.
struct ToleranceBand {
  std::string key;
  double nominal = 0.0;
  std::optional<double> down;  ///< largest loss-free change to smaller values; none: no loss that far, or not possible
  std::optional<double> up;
};

struct Optimum {
  std::optional<Variant> best;  ///< none if no design is feasible
  std::string none_because;     ///< which constraint excludes all
  std::vector<Variant> front;   ///< feasible designs that no other dominates
  std::vector<Rejected> rejected;
  std::optional<Variant> cheaper;  ///< within 1 % of the objective, the best of the front's other axes
  std::vector<ToleranceBand> bands;
  std::string method;  ///< of the refinement: "exact slopes" or "no slopes"
  std::size_t evaluations = 0;
  std::size_t ran_out = 0;      ///< number of designs that failed because the budget of memory or beams was exhausted
  std::string ran_out_because;  ///< error message of the first of the designs that `ran_out` counts
  bool complete = true;
};

/// Told how many designs have been looked at.
class OptimiseObserver {
 public:
  virtual ~OptimiseObserver() = default;
  virtual void at(std::size_t evaluated) = 0;
  /// Reports the progress of a group of designs that are evaluated together.
  /// \param share finished fraction of the group; 0 when the group begins
  /// \param designs number of designs in the group
  virtual void at_group(double share, std::size_t designs) {
    static_cast<void>(share);
    static_cast<void>(designs);
  }
};

StoreLayout optimise_layout(const Study& study);

/// The designs of the first look as points of a sweep, for who wants them in the store before the search: it finds them
/// there. \throw InputError for too many combinations of discrete values
Sweep optimise_scan(const Study& study, const OptimiseRequest& request);

/// Searches for the best design. The search scans every combination of discrete values and a grid of continuous values.
/// It then follows the edges of the feasible region and refines the best designs within bounds and constraints.
/// Finally, values are rounded if this does not make the design worse. Designs that are already in the store are not
/// computed again, and the result is the same.
/// \throw OutputError as ResultStore::record()
Optimum optimise(const Study& study, const OptimiseRequest& request, ResultStore& store, OptimiseObserver* observer,
                 const Cancellation* cancel);

}  // namespace retrace::studies

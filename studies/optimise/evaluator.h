#pragma once

// Evaluates the designs of all stages of a search: first scan, refinement and neighbours of the best design. Each
// design is computed only one time; results in the store are used again.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Thrown to end an optimization that was cancelled.
struct Interrupted {};

/// Evaluates designs: takes their results from the store or computes them, and checks the constraints.
class Evaluator {
 public:
  Evaluator(const Study& study, const OptimiseRequest& request, compute::ResultStore& store, OptimiseObserver* observer,
            const Cancellation* cancel);

  /// Evaluates designs and returns the results in the given order. Several designs are computed in parallel.
  /// \param level accuracy of the results
  /// \throw Interrupted if the search was cancelled
  /// \throw OutputError if a result cannot be stored
  std::vector<Variant> evaluate(const std::vector<PointValues>& designs, const ErrorLevel& level = {});
  Variant evaluate(const PointValues& design, const ErrorLevel& level = {}) {
    return evaluate(std::vector<PointValues>{design}, level).front();
  }
  /// Adds designs from the store that this search has not evaluated, for example designs of an earlier run.
  void add_stored();
  /// Returns the most accurate result of an evaluated design: the mean of all results with the smallest target error.
  const Variant& most_accurate(const PointValues& design) const { return evaluated_[numbers_.at(key_of(design))]; }
  /// Adds designs that another search of this study has evaluated. They are not evaluated again.
  void add_evaluated(const std::vector<Variant>& seen);

  /// Returns all designs evaluated so far, in the order of their first evaluation.
  const std::vector<Variant>& evaluated() const { return evaluated_; }
  /// Returns the number of designs that failed because the budget of memory or beams was exhausted. Such designs are
  /// not stored, so that a resumed search with a larger budget evaluates them again.
  std::size_t budget_failures() const { return budget_failures_; }
  /// Returns the error message of the first design that exhausted the budget. Empty if there is none.
  const std::string& budget_failure_reason() const { return budget_failure_reason_; }
  /// Returns the value of a quantity, or nothing if the quantity has no value for this design.
  std::optional<double> value(const Variant& variant, const std::string& quantity) const;
  /// Returns the standard error of a quantity for a design.
  double error_of(const Variant& variant, const std::string& quantity) const;
  /// Returns the derivative (slope) of the objective with respect to a parameter. Returns nothing if the derivative of
  /// a quantity of the objective cannot be computed.
  std::optional<double> slope(const PointValues& design, std::size_t parameter) const;

 private:
  static std::string key_of(const PointValues& design);
  std::string key_of(const PointValues& design, const ErrorLevel& level) const;
  const Study& study_at(const ErrorLevel& level);
  void keep(const PointValues& design, const ErrorLevel& level, const compute::StoredPoint& point);
  void report_best(const Variant& variant);
  Variant mean_of(const std::map<ErrorLevel, Variant>& results) const;
  std::uint64_t free_number();
  void check_constraints(Variant& variant) const;
  Variant variant_of(const compute::StoredPoint& point, const PointValues& design) const;

  const Study& study_;
  const OptimiseRequest& request_;
  compute::ResultStore& store_;
  OptimiseObserver* observer_;
  const Cancellation* cancel_;
  /// Index of each evaluated design in `evaluated_`. The key is a string that contains the values of all parameters.
  std::map<std::string, std::size_t> numbers_;
  /// Results of an earlier run. The key is a string that contains the values of all parameters and the level of
  /// accuracy.
  std::map<std::string, compute::StoredPoint> stored_;
  std::map<ErrorLevel, Study> studies_;  ///< study adapted to each level of accuracy
  /// Results of each design for each level of accuracy. The key is a string that contains the values of all parameters.
  std::map<std::string, std::map<ErrorLevel, Variant>> by_level_;
  /// cautious objective of the best reported design (Variant::cautious_objective())
  std::optional<double> best_value_;
  std::vector<Variant> evaluated_;
  std::set<std::uint64_t> used_numbers_;  ///< numbers of the points in the store
  std::size_t budget_failures_ = 0;
  std::string budget_failure_reason_;
  std::uint64_t next_ = 0;
};

/// Runs the search of optimise() with an existing evaluator of the study and the request. Afterwards, `evaluator`
/// contains all designs that the search has evaluated.
Optimum optimise(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Cancellation* cancel);

}  // namespace retrace::studies

#pragma once

// Computes and judges candidates for all stages of a search, each point only once: what a store has is looked up.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "studies/optimise/optimise.h"

namespace retrace::studies {

/// Ends an optimisation that was cancelled.
struct Interrupted {};

/// Looks designs up in the store, computes what it lacks, and judges them.
class Evaluator {
 public:
  Evaluator(const Study& study, const OptimiseRequest& request, ResultStore& store, OptimiseObserver* observer,
            const Cancellation* cancel);

  /// The designs, in the order given; several are computed at a time. \throw Interrupted, OutputError
  std::vector<Variant> look_at(const std::vector<PointValues>& designs);
  Variant look_at(const PointValues& design) { return look_at(std::vector<PointValues>{design}).front(); }
  /// Adds designs that another search of this study has evaluated. They are not evaluated again.
  void take_in(const std::vector<Variant>& seen);

  /// Everything looked at so far, in the order of its first look.
  const std::vector<Variant>& seen() const { return seen_; }
  /// Returns the number of designs that failed because the budget of memory or beams was exhausted. Such designs are
  /// not stored, so that a resumed search with a larger budget evaluates them again.
  std::size_t ran_out() const { return ran_out_; }
  /// Returns the error message of the first design that exhausted the budget. Empty if there is none.
  const std::string& ran_out_because() const { return ran_out_because_; }
  /// What a quantity came to; nothing if it has no value.
  std::optional<double> value(const Variant& variant, const std::string& quantity) const;
  /// Slope of the objective by a parameter, where every quantity in it knows one.
  std::optional<double> slope(const PointValues& design, std::size_t parameter) const;

 private:
  static std::string key_of(const PointValues& design);
  std::uint64_t free_number();
  void judge(Variant& variant) const;
  Variant variant_of(const StoredPoint& point, const PointValues& design) const;

  const Study& study_;
  const OptimiseRequest& request_;
  ResultStore& store_;
  OptimiseObserver* observer_;
  const Cancellation* cancel_;
  std::map<std::string, std::size_t> numbers_;  ///< in seen_, by values
  std::map<std::string, StoredPoint> stored_;   ///< of a run that is resumed
  std::vector<Variant> seen_;
  std::set<std::uint64_t> taken_;  ///< numbers of the points in the store
  std::size_t ran_out_ = 0;
  std::string ran_out_because_;
  std::uint64_t next_ = 0;
};

/// Runs the search of optimise() with an existing evaluator of the study and the request. Afterwards, `evaluator`
/// contains all designs that the search has evaluated.
Optimum optimise(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Cancellation* cancel);

}  // namespace retrace::studies

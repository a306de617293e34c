#include "studies/optimise/refine.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <nlopt.hpp>
#include <utility>

namespace retrace::studies {

double fraction_of(const Interval& interval, double value) {
  if (interval.logarithmic) return std::log(value / interval.from) / std::log(interval.to / interval.from);
  return (value - interval.from) / (interval.to - interval.from);
}

namespace {

/// Maximum number of computed derivatives (slopes). A derivative takes about as much time as a hundred evaluations.
constexpr int kMaxDerivatives = 12;
constexpr double kSmallestStep = 1e-8;
constexpr double kDifference = 1e-6;

/// Thrown if a required derivative (slope) is not available.
struct NoSlope {};

/// Optimization problem for NLopt. A design is a vector of its continuous parameters, each as a fraction of its
/// interval.
class Problem {
 public:
  Problem(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Variant& from)
      : study_(study),
        request_(request),
        evaluator_(evaluator),
        design_(from.values),
        fallback_(*from.objective - 1.0) {
    for (std::size_t k = 0; k < study.parameters.size(); ++k)
      if (study.parameters[k].interval) continuous_.push_back(k);
  }

  std::exception_ptr thrown;  ///< exception of the last evaluation that NLopt requested

  std::size_t dimensions() const { return continuous_.size(); }

  std::vector<double> fractions() const {
    std::vector<double> shares;
    for (const std::size_t k : continuous_)
      shares.push_back(
          std::clamp(fraction_of(*study_.parameters[k].interval, std::get<double>(design_[k].shown)), 0.0, 1.0));
    return shares;
  }

  PointValues design(const std::vector<double>& shares) const {
    PointValues values = design_;
    for (std::size_t k = 0; k < continuous_.size(); ++k)
      values[continuous_[k]] = Parameter::value_of(study_.parameters[continuous_[k]].interval->at(shares[k]));
    return values;
  }

  double objective(const std::vector<double>& shares, std::vector<double>& gradient) {
    const PointValues values = design(shares);
    const Variant variant = evaluator_.evaluate(values);
    for (std::size_t k = 0; k < gradient.size(); ++k) {
      const std::optional<double> slope = evaluator_.slope(values, continuous_[k]);
      if (!slope) throw NoSlope{};
      const Interval& interval = *study_.parameters[continuous_[k]].interval;
      const double per_share = interval.logarithmic ? interval.at(shares[k]) * std::log(interval.to / interval.from)
                                                    : interval.to - interval.from;
      gradient[k] = *slope * per_share;
    }
    return variant.objective.value_or(fallback_);
  }

  /// Returns by how much a design exceeds one limit of a constraint; <= 0 if the limit is satisfied.
  double excess(const std::vector<double>& shares, const Constraint& constraint, bool most) {
    const std::optional<double> value = evaluator_.value(evaluator_.evaluate(design(shares)), constraint.quantity);
    if (!value) return 1.0;
    return most ? *value - *constraint.max : *constraint.min - *value;
  }

 private:
  const Study& study_;
  const OptimiseRequest& request_;
  Evaluator& evaluator_;
  PointValues design_;
  double fallback_;
  std::vector<std::size_t> continuous_;
};

/// One limit of a constraint, as data for NLopt.
struct Side {
  Problem* problem = nullptr;
  const Constraint* constraint = nullptr;
  bool most = false;
};

double excess(const Side& side, const std::vector<double>& shares, std::vector<double>& gradient) {
  const double here = side.problem->excess(shares, *side.constraint, side.most);
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    std::vector<double> beside = shares;
    const double step = shares[k] > 0.5 ? -kDifference : kDifference;
    beside[k] += step;
    gradient[k] = (side.problem->excess(beside, *side.constraint, side.most) - here) / step;
  }
  return here;
}

/// Runs a function that NLopt calls. NLopt discards exceptions. Therefore the exception is stored, and the search is
/// stopped.
template <class Work>
double kept(Problem& problem, Work work) {
  try {
    return work();
  } catch (...) {
    problem.thrown = std::current_exception();
    throw nlopt::forced_stop();
  }
}

double objective_for_nlopt(const std::vector<double>& shares, std::vector<double>& gradient, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  return kept(problem, [&] { return problem.objective(shares, gradient); });
}

double excess_for_nlopt(const std::vector<double>& shares, std::vector<double>& gradient, void* data) {
  const auto& side = *static_cast<const Side*>(data);
  return kept(*side.problem, [&] { return excess(side, shares, gradient); });
}

std::vector<Side> sides_of(const OptimiseRequest& request, Problem& problem) {
  std::vector<Side> sides;
  for (const Constraint& constraint : request.constraints) {
    if (constraint.min) sides.push_back({&problem, &constraint, false});
    if (constraint.max) sides.push_back({&problem, &constraint, true});
  }
  return sides;
}

void run(nlopt::algorithm algorithm, const OptimiseRequest& request, Problem& problem, const RefineLimits& limits) {
  nlopt::opt optimiser(algorithm, static_cast<unsigned>(problem.dimensions()));
  optimiser.set_lower_bounds(0.0);
  optimiser.set_upper_bounds(1.0);
  optimiser.set_max_objective(objective_for_nlopt, &problem);
  std::vector<Side> sides = sides_of(request, problem);
  for (Side& side : sides) optimiser.add_inequality_constraint(excess_for_nlopt, &side, 1e-12);
  optimiser.set_maxeval(algorithm == nlopt::LN_COBYLA ? limits.max_evaluations : kMaxDerivatives);
  optimiser.set_xtol_abs(kSmallestStep);
  if (algorithm == nlopt::LN_COBYLA) optimiser.set_initial_step(limits.first_step);
  std::vector<double> shares = problem.fractions();
  double best = 0.0;
  try {
    optimiser.optimize(shares, best);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    // NLopt has failed. The search continues with the designs that NLopt has evaluated.
  }
  if (problem.thrown) std::rethrow_exception(std::exchange(problem.thrown, nullptr));
}

}  // namespace

bool refine(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Variant& from,
            const RefineLimits& limits) {
  Problem problem(study, request, evaluator, from);
  if (problem.dimensions() == 0) return false;
  bool has_slopes = true;
  try {
    run(nlopt::LD_SLSQP, request, problem, limits);
  } catch (const NoSlope&) {
    has_slopes = false;
  }
  // Methods with derivatives find the maximum of a smooth function. A second search without derivatives also handles
  // kinks.
  run(nlopt::LN_COBYLA, request, problem, limits);
  return has_slopes;
}

}  // namespace retrace::studies

#include "studies/optimise/optimise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "studies/optimise/bands.h"
#include "studies/optimise/design_function.h"
#include "studies/optimise/evaluator.h"
#include "studies/optimise/noisy_search.h"
#include "studies/optimise/refine.h"

namespace retrace::studies {
namespace {

/// Maximum loss of the objective for which a cheaper design is proposed, as a fraction of the objective.
constexpr double kNearlyAsGood = 0.01;
/// Minimum gain for which a cheaper design is proposed. It is measured on the axis of the Pareto front, as a fraction
/// of the best design's value on this axis.
constexpr double kWorthIt = 1e-3;
/// Settings of a search with random errors. Searches without random errors use some of these settings, too.
constexpr NoisySearchSettings kSearch;
constexpr const char* kStoreKind = "retrace.optimum/2";
constexpr const char* kLevelInputs[] = {"error_scale", "replicate"};

}  // namespace

compute::StoreLayout optimise_layout(const Study& study) {
  compute::StoreLayout layout{kStoreKind, study.source, study.parts, {}, {}};
  for (const Parameter& parameter : study.parameters) layout.inputs.push_back(parameter.name);
  for (const char* const input : kLevelInputs) layout.inputs.emplace_back(input);
  for (const auto& quantity : study.quantities) layout.outputs.push_back(quantity->name());
  layout.fault_of = [study](const compute::StoredPoint& point) -> std::string {
    return values_of(study, point.inputs) ? "" : "its values are not allowed by the parameters of the study";
  };
  return layout;
}

namespace {

bool is_better(const Variant& a, const Variant& b) {
  return *a.objective > *b.objective;
}

/// Returns ErrorLevel::scale of the first scan: its target error as a multiple of the target error of the study.
double scan_scale(const Study& study, const OptimiseRequest& request) {
  return request.has_levels && may_be_noisy(study) ? kSearch.scan_scale : 1.0;
}

/// All designs of the first scan, as points of a sweep.
class ScannedPoints : public PointPlan {
 public:
  ScannedPoints(const Study& study, const OptimiseRequest& request) {
    const Scan scan(study, request);
    for (std::size_t combination = 0; combination < scan.combinations().size(); ++combination)
      for (PointValues& design : scan.of(combination)) points_.push_back(std::move(design));
  }
  std::uint64_t size() const override { return points_.size(); }
  PointValues values(std::uint64_t point) const override { return points_[point]; }

 private:
  std::vector<PointValues> points_;
};

/// Search for the best design, from the first scan to the result.
class DesignSearch {
 public:
  DesignSearch(const Study& study, const OptimiseRequest& request, Evaluator& evaluator)
      : study_(study),
        request_(request),
        evaluator_(evaluator),
        scan_(study, request),
        function_(study, request, scan_, evaluator),
        continuous_(scan_.continuous()) {}

  /// Runs the search. Returns the best design, or nothing if none is feasible.
  std::optional<Variant> run(Optimum& optimum) {
    const double scale = scan_scale(study_, request_);
    bool is_noisy = false;
    for (std::size_t combination = 0; combination < scan_.combinations().size(); ++combination)
      for (const Variant& variant : evaluator_.evaluate(scan_.of(combination), {scale, 0}))
        is_noisy = is_noisy || has_noise(variant);
    return is_noisy && request_.has_levels ? run_with_noise(scale, optimum) : run_without_noise(optimum);
  }

  /// Returns the neighbours of the best design. Each neighbour differs from the best design by one step of one
  /// parameter.
  std::vector<Rejected> neighbours(const Variant& best) {
    std::vector<Rejected> found;
    for (std::size_t k = 0; k < study_.parameters.size(); ++k)
      for (const int step : {-1, 1}) {
        const std::optional<ParameterValue> value = beside(k, best.values[k], step);
        if (!value) continue;
        PointValues design = best.values;
        design[k] = *value;
        found.push_back({evaluator_.evaluate(design, {neighbour_scale_, 0}),
                         fmt::format("{} {}", step < 0 ? "lower" : "higher", study_.parameters[k].name), ""});
      }
    return found;
  }

  /// Returns true if the compared designs have random errors.
  bool is_noisy() const { return is_noisy_; }

  std::optional<Variant> best_seen() const {
    std::optional<Variant> best;
    for (const Variant& variant : evaluator_.evaluated())
      if (variant.feasible() && (!best || is_better(variant, *best))) best = variant;
    return best;
  }

 private:
  /// Returns true if the objective or a constrained quantity of a design has a random error.
  bool has_noise(const Variant& variant) const {
    return variant.objective_error > 0.0 ||
           std::ranges::any_of(request_.constraints, [&](const Constraint& constraint) {
             return evaluator_.error_of(variant, constraint.quantity) > 0.0;
           });
  }

  std::optional<Variant> run_with_noise(double scale, Optimum& optimum) {
    is_noisy_ = true;
    NoisySearchSettings settings;
    settings.spacing = scan_.spacing();
    if (scale == 1.0) settings.scan_scale = settings.refinement_scale = settings.last_scale = 1.0;
    neighbour_scale_ = settings.refinement_scale;
    std::vector<std::vector<SearchPoint>> points;
    for (std::size_t combination = 0; combination < scan_.combinations().size(); ++combination) {
      points.emplace_back();
      for (const PointValues& design : scan_.of(combination))
        points.back().push_back({combination, scan_.fractions_of(design)});
    }
    const NoisyOptimum found = search_with_noise(function_, points, settings);
    optimum.method = "paired comparison";
    optimum.resolution = found.resolution;
    if (!found.best) return std::nullopt;
    return evaluator_.most_accurate(function_.design_at(*found.best));
  }

  std::optional<Variant> run_without_noise(Optimum& optimum) {
    std::vector<std::pair<std::size_t, Variant>> starts;
    for (std::size_t combination = 0; combination < scan_.combinations().size(); ++combination) {
      const std::vector<Variant> scanned = evaluator_.evaluate(scan_.of(combination));
      look_at_edges(scanned);
      std::optional<Variant> best;
      for (const Variant& variant : scanned)
        if (variant.feasible() && (!best || is_better(variant, *best))) best = variant;
      if (best) starts.emplace_back(combination, best_peak(combination, *best));
    }
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return is_better(a.second, b.second); });
    if (starts.size() > kSearch.max_combinations) starts.resize(kSearch.max_combinations);
    bool by_slopes = !starts.empty() && !continuous_.empty();
    for (const auto& start : starts) by_slopes = refine(study_, request_, evaluator_, start.second) && by_slopes;
    optimum.method = by_slopes ? "exact slopes" : "no slopes";
    const std::optional<Variant> best = best_seen();
    return best ? std::optional(rounded(*best)) : std::nullopt;
  }

  /// Returns the index of the combination of discrete values to which a design belongs.
  std::size_t combination_of(const PointValues& design) const {
    const auto is_same = [&](const PointValues& combination) {
      for (std::size_t k = 0; k < design.size(); ++k)
        if (!study_.parameters[k].interval && design[k].toml != combination[k].toml) return false;
      return true;
    };
    return static_cast<std::size_t>(std::ranges::find_if(scan_.combinations(), is_same) - scan_.combinations().begin());
  }

  /// Evaluates designs near `start` with sizes for which a whole number of elements fills the part. Returns the best
  /// design, which may be `start` itself.
  Variant best_peak(std::size_t combination, const Variant& start) {
    const SearchPoint at{combination, scan_.fractions_of(start.values)};
    std::vector<PointValues> designs;
    for (const SearchPoint& peak : nearest_of(function_.peaks_near(at, kPeakBox * scan_.spacing()), at))
      designs.push_back(function_.design_at(peak));
    Variant best = start;
    for (const Variant& variant : evaluator_.evaluate(designs))
      if (variant.feasible() && is_better(variant, best)) best = variant;
    return best;
  }

  /// Searches along a line of designs, by bisection, for the points at which a constraint changes between satisfied and
  /// violated. The best design may be the last feasible design before one of these points.
  void look_at_edges(const std::vector<Variant>& line) {
    if (continuous_.size() != 1) return;
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      if (line[k].feasible() != line[k + 1].feasible())
        look_at_edge(line[k].feasible() ? line[k] : line[k + 1], line[k].feasible() ? line[k + 1] : line[k]);
  }

  void look_at_edge(Variant inside, Variant outside) {
    constexpr int most_bisections = 50;
    const std::size_t k = continuous_.front();
    const Interval& interval = *study_.parameters[k].interval;
    for (int bisection = 0; bisection < most_bisections; ++bisection) {
      const double a = fraction_of(interval, std::get<double>(inside.values[k].shown));
      const double b = fraction_of(interval, std::get<double>(outside.values[k].shown));
      if (std::abs(a - b) < 1e-9) return;
      const Variant middle = evaluator_.evaluate(scan_.with(inside.values, {0.5 * (a + b)}));
      (middle.feasible() ? inside : outside) = middle;
    }
  }

  /// Rounds the parameters of a design to as few digits as possible without a significant loss of the objective.
  Variant rounded(const Variant& best) {
    if (continuous_.empty() || !request_.is_rounded) return best;
    const SearchPoint at{combination_of(best.values), scan_.fractions_of(best.values)};
    for (const SearchPoint& round : function_.rounder_points(at, kRoundingBox * scan_.spacing())) {
      if (!function_.is_allowed(round)) continue;
      const Variant variant = evaluator_.evaluate(function_.design_at(round));
      if (variant.feasible() &&
          *variant.objective >= *best.objective - kSearch.rounding_loss * std::abs(*best.objective))
        return variant;
    }
    return best;
  }

  std::optional<ParameterValue> beside(std::size_t parameter, const ParameterValue& value, int step) const {
    const Parameter& p = study_.parameters[parameter];
    if (p.interval) {
      const double here = fraction_of(*p.interval, std::get<double>(value.shown));
      const double there = std::clamp(here + step / static_cast<double>(request_.scan - 1), 0.0, 1.0);
      if (std::abs(there - here) < 1e-12) return std::nullopt;
      return Parameter::value_of(p.interval->at(there));
    }
    const auto same = [&](const ParameterValue& other) { return other.toml == value.toml; };
    const auto found = std::find_if(p.values.begin(), p.values.end(), same) - p.values.begin();
    const auto other = found + step;
    if (other < 0 || other >= static_cast<std::ptrdiff_t>(p.values.size())) return std::nullopt;
    return p.values[static_cast<std::size_t>(other)];
  }

  const Study& study_;
  const OptimiseRequest& request_;
  Evaluator& evaluator_;
  Scan scan_;
  DesignFunction function_;
  const std::vector<std::size_t>& continuous_;
  bool is_noisy_ = false;
  double neighbour_scale_ =
      1.0;  ///< factor on the target errors of the neighbours of the best design (ErrorLevel::scale)
};

/// Returns a text that explains why a design was not chosen.
std::string why_not(const Variant& variant, const Variant& best, const OptimiseRequest& request,
                    const Evaluator& evaluator) {
  if (variant.failed) return variant.reason;
  std::string why;
  for (const std::size_t k : variant.broken) {
    const Constraint& constraint = request.constraints[k];
    const std::optional<double> value = evaluator.value(variant, constraint.quantity);
    why += fmt::format(
        "{}{} violates {}", why.empty() ? "" : "; ",
        value ? fmt::format("{} = {:.6g}", constraint.quantity, *value) : constraint.quantity + " has no value and",
        constraint.text());
  }
  if (!why.empty()) return why;
  if (!variant.objective) return "a quantity of the objective has no value";
  const double less = *best.objective - *variant.objective;
  const double error = std::hypot(best.objective_error, variant.objective_error);
  if (error > 0.0 && std::abs(less) < 2.0 * error)
    return fmt::format("the difference of the objective, {:.2g}, is below its error", less);
  if (less <= 0.0) return "equally good, but with more digits or found later";
  return fmt::format("objective lower by {:.3g}", less);
}

/// Returns the best of the excluded designs, for example of the designs that violate a constraint.
/// \param excluded function that returns true if a design was excluded
template <class Excluded>
std::optional<Variant> best_excluded(const Evaluator& evaluator, Excluded excluded) {
  std::optional<Variant> found;
  for (const Variant& variant : evaluator.evaluated())
    if (variant.objective && excluded(variant) && (!found || is_better(variant, *found))) found = variant;
  return found;
}

std::vector<Rejected> excluded_designs(const OptimiseRequest& request, const Evaluator& evaluator,
                                       const Variant& best) {
  std::vector<Rejected> rejected;
  const auto better = [&](const Variant& variant) { return *variant.objective > *best.objective; };
  const auto any = best_excluded(evaluator, [&](const Variant& v) { return !v.broken.empty() && better(v); });
  if (any) rejected.push_back({*any, "best without constraints", ""});
  for (std::size_t k = 0; k < request.constraints.size(); ++k) {
    const auto one =
        best_excluded(evaluator, [&](const Variant& v) { return v.broken == std::vector{k} && better(v); });
    if (one && one->number != any->number)
      rejected.push_back({*one, "best without the constraint " + request.constraints[k].text(), ""});
  }
  return rejected;
}

/// Returns the values of a design on the axes of the Pareto front. Values that should be small are negated, so that
/// larger is always better. Returns nothing if a quantity has no value.
std::optional<std::vector<double>> merits(const Variant& variant, const OptimiseRequest& request,
                                          const Evaluator& evaluator) {
  std::vector<double> merits;
  for (const FrontAxis& axis : request.front) {
    const std::optional<double> value = evaluator.value(variant, axis.quantity);
    if (!value) return std::nullopt;
    // Two standard errors are subtracted, so that a design is not on the Pareto front only because of a large random
    // error.
    const double error = evaluator.error_of(variant, axis.quantity);
    merits.push_back((axis.is_maximized ? *value : -*value) - 2.0 * error);
  }
  return merits;
}

/// Returns true if `a` is at least as good as `b` on every axis and better on one.
bool dominates(const std::vector<double>& a, const std::vector<double>& b) {
  bool better = false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k] < b[k]) return false;
    better = better || a[k] > b[k];
  }
  return better;
}

/// Returns the Pareto front: the feasible designs that no other design dominates. The design that is best on the first
/// axis comes first.
std::vector<Variant> pareto_front(const OptimiseRequest& request, const Evaluator& evaluator) {
  std::vector<std::pair<std::vector<double>, const Variant*>> open;
  for (const Variant& variant : evaluator.evaluated()) {
    if (!variant.feasible()) continue;
    if (auto m = merits(variant, request, evaluator)) open.emplace_back(std::move(*m), &variant);
  }
  // The designs are sorted by the first axis, the best first, so that a design comes after all designs that dominate
  // it.
  std::stable_sort(open.begin(), open.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Variant> front;
  std::vector<std::vector<double>> kept;
  for (const auto& [merit, variant] : open) {
    const auto loses = [&m = merit](const std::vector<double>& other) { return other == m || dominates(other, m); };
    if (std::any_of(kept.begin(), kept.end(), loses)) continue;
    kept.push_back(merit);
    front.push_back(*variant);
  }
  return front;
}

/// Considers the first axis of the Pareto front that is not part of the objective. Among the designs of the front that
/// lose at most 1 % of the objective, returns the best one on this axis. Returns nothing if its gain on this axis is
/// too small.
std::optional<Variant> cheaper_than(const Optimum& optimum, const OptimiseRequest& request,
                                    const Evaluator& evaluator) {
  const auto axis = std::find_if(request.front.begin(), request.front.end(), [&](const FrontAxis& a) {
    return std::none_of(request.objective.weights.begin(), request.objective.weights.end(),
                        [&](const auto& weight) { return weight.first == a.quantity; });
  });
  if (axis == request.front.end()) return std::nullopt;
  const double sign = axis->is_maximized ? 1.0 : -1.0;
  const auto merit = [&](const Variant& v) { return sign * evaluator.value(v, axis->quantity).value(); };
  const double least = *optimum.best->objective - kNearlyAsGood * std::abs(*optimum.best->objective);
  std::optional<Variant> found;
  for (const Variant& variant : optimum.front)
    if (*variant.objective >= least && (!found || merit(variant) > merit(*found))) found = variant;
  if (!found) return std::nullopt;
  const std::optional<double> chosen = evaluator.value(*optimum.best, axis->quantity);
  const bool is_worth_it = !chosen || merit(*found) - sign * *chosen > kWorthIt * std::abs(*chosen);
  return is_worth_it ? found : std::nullopt;
}

/// Returns, for each constraint, how many evaluated designs violate it, and the smallest violation.
std::vector<Exclusion> exclusions_of(const OptimiseRequest& request, const Evaluator& evaluator) {
  std::vector<Exclusion> exclusions(request.constraints.size());
  for (const Variant& variant : evaluator.evaluated()) {
    if (variant.failed) continue;
    for (const std::size_t k : variant.broken) ++exclusions[k].designs;
    for (std::size_t k = 0; k < exclusions.size(); ++k) {
      const Constraint& constraint = request.constraints[k];
      exclusions[k].min_violation =
          std::min(exclusions[k].min_violation, constraint.violation(evaluator.value(variant, constraint.quantity)));
    }
  }
  return exclusions;
}

/// Returns a text for the user that explains why no design is feasible.
std::string why_none(const OptimiseRequest& request, const std::vector<Exclusion>& exclusions,
                     const std::vector<Variant>& seen) {
  const auto judged =
      static_cast<std::size_t>(std::ranges::count_if(seen, [](const Variant& variant) { return !variant.failed; }));
  if (judged == 0) return fmt::format("no design can be computed: {}", seen.empty() ? "none" : seen.back().reason);
  std::string text;
  for (std::size_t k = 0; k < exclusions.size(); ++k)
    if (exclusions[k].designs == judged) {
      text += fmt::format("{}the constraint {} excludes all {} designs", text.empty() ? "" : ", and ",
                          request.constraints[k].text(), judged);
      if (std::isfinite(exclusions[k].min_violation))
        text += fmt::format(" (the closest design violates it by {:.3g})", exclusions[k].min_violation);
    }
  if (!text.empty()) return text;
  for (std::size_t k = 0; k < exclusions.size(); ++k)
    if (exclusions[k].designs > 0)
      text += fmt::format("{}the constraint {} excludes {} of {} designs", text.empty() ? "" : ", ",
                          request.constraints[k].text(), exclusions[k].designs, judged);
  return text.empty() ? "the objective has no value for any design" : text + ": no design satisfies all constraints";
}

/// Adds the results that need no further evaluation of designs: the Pareto front and the designs that were not chosen.
void add_results(const OptimiseRequest& request, const Evaluator& evaluator, std::vector<Rejected> neighbours,
                 Optimum& optimum) {
  optimum.rejected = excluded_designs(request, evaluator, *optimum.best);
  optimum.rejected.insert(optimum.rejected.end(), neighbours.begin(), neighbours.end());
  for (Rejected& rejected : optimum.rejected)
    rejected.why = why_not(rejected.variant, *optimum.best, request, evaluator);
  optimum.front = pareto_front(request, evaluator);
  optimum.cheaper = cheaper_than(optimum, request, evaluator);
}

void search(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Cancellation* cancel,
            Optimum& optimum) {
  DesignSearch searching(study, request, evaluator);
  optimum.best = searching.run(optimum);
  if (!optimum.best) {
    optimum.exclusions = exclusions_of(request, evaluator);
    optimum.infeasible_reason = why_none(request, optimum.exclusions, evaluator.evaluated());
    return;
  }
  std::vector<Rejected> neighbours = searching.neighbours(*optimum.best);
  // If a neighbour is better than the result of the search, it replaces the result.
  if (const auto best = searching.best_seen();
      !searching.is_noisy() &&
      *best->objective > *optimum.best->objective + kSearch.rounding_loss * std::abs(*optimum.best->objective)) {
    optimum.best = best;
    neighbours = searching.neighbours(*best);
  }
  add_results(request, evaluator, std::move(neighbours), optimum);
  for (const std::string& key : request.band_keys)
    optimum.bands.push_back(tolerance_band(study, request, *optimum.best, key, cancel));
}

/// Completes the result of an interrupted search. The best design is chosen from all designs that were evaluated before
/// the interruption.
void finish_early(const OptimiseRequest& request, Evaluator& evaluator, Optimum& optimum) {
  optimum = {};
  optimum.complete = false;
  evaluator.add_stored();
  for (const Variant& variant : evaluator.evaluated())
    if (variant.feasible() && (!optimum.best || variant.cautious_objective() > optimum.best->cautious_objective()))
      optimum.best = variant;
  if (optimum.best) add_results(request, evaluator, {}, optimum);
}

}  // namespace

Sweep optimise_scan(const Study& study, const OptimiseRequest& request) {
  Study at_level = study;
  if (request.has_levels) at_level.level = {scan_scale(study, request), 0};
  return {std::move(at_level), kStoreKind, std::make_shared<ScannedPoints>(study, request)};
}

Optimum optimise(const Study& study, const OptimiseRequest& request, compute::ResultStore& store,
                 OptimiseObserver* observer, const Cancellation* cancel) {
  Evaluator evaluator(study, request, store, observer, cancel);
  return optimise(study, request, evaluator, cancel);
}

Optimum optimise(const Study& study, const OptimiseRequest& request, Evaluator& evaluator, const Cancellation* cancel) {
  Optimum optimum;
  try {
    search(study, request, evaluator, cancel, optimum);
  } catch (const Interrupted&) {
    finish_early(request, evaluator, optimum);
  }
  optimum.designs = evaluator.evaluated();
  optimum.budget_failures = evaluator.budget_failures();
  optimum.budget_failure_reason = evaluator.budget_failure_reason();
  return optimum;
}

}  // namespace retrace::studies

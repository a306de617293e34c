#include "studies/optimise/evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <utility>

#include "core/number_format.h"
#include "core/task_progress.h"
#include "core/threads.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/quantity/study_names.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {
namespace {

/// Adds a value to a key, which is a text that identifies a design or a stored point.
void add_to_key(std::string& key, const std::variant<double, std::string>& value) {
  const double* const number = std::get_if<double>(&value);
  key += number != nullptr ? shortest(*number) : std::get<std::string>(value);
  key += '\n';
}

/// Reports the progress of a group of designs to an observer. The observer may be null.
class GroupProgress : public Progress {
 public:
  GroupProgress(OptimiseObserver* observer, std::size_t designs) : observer_(observer), designs_(designs) {}
  void at(double share) override {
    if (observer_ != nullptr && designs_ > 0) observer_->at_group(share, designs_);
  }

 private:
  OptimiseObserver* observer_;
  std::size_t designs_;
};

}  // namespace

std::string Evaluator::key_of(const PointValues& design) {
  std::string key;
  for (const ParameterValue& value : design) add_to_key(key, value.shown);
  return key;
}

std::string Evaluator::key_of(const PointValues& design, const ErrorLevel& level) const {
  std::string key = key_of(design);
  if (!request_.has_levels) return key;
  add_to_key(key, level.scale);
  add_to_key(key, static_cast<double>(level.replicate));
  return key;
}

Evaluator::Evaluator(const Study& study, const OptimiseRequest& request, compute::ResultStore& store,
                     OptimiseObserver* observer, const Cancellation* cancel)
    : study_(study), request_(request), store_(store), observer_(observer), cancel_(cancel) {
  for (compute::StoredPoint& point : store.points()) {
    std::string key;
    for (const compute::StoredValue& value : point.inputs) add_to_key(key, value);
    used_numbers_.insert(point.point);
    stored_.emplace(std::move(key), std::move(point));
  }
}

/// Returns a copy of the study whose target error and random numbers correspond to a level of accuracy.
const Study& Evaluator::study_at(const ErrorLevel& level) {
  if (!request_.has_levels) return study_;
  const auto found = studies_.find(level);
  if (found != studies_.end()) return found->second;
  Study study = study_;
  study.level = level;
  return studies_.emplace(level, std::move(study)).first->second;
}

/// Returns the lowest point number that no stored point has. A search evaluates its designs in a fixed order.
/// Therefore, each point of a resumed run has the same number as in an uninterrupted run.
std::uint64_t Evaluator::free_number() {
  while (used_numbers_.contains(next_)) ++next_;
  return next_++;
}

std::vector<Variant> Evaluator::evaluate(const std::vector<PointValues>& designs, const ErrorLevel& level) {
  std::vector<PointValues> open;
  std::vector<std::string> keys;
  std::set<std::string> added;
  for (const PointValues& design : designs) {
    const auto known = by_level_.find(key_of(design));
    if (known != by_level_.end() && known->second.contains(level)) continue;
    std::string key = key_of(design, level);
    if (!added.insert(key).second) continue;
    open.push_back(design);
    keys.push_back(std::move(key));
  }
  std::vector<std::uint64_t> number(open.size());
  for (std::size_t k = 0; k < open.size(); ++k) {
    const auto found = stored_.find(keys[k]);
    number[k] = found != stored_.end() ? found->second.point : free_number();
  }
  const std::size_t unknown = static_cast<std::size_t>(
      std::ranges::count_if(keys, [&](const std::string& key) { return !stored_.contains(key); }));
  GroupProgress group(observer_, unknown);
  group.at(0.0);
  TaskProgress all(&group, std::max<std::size_t>(1, unknown));
  const Study& study = study_at(level);
  std::vector<std::optional<compute::StoredPoint>> points(open.size());
  // `char` instead of bool: threads write to neighbouring elements at the same time, which vector<bool> does not allow.
  std::vector<char> ran_out(open.size());
  std::mutex mutex;
  std::size_t finished = evaluated_.size();
  for_each_in_parallel(open.size(), [&](std::size_t k) {
    const auto found = stored_.find(keys[k]);
    if (found != stored_.end()) {
      points[k] = found->second;
    } else {
      bool has_run_out = false;
      TaskProgress::Task task(all);
      points[k] = compute_point(study, number[k], open[k], cancel_, &has_run_out, &task);
      if (!points[k]) return;
      task.finish();
      ran_out[k] = has_run_out ? 1 : 0;
      if (!has_run_out) store_.record(*points[k]);
    }
    const std::lock_guard lock(mutex);
    report_best(variant_of(*points[k], open[k]));
    if (observer_ != nullptr) observer_->at(++finished);
  });
  bool is_interrupted = is_cancelled(cancel_);
  for (std::size_t k = 0; k < open.size(); ++k) {
    // If the user interrupts the search, all finished designs are stored before the search ends.
    is_interrupted = is_interrupted || !points[k];
    if (!points[k]) continue;
    if (ran_out[k] != 0 && budget_failures_++ == 0) budget_failure_reason_ = points[k]->reason;
    keep(open[k], level, *points[k]);
  }
  if (is_interrupted) throw Interrupted{};
  std::vector<Variant> found;
  for (const PointValues& design : designs) found.push_back(by_level_.at(key_of(design)).at(level));
  return found;
}

/// Adds a stored result to the results of its design. `level` is the accuracy with which the result was computed.
void Evaluator::keep(const PointValues& design, const ErrorLevel& level, const compute::StoredPoint& point) {
  const std::string key = key_of(design);
  std::map<ErrorLevel, Variant>& results = by_level_[key];
  if (!results.emplace(level, variant_of(point, design)).second) return;
  const auto [at, is_new] = numbers_.try_emplace(key, evaluated_.size());
  if (is_new) {
    evaluated_.push_back(results.begin()->second);
    return;
  }
  const std::uint64_t number = evaluated_[at->second].number;
  evaluated_[at->second] = mean_of(results);
  evaluated_[at->second].number = number;
}

/// Returns the mean of the most accurate results, which are those with the smallest target error.
Variant Evaluator::mean_of(const std::map<ErrorLevel, Variant>& results) const {
  Variant mean = results.begin()->second;
  std::size_t count = 0;
  std::vector<double> squares(mean.outputs.size(), 0.0);
  for (const auto& [level, variant] : results) {
    if (level.scale != results.begin()->first.scale) break;
    ++count;
    if (variant.failed) return variant;
    for (std::size_t k = 0; k < squares.size(); ++k) {
      const compute::StoredOutput& output = variant.outputs[k];
      squares[k] += output.std_error * output.std_error;
      if (count == 1) continue;
      if (mean.outputs[k].value && output.value)
        *mean.outputs[k].value += (*output.value - *mean.outputs[k].value) / static_cast<double>(count);
      else
        mean.outputs[k].value.reset();
    }
  }
  for (std::size_t k = 0; k < squares.size(); ++k)
    mean.outputs[k].std_error = std::sqrt(squares[k]) / static_cast<double>(count);
  check_constraints(mean);
  return mean;
}

/// Reports a design to the observer if it is better than all previously reported designs.
void Evaluator::report_best(const Variant& variant) {
  if (!variant.feasible()) return;
  const double value = variant.cautious_objective();
  if (best_value_ && value <= *best_value_) return;
  best_value_ = value;
  if (observer_ != nullptr) observer_->at_best(variant);
}

void Evaluator::add_stored() {
  const std::size_t parameters = study_.parameters.size();
  for (const auto& [key, point] : stored_) {
    const std::optional<PointValues> design = values_of(study_, point.inputs);
    if (!design) continue;
    ErrorLevel level;
    if (request_.has_levels)
      level = {std::get<double>(point.inputs[parameters]),
               static_cast<std::uint32_t>(std::get<double>(point.inputs[parameters + 1]))};
    keep(*design, level, point);
  }
}

void Evaluator::add_evaluated(const std::vector<Variant>& seen) {
  for (Variant variant : seen) {
    const std::string key = key_of(variant.values);
    if (!numbers_.try_emplace(key, evaluated_.size()).second) continue;
    check_constraints(variant);
    by_level_[key].emplace(ErrorLevel{}, variant);
    evaluated_.push_back(std::move(variant));
  }
}

Variant Evaluator::variant_of(const compute::StoredPoint& point, const PointValues& design) const {
  Variant variant;
  variant.number = point.point;
  variant.values = design;
  variant.failed = point.failed;
  variant.reason = point.reason;
  variant.outputs = point.outputs;
  check_constraints(variant);
  return variant;
}

std::optional<double> Evaluator::value(const Variant& variant, const std::string& quantity) const {
  const std::optional<std::size_t> k = quantity_index(study_, quantity);
  return k && *k < variant.outputs.size() ? variant.outputs[*k].value : std::nullopt;
}

double Evaluator::error_of(const Variant& variant, const std::string& quantity) const {
  const std::optional<std::size_t> k = quantity_index(study_, quantity);
  return k && *k < variant.outputs.size() ? variant.outputs[*k].std_error : 0.0;
}

void Evaluator::check_constraints(Variant& variant) const {
  variant.objective.reset();
  variant.objective_error = 0.0;
  variant.broken.clear();
  if (variant.failed) return;
  double sum = 0.0;
  // All terms of the objective may use common random numbers, so their errors are correlated. The errors are therefore
  // added linearly and not as squares.
  double sum_of_errors = 0.0;
  double least = std::numeric_limits<double>::infinity();
  double error_of_least = 0.0;
  bool has_all = true;
  for (const auto& [quantity, weight] : request_.objective.weights) {
    const std::optional<double> term = value(variant, quantity);
    has_all = has_all && term;
    if (!term) continue;
    const double error = std::abs(weight) * error_of(variant, quantity);
    sum += weight * *term;
    sum_of_errors += error;
    if (weight * *term < least) error_of_least = error;
    least = std::min(least, weight * *term);
  }
  if (has_all) {
    variant.objective = request_.objective.uses_minimum ? least : sum;
    variant.objective_error = request_.objective.uses_minimum ? error_of_least : sum_of_errors;
  }
  for (std::size_t k = 0; k < request_.constraints.size(); ++k)
    if (request_.constraints[k].violation(value(variant, request_.constraints[k].quantity)) > 0.0)
      variant.broken.push_back(k);
}

namespace {

/// Returns the RRE parameter that a parameter of a study corresponds to, and its change per unit of the study's
/// parameter.
std::optional<std::pair<RreParameter, double>> rre_parameter(const Parameter& parameter, const design::Design& design) {
  constexpr double deg_per_arcmin = 1.0 / 60.0;
  const std::set<std::string> varied(parameter.keys.begin(), parameter.keys.end());
  // For a prism, the error of the angle between the facets is an error of the apex angle.
  const bool is_prism = std::holds_alternative<geometry::RtpElement>(design.part().element);
  if (varied == std::set<std::string>{"surface.dihedral_error_arcmin"})
    return {{is_prism ? RreParameter::apex_angle_deg : RreParameter::dihedral_error_deg, deg_per_arcmin}};
  for (const RreParameter each : parameters_of(design)) {
    const std::vector<std::string> keys = keys_of(each, design);
    if (varied == std::set(keys.begin(), keys.end())) return {{each, 1.0}};
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> Evaluator::slope(const PointValues& design, std::size_t parameter) const {
  if (request_.objective.uses_minimum) return std::nullopt;
  try {
    const Candidate candidate = make_candidate(study_, design);
    if (!candidate.design().elements()) return std::nullopt;
    const auto by = rre_parameter(study_.parameters[parameter], candidate.design());
    if (!by) return std::nullopt;
    double sum = 0.0;
    for (const auto& [name, weight] : request_.objective.weights) {
      const std::optional<double> term = quantity_named(study_, name)->slope(candidate, by->first, cancel_);
      if (!term) return std::nullopt;
      sum += weight * *term * by->second;
    }
    return sum;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace retrace::studies

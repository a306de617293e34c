#include "studies/sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "core/memory_budget.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/threads.h"
#include "core/version.h"
#include "studies/quantity/io/study_reader.h"

namespace retrace::studies {
namespace {

constexpr std::chrono::milliseconds kWaitForOthers{50};

/// Returns the sampling method of a combination. Returns nothing for combinations without sampling.
std::optional<compute::UnitSamples::Kind> samples_of(Combine combine) {
  switch (combine) {
    case Combine::sobol: return compute::UnitSamples::Kind::sobol;
    case Combine::latin_hypercube: return compute::UnitSamples::Kind::latin_hypercube;
    case Combine::monte_carlo: return compute::UnitSamples::Kind::monte_carlo;
    case Combine::grid:
    case Combine::zipped: break;
  }
  return std::nullopt;
}

std::uint64_t grid_size(const Study& study) {
  std::uint64_t size = 1;
  for (const Parameter& parameter : study.parameters) {
    size *= parameter.values.size();
    if (size > Sweep::max_points)
      throw InputError(parameter.location,
                       fmt::format("with this parameter, the grid has more than {} points", Sweep::max_points));
  }
  return size;
}

std::uint64_t zipped_size(const Study& study) {
  const std::size_t size = study.parameters.front().values.size();
  for (const Parameter& parameter : study.parameters)
    if (parameter.values.size() != size)
      throw InputError(parameter.location, fmt::format("for sweep.combine = \"zipped\", all parameters must have the "
                                                       "same number of values as the first parameter ({}), got {}",
                                                       size, parameter.values.size()));
  return size;
}

}  // namespace

Sweep::Sweep(Study study, Combine combine, std::uint64_t samples) : study_(std::move(study)), combine_(combine) {
  if (const auto kind = samples_of(combine)) {
    size_ = samples;
    samples_.emplace(*kind, study_.parameters.size(), size_, study_.seed);
    return;
  }
  for (const Parameter& parameter : study_.parameters)
    if (parameter.values.empty())
      throw InputError(parameter.location,
                       "for sweep.combine = \"grid\" or \"zipped\", a parameter requires values, or a range with step "
                       "or count; an interval or a distribution is only allowed for sweep.combine = \"sobol\", "
                       "\"latin_hypercube\" or \"monte_carlo\"");
  size_ = combine == Combine::grid ? grid_size(study_) : zipped_size(study_);
}

Sweep::Sweep(Study study, std::string kind, std::shared_ptr<const PointPlan> plan)
    : study_(std::move(study)), kind_(std::move(kind)), plan_(std::move(plan)), size_(plan_->size()) {}

PointValues Sweep::values(std::uint64_t point) const {
  if (plan_) return plan_->values(point);
  if (samples_) return values_at(study_, samples_->at(point));
  PointValues values(study_.parameters.size());
  for (std::size_t k = values.size(); k-- > 0;) {
    const std::vector<ParameterValue>& choices = study_.parameters[k].values;
    values[k] = choices[combine_ == Combine::zipped ? point : point % choices.size()];
    point = combine_ == Combine::zipped ? point : point / choices.size();
  }
  return values;
}

PointValues values_at(const Study& study, const std::vector<double>& fractions) {
  PointValues values;
  for (std::size_t k = 0; k < fractions.size(); ++k) {
    const Parameter& parameter = study.parameters[k];
    if (parameter.distribution) {
      values.push_back(Parameter::value_of(parameter.distribution->quantile(fractions[k])));
    } else if (parameter.interval) {
      values.push_back(Parameter::value_of(parameter.interval->at(fractions[k])));
    } else {
      const double count = static_cast<double>(parameter.values.size());
      values.push_back(parameter.values[static_cast<std::size_t>(fractions[k] * count)]);
    }
  }
  return values;
}

namespace {

/// Returns true if a stored value equals the value in the study. Numbers may differ by rounding errors, because another
/// machine may have computed them.
bool is_same(const compute::StoredValue& stored, const compute::StoredValue& of_study) {
  const double* const a = std::get_if<double>(&stored);
  const double* const b = std::get_if<double>(&of_study);
  if (a == nullptr || b == nullptr) return stored == of_study;
  return std::abs(*a - *b) <= std::max(1e-9 * std::abs(*b), 1e-15);
}

std::string text_of_value(const compute::StoredValue& value) {
  const double* const number = std::get_if<double>(&value);
  return number != nullptr ? shortest(*number) : in_quotes(std::get<std::string>(value));
}

/// Compares the number and the parameter values of a stored point with those of the sweep. Returns a message about the
/// first difference. The text is empty if there is none.
std::string fault_of(const Sweep& sweep, const compute::StoredPoint& point) {
  if (point.point >= sweep.size()) return fmt::format("the study has only {} points", sweep.size());
  const PointValues values = sweep.values(point.point);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!is_same(point.inputs[k], values[k].shown))
      return fmt::format("{} is {} in the study, got {}", sweep.study().parameters[k].name,
                         text_of_value(values[k].shown), text_of_value(point.inputs[k]));
  return {};
}

}  // namespace

compute::StoreLayout Sweep::layout() const {
  compute::StoreLayout layout{kind_, study_.source, study_.parts, {}, {}};
  for (const Parameter& parameter : study_.parameters) layout.inputs.push_back(parameter.name);
  for (const auto& quantity : study_.quantities) layout.outputs.push_back(quantity->name());
  layout.fault_of = [sweep = *this](const compute::StoredPoint& point) { return fault_of(sweep, point); };
  return layout;
}

namespace {

/// Divides the progress of one point among its quantities. Quantities that are computed from the same trace count as
/// one. Quantities without ray or beam tracing do not count.
class QuantityProgress {
 public:
  QuantityProgress(const Quantities& quantities, Progress* whole) : whole_(whole) {
    for (const auto& quantity : quantities)
      if (!quantity->tracing().empty()) tracings_.insert(quantity->tracing());
  }

  PartProgress of(const Quantity& quantity) {
    const auto count = static_cast<double>(std::max<std::size_t>(1, tracings_.size()));
    const bool is_new = !quantity.tracing().empty() && begun_.insert(quantity.tracing()).second;
    const auto begun = static_cast<double>(begun_.size());
    return {is_new ? whole_ : nullptr, (begun - 1.0) / count, begun / count};
  }

 private:
  Progress* whole_;
  std::set<std::string> tracings_;
  std::set<std::string> begun_;
};

/// Computes all quantities of a point. Returns nothing if the computation was cancelled.
std::optional<std::vector<compute::StoredOutput>> measure_all(const Study& study, const PointValues& values,
                                                              const Cancellation* cancel, Progress* progress) {
  Candidate candidate = make_candidate(study, values);
  QuantityProgress of_quantities(study.quantities, progress);
  std::vector<compute::StoredOutput> outputs;
  for (const auto& quantity : study.quantities) {
    PartProgress part = of_quantities.of(*quantity);
    candidate.report_to(&part);
    const std::optional<Measured> measured = quantity->measure(candidate, cancel);
    if (!measured) return std::nullopt;
    // NaN and infinity count as missing values.
    const bool has_value = measured->value && std::isfinite(*measured->value);
    outputs.push_back({has_value ? measured->value : std::nullopt, measured->std_error});
  }
  return outputs;
}

}  // namespace

std::vector<compute::StoredValue> stored_inputs(const Study& study, const PointValues& values) {
  std::vector<compute::StoredValue> inputs;
  for (const ParameterValue& value : values) inputs.push_back(value.shown);
  if (study.level) {
    inputs.emplace_back(study.level->scale);
    inputs.emplace_back(static_cast<double>(study.level->replicate));
  }
  return inputs;
}

std::optional<compute::StoredPoint> compute_point(const Study& study, std::uint64_t number, const PointValues& values,
                                                  const Cancellation* cancel, bool* ran_out, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  compute::StoredPoint point;
  point.point = number;
  point.version = kVersion;
  point.inputs = stored_inputs(study, values);
  try {
    const auto outputs = measure_all(study, values, cancel, progress);
    if (!outputs) return std::nullopt;
    point.outputs = *outputs;
  } catch (const Error& error) {
    point.failed = true;
    point.reason = error.what();
    if (ran_out != nullptr) *ran_out = dynamic_cast<const TraceBudgetError*>(&error) != nullptr;
  }
  point.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return point;
}

struct SweepCount::State {
  SweepObserver* observer = nullptr;
  std::uint64_t done = 0;
  std::uint64_t failed = 0;
  std::uint64_t total = 0;
  std::mutex mutex;

  void tell() const {
    if (observer != nullptr) observer->at(done, total, failed);
  }
};

/// Converts the progress of the points that were unfinished at the start to the progress of the whole sweep, and passes
/// it on to the observer. A mutex serializes all calls of the observer.
struct SweepCount::Share : Progress {
  explicit Share(State& its_state)
      : state(its_state),
        begin(its_state.total > 0 ? static_cast<double>(its_state.done) / static_cast<double>(its_state.total) : 0.0) {}
  void at(double share) override {
    const std::lock_guard lock(state.mutex);
    if (state.observer != nullptr) state.observer->at_fraction(std::lerp(begin, 1.0, share));
  }
  State& state;
  double begin;
};

SweepCount::SweepCount(const Sweep& sweep, const compute::ResultStore& store, SweepObserver* observer)
    : state_(std::make_unique<State>()) {
  state_->observer = observer;
  state_->done = store.finished().size();
  state_->total = sweep.size();
  share_ = std::make_unique<Share>(*state_);
  points_.emplace(share_.get(), state_->total > state_->done ? state_->total - state_->done : 1);
  state_->tell();
}

SweepCount::~SweepCount() = default;

TaskProgress& SweepCount::points() {
  return *points_;
}

void SweepCount::finished(bool failed) {
  const std::lock_guard lock(state_->mutex);
  ++state_->done;
  state_->failed += failed ? 1 : 0;
  state_->tell();
}

std::vector<std::uint64_t> unfinished(const Sweep& sweep, const compute::ResultStore& store) {
  const std::vector<std::uint64_t> finished = store.finished();
  std::vector<std::uint64_t> open;
  auto next = finished.begin();
  for (std::uint64_t point = 0; point < sweep.size(); ++point) {
    if (next != finished.end() && *next == point)
      ++next;
    else
      open.push_back(point);
  }
  return open;
}

namespace {

/// Computes the points that no other process has claimed.
/// \return number of computed points
std::size_t work_off(const Sweep& sweep, const std::vector<std::uint64_t>& points, compute::ResultStore& store,
                     SweepCount& count, const Cancellation* cancel) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> computed{0};
  for_each_in_parallel(points.size(), [&](std::size_t) {
    // Points are computed in ascending order of their numbers. The order of the indices of for_each_in_parallel() does
    // not matter.
    const std::uint64_t number = points[next.fetch_add(1)];
    if (is_cancelled(cancel) || !store.claim(number)) return;
    TaskProgress::Task task(count.points());
    const std::optional<compute::StoredPoint> point =
        compute_point(sweep.study(), number, sweep.values(number), cancel, nullptr, &task);
    if (!point) {
      store.give_up(number);
      return;
    }
    store.record(*point);
    task.finish();
    count.finished(point->failed);
    ++computed;
  });
  return computed;
}

}  // namespace

bool run_sweep(const Sweep& sweep, compute::ResultStore& store, SweepObserver* observer, const Cancellation* cancel) {
  SweepCount count(sweep, store, observer);
  for (;;) {
    const std::vector<std::uint64_t> open = unfinished(sweep, store);
    if (open.empty()) return true;
    const std::size_t computed = work_off(sweep, open, store, count, cancel);
    if (is_cancelled(cancel)) return unfinished(sweep, store).empty();
    if (computed == 0 && store.claimed_by_others() > 0) std::this_thread::sleep_for(kWaitForOthers);
  }
}

SweepResult collect(const Sweep& sweep, const compute::ResultStore& store, bool complete) {
  SweepResult result{sweep, store.points(), 0.0, complete, keys_without_effect(sweep.study())};
  const auto failed = [](const compute::StoredPoint& point) { return point.failed; };
  const auto first = std::find_if(result.points.begin(), result.points.end(), failed);
  if (first != result.points.end())
    result.warnings.push_back(
        {"points_failed",
         fmt::format("{} of {} points of the study failed. The first of them is point {}, with the message: {}",
                     std::count_if(result.points.begin(), result.points.end(), failed), result.points.size(),
                     first->point, first->reason)});
  for (const compute::StoredPoint& point : result.points)
    if (point.version != kVersion) {
      result.warnings.push_back(
          {"other_version",
           fmt::format("some points were computed by retrace {}, but this is retrace {}", point.version, kVersion)});
      break;
    }
  return result;
}

}  // namespace retrace::studies

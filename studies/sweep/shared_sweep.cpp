#include "studies/sweep/shared_sweep.h"

#include <chrono>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

namespace retrace::studies {
namespace {

using PointJson = nlohmann::json;

constexpr std::chrono::milliseconds kWaitForClaims{50};

std::string to_message(const compute::StoredPoint& point) {
  PointJson outputs = PointJson::array();
  for (const compute::StoredOutput& output : point.outputs)
    outputs.push_back(output.value ? PointJson{*output.value, output.std_error} : PointJson());
  return PointJson{{"point", point.point}, {"failed", point.failed},       {"reason", point.reason},
                   {"outputs", outputs},   {"elapsed_s", point.elapsed_s}, {"version", point.version}}
      .dump(-1, ' ', false, PointJson::error_handler_t::replace);
}

/// Reads a point from the message of another process.
/// \param sweep sweep from which the inputs of the point are taken, because the message does not contain them
compute::StoredPoint from_message(const std::string& message, const Sweep& sweep) {
  const PointJson json = PointJson::parse(message);
  compute::StoredPoint point;
  point.point = json.at("point");
  point.failed = json.at("failed");
  point.reason = json.at("reason");
  point.elapsed_s = json.at("elapsed_s");
  point.version = json.at("version");
  for (const PointJson& output : json.at("outputs")) {
    compute::StoredOutput stored;
    if (!output.is_null()) stored.value = output.at(0).get<double>();
    if (!output.is_null() && output.at(1).is_number()) stored.std_error = output.at(1).get<double>();
    point.outputs.push_back(stored);
  }
  point.inputs = stored_inputs(sweep.study(), sweep.values(point.point));
  return point;
}

/// Tasks for the points that are not in the store. If other processes have claimed points in the store, their results
/// are awaited.
class SweepLedger : public TaskLedger {
 public:
  SweepLedger(const Sweep& sweep, compute::ResultStore& store, SweepObserver* observer)
      : sweep_(sweep), store_(store), count_(sweep, store, observer) {
    refill();
  }

  std::optional<std::uint64_t> take() override {
    while (!open_.empty()) {
      const std::uint64_t point = open_.front();
      open_.pop_front();
      if (store_.claim(point)) return point;
    }
    return std::nullopt;
  }

  void give_back(std::uint64_t point) override {
    store_.give_up(point);
    open_.push_front(point);
  }

  void finish(std::uint64_t, const std::string& bytes) override {
    const compute::StoredPoint point = from_message(bytes, sweep_);
    store_.record(point);
    TaskProgress::Task(count_.points()).finish();
    count_.finished(point.failed);
  }

  bool is_finished() override {
    if (!open_.empty()) return false;
    if (store_.claimed_by_others() > 0) std::this_thread::sleep_for(kWaitForClaims);
    refill();
    return open_.empty();
  }

 private:
  void refill() {
    const std::vector<std::uint64_t> open = unfinished(sweep_, store_);
    open_.assign(open.begin(), open.end());
  }

  const Sweep& sweep_;
  compute::ResultStore& store_;
  SweepCount count_;
  std::deque<std::uint64_t> open_;
};

}  // namespace

std::optional<std::string> compute_shared(const Sweep& sweep, std::uint64_t number, const Cancellation* cancel) {
  const std::optional<compute::StoredPoint> point = compute_point(sweep.study(), number, sweep.values(number), cancel);
  return point ? std::optional(to_message(*point)) : std::nullopt;
}

ComputeTask compute_task(Sweep sweep) {
  return [kept = std::make_shared<const Sweep>(std::move(sweep))](std::uint64_t point, const Cancellation* cancel) {
    return compute_shared(*kept, point, cancel);
  };
}

bool distribute_sweep(const Sweep& sweep, compute::ResultStore& store, SweepObserver* observer,
                      const DistributeTasks& distribute) {
  SweepLedger ledger(sweep, store, observer);
  return distribute(
      [&sweep](std::uint64_t number, const Cancellation* cancel) { return compute_shared(sweep, number, cancel); },
      ledger);
}

}  // namespace retrace::studies

// Measures the overhead of a study in three ways: points per second with the exact engine, time for storing results,
// and distribution of points with MPI.
//   retrace_benchmarks --benchmark_filter=points|store
//   mpirun -np 3 retrace_benchmarks     # overhead of distributing points of 10 ms, as a fraction of the ranks' time

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "compute/ranks/mpi_session.h"
#include "core/threads.h"
#include "core/version.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_reader.h"
#include "studies/sweep/shared_sweep.h"

namespace retrace::benchmarks::studies_benchmark {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPoint{10};

/// Quantity whose computation takes 10 ms without using the processor, so that other load on the machine has no
/// influence.
class Sleep final : public studies::Quantity {
 public:
  Sleep() : Quantity("sleep") {}
  std::optional<studies::Measured> measure(const studies::Candidate&, const Cancellation*) const override {
    std::this_thread::sleep_for(kPoint);
    return studies::Measured{1.0, 0.0};
  }
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns a study of prisms as a function of incidence, with the exact engine.
studies::Study study_of(int points) {
  return studies::parse_study("design = \"" RETRACE_SOURCE_DIR
                              "/examples/rtp_single_0p45mm.toml\"\n[[parameter]]\nkey = \"analysis.incidence_deg\"\n"
                              "from = 0\nto = 40\ncount = " +
                                  std::to_string(points) +
                                  "\n[[quantity]]\nkind = \"rre\"\n[analysis]\nengine = \"exact\"\n",
                              "benchmark.toml");
}

studies::Sweep sleeping_sweep(int points) {
  studies::Study study = study_of(points);
  study.quantities = {std::make_shared<Sleep>()};
  return studies::read_sweep(std::move(study));
}

/// Store of results that is deleted by the destructor.
class TemporaryStore {
 public:
  explicit TemporaryStore(const studies::Sweep& sweep)
      : folder_(fs::temp_directory_path() / ("retrace_benchmark_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    store_ =
        std::make_unique<compute::ResultStore>(folder_ / "store.sqlite", sweep.layout(), compute::IfExists::overwrite);
  }
  ~TemporaryStore() {
    store_.reset();
    fs::remove_all(folder_);
  }
  compute::ResultStore& store() { return *store_; }

 private:
  fs::path folder_;
  std::unique_ptr<compute::ResultStore> store_;
};

void exact_points(benchmark::State& state) {
  const studies::Sweep sweep = studies::read_sweep(study_of(4000));
  for (auto _ : state) {
    TemporaryStore temporary(sweep);
    run_with_threads(static_cast<unsigned>(state.range(0)),
                     [&] { studies::run_sweep(sweep, temporary.store(), nullptr, nullptr); });
  }
  state.counters["points/s"] =
      benchmark::Counter(4000.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(exact_points)->Arg(1)->Arg(0)->ArgName("threads")->UseRealTime()->Unit(benchmark::kMillisecond);

/// Measures the elapsed time of a sweep on one thread, relative to the total time of its points. Each point takes 10
/// ms.
void store_overhead(benchmark::State& state) {
  constexpr int points = 200;
  const studies::Sweep sweep = sleeping_sweep(points);
  double with_s = 0.0;
  double without_s = 0.0;
  for (auto _ : state) {
    auto start = Clock::now();
    for (std::uint64_t k = 0; k < points; ++k) studies::compute_point(sweep.study(), k, sweep.values(k), nullptr);
    without_s += seconds_since(start);
    TemporaryStore temporary(sweep);
    start = Clock::now();
    run_with_threads(1, [&] { studies::run_sweep(sweep, temporary.store(), nullptr, nullptr); });
    with_s += seconds_since(start);
  }
  state.counters["overhead_percent"] = 100.0 * (with_s / without_s - 1.0);
}
BENCHMARK(store_overhead)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Measures the time of the last tenth of 10^5 points relative to the time of the first tenth.
void many_points(benchmark::State& state) {
  constexpr std::uint64_t points = 100'000;
  const studies::Sweep sweep = sleeping_sweep(2);
  double first_s = 0.0;
  double last_s = 0.0;
  for (auto _ : state) {
    TemporaryStore temporary(sweep);
    auto start = Clock::now();
    for (std::uint64_t k = 0; k < points; ++k) {
      if (k == points - points / 10) start = Clock::now();
      temporary.store().claim(k);
      temporary.store().record({k, false, "", {1.0}, {{1.0, 0.0}}, 0.0, kVersion});
      if (k + 1 == points / 10) first_s += seconds_since(start);
    }
    last_s += seconds_since(start);
  }
  state.counters["first_us"] = 1e6 * first_s / (0.1 * points) / static_cast<double>(state.iterations());
  state.counters["last_us"] = 1e6 * last_s / (0.1 * points) / static_cast<double>(state.iterations());
}
BENCHMARK(many_points)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Runs the benchmark as one of several MPI ranks. Each rank computes one point at a time.
int run_under_mpi() {
  constexpr int points = 900;
  const studies::Sweep sweep = sleeping_sweep(points);
  compute::MpiSession session;
  if (session.rank() != 0) {
    const ComputeTask compute = [&](std::uint64_t point, const Cancellation* cancel) {
      return studies::compute_shared(sweep, point, cancel);
    };
    session.compute_tasks(compute, 1, nullptr);
    session.end();
    return 0;
  }
  TemporaryStore temporary(sweep);
  const auto start = Clock::now();
  studies::distribute_sweep(sweep, temporary.store(), nullptr, [&](const ComputeTask& compute, TaskLedger& ledger) {
    return session.distribute_tasks(compute, ledger, 1, nullptr);
  });
  const double elapsed_s = seconds_since(start);
  double points_s = 0.0;
  for (const compute::StoredPoint& point : temporary.store().points()) points_s += point.elapsed_s;
  const double ranks = std::stod(std::getenv("OMPI_COMM_WORLD_SIZE"));
  std::printf("%g ranks, %d points of %.2f ms: %.2f s, overhead %.1f %%\n", ranks, points, 1e3 * points_s / points,
              elapsed_s, 100.0 * (elapsed_s * ranks / points_s - 1.0));
  session.end();
  return 0;
}

}  // namespace
}  // namespace retrace::benchmarks::studies_benchmark

int main(int argc, char** argv) {
  if (retrace::compute::MpiSession::is_launched()) return retrace::benchmarks::studies_benchmark::run_under_mpi();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

// Measures the speed-up of a loop without shared data on several cores. The speed-up of the engines must be compared
// with this value, because shared and throttled machines provide less than their number of cores.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <thread>
#include <vector>

namespace retrace::benchmarks::spin_probe_benchmark {
namespace {

/// Runs a single chain of dependent fused multiply-adds. Memory and vector units have no influence on its speed.
double spin(std::uint64_t steps) {
  double x = 0.5;
  for (std::uint64_t i = 0; i < steps; ++i) x = x * 0.999999 + 1e-7;
  return x;
}

/// Arg: number of threads.
void spin_probe(benchmark::State& state) {
  constexpr std::uint64_t kSteps = 100'000'000;
  const auto count = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < count; ++t)
      threads.emplace_back([] {
        double x = spin(kSteps);
        benchmark::DoNotOptimize(x);
      });
  }
  const double steps = static_cast<double>(count) * static_cast<double>(kSteps);
  state.counters["Msteps/s"] =
      benchmark::Counter(1e-6 * steps * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK(spin_probe)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(static_cast<std::int64_t>(std::max(1U, std::thread::hardware_concurrency())))
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::spin_probe_benchmark

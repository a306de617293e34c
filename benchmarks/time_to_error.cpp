// Time to a standard error of 0.01 percentage points of RRE, for each element kind.
#include <benchmark/benchmark.h>

#include <thread>

#include "benchmarks/scenes.h"
#include "raytrace/monte_carlo.h"
#include "raytrace/threads.h"

namespace retrace::benchmarks {
namespace {

/// Args: element kind (order of endless_scenes()), incidence in degrees, threads.
void time_to_error(benchmark::State& state) {
  static const std::vector<Scene> scenes = endless_scenes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  const raytrace::MonteCarlo tracer(scene.part);
  raytrace::Optics optics;
  optics.index = 1.4917;
  raytrace::Sampling sampling;
  sampling.target_error = 1e-4;
  raytrace::MonteCarloResult result;
  raytrace::run_with_threads(static_cast<unsigned>(state.range(2)), [&] {
    for (auto _ : state)
      result = tracer.trace(optics, {Angle::from_deg(static_cast<double>(state.range(1))), Angle::from_deg(10.0)},
                            {0.5}, sampling, {});
  });
  state.SetLabel(scene.name);
  state.counters["rays"] = static_cast<double>(result.rays);
  state.counters["std_error"] = result.cones.front().std_error;
}

BENCHMARK(time_to_error)
    ->ArgNames({"kind", "incidence", "threads"})
    ->ArgsProduct({{0, 1, 2}, {0, 10}, {1, static_cast<std::int64_t>(std::thread::hardware_concurrency())}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks

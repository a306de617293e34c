// Time to a standard error of 0.01 percentage points of RRE, for each element kind.
#include <benchmark/benchmark.h>

#include <array>
#include <thread>

#include "benchmarks/scenes.h"
#include "raytrace/monte_carlo.h"
#include "raytrace/threads.h"

namespace retrace::benchmarks {
namespace {

constexpr std::array<const char*, 3> kWays = {"cell", "Embree", "Embree, plain"};

/// Args: element kind (order of endless_scenes()), incidence in degrees, way, threads.
void time_to_error(benchmark::State& state) {
  static const std::vector<Scene> scenes = endless_scenes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  const std::int64_t way = state.range(2);
  using raytrace::MonteCarlo;
  const MonteCarlo tracer(scene.part, way == 0 ? MonteCarlo::Engine::cell : MonteCarlo::Engine::embree);
  raytrace::Optics optics;
  optics.index = 1.4917;
  raytrace::Sampling sampling;
  sampling.target_error = 1e-4;
  if (way == 2) sampling.kind = raytrace::Sampling::Kind::plain;
  raytrace::MonteCarloResult result;
  raytrace::run_with_threads(static_cast<unsigned>(state.range(3)), [&] {
    for (auto _ : state)
      result = tracer.trace(optics, {Angle::from_deg(static_cast<double>(state.range(1))), Angle::from_deg(10.0)},
                            {0.5}, sampling, {});
  });
  state.SetLabel(scene.name + ", " + kWays[static_cast<std::size_t>(way)]);
  state.counters["rays"] = static_cast<double>(result.rays);
  state.counters["std_error"] = result.cones.front().std_error;
}

BENCHMARK(time_to_error)
    ->ArgNames({"kind", "incidence", "way", "threads"})
    ->ArgsProduct(
        {{0, 1, 2}, {0, 10, 20, 30}, {0, 1, 2}, {1, static_cast<std::int64_t>(std::thread::hardware_concurrency())}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks

// Time to a standard error of 0.01 percentage points of RRE, for each element kind.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <thread>

#include "benchmarks/scenes.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/sampling/threads.h"

namespace retrace::benchmarks::time_to_error_benchmark {
namespace {

constexpr std::array<const char*, 3> kWays = {"cell", "Embree", "Embree, plain"};

/// Sq and correlation length of rough facets, both assumed alike for all kinds: finishing plunges reach Sq of this
/// order.
constexpr surface_models::Roughness kRoughFacets{10.0, 5.0, 0.0, 0.0};

/// Plain sampling is stopped at 0.05 points and its time scaled by the square of the errors: its error falls as
/// 1/sqrt(rays).
constexpr double kTargetError = 1e-4;
constexpr double kPlainTargetError = 5e-4;

/// Args: element kind (order of endless_scenes()), incidence in degrees, rough facets (0 or 1), way, threads.
void time_to_error(benchmark::State& state) {
  static const std::vector<Scene> scenes = endless_scenes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  const bool is_rough = state.range(2) == 1;
  const std::int64_t way = state.range(3);
  const bool is_plain = way == 2;
  using raytrace::MonteCarlo;
  const MonteCarlo tracer(scene.part, way == 0 ? MonteCarlo::Engine::cell : MonteCarlo::Engine::embree);
  raytrace::Optics optics;
  optics.index = 1.4917;
  if (is_rough) optics.facet_scatter = surface_models::HarveyShack(kRoughFacets);
  raytrace::Sampling sampling;
  sampling.target_error = is_plain ? kPlainTargetError : kTargetError;
  if (is_plain) sampling.kind = raytrace::Sampling::Kind::plain;
  raytrace::MonteCarloResult result;
  const auto start = std::chrono::steady_clock::now();
  raytrace::run_with_threads(static_cast<unsigned>(state.range(4)), [&] {
    for (auto _ : state)
      result = tracer.trace(optics, {Angle::from_deg(static_cast<double>(state.range(1))), Angle::from_deg(10.0)},
                            {0.5}, sampling, {});
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const double std_error = result.cones.front().std_error;
  const double seconds = elapsed.count() / static_cast<double>(state.iterations());
  state.SetLabel(scene.name + (is_rough ? ", rough, " : ", ") + kWays[static_cast<std::size_t>(way)]);
  state.counters["rays"] = static_cast<double>(result.rays);
  state.counters["std_error"] = std_error;
  state.counters["s_to_target"] =
      is_plain ? seconds * (std_error * std_error) / (kTargetError * kTargetError) : seconds;
}

BENCHMARK(time_to_error)
    ->ArgNames({"kind", "incidence", "rough", "way", "threads"})
    ->ArgsProduct({{0, 1, 2},
                   {0, 10, 20, 30},
                   {0, 1},
                   {0, 1, 2},
                   {1, static_cast<std::int64_t>(std::thread::hardware_concurrency())}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::time_to_error_benchmark

// Benchmarks of the exact engine: time per point and per beam, cost of lower cut-offs, and scaling with the number of
// elements.
#include <benchmark/benchmark.h>

#include <cmath>

#include "benchmarks/scenes.h"
#include "raytrace/exact/beam_tracer.h"

namespace retrace::benchmarks::beams_benchmark {
namespace {

raytrace::Optics pmma() {
  raytrace::Optics optics;
  optics.index = 1.4917;
  return optics;
}

void report(benchmark::State& state, const raytrace::BeamResult& result) {
  const double beams = static_cast<double>(result.beams);
  state.counters["beams"] = beams;
  state.counters["truncated"] = result.ledgers[0][raytrace::Account::truncated];
  state.counters["time/beam"] = benchmark::Counter(beams * static_cast<double>(state.iterations()),
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Args: element kind (order of infinite_scenes()), incidence and azimuth in degrees, -log10 of the truncated power.
void beams_of_a_point(benchmark::State& state) {
  static const std::vector<Scene> scenes = infinite_scenes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  const raytrace::BeamTracer tracer(scene.part);
  raytrace::BeamPolicy policy;
  policy.truncated_goal = std::pow(10.0, -static_cast<double>(state.range(3)));
  raytrace::BeamResult result;
  for (auto _ : state)
    result = tracer.trace(
        pmma(),
        {Angle::from_deg(static_cast<double>(state.range(1))), Angle::from_deg(static_cast<double>(state.range(2)))},
        {0.5}, policy);
  state.SetLabel(scene.name);
  report(state, result);
}

/// Arg: number of elements along a side of a finite brick array. Normal incidence, truncated power 1e-6.
void beams_of_a_finite_array(benchmark::State& state) {
  const Scene scene = brick_scene(static_cast<int>(state.range(0)));
  const raytrace::BeamTracer tracer(scene.part);
  raytrace::BeamPolicy policy;
  policy.truncated_goal = 1e-6;
  raytrace::BeamResult result;
  for (auto _ : state) result = tracer.trace(pmma(), {}, {0.5}, policy);
  report(state, result);
}

BENCHMARK(beams_of_a_point)
    ->ArgNames({"kind", "incidence", "azimuth", "decades"})
    ->ArgsProduct({{0}, {0, 20, 40}, {0}, {6, 8, 10}})
    ->ArgsProduct({{0}, {20, 40}, {25}, {3, 4, 5}})
    ->ArgsProduct({{1, 2}, {0, 10, 20}, {4}, {4, 5, 6}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(beams_of_a_finite_array)
    ->ArgName("side")
    ->Arg(5)
    ->Arg(10)
    ->Arg(20)
    ->Arg(40)
    ->Arg(80)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::beams_benchmark

// Measures the time to reach a standard error of RRE (retroreflective efficiency) of 0.01 and 0.001 percentage points,
// for each element kind.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "benchmarks/scenes.h"
#include "core/threads.h"
#include "raytrace/exact/scattered_rays.h"
#include "raytrace/exact/stochastic_beams.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/paths/monte_carlo.h"

namespace retrace::benchmarks::time_to_error_benchmark {
namespace {

enum Way : std::int64_t { kStochastic, kCell, kEmbree, kPlain };
constexpr std::array<const char*, 4> kWays = {"stochastic beams", "cell", "Embree", "Embree, plain"};

/// Rms height Sq and correlation length of rough facets. All element kinds use the same values. Facets finished by
/// plunge cutting have an Sq of this magnitude.
constexpr surface_models::Roughness kRoughFacets{10.0, 5.0, 0.0, 0.0};

/// Target error of plain Monte Carlo sampling: 0.05 percentage points. The time for a smaller error is extrapolated
/// with the squared ratio of the errors, because the error is proportional to 1/sqrt(rays).
constexpr double kPlainTargetError = 5e-4;

/// Returns infinite arrays, and a finite array of full cubes of 2.5 mm on 20 x 20 mm.
std::vector<Scene> scenes_of_all_sizes() {
  std::vector<Scene> scenes = infinite_scenes();
  geometry::PartSpec spec;
  spec.element = geometry::HexagonalCube{2.5};
  spec.array.arrangement = geometry::Arrangement::honeycomb;
  spec.array.extent = geometry::Extent::finite;
  spec.array.x_length_mm = 20.0;
  spec.array.y_length_mm = 20.0;
  spec.thickness_mm = 2.0;
  scenes.push_back({"20 x 20 mm of hexagonal_icc", geometry::build_part(spec), {10.0, 10.0}});
  return scenes;
}

double stochastic_error(const geometry::Part& part, const raytrace::Optics& optics, const raytrace::Illumination& light,
                        const raytrace::Sampling& sampling) {
  const raytrace::BeamTracer tracer(part, raytrace::BeamTracer::Elements::instanced);
  std::optional<raytrace::BackSurface> surface;
  std::optional<raytrace::ScatteredLightByRays> scattered;
  if (!optics.is_smooth()) {
    surface.emplace(part, tracer.centre_mm());
    scattered.emplace(tracer, *surface, optics, light, std::vector<double>{0.5});
  }
  raytrace::StochasticBeams beams(tracer, scattered ? &*scattered : nullptr, optics, light, {0.5}, sampling);
  while (!beams.advance()) continue;
  return beams.result().cones.front().std_error;
}

/// Args: element kind (order of scenes_of_all_sizes()), incidence in degrees, rough facets (0 or 1), method, threads,
/// -log10 of the target error.
void time_to_error(benchmark::State& state) {
  static const std::vector<Scene> scenes = scenes_of_all_sizes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  const bool is_rough = state.range(2) == 1;
  const std::int64_t way = state.range(3);
  const double target_error = std::pow(10.0, -static_cast<double>(state.range(5)));
  using raytrace::MonteCarlo;
  raytrace::Optics optics;
  optics.index = 1.4917;
  if (is_rough)
    optics.facet_scatter = surface_models::HarveyShack(kRoughFacets, {optics.index, 1.0, optics.wavelength_nm});
  raytrace::Sampling sampling;
  sampling.target_error = way == kPlain ? kPlainTargetError : target_error;
  if (way == kPlain) sampling.kind = raytrace::Sampling::Kind::plain;
  const raytrace::Illumination light{Angle::from_deg(static_cast<double>(state.range(1))), Angle::from_deg(10.0)};
  double std_error = 0.0;
  const auto start = std::chrono::steady_clock::now();
  run_with_threads(static_cast<unsigned>(state.range(4)), [&] {
    const MonteCarlo tracer(scene.part, way == kCell ? MonteCarlo::Engine::cell : MonteCarlo::Engine::embree);
    for (auto _ : state)
      std_error = way == kStochastic ? stochastic_error(scene.part, optics, light, sampling)
                                     : tracer.trace(optics, light, {0.5}, sampling, {}).cones.front().std_error;
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const double seconds = elapsed.count() / static_cast<double>(state.iterations());
  state.SetLabel(scene.name + (is_rough ? ", rough, " : ", ") + kWays[static_cast<std::size_t>(way)]);
  state.counters["std_error"] = std_error;
  state.counters["s_to_target"] =
      way == kPlain ? seconds * (std_error * std_error) / (target_error * target_error) : seconds;
}

void cases(benchmark::internal::Benchmark* benchmark) {
  const auto threads = static_cast<std::int64_t>(std::thread::hardware_concurrency());
  for (const std::int64_t kind : {0, 1, 2, 3})
    for (const std::int64_t incidence : {0, 10, 20, 30})
      for (const std::int64_t rough : {0, 1})
        for (const std::int64_t way : {kStochastic, kCell, kEmbree, kPlain}) {
          for (const std::int64_t count : {std::int64_t{1}, threads})
            benchmark->Args({kind, incidence, rough, way, count, 4});
          if (way == kStochastic || way == kCell) benchmark->Args({kind, incidence, rough, way, 1, 5});
        }
}

BENCHMARK(time_to_error)
    ->ArgNames({"kind", "incidence", "rough", "way", "threads", "decades"})
    ->Apply(cases)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::time_to_error_benchmark

// Benchmarks of complete paths through infinite arrays. Compares the cell engine (which traces a path from cell to cell
// of the array), Embree, and a minimal loop whose time is a lower bound.
#include <benchmark/benchmark.h>

#include <cmath>
#include <thread>
#include <vector>

#include "benchmarks/scenes.h"
#include "core/threads.h"
#include "raytrace/paths/monte_carlo.h"

namespace retrace::benchmarks::cell_paths_benchmark {
namespace {

using raytrace::MonteCarlo;

/// Args: element kind (order of infinite_scenes()), incidence in degrees, engine (0 Embree, 1 cell), threads.
void endless_paths(benchmark::State& state) {
  static const std::vector<Scene> scenes = infinite_scenes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  const bool is_cell = state.range(2) == 1;
  const MonteCarlo tracer(scene.part, is_cell ? MonteCarlo::Engine::cell : MonteCarlo::Engine::embree);
  raytrace::Optics optics;
  optics.index = 1.4917;
  raytrace::Sampling sampling;
  sampling.rays = is_cell ? 1U << 20 : 1U << 17;
  double segments = 0.0;
  double paths = 0.0;
  run_with_threads(static_cast<unsigned>(state.range(3)), [&] {
    for (auto _ : state) {
      const auto result = tracer.trace(
          optics, {Angle::from_deg(static_cast<double>(state.range(1))), Angle::from_deg(10.0)}, {0.5}, sampling, {});
      segments += static_cast<double>(result.segments);
      paths += static_cast<double>(result.rays);
    }
  });
  state.SetLabel(scene.name + (is_cell ? ", cell" : ", Embree"));
  state.counters["Msegments/s"] = benchmark::Counter(1e-6 * segments, benchmark::Counter::kIsRate);
  state.counters["Mpaths/s"] = benchmark::Counter(1e-6 * paths, benchmark::Counter::kIsRate);
}

struct Bundle {
  std::vector<double> x, weight;
};

/// Traces paths in one plane of incidence through one prism. Each path enters the prism, is reflected at the facets and
/// leaves. The loop contains only intersections with planes, tests for total reflection, Fresnel weights of s and p,
/// and the shift back into the cell.
__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"))) void bare_paths(
    double* __restrict x, double* __restrict weight, std::size_t count, double sine, double index, double thickness) {
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double half = 0.25;
  const double c = std::sqrt(0.5);
  for (std::size_t i = 0; i < count; ++i) {
    const double ci = std::sqrt(1.0 - sine * sine / (index * index));
    const double rs0 = (cosine - index * ci) / (cosine + index * ci);
    const double rp0 = (index * cosine - ci) / (index * cosine + ci);
    double ws = 1.0 - rs0 * rs0;
    double wp = 1.0 - rp0 * rp0;
    double dx = -sine / index;
    double dz = -ci;
    double px = x[i] + thickness * dx / -dz;
    px -= 0.5 * std::floor(px / 0.5);
    px -= half;
    double pz = 0.0;
    for (int bounce = 0; bounce < 2; ++bounce) {
      // The facets are z = -half + |px|. Their outward normals are (-+c, -c).
      const double n1 = -c * dx - c * dz;
      const double n2 = c * dx - c * dz;
      const double t1 = n1 > 0.0 ? (c * half + c * px + c * pz) / n1 : 1e30;
      const double t2 = n2 > 0.0 ? (c * half - c * px + c * pz) / n2 : 1e30;
      const double t = t1 < t2 ? t1 : t2;
      const double nx = t1 < t2 ? -c : c;
      const double along = t1 < t2 ? n1 : n2;
      px += t * dx;
      pz += t * dz;
      const double sin2 = index * index * (1.0 - along * along);
      const double ct = std::sqrt(sin2 < 1.0 ? 1.0 - sin2 : 0.0);
      const double rs = sin2 < 1.0 ? (index * along - ct) / (index * along + ct) : 1.0;
      const double rp = sin2 < 1.0 ? (along - index * ct) / (along + index * ct) : 1.0;
      ws *= rs * rs;
      wp *= rp * rp;
      dx -= 2.0 * along * nx;
      dz += 2.0 * along * c;
    }
    const double co = dz;
    const double so2 = index * index * (1.0 - co * co);
    const double ct = std::sqrt(so2 < 1.0 ? 1.0 - so2 : 0.0);
    const double rs = so2 < 1.0 ? (index * co - ct) / (index * co + ct) : 1.0;
    const double rp = so2 < 1.0 ? (co - index * ct) / (co + index * ct) : 1.0;
    weight[i] = 0.5 * (ws * (1.0 - rs * rs) + wp * (1.0 - rp * rp));
  }
}

/// Arg: incidence in degrees. One thread.
void bare_loop(benchmark::State& state) {
  constexpr std::size_t kRays = 4096;
  Bundle bundle{std::vector<double>(kRays), std::vector<double>(kRays)};
  for (std::size_t i = 0; i < kRays; ++i)
    bundle.x[i] = std::fmod(0.618033988749895 * static_cast<double>(i), 1.0) * 0.5;
  const double sine = std::sin(Angle::from_deg(static_cast<double>(state.range(0))).rad());
  for (auto _ : state) {
    bare_paths(bundle.x.data(), bundle.weight.data(), kRays, sine, 1.4917, 1.0);
    benchmark::DoNotOptimize(bundle.weight.data());
    benchmark::ClobberMemory();
  }
  const double paths = static_cast<double>(kRays) * static_cast<double>(state.iterations());
  state.counters["Mpaths/s"] = benchmark::Counter(1e-6 * paths, benchmark::Counter::kIsRate);
  state.counters["Msegments/s"] = benchmark::Counter(4e-6 * paths, benchmark::Counter::kIsRate);
}

BENCHMARK(bare_loop)->ArgName("incidence")->Arg(0)->Arg(20);
BENCHMARK(endless_paths)
    ->ArgNames({"kind", "incidence", "engine", "threads"})
    ->ArgsProduct({{0, 1, 2}, {0, 20}, {0, 1}, {1, static_cast<std::int64_t>(std::thread::hardware_concurrency())}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::cell_paths_benchmark

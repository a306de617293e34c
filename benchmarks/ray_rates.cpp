// Benchmarks of rays per second: Embree only, the surface search with exact intersections, and complete paths.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <thread>

#include "benchmarks/raw_embree.h"
#include "benchmarks/scenes.h"
#include "core/threads.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/paths/monte_carlo.h"

namespace retrace::benchmarks {

using geometry::Arrangement;
using geometry::Vec2;
using geometry::Vec3;
using raytrace::BackSurface;
using raytrace::SurfaceRay;

Scene brick_scene(int n) {
  geometry::PartSpec spec;
  spec.element = geometry::RtpElement{0.5, 0.5, 90.0};
  spec.array.arrangement = Arrangement::offset;
  spec.array.x_length_mm = spec.array.y_length_mm = 0.5 * n;
  spec.thickness_mm = 0.5;
  Scene scene{std::to_string(n * n) + " prisms", geometry::build_part(spec), Vec2::Constant(0.25 * n)};
  return scene;
}

std::vector<Scene> infinite_scenes() {
  geometry::PartSpec spec;
  spec.array.extent = geometry::Extent::infinite;
  spec.thickness_mm = 1.0;
  const double aperture = 2.0 * std::sqrt(2.0 / 3.0);
  std::vector<Scene> scenes;
  const auto add = [&](std::string name, const geometry::Element& element, Arrangement arrangement) {
    spec.element = element;
    spec.array.arrangement = arrangement;
    geometry::Part part = geometry::build_part(spec);
    const Vec2 centre = 0.5 * *part.period_mm;
    scenes.push_back({std::move(name), std::move(part), centre});
  };
  add("rtp", geometry::RtpElement{0.5, 0.5, 90.0}, Arrangement::offset);
  add("hexagonal_icc", geometry::HexagonalCube{aperture}, Arrangement::honeycomb);
  add("triangular_icc", geometry::TriangularCube{aperture}, Arrangement::triangular);
  return scenes;
}

std::vector<SurfaceRay> coherent_rays(const Scene& scene, std::size_t count) {
  const Vec2 half = 0.98 * scene.centre_mm;
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
  std::vector<SurfaceRay> rays;
  for (std::size_t j = 0; j < side; ++j)
    for (std::size_t i = 0; i < side; ++i) {
      SurfaceRay ray;
      const Vec2 u(2.0 * static_cast<double>(i) / static_cast<double>(side) - 1.0,
                   2.0 * static_cast<double>(j) / static_cast<double>(side) - 1.0);
      ray.origin = Vec3(half.x() * u.x(), half.y() * u.y(), 0.002);
      ray.direction = Vec3(std::sin(0.1), 0.0, -std::cos(0.1));
      rays.push_back(ray);
    }
  return rays;
}

std::vector<SurfaceRay> incoherent_rays(const Scene& scene, std::size_t count) {
  const BackSurface surface(scene.part, scene.centre_mm);
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<SurfaceRay> rays;
  while (rays.size() < count) {
    SurfaceRay ray;
    ray.origin =
        Vec3(0.98 * scene.centre_mm.x() * unit(generator), 0.98 * scene.centre_mm.y() * unit(generator), 0.002);
    ray.direction = -Vec3::UnitZ();
    const auto hit = surface.first_hit(ray);
    if (!hit) continue;
    ray.origin += hit->t * ray.direction;
    ray.source = hit->facet;
    ray.direction = Vec3(normal(generator), normal(generator), normal(generator)).normalized();
    const Vec3 n = surface.facet(hit->facet).normal;
    const double out = ray.direction.dot(n);
    if (out > 0.0) ray.direction -= 2.0 * out * n;
    rays.push_back(ray);
  }
  return rays;
}

namespace {

constexpr std::size_t kRays = 200'000;

const Scene& scene_of(std::int64_t n) {
  static const Scene small = brick_scene(20);
  static const Scene large = brick_scene(222);
  return n == 20 ? small : large;
}

const std::vector<SurfaceRay>& rays_of(std::int64_t n, bool coherent) {
  static const std::vector<SurfaceRay> rays[4] = {
      incoherent_rays(scene_of(20), kRays), coherent_rays(scene_of(20), kRays), incoherent_rays(scene_of(222), kRays),
      coherent_rays(scene_of(222), kRays)};
  return rays[(n == 20 ? 0 : 2) + (coherent ? 1 : 0)];
}

void report(benchmark::State& state, std::size_t rays_per_iteration) {
  state.counters["Mrays/s"] =
      benchmark::Counter(1e-6 * static_cast<double>(rays_per_iteration) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

// Runs a benchmark with rays_of(), which are computed only one time. Args: number of elements along a side, and whether
// the rays are coherent.
template <class Trace>
void run_raw(benchmark::State& state, const Trace& trace) {
  static const RawEmbree small(scene_of(20));
  static const RawEmbree large(scene_of(222));
  const RawEmbree& raw = state.range(0) == 20 ? small : large;
  const auto& rays = rays_of(state.range(0), state.range(1) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(trace(raw, rays));
  report(state, rays.size());
}

void raw_embree_1(benchmark::State& state) {
  run_raw(state, [](const RawEmbree& raw, const auto& rays) { return raw.trace1(rays); });
}
void raw_embree_8(benchmark::State& state) {
  run_raw(state, [](const RawEmbree& raw, const auto& rays) { return raw.trace8(rays); });
}
void raw_embree_16(benchmark::State& state) {
  run_raw(state, [](const RawEmbree& raw, const auto& rays) { return raw.trace16(rays); });
}

void raw_embree_streams(benchmark::State& state) {
  run_raw(state, [](const RawEmbree& raw, const auto& rays) { return raw.trace_streams(rays); });
}

void raw_embree_flat(benchmark::State& state) {
  static const RawEmbree small(scene_of(20), RawEmbree::Build::flat);
  static const RawEmbree large(scene_of(222), RawEmbree::Build::flat);
  const RawEmbree& raw = state.range(0) == 20 ? small : large;
  const auto& rays = rays_of(state.range(0), state.range(1) != 0);
  for (auto _ : state) benchmark::DoNotOptimize(raw.trace1(rays));
  report(state, rays.size());
}

/// Measures the tracer's own search with the rays of run_raw(). It consists of Embree, the exclusion of the source
/// facet, and the intersection with the plane in double precision.
void surface_search(benchmark::State& state) {
  static const BackSurface small(scene_of(20).part, scene_of(20).centre_mm);
  static const BackSurface large(scene_of(222).part, scene_of(222).centre_mm);
  const BackSurface& surface = state.range(0) == 20 ? small : large;
  const auto& rays = rays_of(state.range(0), state.range(1) != 0);
  for (auto _ : state) {
    std::size_t hits = 0;
    for (const SurfaceRay& ray : rays) hits += surface.first_hit(ray).has_value();
    benchmark::DoNotOptimize(hits);
  }
  report(state, rays.size());
}

/// Measures complete paths with polarisation, splitting and the energy ledger. Args: elements along a side, incidence
/// in degrees, threads.
void whole_paths(benchmark::State& state) {
  const raytrace::MonteCarlo tracer(scene_of(state.range(0)).part);
  raytrace::Optics optics;
  optics.index = 1.4917;
  raytrace::Sampling sampling;
  sampling.rays = 1U << 17;
  double segments = 0.0;
  double paths = 0.0;
  run_with_threads(static_cast<unsigned>(state.range(2)), [&] {
    for (auto _ : state) {
      const auto result =
          tracer.trace(optics, {Angle::from_deg(static_cast<double>(state.range(1))), {}}, {0.5}, sampling, {});
      segments += static_cast<double>(result.segments);
      paths += static_cast<double>(result.rays);
    }
  });
  state.counters["Msegments/s"] = benchmark::Counter(1e-6 * segments, benchmark::Counter::kIsRate);
  state.counters["Mpaths/s"] = benchmark::Counter(1e-6 * paths, benchmark::Counter::kIsRate);
}

void surface_args(benchmark::internal::Benchmark* b) {
  b->ArgNames({"side", "coherent"})->ArgsProduct({{20, 222}, {0, 1}})->UseRealTime();
  b->Threads(1)->Threads(static_cast<int>(std::thread::hardware_concurrency()));
}

BENCHMARK(raw_embree_1)->Apply(surface_args);
BENCHMARK(raw_embree_flat)->Apply(surface_args);
BENCHMARK(raw_embree_8)->Apply(surface_args);
BENCHMARK(raw_embree_16)->Apply(surface_args);
BENCHMARK(raw_embree_streams)->Apply(surface_args);
BENCHMARK(surface_search)->Apply(surface_args);
BENCHMARK(whole_paths)
    ->ArgNames({"side", "incidence", "threads"})
    ->ArgsProduct({{20, 222}, {0, 20}, {1, static_cast<std::int64_t>(std::thread::hardware_concurrency())}})
    ->UseRealTime();

}  // namespace
}  // namespace retrace::benchmarks

// Benchmarks of the far field: Fourier transform of a polygon, field of an infinite array of cube corners, and
// intensity at a receiver.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "benchmarks/scenes.h"
#include "raytrace/observers/far_field.h"

namespace retrace::benchmarks::far_field_benchmark {
namespace {

/// Arg: number of corners of the polygon.
void transform_of_a_polygon(benchmark::State& state) {
  geometry::Polygon polygon;
  for (std::int64_t k = 0; k < state.range(0); ++k) {
    const double a = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(state.range(0));
    polygon.push_back({std::cos(a), std::sin(a)});
  }
  const raytrace::PolygonTransform transform(polygon);
  double x = 1.0;
  for (auto _ : state) benchmark::DoNotOptimize(transform.at({x += 0.1, 3.0}));
}

raytrace::FarField field_at(const geometry::Part& part, double incidence_deg) {
  raytrace::Optics optics;
  optics.index = 1.4917;
  const raytrace::Illumination light{Angle::from_deg(incidence_deg), Angle::from_deg(4.0)};
  raytrace::FarFieldCollector collector(part, light, {});
  raytrace::BeamPolicy policy;
  policy.cutoff = 1e-6;
  policy.separate_cells = true;
  raytrace::BeamTracer(part).trace(optics, light, {0.5}, policy, nullptr,
                                   [&](const raytrace::ReturnedBeam& beam) { collector.add(beam); });
  return collector.finish();
}

std::int64_t polygons_of(const raytrace::FarField& field) {
  std::size_t count = 0;
  for (const raytrace::CoherentGroup& group : field.groups()) count += group.polygons.size();
  return static_cast<std::int64_t>(count);
}

/// Args: element kind (order of infinite_scenes()), incidence in degrees.
void far_field_of_an_array(benchmark::State& state) {
  static const std::vector<Scene> scenes = infinite_scenes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  std::int64_t polygons = 0;
  for (auto _ : state) polygons = polygons_of(field_at(scene.part, static_cast<double>(state.range(1))));
  state.SetLabel(scene.name);
  state.counters["polygons"] = static_cast<double>(polygons);
}

/// Args: element kind (order of infinite_scenes()), incidence in degrees. Source and receiver have a diameter of 10
/// minutes of arc.
void intensity_at_a_receiver(benchmark::State& state) {
  static const std::vector<Scene> scenes = infinite_scenes();
  const Scene& scene = scenes[static_cast<std::size_t>(state.range(0))];
  const raytrace::FarField field = field_at(scene.part, static_cast<double>(state.range(1)));
  const raytrace::ApertureKernel kernel({Angle::from_deg(10.0 / 60.0), Angle::from_deg(10.0 / 60.0)});
  const Angle t = Angle::from_deg(static_cast<double>(state.range(1)) + 0.33);
  const raytrace::Vec3 direction(std::sin(t.rad()), 0.0, std::cos(t.rad()));
  for (auto _ : state) benchmark::DoNotOptimize(field.intensity(direction, kernel).per_sr);
  state.SetLabel(scene.name);
  state.counters["polygons"] = static_cast<double>(polygons_of(field));
}

BENCHMARK(transform_of_a_polygon)->ArgName("corners")->Arg(3)->Arg(6)->Arg(12);
BENCHMARK(far_field_of_an_array)
    ->ArgNames({"kind", "incidence"})
    ->ArgsProduct({{0, 1, 2}, {0, 20}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(intensity_at_a_receiver)
    ->ArgNames({"kind", "incidence"})
    ->ArgsProduct({{0, 1, 2}, {0, 20}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace retrace::benchmarks::far_field_benchmark

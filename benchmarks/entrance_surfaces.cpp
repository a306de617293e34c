// Benchmarks of complete paths through curved entrance surfaces over a plate with a mirror, compared with a plane
// entrance face.
#include <benchmark/benchmark.h>

#include <memory>

#include "core/threads.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/part/plate.h"
#include "raytrace/paths/monte_carlo.h"
#include "tests/support/entrance_surfaces.h"

namespace retrace::benchmarks::fronts_benchmark {
namespace {

using geometry::Vec3;

constexpr double kSize = 2.0;
constexpr double kThickness = 1.0;

/// Returns a surface with bumps of 0.02 mm, ten along a side.
std::shared_ptr<const geometry::EntranceSurface> bumps_surface() {
  geometry::Sag sag;
  sag.formula = parse_formula("0.02 * cos(15.707963267949 * x) * cos(15.707963267949 * y)", {"x", "y"}, {});
  return std::make_shared<const geometry::EntranceSurface>(geometry::FreeformSurface(sag, std::nullopt, {}, {}),
                                                           Vec3(0.0, 0.0, kThickness), 0.1 * kSize);
}

geometry::Entrance meshed(const geometry::EntranceSurface& surface, std::uint32_t cells,
                          const geometry::Polygon& outline) {
  return std::make_shared<const geometry::SurfacePatch>(geometry::entrance_of_mesh(
      testing::meshed(surface, kSize, cells), geometry::MeshSide::top, Vec3::Zero(), outline));
}

/// Arg: 0 plane entrance face, 1 exact surface, 2 mesh of this surface with 20,000 triangles.
void entrance_paths(benchmark::State& state) {
  const geometry::Part plate = geometry::build_plate({kSize, kSize}, kThickness);
  const auto bumps = bumps_surface();
  const geometry::Entrance exact = bumps;
  const geometry::Entrance mesh = meshed(*bumps, 100, plate.outline);
  const geometry::Entrance* const entrances[] = {nullptr, &exact, &mesh};
  const raytrace::MonteCarlo tracer(plate, raytrace::MonteCarlo::Engine::embree, entrances[state.range(0)]);
  raytrace::Optics optics;
  optics.index = 1.4917;
  optics.mirror_facets = true;
  raytrace::Sampling sampling;
  sampling.rays = 1U << 16;
  double paths = 0.0;
  double segments = 0.0;
  run_with_threads(1, [&] {
    for (auto _ : state) {
      const auto result = tracer.trace(optics, {Angle::from_deg(10.0), {}}, {0.5}, sampling, {});
      paths += static_cast<double>(result.rays);
      segments += static_cast<double>(result.segments);
    }
  });
  state.counters["Msegments/s"] = benchmark::Counter(1e-6 * segments, benchmark::Counter::kIsRate);
  state.counters["Mpaths/s"] = benchmark::Counter(1e-6 * paths, benchmark::Counter::kIsRate);
}
BENCHMARK(entrance_paths)->Arg(0)->Arg(1)->Arg(2)->UseRealTime();

}  // namespace
}  // namespace retrace::benchmarks::fronts_benchmark

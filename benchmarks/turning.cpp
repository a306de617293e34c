// Measures path points per second on one core, for a polynomial surface and for an array of 1,000 tilted lenslets.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

#include "fabrication/turning/plan/path.h"

namespace retrace::benchmarks::turning_benchmark {
namespace {

using namespace retrace::fabrication::turning;
using namespace retrace::geometry;

TurningTool tool() {
  TurningTool result;
  result.nose_radius_mm = 0.05;
  return result;
}

void polynomial_path(benchmark::State& state) {
  Sag sag;
  XyPolynomial p{1.0, 6, std::vector<double>(XyPolynomial::count(6), 0.0)};
  for (int i = 0; i <= 6; ++i)
    for (int j = 0; i + j <= 6; ++j) p.coefficients[p.index(i, j)] = 1e-3 / (1 + i + 2 * j);
  sag.polynomial = p;
  const FreeformSurface surface(sag, std::nullopt, {}, {});
  PathOptions options;
  options.radius_mm = 1.0;
  options.feed_mm = 1e-3;
  options.points_per_turn = 1000;
  std::size_t points = 0;
  for (auto _ : state) points += make_path(surface, tool(), options, {}).front().size();
  state.SetItemsProcessed(static_cast<std::int64_t>(points));
}

/// Returns 32 x 32 aspheres on a sphere with C2 blends. The axis of each asphere is along the sphere's normal.
FreeformSurface lenslet_array() {
  Sag base;
  base.asphere.curvature_per_mm = -0.02;
  const FreeformSurface bare(base, std::nullopt, {}, {});
  std::vector<Lenslet> lenslets;
  for (int i = 0; i < 32; ++i)
    for (int k = 0; k < 32; ++k) {
      Lenslet lenslet;
      lenslet.sag.asphere = {-0.8, -0.5, {1e-3}};
      const retrace::geometry::Vec2 at(0.3 * (i - 15.5), 0.3 * (k - 15.5));
      place_on_base(lenslet, bare, at.x(), at.y(), 5e-3, true, {});
      lenslet.inner = circle_boundary(at, 0.11);
      lenslet.outer = circle_boundary(at, 0.14);
      lenslets.push_back(lenslet);
    }
  return {base, std::nullopt, lenslets, {}};
}

void lenslet_path(benchmark::State& state) {
  const FreeformSurface surface = lenslet_array();
  PathOptions options;
  options.radius_mm = 4.5;
  options.feed_mm = 0.02;
  options.points_per_turn = 5000;
  std::size_t points = 0;
  for (auto _ : state) points += make_path(surface, tool(), options, {}).front().size();
  state.SetItemsProcessed(static_cast<std::int64_t>(points));
}

/// Measures the time of the proof that the tool nose touches this array at only one point at a time. The proof is
/// computed once per path.
void lenslet_proof(benchmark::State& state) {
  const FreeformSurface surface = lenslet_array();
  for (auto _ : state) benchmark::DoNotOptimize(SingleContactMap(surface, tool(), 4.5).has_single_contact(0.0, 0.0));
}

/// Computes the same points as the benchmark above, but searches the complete arc of the tool at each point.
void lenslet_search(benchmark::State& state) {
  const FreeformSurface surface = lenslet_array();
  const NoseCompensation nose(surface, tool());
  double angle = 0.0;
  double c = 0.0;
  for (auto _ : state) {
    c += 2.0 * std::numbers::pi / 5000.0;
    const retrace::geometry::Vec2 across(std::cos(c), -std::sin(c));
    const retrace::geometry::Vec2 cut(-std::sin(c), -std::cos(c));
    const retrace::geometry::Vec2 tip = (4.5 - std::fmod(3e-3 * c, 4.0)) * across;
    benchmark::DoNotOptimize(nose.height_mm(tip.x(), tip.y(), across, cut, angle));
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK(polynomial_path)->Unit(benchmark::kMillisecond);
BENCHMARK(lenslet_path)->Unit(benchmark::kMillisecond);
BENCHMARK(lenslet_proof)->Unit(benchmark::kMillisecond);
BENCHMARK(lenslet_search)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace retrace::benchmarks::turning_benchmark

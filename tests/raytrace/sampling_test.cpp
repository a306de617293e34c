// Tests of sampling: stratification, uniform distribution over the entrance face, and correct standard errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "core/random.h"
#include "geometry/part/mesh_part.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "raytrace/sampling/replicate_means.h"
#include "raytrace/sampling/sobol.h"
#include "tests/support/designs.h"
#include "tests/support/sample_size.h"
#include "tests/support/statistics.h"

namespace retrace::testing::sampling_test {
namespace {

using namespace geometry;
using namespace raytrace;

TEST(ReplicateMeans, TheStokesParameterOfPowerIsTheEfficiency) {
  std::mt19937 random(59);
  std::uniform_real_distribution<double> power(0.0, 1.0);
  for (const std::uint32_t rays : {1U, 3U, 1000U, 4097U}) {
    std::vector<Tally> replicates(32, Tally(3));
    for (Tally& tally : replicates)
      for (auto* const sums : {&tally.returned, &tally.scattered, &tally.entrance_reflected})
        for (Stokes& sum : *sums) sum.i = rays * power(random);
    for (const ConeResult& cone : result_of(replicates, rays, {0.1, 0.5, 2.0}).cones)
      EXPECT_EQ(cone.stokes.i, cone.rre) << rays << " rays";
  }
}

// A scrambled (0, m, 2)-net has 2^m points. Every elementary interval with the area 2^-m contains exactly one point.
TEST(SobolSquare, IsAStratifiedNet) {
  constexpr int kBits = 10;
  for (const std::uint32_t seed : {0U, 1U, 0xdeadbeefU, 0x80000001U}) {
    const SobolSquare square(seed, ~std::uint64_t{seed} * 2654435761U);
    for (int a = 0; a <= kBits; ++a) {
      std::set<std::pair<int, int>> boxes;
      for (std::uint32_t i = 0; i < (1U << kBits); ++i) {
        const auto u = square(i);
        ASSERT_GE(u[0], 0.0);
        ASSERT_LT(u[0], 1.0);
        boxes.emplace(static_cast<int>(u[0] * std::ldexp(1.0, a)), static_cast<int>(u[1] * std::ldexp(1.0, kBits - a)));
      }
      EXPECT_EQ(boxes.size(), 1U << kBits) << "seed " << seed << " split " << a;
    }
  }
}

// Over many scrambles, each point is uniformly distributed. The test compares the means and the covariance of the first
// points.
TEST(SobolSquare, ScramblesAreUnbiased) {
  constexpr std::uint32_t kScrambles = 20000;
  for (const std::uint32_t index : {0U, 1U, 5U, 1023U}) {
    double sum_x = 0.0, sum_y = 0.0, sum_xy = 0.0, sum_xx = 0.0;
    for (std::uint32_t s = 0; s < kScrambles; ++s) {
      const auto words = philox({17, 1}, s, 0);
      const auto u =
          SobolSquare((std::uint64_t{words[0]} << 32) | words[1], (std::uint64_t{words[2]} << 32) | words[3])(index);
      sum_x += u[0] - 0.5;
      sum_y += u[1] - 0.5;
      sum_xy += (u[0] - 0.5) * (u[1] - 0.5);
      sum_xx += (u[0] - 0.5) * (u[0] - 0.5);
    }
    const double z = normal_bound(16);
    const double n = kScrambles;
    EXPECT_LT(std::abs(sum_x / n), z * std::sqrt(1.0 / 12.0 / n)) << index;
    EXPECT_LT(std::abs(sum_y / n), z * std::sqrt(1.0 / 12.0 / n)) << index;
    EXPECT_LT(std::abs(sum_xy / n), z / 12.0 / std::sqrt(n)) << index;
    EXPECT_LT(std::abs(sum_xx / n - 1.0 / 12.0), z * std::sqrt(1.0 / 180.0 / n)) << index;
  }
}

// Equal areas of the entrance face contain equal fractions of the points.
TEST(EntranceSampler, IsEvenOverTheFace) {
  for (const Element& element :
       {Element(RtpElement{0.7, 0.4, 90.0}), Element(HexagonalCube{1.0}), Element(TriangularCube{1.0})}) {
    const Part part = build_part(single(element, 0.5));
    const EntranceSampler sampler(part);
    Vec2 mean = Vec2::Zero();
    double second = 0.0;
    constexpr int kSide = 1200;  // the number of cells divides evenly over the triangle fan of the hexagon
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const Vec2 p = sampler({(i + 0.5) / kSide, (j + 0.5) / kSide}) + sampler.centre_mm();
        EXPECT_TRUE(contains(bounding_box(part.outline), {p}, 1e-12));
        mean += p / (kSide * kSide);
        second += (p - centroid(part.outline)).squaredNorm() / (kSide * kSide);
      }
    EXPECT_LT((mean - centroid(part.outline)).norm(), 1e-4);
    // Mean square distance from the centroid: (b^2 + w^2)/12 for a rectangle, 5 s^2/12 for a hexagon with the side s,
    // and s^2/12 for a triangle with the side s.
    double expected = (0.49 + 0.16) / 12.0;
    if (std::holds_alternative<HexagonalCube>(element)) expected = 5.0 * 0.25 / 12.0;
    if (std::holds_alternative<TriangularCube>(element)) expected = 0.75 / 12.0;
    EXPECT_NEAR(second, expected, 1e-4);
  }
}

/// Returns a convex polygon with random corners on an ellipse. More than half of the polygons are irregular
/// quadrilaterals.
Polygon random_outline(std::mt19937& random) {
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::vector<double> angles;
  const std::size_t corners = even(random) < 0.5 ? 4 : 3 + random() % 5;
  while (angles.size() < corners) {
    const double angle = 2.0 * std::numbers::pi * even(random);
    const auto is_near = [&](double other) {
      return std::abs(std::remainder(angle - other, 2.0 * std::numbers::pi)) < 0.2;
    };
    if (std::none_of(angles.begin(), angles.end(), is_near)) angles.push_back(angle);
  }
  std::sort(angles.begin(), angles.end());
  const Vec2 axes(0.5 + even(random), 0.5 + even(random));
  Polygon outline;
  for (const double a : angles) outline.push_back(axes.cwiseProduct(Vec2(std::cos(a), std::sin(a))));
  return outline;
}

/// Returns the mesh of a plate of 0.5 mm with this outline and with a pyramid below the plate.
TriangleMesh pyramid_below(const Polygon& outline) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, 0.5})
    for (const Vec2& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  const Vec2 middle = centroid(outline);
  mesh.vertices.emplace_back(middle.x(), middle.y(), -0.3);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    mesh.triangles.push_back({2 * n, next, k});
    mesh.triangles.push_back({k, next, next + n});
    mesh.triangles.push_back({k, next + n, k + n});
    if (k > 1) mesh.triangles.push_back({n, n + k - 1, n + k});
  }
  return mesh;
}

// Rays start evenly distributed within an entrance face of any outline, and no power is lost.
TEST(EntranceSampler, StartsWithinAnyOutline) {
  std::mt19937 random(5);
  for (int k = 0; k < 200; ++k) {
    const Polygon outline = random_outline(random);
    const Part part = part_of_mesh(pyramid_below(outline));
    const EntranceSampler sampler(part);
    constexpr int kSide = 200;
    Vec2 mean = Vec2::Zero();
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const Vec2 p = sampler({(i + 0.5) / kSide, (j + 0.5) / kSide}) + sampler.centre_mm();
        EXPECT_TRUE(contains(outline, p)) << k;
        mean += p / (kSide * kSide);
      }
    EXPECT_LT((mean - centroid(outline)).norm(), 2e-2) << k;
    const Ledger ledger = MonteCarlo(part).trace(pmma(), from(15.0, 40.0), {0.5}, rays(512), {}).cones[0].ledger;
    EXPECT_EQ(ledger[Account::lost], 0.0) << k;
    EXPECT_NEAR(ledger.total(), 1.0, 1e-9) << k;
  }
}

// A design with its true RRE. Over 200 seeds, 95 % intervals must contain the true value in 90 to 99 % of the runs.
struct Truth {
  PartSpec spec;
  Optics optics;
  Illumination illumination;
  double rre;
};

TEST(StandardError, IsTrue) {
  const double r = std::pow((kPmma - 1.0) / (kPmma + 1.0), 2.0);
  PartSpec bricks = finite(RtpElement{2.0, 2.0, 90.0}, Arrangement::offset, 10.0, 10.0, 2.0);
  bricks.array.shifted_rows = RowParity::odd;
  const double share = 22.0 * 4.0 / 100.0;
  // There is no closed form for the hexagon, so the exact engine computes its true RRE.
  const Part hexagon = build_part(single(HexagonalCube{1.0}, 0.5));
  BeamPolicy exactly;
  exactly.truncated_goal = 1e-7;
  const double hexagon_rre =
      BeamTracer(hexagon).trace(pmma(), from(20.0, 10.0), {0.5}, exactly).ledgers[0][Account::retroreflected];
  const std::vector<Truth> truths = {{bricks, pmma(), from(0.0), share + (1.0 - share) * 2.0 * r / (1.0 + r)},
                                     {single(HexagonalCube{1.0}, 0.5), pmma(), from(20.0, 10.0), hexagon_rre}};
  for (const Truth& truth : truths) {
    const Part part = build_part(truth.spec);
    const MonteCarlo tracer(part);
    int covered = 0;
    const double t95 = student_bound_of(0.05, Sampling::kReplicates);
    // The fraction of intervals that contain the true value does not depend on the number of rays.
    const std::uint64_t count = test::sample_size(1U << 11, 1U << 13);
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
      const ConeResult result = tracer.trace(truth.optics, truth.illumination, {0.5}, rays(count, seed), {}).cones[0];
      if (std::abs(result.rre - truth.rre) <= t95 * result.spread) ++covered;
    }
    EXPECT_GE(covered, 180);
    EXPECT_LE(covered, 198);
  }
}

}  // namespace
}  // namespace retrace::testing::sampling_test

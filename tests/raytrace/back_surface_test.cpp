// Tests of BackSurface, which finds hit facets with the bounding boxes of Embree. The results are compared with a
// search through all cells, and with the triangles of exported solids.
#include "raytrace/faces/back_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/designs.h"

namespace retrace::testing::back_surface_test {
namespace {

using namespace geometry;
using namespace raytrace;

Vec3 random_direction(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  return Vec3(normal(generator), normal(generator), normal(generator)).normalized();
}

/// Returns the distance along the ray to the first triangle that faces it, or infinity. Triangles of the facet that the
/// ray leaves are ignored. The method uses signed volumes; it is independent of planes and outlines.
double distance_to_triangles(const Part& part, const Vec2& centre, const SurfaceRay& ray) {
  double least = INFINITY;
  for (std::uint32_t p = 0; p < part.placements.size(); ++p) {
    const Placement& at = part.placements[p];
    const SurfacePatch& patch = part.patches[at.patch];
    const Vec3 place(at.offset_mm.x() - centre.x(), at.offset_mm.y() - centre.y(), at.height_mm);
    for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
      if (ray.source == FacetRef{p, patch.triangle_facet[t]}) continue;
      const Vec3 a = patch.vertices[patch.triangles[t][0]] + place - ray.origin;
      const Vec3 b = patch.vertices[patch.triangles[t][1]] + place - ray.origin;
      const Vec3 c = patch.vertices[patch.triangles[t][2]] + place - ray.origin;
      const double u = ray.direction.dot(b.cross(c));
      const double v = ray.direction.dot(c.cross(a));
      const double w = ray.direction.dot(a.cross(b));
      if (ray.inside ? std::min({u, v, w}) < 0.0 : std::max({u, v, w}) > 0.0) continue;
      if (u + v + w == 0.0) continue;
      const double distance = a.dot(b.cross(c)) / (u + v + w);
      if (distance > 0.0) least = std::min(least, distance);
    }
  }
  return least;
}

/// Compares the results of the searches. Rays start inside the plate and travel downwards. From each hit point, a new
/// ray starts on a random side of the facet.
void compare_searches(const PartSpec& spec, int count) {
  const Part part = build_part(spec);
  const Rectangle box = bounding_box(part.outline);
  const Vec2 centre = 0.5 * (box.lower + box.upper);
  const BackSurface surface(part, centre);
  const ExactSurface all(part, centre);
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::size_t triangles = 0;
  for (const Placement& at : part.placements) triangles += part.patches[at.patch].triangles.size();
  const int every = 1 + static_cast<int>(triangles * static_cast<std::size_t>(count) / 5'000'000);
  int hits = 0;
  for (int k = 0; k < count; ++k) {
    SurfaceRay ray;
    ray.origin.head<2>() = box.lower - centre + box.size().cwiseProduct(Vec2(unit(generator), unit(generator)));
    ray.origin.z() = 0.01;
    ray.direction = random_direction(generator);
    ray.direction.z() = -std::abs(ray.direction.z()) - 0.3;
    ray.direction.normalize();
    for (int bounce = 0; bounce < 4; ++bounce) {
      const auto fast = surface.first_hit(ray);
      const auto exact = all.first_hit(ray);
      ASSERT_EQ(fast.has_value(), exact.has_value()) << "ray " << k << " bounce " << bounce;
      if (k % every == 0) {
        const double distance = distance_to_triangles(part, centre, ray);
        ASSERT_EQ(fast.has_value(), std::isfinite(distance)) << "ray " << k << " bounce " << bounce;
        if (fast) {
          ASSERT_NEAR(fast->t, distance, 1e-9) << "ray " << k << " bounce " << bounce;
        }
      }
      if (!fast) break;
      ++hits;
      ASSERT_NEAR(fast->t, exact->t, 1e-9);
      const Vec3 normal = surface.facet(fast->facet).normal;
      ray.origin += fast->t * ray.direction;
      ray.source = fast->facet;
      ray.inside = unit(generator) < 0.7;
      // The direction is random, on the chosen side of the facet.
      ray.direction = random_direction(generator);
      const double out = ray.direction.dot(normal);
      if ((out > 0.0) == ray.inside) ray.direction -= 2.0 * out * normal;
    }
  }
  EXPECT_GT(hits, count);
}

TEST(BackSurface, BrickRows) {
  compare_searches(finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.0, 3.0, 0.5), 20000);
}
TEST(BackSurface, Checker) {
  PartSpec spec = finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 3.3, 3.3, 0.5);
  spec.array.x_gap_mm = 0.1;
  compare_searches(spec, 20000);
}
TEST(BackSurface, Honeycomb) {
  compare_searches(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 5.0, 5.0, 0.5), 20000);
}
TEST(BackSurface, Triangular) {
  compare_searches(finite(TriangularCube{1.0}, Arrangement::triangular, 5.0, 5.0, 0.5), 20000);
}
TEST(BackSurface, InstancedPieces) {
  const PartSpec spec = finite(HexagonalCube{0.5}, Arrangement::honeycomb, 100.0, 100.0, 0.5);
  const Part part = build_part(spec);
  std::size_t cells = 0;
  std::size_t different = 0;
  for (const SurfacePatch& patch : part.patches) different += patch.cells.size();
  for (const Placement& at : part.placements) cells += part.patches[at.patch].cells.size();
  ASSERT_GT(cells, 4 * different) << "no instances";
  compare_searches(spec, 500);
}

// If cells have many facets, each facet has its own box.
TEST(BackSurface, RoundedEdges) {
  PartSpec spec = finite(HexagonalCube{1.0}, Arrangement::honeycomb, 5.0, 5.0, 0.5);
  spec.edges.root_radius_mm = 0.02;
  spec.edges.rim_radius_mm = 0.01;
  spec.edges.chords = 8;
  compare_searches(spec, 2000);
}

TEST(BackSurface, EveryCellUnlikeTheOthers) {
  PartSpec spec = finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 10.0, 10.0, 0.5);
  spec.substrate = Substrate{SphereSubstrate{20.0}, ElementAxes::normal};
  compare_searches(spec, 2000);
}

// A ray that leaves a facet does not hit the same facet again, even at grazing angles.
TEST(BackSurface, NoSelfHit) {
  const Part part = build_part(single(HexagonalCube{1.0}, 0.5));
  const BackSurface surface(part, Vec2::Zero());
  std::mt19937_64 generator(5);
  int hits = 0;
  for (int k = 0; k < 20000; ++k) {
    SurfaceRay ray;
    ray.origin = Vec3(0.5, 0.43, 0.001);
    ray.direction = random_direction(generator);
    ray.direction.z() = -std::abs(ray.direction.z()) - 0.5;
    ray.direction.normalize();
    const auto hit = surface.first_hit(ray);
    if (!hit) continue;  // leaves through a side
    ++hits;
    const Vec3 normal = surface.facet(hit->facet).normal;
    ray.origin += hit->t * ray.direction;
    ray.source = hit->facet;
    const Vec3 along = normal.unitOrthogonal();
    for (const double lift : {1e-3, 1e-6, 1e-9, 1e-12}) {
      ray.direction = (along - lift * normal).normalized();
      const auto next = surface.first_hit(ray);
      EXPECT_FALSE(next && next->facet == ray.source);
    }
  }
  EXPECT_GT(hits, 10000);
}

}  // namespace
}  // namespace retrace::testing::back_surface_test

// Tests of canted cube corners. Their three planes remain perpendicular to each other, so that they return light to the
// source. Their effective aperture is tilted with them.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"
#include "tests/support/reference_tracer.h"
#include "tests/support/sample_size.h"

namespace retrace::testing::cant_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kDeg = std::numbers::pi / 180.0;

struct Case {
  std::string name;
  PartSpec spec;
  std::uint64_t ray_count = 1U << 16;               ///< number of rays that are compared with beams
  std::vector<double> azimuths_deg = {0.0, 130.0};  ///< azimuths at which rays are compared with beams
};

std::vector<Case> cases() {
  const HexagonalCube hexagon{1.0, {12.0, 25.0}};
  const HexagonalCube steep{1.0, {30.0, 0.0}};
  const TriangularCube triangle{1.0, {12.0, -70.0}};
  PartSpec omitted = finite(hexagon, Arrangement::honeycomb, 3.1, 2.7, 1.0);
  omitted.array.partial_elements = PartialElements::omit;
  PartSpec with_errors = finite(triangle, Arrangement::triangular, 2.1, 1.9, 1.0);
  with_errors.angle_errors = {{30.0, -20.0, 10.0}, {15.0, 0.0, -40.0}};
  with_errors.random_tilts = {5.0, 3};
  return {
      {"single hexagon", single(hexagon, 1.0)},
      {"single steep hexagon", single(steep, 8.0)},
      {"single triangle", single(triangle, 1.0)},
      {"honeycomb", finite(hexagon, Arrangement::honeycomb, 2.1, 1.9, 1.0)},
      {"honeycomb, partial omitted", omitted},
      {"triangular", finite(triangle, Arrangement::triangular, 2.1, 1.9, 1.0)},
      {"triangular with errors of angle", with_errors},
      {"infinite honeycomb", infinite(hexagon, Arrangement::honeycomb, 1.0)},
      // Rays in this thick plate have hundreds of reflections, and beams truncate several percent of the power. The
      // error of rays is much smaller, even with fewer rays. An azimuth takes ten seconds. The usual run therefore has
      // only the azimuth that is oblique to every mirror plane.
      {"infinite steep honeycomb", infinite(steep, Arrangement::honeycomb, 5.0), test::sample_size(1U << 13, 1U << 16),
       test::is_long_run() ? std::vector<double>{0.0, 130.0} : std::vector<double>{130.0}},
      {"infinite triangular", infinite(triangle, Arrangement::triangular, 1.0)}};
}

class Canted : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Canted, NothingIsLost) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  ASSERT_GT(part.top_mm, 1e-3);
  ASSERT_LT(part.top_mm, part.thickness_mm);
  expect_nothing_lost(part, {0.0, 20.0, 60.0, 85.0}, 1024, c.name);
}

TEST_P(Canted, EnginesAgree) {
  const Case c = cases()[GetParam()];
  const Part part = build_part(c.spec);
  for (const double azimuth_deg : c.azimuths_deg)
    expect_same_accounts(part, from(15.0, azimuth_deg), 1e-5, 3e-3, c.name, c.ray_count);
}

INSTANTIATE_TEST_SUITE_P(Cases, Canted, ::testing::Range(std::size_t{0}, cases().size()));

TEST(Cant, AgreesWithTheReference) {
  const std::vector<Case> all = cases();
  for (const std::size_t k : {std::size_t{3}, std::size_t{5}}) {
    const Part part = build_part(all[k].spec);
    expect_agrees_with_reference(part, from(20.0, 70.0), test::sample_size(4000U, 8000U), 1U << 16, all[k].name);
  }
}

/// Returns the directions of the three edges of a cube from its apex, as columns.
Eigen::Matrix3d edges_of(const Cant& cant) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) {
    const double a = 120.0 * k * kDeg;
    edges.col(k) << std::sqrt(2.0 / 3.0) * std::cos(a), std::sqrt(2.0 / 3.0) * std::sin(a), 1.0 / std::numbers::sqrt3;
  }
  const Vec3 pivot(-std::sin(cant.azimuth_deg * kDeg), std::cos(cant.azimuth_deg * kDeg), 0.0);
  return Eigen::AngleAxisd(cant.deg * kDeg, pivot) * edges;
}

bool in_polygon(const Polygon& outline, const Vec2& p) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 along = outline[(i + 1) % outline.size()] - outline[i];
    const Vec2 to = p - outline[i];
    if (along.x() * to.y() - along.y() * to.x() < 0.0) return false;
  }
  return true;
}

/// Returns the fraction of points of a regular outline for which the light hits all three planes of an unbounded cube,
/// and finally the entrance face, within the outline. In coordinates along the edges of the cube, each reflection
/// reverses one component of the direction.
double share_by_points(const Polygon& outline, const Cant& cant, double depth_mm, double thickness_mm,
                       const Vec3& to_source) {
  // A side of a region that is parallel to the grid changes its area by at most half a step, which is 0.25 % of the
  // box.
  constexpr int kSteps = 200;
  const Eigen::Matrix3d edges = edges_of(cant);
  const Vec3 d = edges.transpose() * to_source;
  if (d.minCoeff() <= 0.0) return 0.0;
  const Rectangle box = bounding_box(outline);
  int inside = 0;
  int back = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const Vec2 p = box.lower + box.size().cwiseProduct(Vec2((i + 0.5) / kSteps, (j + 0.5) / kSteps));
      if (!in_polygon(outline, p)) continue;
      ++inside;
      const Vec3 start = edges.transpose() * Vec3(p.x(), p.y(), thickness_mm + depth_mm);
      std::array<double, 3> times{};
      for (Eigen::Index k = 0; k < 3; ++k) times[static_cast<std::size_t>(k)] = start[k] / d[k];
      bool all = true;
      for (const double t : times) {
        const Vec3 at = edges * (start - t * d).cwiseAbs();
        all = all && in_polygon(outline, at.head<2>());
      }
      // After three reflections, the path is the incident path reflected at the apex. It then continues up to the
      // entrance face.
      const Vec3 end = edges * (-start + *std::max_element(times.begin(), times.end()) * d);
      const double up = (thickness_mm + depth_mm - end.z()) / to_source.z();
      back += all && in_polygon(outline, (end + up * to_source).head<2>()) ? 1 : 0;
    }
  return static_cast<double>(back) / inside;
}

/// Returns the power that three facets of a single mirror cube return exactly to the source.
double straight_back(const PartSpec& spec, const Illumination& light) {
  double power = 0.0;
  const BeamObserver note = [&](const ReturnedBeam& beam) {
    if (beam.depth == 4 && (beam.direction - direction_to_source(light)).norm() < 1e-9) power += beam.stokes.i;
  };
  BeamTracer(build_part(spec)).trace(ideal(), light, {0.5}, {}, nullptr, note);
  return power;
}

TEST(Cant, EffectiveApertureIsThatOfTheLeaningCube) {
  const double thickness_mm = 1.5;
  for (const Cant& cant : {Cant{}, Cant{6.0, 0.0}, Cant{10.0, 180.0}, Cant{15.0, 100.0}}) {
    for (const Element& element : {Element(HexagonalCube{1.0, cant}), Element(TriangularCube{1.0, cant})}) {
      const double along_axis_deg = std::asin(kPmma * std::sin(cant.deg * kDeg)) / kDeg;
      for (const auto& [t, p] : {std::array{0.0, 0.0}, std::array{along_axis_deg, cant.azimuth_deg},
                                 std::array{10.0, 40.0}, std::array{20.0, cant.azimuth_deg + 180.0}}) {
        const double inner = std::asin(std::sin(t * kDeg) / kPmma);
        const Vec3 to_source(std::sin(inner) * std::cos(p * kDeg), std::sin(inner) * std::sin(p * kDeg),
                             std::cos(inner));
        const double expected =
            share_by_points(element_cell(element).outline, cant, element_depth_mm(element), thickness_mm, to_source);
        EXPECT_NEAR(straight_back(single(element, thickness_mm), from(t, p)), expected, 4e-3)
            << cant.deg << ", " << cant.azimuth_deg << " at " << t << ", " << p;
      }
    }
  }
}

}  // namespace
}  // namespace retrace::testing::cant_test

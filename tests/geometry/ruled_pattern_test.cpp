#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "core/error.h"
#include "geometry/elements/ruled_pattern.h"

// Tests of the cells between sets of V-grooves: perpendicular faces, base triangles, and a comparison with the maximum
// of the groove profiles on a grid.

namespace retrace::testing::ruled_pattern_test {
namespace {

using geometry::Cell, geometry::CellFacet, geometry::GrooveSet, geometry::RuledPattern, geometry::Vec2, geometry::Vec3;

constexpr double kDeg = std::numbers::pi / 180.0;

Vec3 normal_of(const CellFacet& facet) {
  return Vec3(facet.plane.slope.x(), facet.plane.slope.y(), -1.0).normalized();
}

GrooveSet set_of(double azimuth_deg, std::vector<double> spacing_mm, std::vector<std::array<double, 2>> half_angles_deg,
                 double offset_mm = 0.0) {
  GrooveSet set;
  set.azimuth_deg = azimuth_deg;
  set.spacing_mm = std::move(spacing_mm);
  set.half_angles_deg = std::move(half_angles_deg);
  set.offset_mm = offset_mm;
  return set;
}

/// Returns the height of the master's negative: the highest groove profile at a point, computed groove by groove. A
/// profile is the lowest of both faces and of the flat or the arc. The arc is a circle here, not a row of chords.
double height_by_half_spaces(const std::vector<GrooveSet>& sets, const std::optional<double>& depth_mm, const Vec2& p) {
  double highest = depth_mm ? -*depth_mm : -INFINITY;
  for (const GrooveSet& set : sets) {
    const double azimuth = set.azimuth_deg * kDeg;
    const double t = -std::sin(azimuth) * p.x() + std::cos(azimuth) * p.y();
    for (const int direction : {1, -1}) {
      double position = set.offset_mm;
      for (int m = direction > 0 ? 0 : -1; std::abs(m) < 400; m += direction) {
        const auto at = [](const auto& list, int number) {
          const int count = static_cast<int>(list.size());
          return list[static_cast<std::size_t>((number % count + count) % count)];
        };
        if (direction < 0) position -= at(set.spacing_mm, m);
        const double left = at(set.half_angles_deg, m)[0] * kDeg, right = at(set.half_angles_deg, m)[1] * kDeg;
        const double along = t - position;
        double height = std::min(-along / std::tan(left), along / std::tan(right));
        if (set.bottom_flat_mm > 0.0)
          height = std::min(height, -set.bottom_flat_mm / (std::tan(left) + std::tan(right)));
        if (set.bottom_radius_mm > 0.0) {
          // The circle touches both faces. Its centre is on the bisector of the groove.
          const double r = set.bottom_radius_mm;
          const double bisector = 0.5 * (left - right);
          const double below = r / std::sin(0.5 * (left + right));
          const Vec2 centre(below * std::sin(bisector), -below * std::cos(bisector));
          const double from_x = along - centre.x();
          if (from_x < r * std::cos(left) && from_x > -r * std::cos(right))
            height = std::min(height, centre.y() + std::sqrt(r * r - from_x * from_x));
        }
        highest = std::max(highest, set.rise_mm + height);
        if (direction > 0) position += at(set.spacing_mm, m);
      }
    }
  }
  return highest;
}

/// Returns the heights of all facets that contain a point, for the cells of a period and their neighbours.
std::vector<double> heights_of_cells(const RuledPattern& pattern, const Vec2& p) {
  std::vector<double> heights;
  for (const Cell& cell : pattern.cells)
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) {
        if (!pattern.period_mm && (i != 0 || j != 0)) continue;
        const Vec2 shift =
            pattern.period_mm ? Vec2(i * pattern.period_mm->x(), j * pattern.period_mm->y()) : Vec2(0, 0);
        if (!geometry::contains(cell.outline, Vec2(p - shift))) continue;
        for (const CellFacet& facet : cell.facets)
          if (geometry::contains(facet.outline, Vec2(p - shift), -1e-9)) heights.push_back(facet.plane.at(p - shift));
      }
  return heights;
}

/// Compares the cells of a pattern with the maximum of the groove profiles on a grid around the origin.
void expect_envelope(const std::vector<GrooveSet>& sets, const std::optional<double>& depth_mm, double tolerance_mm) {
  const RuledPattern pattern = geometry::ruled_pattern(sets, depth_mm);
  const Vec2 half =
      pattern.period_mm ? *pattern.period_mm : Vec2::Constant(1.2 * sets.front().spacing_mm.front()).eval();
  int compared = 0;
  for (int i = 0; i < 37; ++i)
    for (int j = 0; j < 37; ++j) {
      const Vec2 p(half.x() * (0.0371 + i / 18.0 - 1.0), half.y() * (0.0213 + j / 18.0 - 1.0));
      const std::vector<double> heights = heights_of_cells(pattern, p);
      ASSERT_LE(heights.size(), 1U) << "overlapping facets at " << p.transpose();
      if (heights.empty()) continue;  // on an edge, or outside of the computed cells
      EXPECT_NEAR(heights.front(), height_by_half_spaces(sets, depth_mm, p), tolerance_mm) << p.transpose();
      ++compared;
    }
  EXPECT_GT(compared, pattern.period_mm ? 1300 : 800);
  double covered = 0.0;
  for (const Cell& cell : pattern.cells) {
    double of_cell = 0.0;
    for (const CellFacet& facet : cell.facets) of_cell += geometry::area(facet.outline);
    EXPECT_NEAR(of_cell, geometry::area(cell.outline), 1e-9);
    covered += of_cell;
  }
  if (!pattern.period_mm) return;
  EXPECT_NEAR(covered, pattern.period_mm->prod(), 1e-9);
}

TEST(RuledPattern, FacesOfAllFormsArePerpendicular) {
  for (const std::array<double, 3>& base : std::vector<std::array<double, 3>>{
           {60.0, 60.0, 60.0}, {70.0, 55.0, 55.0}, {50.0, 65.0, 65.0}, {50.0, 60.0, 70.0}, {52.0, 58.0, 70.0}}) {
    const RuledPattern pattern = geometry::ruled_pattern(geometry::perpendicular_groove_sets(base, 0.1), {});
    ASSERT_FALSE(pattern.cells.empty());
    for (const Cell& cell : pattern.cells) {
      ASSERT_EQ(cell.facets.size(), 3U);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(normal_of(cell.facets[k]).dot(normal_of(cell.facets[(k + 1) % 3])), 0.0, 1e-12);
    }
  }
}

// The half-angle h of a face follows from the angles B and C at the ends of its base: sin^2(h) = cot(B) cot(C).
TEST(RuledPattern, HalfAnglesFollowFromTheBaseTriangle) {
  const std::array<double, 3> base = {50.0, 60.0, 70.0};
  const std::vector<GrooveSet> sets = geometry::perpendicular_groove_sets(base, 0.1);
  for (std::size_t k = 0; k < 3; ++k) {
    const double sine = std::sin(sets[k].half_angles_deg[0][0] * kDeg);
    const double b = base[(k + 1) % 3] * kDeg, c = base[(k + 2) % 3] * kDeg;
    EXPECT_NEAR(sine * sine, 1.0 / (std::tan(b) * std::tan(c)), 1e-14);
  }
}

// The axis of a cube corner has equal angles to its three faces. For base angles of 55, 55 and 70 degrees, the cant is
// asin(cot 55) - asin(1 / sqrt 3), because the axis is rotated about a line that is parallel to the base face.
TEST(RuledPattern, CantOfAnIsoscelesCellIsTheChangeOfItsBaseFace) {
  const double expected = std::asin(1.0 / std::tan(55.0 * kDeg)) - std::asin(1.0 / std::sqrt(3.0));
  EXPECT_NEAR(expected / kDeg, 9.18, 0.005);
  const Cell cell =
      geometry::largest_cell(geometry::ruled_pattern(geometry::perpendicular_groove_sets({70.0, 55.0, 55.0}, 1.0), {}));
  Vec3 axis = Vec3::Zero();
  for (const CellFacet& facet : cell.facets) axis -= normal_of(facet);
  EXPECT_NEAR(std::acos(axis.normalized().z()), expected, 1e-12);
  const std::array<double, 3> base = geometry::base_angles_of_cant(expected / kDeg);
  EXPECT_NEAR(base[0], 70.0, 1e-9);
  EXPECT_NEAR(base[1], 55.0, 1e-9);
  for (const double cant_deg : {-20.0, -9.0, 0.0, 5.0, 9.7}) {
    const RuledPattern pattern =
        geometry::ruled_pattern(geometry::perpendicular_groove_sets(geometry::base_angles_of_cant(cant_deg), 1.0), {});
    for (const Cell& each : pattern.cells) {
      axis.setZero();
      for (const CellFacet& facet : each.facets) axis -= normal_of(facet);
      EXPECT_NEAR(std::acos(std::min(1.0, axis.normalized().z())), std::abs(cant_deg) * kDeg, 1e-7);
    }
  }
}

// The groove through the vertex of the first base angle cuts off the tip of a cell if the apex is nearer to this vertex
// than to the opposite side. The faces of the first set then have half-angles above 45 degrees, which is a cant of
// 45 degrees - atan(1 / sqrt 2) = 9.736 degrees. In the other direction, there is no such limit.
TEST(RuledPattern, GroovesCutOffTheTipsAboveACantOfNinePointSevenDegrees) {
  const double limit_deg = 45.0 - std::atan(1.0 / std::numbers::sqrt2) / kDeg;
  EXPECT_NEAR(limit_deg, 9.736, 5e-4);
  const auto facets_at = [](double cant_deg) {
    return geometry::largest_cell(
               geometry::ruled_pattern(
                   geometry::perpendicular_groove_sets(geometry::base_angles_of_cant(cant_deg), 1.0), {}))
        .facets.size();
  };
  EXPECT_EQ(facets_at(limit_deg - 0.01), 3U);
  EXPECT_EQ(facets_at(limit_deg + 0.01), 4U);
  EXPECT_EQ(facets_at(-25.0), 3U);
}

// Both arrays consist of the same triangles, rotated and not.
TEST(RuledPattern, EquilateralCellsEqualTriangularCubeCorners) {
  const double aperture = 0.4;
  const RuledPattern pattern =
      geometry::ruled_pattern(geometry::perpendicular_groove_sets({60.0, 60.0, 60.0}, 0.75 * aperture), {});
  ASSERT_TRUE(pattern.period_mm);
  EXPECT_EQ(pattern.cells.size(), 4U);
  geometry::PartSpec spec;
  spec.element = geometry::TriangularCube{aperture, {}};
  spec.array.arrangement = geometry::Arrangement::triangular;
  const geometry::Lattice lattice = geometry::make_lattice(spec, true);
  EXPECT_NEAR((*pattern.period_mm - lattice.period_mm).norm(), 0.0, 1e-14);
  for (const Cell& cell : lattice.cells)
    for (const CellFacet& facet : cell.facets) {
      const Vec2 p = geometry::centroid(facet.outline);
      const std::vector<double> heights = heights_of_cells(pattern, p);
      ASSERT_EQ(heights.size(), 1U);
      EXPECT_NEAR(heights.front(), facet.plane.at(p), 1e-14);
    }
  EXPECT_NEAR(pattern.lowest_mm, -geometry::element_depth_mm(spec.element), 1e-14);
}

TEST(RuledPattern, SurfaceIsTheHighestGrooveProfile) {
  expect_envelope(geometry::perpendicular_groove_sets({70.0, 55.0, 55.0}, 1.0), {}, 1e-12);
  expect_envelope(geometry::perpendicular_groove_sets({70.0, 55.0, 55.0}, 1.0), 0.3, 1e-12);
  // A divergence pattern: half-angles that differ from groove to groove and from side to side.
  std::vector<GrooveSet> spread = geometry::perpendicular_groove_sets({60.0, 60.0, 60.0}, 1.0);
  spread[0].half_angles_deg = {{35.3, 35.1}, {35.0, 35.6}, {35.4, 35.26}};
  spread[1].half_angles_deg = {{35.2, 35.5}, {35.3, 35.0}};
  expect_envelope(spread, {}, 1e-12);
  expect_envelope(spread, 0.55, 1e-12);
  // Grooves that do not meet in points, with different depths and lists of spacings.
  std::vector<GrooveSet> loose = {set_of(270.0, {1.0, 0.8}, {{35.0, 40.0}}, 0.1), set_of(30.0, {0.9}, {{33.0, 30.0}}),
                                  set_of(150.0, {0.9}, {{36.0, 36.0}, {50.0, 20.0}}, 0.21)};
  loose[1].rise_mm = -0.12;
  expect_envelope(loose, {}, 1e-12);
  expect_envelope(loose, 0.4, 1e-12);
}

TEST(RuledPattern, GroovesMayHaveTwoOrFourDirectionsOrNoPeriod) {
  expect_envelope({set_of(0.0, {1.0}, {{45.0, 45.0}}), set_of(90.0, {0.7, 0.5}, {{40.0, 30.0}})}, {}, 1e-12);
  expect_envelope({set_of(0.0, {1.0}, {{45.0, 45.0}}), set_of(45.0, {1.0}, {{40.0, 50.0}}, 0.3),
                   set_of(90.0, {1.0}, {{45.0, 30.0}}), set_of(135.0, {1.0}, {{40.0, 40.0}})},
                  {}, 1e-12);
  const std::vector<GrooveSet> oblique = {set_of(17.0, {1.0}, {{35.0, 36.0}}), set_of(80.0, {1.1}, {{30.0, 33.0}}),
                                          set_of(141.0, {0.9}, {{40.0, 38.0}})};
  EXPECT_FALSE(geometry::ruled_pattern(oblique, {}).period_mm);
  expect_envelope(oblique, {}, 1e-12);
}

TEST(RuledPattern, FlatAndRoundBottomsReplaceTheGrooveBottomsOnly) {
  std::vector<GrooveSet> flat = geometry::perpendicular_groove_sets({70.0, 55.0, 55.0}, 1.0);
  for (GrooveSet& set : flat) set.bottom_flat_mm = 0.05;
  expect_envelope(flat, {}, 1e-12);
  expect_envelope(flat, 0.35, 1e-12);
  std::vector<GrooveSet> round = geometry::perpendicular_groove_sets({60.0, 60.0, 60.0}, 1.0);
  round[0].half_angles_deg = {{30.0, 40.0}};
  for (GrooveSet& set : round) {
    set.bottom_radius_mm = 0.04;
    set.bottom_chords = 32;
  }
  // A chord is at most r (1 - cos(step / 2)) above or below the circle, measured along its normal.
  const double step = std::numbers::pi / 32.0;
  expect_envelope(round, {}, 4.0 * 0.04 * (1.0 - std::cos(0.5 * step)));
}

TEST(RuledPattern, RandomGroovesGiveTheHighestProfile) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 12; ++trial) {
    std::vector<GrooveSet> sets;
    for (int k = 0; k < 3; ++k) {
      GrooveSet set = set_of(60.0 * k + 40.0 * unit(random), {0.6 + unit(random), 0.6 + unit(random)},
                             {{25.0 + 25.0 * unit(random), 25.0 + 25.0 * unit(random)},
                              {25.0 + 25.0 * unit(random), 25.0 + 25.0 * unit(random)}},
                             unit(random));
      set.rise_mm = k == 0 ? 0.0 : -0.1 * unit(random);
      if (trial % 3 == 1) set.bottom_flat_mm = 0.05;
      sets.push_back(set);
    }
    expect_envelope(sets, trial % 2 == 0 ? std::optional(0.5) : std::nullopt, 1e-11);
  }
}

TEST(RuledPattern, RefusesGroovesWithoutCells) {
  EXPECT_THROW(geometry::ruled_pattern({set_of(0.0, {1.0}, {{45.0, 45.0}}), set_of(180.0, {1.0}, {{45.0, 45.0}})}, {}),
               InputError);
  std::vector<GrooveSet> wide = geometry::perpendicular_groove_sets({60.0, 60.0, 60.0}, 0.1);
  for (GrooveSet& set : wide) set.bottom_flat_mm = 0.11;
  EXPECT_THROW(geometry::ruled_pattern(wide, {}), InputError);
  geometry::ArrayLayout infinite;
  infinite.extent = geometry::Extent::infinite;
  EXPECT_THROW(geometry::ruled_lattice(
                   geometry::ruled_pattern({set_of(0.0, {1.0}, {{35.0, 35.0}}), set_of(61.0, {1.0}, {{35.0, 35.0}}),
                                            set_of(123.0, {1.0}, {{35.0, 35.0}})},
                                           {}),
                   infinite),
               InputError);
}

}  // namespace
}  // namespace retrace::testing::ruled_pattern_test

// Tests of parts with zones, which are regions with elements of their own kind and rotation. A single zone equals the
// part without zones. Rectangular zones equal separate parts of the same size. Rotated zones have rotated facets. The
// boundary of the part is closed for any combination of zones.

#include "geometry/part/zones.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "geometry/elements/element_cells.h"
#include "geometry/part/faceted_solid.h"
#include "geometry/part/mould_boundary.h"
#include "tests/geometry/outline_random.h"
#include "tests/geometry/part_checks.h"
#include "tests/support/refusals.h"

namespace retrace::geometry::zones_test {
namespace {

PartSpec prisms(double base_mm, double width_mm, Arrangement arrangement = Arrangement::aligned) {
  PartSpec spec;
  spec.element = RtpElement{base_mm, width_mm, 90.0};
  spec.array.arrangement = arrangement;
  return spec;
}
PartSpec hexagons(double aperture_mm, const Cant& cant = {}) {
  PartSpec spec;
  spec.element = HexagonalCube{aperture_mm, cant};
  spec.array.arrangement = Arrangement::honeycomb;
  return spec;
}
PartSpec triangles(double aperture_mm) {
  PartSpec spec;
  spec.element = TriangularCube{aperture_mm, {}};
  spec.array.arrangement = Arrangement::triangular;
  return spec;
}
std::vector<PartSpec> kinds() {
  std::vector<PartSpec> all = {prisms(0.5, 0.5),
                               prisms(0.7, 0.4, Arrangement::offset),
                               prisms(0.6, 0.6, Arrangement::checker),
                               hexagons(0.9),
                               hexagons(0.8, {5.0, 30.0}),
                               triangles(1.1)};
  PartSpec gaps = prisms(0.5, 0.6);
  gaps.array.x_gap_mm = 0.05;
  gaps.array.y_gap_mm = 0.1;
  all.push_back(gaps);
  PartSpec errors = hexagons(1.0);
  errors.angle_errors = {{30.0, -10.0, 5.0}, {0.0, 20.0, 0.0}};
  all.push_back(errors);
  PartSpec edges = hexagons(1.0);
  edges.edges.root_radius_mm = 0.03;
  edges.edges.rim_chamfer_mm = 0.02;
  all.push_back(edges);
  PartSpec tilted = prisms(0.5, 0.5);
  tilted.random_tilts = {5.0, 3};
  all.push_back(tilted);
  return all;
}

Polygon box(double x0, double y0, double x1, double y1) {
  return to_polygon({{x0, y0}, {x1, y1}});
}
ZonedSpec plate(const Vec2& size_mm, std::vector<PartZone> zones) {
  return {size_mm, 0.8, std::move(zones)};
}
Part alone(PartSpec spec, const Vec2& size_mm) {
  spec.array.x_length_mm = size_mm.x();
  spec.array.y_length_mm = size_mm.y();
  spec.thickness_mm = 0.8;
  return build_part(spec);
}

/// Expects that the boundary is closed and encloses the volume of the part. If four cells of different heights meet
/// at a corner, the part may touch itself along the vertical line through this corner. The boundary is then not a
/// manifold, which is allowed.
void expect_closed(const Part& part) {
  const BoundaryMesh mesh = closed_boundary(part);
  const BoundaryReport report = check_boundary(mesh);
  EXPECT_TRUE(report.is_closed);
  EXPECT_EQ(report.self_intersects, !report.is_manifold);
  EXPECT_NEAR(volume_mm3(mesh), part.entrance_area_mm2 * part.thickness_mm + volume_below(part), 1e-8);
}

TEST(Zones, OneZoneIsThePartItself) {
  const std::vector<PartSpec> all = kinds();
  for (std::size_t k = 0; k < all.size(); ++k) {
    SCOPED_TRACE(k);
    const PartSpec& kind = all[k];
    const Part part = alone(kind, {5.3, 4.1});
    const Part zoned = build_part(plate({5.3, 4.1}, {{{box(0, 0, 5.3, 4.1)}, 0.0, kind}}));
    ASSERT_EQ(zoned.patches.size(), 1U);
    ASSERT_EQ(zoned.patches[0].facets.size(), part.patches[0].facets.size());
    EXPECT_EQ(zoned.elements_full, part.elements_full);
    EXPECT_EQ(zoned.elements_partial, part.elements_partial);
    EXPECT_NEAR(zoned.element_depth_mm, part.element_depth_mm, 1e-12);
    EXPECT_NEAR(zoned.retro_facet_area_mm2, part.retro_facet_area_mm2, 1e-9);
    for (std::size_t f = 0; f < part.patches[0].facets.size(); ++f) {
      const PatchFacet& a = zoned.patches[0].facets[f];
      const PatchFacet& b = part.patches[0].facets[f];
      // A part with zones labels all vertical walls as inner walls, including those along the border.
      EXPECT_EQ(a.role, b.role == FacetRole::border_wall ? FacetRole::inner_wall : b.role);
      EXPECT_LT((a.normal - b.normal).norm(), 1e-10);  // corners of walls of 1e-3 mm have errors of 1e-15 mm
    }
  }
}

TEST(Zones, RectanglesHoldWhatTheyWouldHoldAlone) {
  const std::vector<PartSpec> all = kinds();
  for (std::size_t k = 0; k < all.size(); ++k) {
    SCOPED_TRACE(k);
    const PartSpec& left = all[k];
    const PartSpec& right = all[(k + 3) % all.size()];
    const Part part = build_part(plate({5.0, 3.0}, {{{box(0, 0, 2.3, 3.0)}, 0.0, left},
                                                    {{box(2.3, 0, 5.0, 1.4), box(2.3, 1.4, 5.0, 3.0)}, 0.0, right}}));
    expect_closed(part);
    const Part alone_left = alone(left, {2.3, 3.0});
    const Part below = alone(right, {2.7, 1.4});
    const Part above = alone(right, {2.7, 1.6});
    ASSERT_EQ(part.zones.size(), 2U);
    EXPECT_EQ(part.zones[0].full, alone_left.elements_full);
    EXPECT_EQ(part.zones[0].partial, alone_left.elements_partial);
    EXPECT_EQ(part.zones[1].full, below.elements_full + above.elements_full);
    EXPECT_EQ(part.zones[1].partial, below.elements_partial + above.elements_partial);
    EXPECT_NEAR(volume_below(part), volume_below(alone_left) + volume_below(below) + volume_below(above), 1e-9);
    EXPECT_NEAR(part.retro_facet_area_mm2,
                alone_left.retro_facet_area_mm2 + below.retro_facet_area_mm2 + above.retro_facet_area_mm2, 1e-9);
  }
}

/// Returns the fraction of the retroreflecting facets of `turned`, by their area in the xy plane, whose normal is a
/// normal of `other` rotated by `deg` about z.
double share_of_turned(const Part& turned, const Part& other, double deg) {
  const Eigen::AngleAxisd turn(deg * std::numbers::pi / 180.0, Vec3::UnitZ());
  double all = 0.0;
  double found = 0.0;
  for (const PatchFacet& facet : turned.patches[0].facets) {
    if (facet.role != FacetRole::retro_facet) continue;
    const double plan_mm2 = facet_area(turned.patches[0], facet) * -facet.normal.z();
    all += plan_mm2;
    const bool is_found = std::ranges::any_of(other.patches[0].facets, [&](const PatchFacet& f) {
      return f.role == FacetRole::retro_facet && (turn * f.normal - facet.normal).norm() < 1e-12;
    });
    found += is_found ? plan_mm2 : 0.0;
  }
  EXPECT_NEAR(all, turned.entrance_area_mm2, 1e-9);
  return found / all;
}

TEST(Zones, TurnedZonesHaveTheTurnedFacets) {
  const Vec2 size(4.0, 3.0);
  for (const PartSpec& kind : {prisms(0.5, 0.5), hexagons(0.9, {4.0, 10.0}), triangles(1.1)})
    for (const double deg : {17.0, 90.0, -130.0}) {
      const Part part = build_part(plate(size, {{{box(0, 0, size.x(), size.y())}, deg, kind}}));
      expect_closed(part);
      EXPECT_EQ(share_of_turned(part, alone(kind, size), deg), 1.0);
    }
}

// A square is filled by whole square prisms. If the prisms are rotated by 90 degrees, they occupy the same squares
// and remain whole.
TEST(Zones, PrismsTurnedByARightAngleAreWhole) {
  const Part part = build_part(plate({2.0, 2.0}, {{{box(0, 0, 2, 2)}, 90.0, prisms(0.5, 0.5)}}));
  EXPECT_EQ(part.elements_full, 16);
  EXPECT_EQ(part.elements_partial, 0);
  EXPECT_NEAR(volume_below(part), volume_below(alone(prisms(0.5, 0.5), {2.0, 2.0})), 1e-12);
}

TEST(Zones, WhateverMeetsIsClosed) {
  const std::vector<PartSpec> all = kinds();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto any = [&] { return all[std::min(all.size() - 1, static_cast<std::size_t>(unit(random) * 10.0))]; };
  for (std::size_t trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    // Four triangular zones around a random point, the hub.
    const Vec2 size(3.0 + unit(random), 2.5 + unit(random));
    const Vec2 hub = (Vec2(0.3, 0.3) + 0.4 * Vec2(unit(random), unit(random))).cwiseProduct(size);
    const Polygon corners = to_polygon({Vec2::Zero(), size});
    std::vector<PartZone> zones;
    for (std::size_t k = 0; k < 4; ++k)
      zones.push_back({{{corners[k], corners[(k + 1) % 4], hub}}, std::floor(360.0 * unit(random)), any()});
    zones[trial % 4].elements.array.partial_elements = PartialElements::omit;
    const ZonedSpec spec = plate(size, zones);
    EXPECT_FALSE(fault_of_zones(spec));
    const Part part = build_part(spec);
    expect_closed(part);
    EXPECT_EQ(part.elements_full, part.zones[0].full + part.zones[1].full + part.zones[2].full + part.zones[3].full);
  }
}

// With PartialElements::omit, elements that the border of a zone would cut are replaced by land, which is flat. All
// remaining facets belong to whole elements.
TEST(Zones, PartialElementsAreLeftOutIfTheyAreNotWanted) {
  PartSpec kind = hexagons(0.9);
  const auto build = [&] {
    return build_part(
        plate({4.0, 3.0}, {{{{{0, 0}, {4, 0}, {0, 3}}}, 20.0, kind}, {{{{4, 0}, {4, 3}, {0, 3}}}, 0.0, kind}}));
  };
  const Part cut = build();
  kind.array.partial_elements = PartialElements::omit;
  const Part whole = build();
  EXPECT_EQ(whole.elements_full, cut.elements_full);
  EXPECT_GT(whole.elements_partial, 0);
  const double cell_mm2 = area(aperture_outline(kind.element));
  double retro_mm2 = 0.0;
  for (const PatchFacet& facet : whole.patches[0].facets)
    if (facet.role == FacetRole::retro_facet) retro_mm2 += facet_area(whole.patches[0], facet) * -facet.normal.z();
  EXPECT_NEAR(retro_mm2, static_cast<double>(whole.elements_full) * cell_mm2, 1e-9);
}

/// Expects that a part has the three facets of a whole element at the given position and rotation.
void expect_standing(const Part& part, const ElementPlacement& at, const PartSpec& kind) {
  const Cell cell = element_cell(kind.element, kind.angle_errors);
  const Vec3 apex(at.apex_mm.x(), at.apex_mm.y(), -element_depth_mm(kind.element, kind.angle_errors));
  const Eigen::AngleAxisd turn(at.rotation_deg * std::numbers::pi / 180.0, Vec3::UnitZ());
  const SurfacePatch& patch = part.patches[0];
  for (const CellFacet& facet : cell.facets) {
    const Vec3 normal = turn * Vec3(facet.plane.slope.x(), facet.plane.slope.y(), -1.0).normalized();
    EXPECT_TRUE(std::ranges::any_of(patch.facets,
                                    [&](const PatchFacet& own) {
                                      if ((own.normal - normal).norm() > 1e-9 ||
                                          std::abs(own.normal.dot(apex) - own.offset_mm) > 1e-9)
                                        return false;
                                      for (std::uint32_t k = 0; k < own.corner_count; ++k)
                                        if ((patch.vertices[patch.corners[own.first_corner + k]] - apex).norm() < 1e-8)
                                          return true;
                                      return false;
                                    }))
        << at.apex_mm.transpose() << " turned by " << at.rotation_deg;
  }
}

TEST(Zones, WholeElementsStandWhereThePartHasThem) {
  PartSpec errors = hexagons(0.5);
  errors.angle_errors = {{30.0, -10.0, 5.0}, {0.0, 20.0, 0.0}};
  const std::vector<PartSpec> cubes = {hexagons(0.45), errors, triangles(0.6)};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto any = [&] { return cubes[std::min<std::size_t>(2, static_cast<std::size_t>(unit(random) * 3.0))]; };
  for (std::size_t trial = 0; trial < 8; ++trial) {
    SCOPED_TRACE(trial);
    const Vec2 size(3.0 + unit(random), 2.5 + unit(random));
    const double middle = size.x() * (0.3 + 0.4 * unit(random));
    const ZonedSpec spec =
        plate(size, {{{box(0, 0, middle, size.y())}, 0.0, any()},
                     {{{{middle, 0}, {size.x(), 0}, {size.x(), size.y()}}}, std::floor(360.0 * unit(random)), any()},
                     {{{{middle, 0}, {size.x(), size.y()}, {middle, size.y()}}}, 0.0, any()}});
    const Part part = build_part(spec);
    const auto elements = whole_elements(spec);
    ASSERT_EQ(elements.size(), 3U);
    for (std::size_t z = 0; z < 3; ++z) {
      EXPECT_EQ(static_cast<std::int64_t>(elements[z].size()), part.zones[z].full);
      for (const ElementPlacement& at : elements[z]) expect_standing(part, at, spec.zones[z].elements);
    }
  }
}

// A polygon that goes around twice is not convex, although it turns left at every corner. The width of a polygon is
// measured across its narrowest direction.
TEST(Zones, RegionsAreConvexPolygonsThatGoRoundOnce) {
  const Polygon once = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
  Polygon twice = once;
  twice.insert(twice.end(), once.begin(), once.end());
  EXPECT_TRUE(is_convex(once, 0.0));
  EXPECT_FALSE(is_convex(twice, 0.0));
  EXPECT_FALSE(is_convex({{5, 0}, {8, 10}, {0, 4}, {10, 4}, {2, 10}}, 0.0));
  EXPECT_FALSE(is_convex({{0, 0}, {4, 0}, {2, 1}, {0, 4}}, 0.0));
  EXPECT_TRUE(is_convex({{0, 0}, {2, 1e-12}, {4, 0}, {4, 3}}, 1e-9));
  EXPECT_EQ(width(once), 3.0);
  EXPECT_NEAR(width({{0, 0}, {4, 0}, {0, 3}}), 2.4, 1e-12);
}

/// Returns a plate whose elements are assigned to the zones in turn. Each zone has one kind of element. The flat land
/// belongs to the first zone.
ZonedSpec dealt_out(const Vec2& size_mm, const std::vector<PartZone>& kinds) {
  ZonedSpec spec = plate(size_mm, kinds);
  spec.is_by_cell = true;
  std::size_t next = 0;
  for (const ArrayCell& cell : plan_of_array(array_of_cells(spec, kinds.front())).cells)
    spec.zones[cell.is_element ? next++ % kinds.size() : 0].cells.push_back(cell.number);
  return spec;
}

// If both zones have the same kind of element, the part equals the array without zones.
TEST(Zones, AlikeElementsByCellAreTheArray) {
  const std::vector<PartSpec> all = kinds();
  const Vec2 size(5.3, 4.1);
  for (std::size_t k = 0; k < all.size(); ++k) {
    SCOPED_TRACE(k);
    for (const PartialElements partial : {PartialElements::cut, PartialElements::omit}) {
      PartSpec kind = all[k];
      kind.array.partial_elements = partial;
      const ZonedSpec spec = dealt_out(size, {{{}, 0.0, kind}, {{}, 0.0, kind}});
      ASSERT_FALSE(fault_of_zones(spec));
      const Part part = build_part(spec);
      const Part array = alone(kind, size);
      expect_closed(part);
      EXPECT_EQ(part.elements_full, array.elements_full);
      EXPECT_EQ(part.elements_partial, array.elements_partial);
      EXPECT_NEAR(part.zones[0].area_mm2 + part.zones[1].area_mm2, size.prod(), 1e-9);
      EXPECT_NEAR(volume_below(part), volume_below(array), 1e-9);
      EXPECT_NEAR(part.retro_facet_area_mm2, array.retro_facet_area_mm2, 1e-9);
    }
  }
}

TEST(Zones, WholeElementsByCellStandWhereThePartHasThem) {
  for (const PartSpec& kind : {hexagons(0.45), triangles(0.6)}) {
    const double turn_deg = std::holds_alternative<HexagonalCube>(kind.element) ? 60.0 : 120.0;
    const ZonedSpec spec = dealt_out({3.1, 2.7}, {{{}, 0.0, kind}, {{}, turn_deg, kind}});
    const Part part = build_part(spec);
    const auto elements = whole_elements(spec);
    for (std::size_t z = 0; z < 2; ++z) {
      EXPECT_EQ(static_cast<std::int64_t>(elements[z].size()), part.zones[z].full);
      for (const ElementPlacement& at : elements[z]) expect_standing(part, at, kind);
    }
  }
}

/// Returns a rotation, in degrees, that maps the outline of an element to itself.
double turn_of(const PartSpec& kind) {
  if (std::holds_alternative<HexagonalCube>(kind.element)) return 60.0;
  return std::holds_alternative<TriangularCube>(kind.element) ? 120.0 : 180.0;
}

// Elements are rotated about their centroids. The part then has the same number of elements, with rotated facets,
// and its boundary is closed by walls.
TEST(Zones, ElementsByCellAreTurnedInTheirPlaces) {
  for (PartSpec kind : kinds()) {
    if (kind.random_tilts.sigma_arcmin > 0.0) continue;
    kind.array.partial_elements = PartialElements::omit;
    const Vec2 size(5.3, 4.1);
    const double deg = turn_of(kind);
    const ZonedSpec spec = dealt_out(size, {{{}, 0.0, kind}, {{}, deg, kind}});
    ASSERT_FALSE(fault_of_zones(spec));
    const Part part = build_part(spec);
    expect_closed(part);
    const Part array = alone(kind, size);
    EXPECT_EQ(part.elements_full, array.elements_full);
    const Eigen::AngleAxisd turn(deg * std::numbers::pi / 180.0, Vec3::UnitZ());
    const SurfacePatch& patch = part.patches[0];
    std::size_t cell = 0;
    for (std::size_t zone = 0; zone < 2; ++zone)
      for (const std::size_t end = cell + part.zones[zone].cells; cell < end; ++cell)
        for (std::uint32_t f = 0; f < patch.cells[cell].facet_count; ++f) {
          const PatchFacet& facet = patch.facets[patch.cells[cell].first_facet + f];
          if (facet.role != FacetRole::retro_facet) continue;
          const Vec3 back = zone == 0 ? facet.normal : Vec3(turn.inverse() * facet.normal);
          EXPECT_TRUE(std::ranges::any_of(
              array.patches[0].facets, [&](const PatchFacet& other) { return (other.normal - back).norm() < 1e-12; }));
        }
    EXPECT_EQ(cell, patch.cells.size());
  }
}

// The volume of a part whose elements have different kinds is the sum over its elements. The volume of each element
// is the mean volume in an array of its own kind, whether the element is rotated or not.
TEST(Zones, UnlikeElementsByCellHoldWhatEachHoldsInItsArray) {
  const Vec2 size(5.3, 4.1);
  PartSpec upright = hexagons(0.9);
  PartSpec canted = hexagons(0.9, {5.0, 30.0});
  for (PartSpec* const kind : {&upright, &canted}) kind->array.partial_elements = PartialElements::omit;
  const ZonedSpec spec = dealt_out(size, {{{}, 0.0, upright}, {{}, 180.0, canted}, {{}, 60.0, canted}});
  const Part part = build_part(spec);
  expect_closed(part);
  const auto each = [&](const PartSpec& kind) {
    const Part array = alone(kind, size);
    return volume_below(array) / static_cast<double>(array.elements_full);
  };
  EXPECT_NE(each(upright), each(canted));
  EXPECT_NEAR(volume_below(part),
              static_cast<double>(part.zones[0].full) * each(upright) +
                  static_cast<double>(part.zones[1].full + part.zones[2].full) * each(canted),
              1e-9);
}

/// Returns the zone of a fault and records the text of the fault.
template <class Fault>
std::optional<int> zone_of(const std::optional<Fault>& fault) {
  if (!fault) return std::nullopt;
  record_message(fault->text);
  return static_cast<int>(fault->zone);
}

TEST(Zones, CellsThatAreNotOneEachAreFound) {
  const auto fault = [](const ZonedSpec& spec) { return zone_of(fault_of_zones(spec)); };
  const Vec2 size(4.0, 3.0);
  const ZonedSpec well = dealt_out(size, {{{}, 0.0, prisms(0.5, 0.5)}, {{}, 90.0, prisms(0.5, 0.5)}});
  EXPECT_EQ(fault(well), std::nullopt);
  ZonedSpec spec = well;
  spec.zones[1].cells.push_back(spec.zones[0].cells.front());
  EXPECT_EQ(fault(spec), 1);
  spec = well;
  spec.zones[0].cells.erase(spec.zones[0].cells.begin());
  EXPECT_EQ(fault(spec), 1);
  spec = well;
  spec.zones[1].rotation_deg = 45.0;
  EXPECT_EQ(fault(spec), 1);
  for (const PartSpec& other : {prisms(0.5, 0.4), prisms(0.5, 0.5, Arrangement::offset), hexagons(0.5)}) {
    spec = well;
    spec.zones[1].elements = other;
    EXPECT_EQ(fault(spec), 1);
  }
}

TEST(Zones, ThatDoNotCoverThePartAreFound) {
  const auto fault = [](std::vector<Polygon> a, std::vector<Polygon> b) {
    return zone_of(
        fault_of_zones(plate({4.0, 3.0}, {{std::move(a), 0.0, hexagons(0.5)}, {std::move(b), 0.0, hexagons(0.5)}})));
  };
  EXPECT_EQ(fault({box(0, 0, 2, 3)}, {box(2, 0, 4, 3)}), std::nullopt);
  EXPECT_EQ(fault({box(0, 0, 2, 3)}, {box(2, 0, 4.001, 3)}), 1);
  EXPECT_EQ(fault({box(0, 0, 2.1, 3)}, {box(2, 0, 4, 3)}), 1);
  EXPECT_EQ(fault({box(0, 0, 2, 3)}, {box(2, 0, 4, 2), box(2, 1, 4, 3)}), 1);
  // Corners that are closer than the welding distance count as equal. A larger distance between zones is a gap or
  // an overlap.
  EXPECT_EQ(fault({box(0, 0, 2, 3)}, {box(2 + 1e-8, 0, 4, 3)}), 1);
  EXPECT_EQ(fault({box(0, 0, 2, 3)}, {box(2 - 1e-8, 0, 4, 3)}), 1);
  EXPECT_EQ(fault({box(0, 0, 2, 3)}, {box(2 + 1e-13, 0, 4, 3)}), std::nullopt);
  EXPECT_EQ(fault({box(0, 0, 2, 3)}, {box(2.5, 0, 4, 3)}), 1);
}

/// Returns a plate with an outline and zones.
ZonedSpec outlined_plate(const Outline& outline, double margin_mm, std::vector<PartZone> zones) {
  std::optional<OutlineFault> fault;
  const auto plan = std::make_shared<const PlanRegion>(plan_region(outline, margin_mm, 0.01, fault));
  EXPECT_FALSE(fault) << fault->text;
  ZonedSpec spec = plate(plan->box_mm.size(), std::move(zones));
  spec.outline = plan;
  return spec;
}

/// Returns a part without zones that has the outline of a plate with zones.
Part part_without_zones(PartSpec spec, const ZonedSpec& zoned) {
  spec.array.outline = zoned.outline;
  spec.array.x_offset_mm = spec.array.y_offset_mm = zoned.outline->margin_mm;
  return alone(spec, zoned.size_mm);
}
Outline notched() {
  return oriented({rounded(
      polygon_of_corners({{0, 0}, {5.2, 0}, {5.2, 2.0}, {2.6, 2.0}, {2.6, 4.0}, {0, 4.0}}, {0.1, 0, 0, 0, 0, 0}),
      0.3)});
}
Outline holed() {
  return oriented({circle({0, 0}, 2.5), circle({0.4, 0.3}, 0.7)});
}

TEST(ZonesWithOutline, ARectangleIsTheRectangle) {
  const Vec2 size(5.3, 4.1);
  const std::vector<PartZone> zones = {{{box(0, 0, 2.4, 4.1)}, 0.0, hexagons(0.9)},
                                       {{box(2.4, 0, 5.3, 4.1)}, 30.0, hexagons(0.7)}};
  ZonedSpec spec = outlined_plate(oriented({polygon_of_corners({{1, 1}, {6.3, 1}, {6.3, 5.1}, {1, 5.1}})}), 0.0, zones);
  EXPECT_FALSE(fault_of_zones(spec));
  const Part a = build_part(plate(spec.size_mm, zones));
  const Part b = build_part(spec);
  ASSERT_EQ(a.patches[0].vertices.size(), b.patches[0].vertices.size());
  for (std::size_t k = 0; k < a.patches[0].vertices.size(); ++k)
    EXPECT_LT((a.patches[0].vertices[k] - b.patches[0].vertices[k]).norm(), 1e-12);
  EXPECT_NEAR(a.entrance_area_mm2, b.entrance_area_mm2, 1e-12);
  EXPECT_LT((spec.size_mm - size).norm(), 1e-12);
}

// A plate that is covered by a single zone equals the part without zones. The zone is given as a region or as a set of
// elements.
TEST(ZonesWithOutline, OneZoneIsThePartItself) {
  for (const Outline& outline : {notched(), holed()})
    for (const double margin_mm : {0.0, 0.15})
      for (const PartialElements partial : {PartialElements::cut, PartialElements::omit}) {
        PartSpec kind = hexagons(0.5);
        kind.array.partial_elements = partial;
        ZonedSpec spec = outlined_plate(outline, margin_mm, {{{}, 0.0, kind}});
        const Part part = part_without_zones(kind, spec);
        spec.zones[0].regions = {box(0, 0, spec.size_mm.x(), spec.size_mm.y())};
        ZonedSpec by_cell = spec;
        by_cell.is_by_cell = true;
        by_cell.zones[0].regions.clear();
        for (const ArrayCell& cell : plan_of_array(array_of_cells(by_cell, by_cell.zones[0])).cells)
          by_cell.zones[0].cells.push_back(cell.number);
        for (const ZonedSpec& zoned : {spec, by_cell}) {
          EXPECT_FALSE(fault_of_zones(zoned));
          const Part own = build_part(zoned);
          EXPECT_EQ(own.elements_full, part.elements_full);
          EXPECT_EQ(own.elements_partial, part.elements_partial);
          EXPECT_NEAR(own.retro_facet_area_mm2, part.retro_facet_area_mm2, 1e-8);
          EXPECT_NEAR(own.zones[0].area_mm2, zoned.area_mm2(), 1e-8);
          EXPECT_EQ(own.entrance_pieces.size(), part.entrance_pieces.size());
          EXPECT_EQ(static_cast<std::int64_t>(whole_elements(zoned)[0].size()), part.elements_full);
          expect_closed(own);
        }
      }
}

TEST(ZonesWithOutline, SolidsAreClosed) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const std::vector<PartSpec> kinds = {prisms(0.3, 0.25, Arrangement::offset), hexagons(0.4), triangles(0.5)};
  for (int trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    const Outline outline = random_outline(random, 2.0);
    std::optional<OutlineFault> fault;
    const double margin_mm = trial % 3 == 0 ? 0.05 : 0.0;
    plan_region(outline, margin_mm, 0.01, fault);
    if (fault) continue;
    ZonedSpec spec = outlined_plate(outline, margin_mm, {});
    const Vec2 size = spec.size_mm;
    const double middle = (0.3 + 0.4 * unit(random)) * size.x();
    for (const auto& [from, to] : {std::pair{0.0, middle}, {middle, size.x()}})
      spec.zones.push_back({{box(from, 0, to, size.y())},
                            trial % 2 == 0 ? 0.0 : std::floor(360.0 * unit(random)),
                            kinds[static_cast<std::size_t>(trial) % kinds.size()]});
    spec.zones[1].elements.array.partial_elements = PartialElements::omit;
    EXPECT_FALSE(fault_of_zones(spec));
    const Part part = build_part(spec);
    expect_closed(part);
    EXPECT_TRUE(check_boundary(mould_boundary(part, 0.5)).is_closed);
    EXPECT_NEAR(part.zones[0].area_mm2 + part.zones[1].area_mm2, spec.area_mm2(), 1e-7);
    EXPECT_NEAR(part.entrance_area_mm2, spec.area_mm2(), 1e-9);
  }
}

TEST(ZonesWithOutline, FaultsAreFound) {
  const Outline angle =
      oriented({polygon_of_corners({{0, 0}, {5.2, 0}, {5.2, 2.0}, {2.6, 2.0}, {2.6, 4.0}, {0, 4.0}})});
  const auto fault = [&](std::vector<Polygon> first, std::vector<Polygon> second) {
    return fault_of_zones(
        outlined_plate(angle, 0.0, {{std::move(first), 0.0, hexagons(0.5)}, {std::move(second), 0.0, hexagons(0.5)}}));
  };
  EXPECT_FALSE(fault({box(0, 0, 5.2, 2.0)}, {box(0, 2.0, 2.6, 4.0)}));
  EXPECT_TRUE(fault({box(0, 0, 5.2, 2.0)}, {box(0, 2.0, 2.5, 4.0)})) << "a part of the plate is not covered";
  EXPECT_TRUE(fault({box(0, 0, 5.2, 2.1)}, {box(0, 2.0, 2.6, 4.0)})) << "the zones overlap inside the outline";
  // Regions may overlap outside of the outline.
  EXPECT_FALSE(fault({box(0, 0, 5.2, 2.0), box(2.6, 2.0, 5.2, 4.0)}, {box(0, 2.0, 5.2, 4.0)}));
  const auto outside = fault({box(0, 0, 5.2, 2.0), box(0, 2.0, 2.6, 4.0)}, {box(2.6, 2.0, 5.2, 4.0)});
  ASSERT_TRUE(outside) << "the second zone is in the notch";
  EXPECT_EQ(outside->zone, 1U);
}

}  // namespace
}  // namespace retrace::geometry::zones_test

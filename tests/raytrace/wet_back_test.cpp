// Tests of parts with another medium behind some elements: selection of these elements, and their returned light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "geometry/part/chosen_elements.h"
#include "tests/support/designs.h"
#include "tests/support/outlined_parts.h"

namespace retrace::testing::wet_back_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kWater = 1.333;

/// Returns optics with another index behind the chosen elements. The choice may include all elements.
Optics wet_behind(Optics optics, const Part& part, const ElementChoice& choice, double index) {
  Optics wet = optics;
  wet.back_index = index;
  optics.wet = std::make_shared<const WetBack>(WetBack{wet, std::make_shared<const ChosenElements>(part, choice)});
  return optics;
}

ConeResult traced(const Part& part, const Optics& optics, const Illumination& illumination,
                  std::uint64_t count = 4096) {
  return MonteCarlo(part).trace(optics, illumination, {0.5}, rays(count), {}).cones[0];
}

PartSpec prisms(Arrangement arrangement = Arrangement::aligned) {
  return finite(RtpElement{0.5, 0.5, 90.0}, arrangement, 8.0, 8.0, 0.4);
}

/// Returns arrays of all kinds, with cut elements, land (flat areas between elements) and margins.
std::vector<PartSpec> arrays() {
  std::vector<PartSpec> all = {finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 2.5, 2.6, 0.4),
                               finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::checker, 2.5, 2.0, 0.4),
                               finite(HexagonalCube{1.0}, Arrangement::honeycomb, 4.3, 3.9, 0.4),
                               finite(TriangularCube{1.0}, Arrangement::triangular, 4.3, 3.9, 0.4)};
  all.push_back(all[0]);
  all.back().array.x_gap_mm = 0.05;
  all.back().array.y_gap_mm = 0.08;
  all.back().array.x_offset_mm = 0.15;
  return all;
}

/// Returns the fraction of light along the normal that a 90 degree prism behind a plate returns. Both facets are hit at
/// 45 degrees, and the entrance face causes multiple reflections.
double returned_by_prism(double index, double back_index) {
  const double sine = index / back_index * std::sqrt(0.5);
  double facets = 1.0;  // power of unpolarised light
  const double face = std::pow((index - 1.0) / (index + 1.0), 2.0);
  const auto through_plate = [&](double reflectance) {
    const double both = reflectance * reflectance;
    return face + (1.0 - face) * (1.0 - face) * both / (1.0 - face * both);
  };
  if (sine >= 1.0) return through_plate(facets);
  const double cosine = std::sqrt(1.0 - sine * sine), c = std::sqrt(0.5);
  const double s = std::pow((index * c - back_index * cosine) / (index * c + back_index * cosine), 2.0);
  const double p = std::pow((back_index * c - index * cosine) / (back_index * c + index * cosine), 2.0);
  // Reflections at the entrance face keep s and p polarisation separate.
  return 0.5 * (through_plate(s) + through_plate(p));
}

TEST(ChosenElements, ARegionHasTheElementsWhoseMiddlesLieInIt) {
  const Part part = build_part(prisms());  // 16 x 16 elements, with centers at 0.25 + 0.5 k
  const auto count = [&](const ElementChoice& choice) { return ChosenElements(part, choice).count(); };
  EXPECT_EQ(ChosenElements(part, Disc{{0.0, 0.0}, 1.0}).of_all(), 256);
  EXPECT_EQ(count(Rectangle{{0.0, 0.0}, {8.0, 8.0}}), 256);
  EXPECT_EQ(count(Rectangle{{0.2, 0.3}, {1.3, 0.8}}), 3);  // x = 0.25, 0.75 and 1.25 in row 2
  EXPECT_EQ(count(Disc{{0.25, 0.25}, 0.6}), 3);
  EXPECT_EQ(count(Disc{{20.0, 0.0}, 1.0}), 0);
  EXPECT_EQ(count(geometry::HalfPlane{{4.0, 0.0}, 0.0}), 128);
  EXPECT_EQ(count(geometry::HalfPlane{{0.0, 7.0}, 90.0}), 32);
  EXPECT_EQ(count(geometry::HalfPlane{{0.0, 1.0}, -90.0}), 32);
  EXPECT_EQ(count(geometry::HalfPlane{{0.0, 0.6}, 225.0}), 1);  // below x + y = 0.6
}

TEST(ChosenElements, EverythingAndNothingAreKnown) {
  for (const PartSpec& spec : arrays()) {
    const Part part = build_part(spec);
    const auto& [x, y] = std::pair(spec.array.x_length_mm, spec.array.y_length_mm);
    for (const ElementChoice& all : {ElementChoice(Rectangle{{0.0, 0.0}, {x, y}}),
                                     ElementChoice(RandomFraction{1.0, 9}), ElementChoice(Disc{{0.0, 0.0}, 10.0})}) {
      const ChosenElements chosen(part, all);
      EXPECT_TRUE(chosen.contains_all());
      EXPECT_FALSE(chosen.is_empty());
      EXPECT_EQ(chosen.count(), part.elements_full + part.elements_partial);
      EXPECT_EQ(chosen.of_all(), chosen.count());
    }
    for (const ElementChoice& none : {ElementChoice(RandomFraction{0.0, 9}), ElementChoice(Disc{{-9.0, 0.0}, 1.0})}) {
      EXPECT_TRUE(ChosenElements(part, none).is_empty());
      EXPECT_FALSE(ChosenElements(part, none).contains_all());
    }
    const ChosenElements half(part, geometry::HalfPlane{{0.5 * x, 0.0}, 0.0});
    EXPECT_FALSE(half.contains_all() || half.is_empty());
  }
}

// For every seed, each element is chosen with the same probability. Different seeds give independent choices.
TEST(ChosenElements, ASharesCountIsThatOfIndependentChances) {
  const Part part = build_part(prisms());
  for (const double share : {0.1, 0.5, 0.9}) {
    double sum = 0.0, square = 0.0;
    constexpr int kSeeds = 200;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const auto count = static_cast<double>(ChosenElements(part, RandomFraction{share, seed}).count());
      sum += count - 256.0 * share;
      square += std::pow(count - 256.0 * share, 2.0);
    }
    const double variance = 256.0 * share * (1.0 - share);
    EXPECT_NEAR(sum / kSeeds, 0.0, 4.0 * std::sqrt(variance / kSeeds)) << share;
    EXPECT_NEAR(square / kSeeds / variance, 1.0, 4.0 * std::sqrt(2.0 / kSeeds)) << share;
  }
}

bool is_wall(const PatchFacet& facet) {
  return facet.role == FacetRole::inner_wall || facet.role == FacetRole::border_wall;
}

// An element is either wet or dry as a whole, including its facets and the outer walls at its ends.
TEST(ChosenElements, FacetsOfAnElementAreChosenTogether) {
  const Part part = build_part(prisms(Arrangement::offset));
  const ChosenElements chosen(part, RandomFraction{0.5, 3});
  for (std::uint32_t p = 0; p < part.placements.size(); ++p)
    for (const PatchCell& cell : part.patches[part.placements[p].patch].cells)
      for (std::uint32_t f = 1; f < cell.facet_count; ++f) {
        if (is_wall(part.patches[part.placements[p].patch].facets[cell.first_facet + f])) continue;
        EXPECT_EQ(chosen.has(p, cell.first_facet), chosen.has(p, cell.first_facet + f));
      }
  std::int64_t wet = 0;
  for (int k = 0; k < 16; ++k) {  // elements along y = 0, in row 1
    const bool is_wet = chosen.has_wall_at({0.5 * k + 0.1, 0.0});
    EXPECT_EQ(is_wet, chosen.has_wall_at({0.5 * k + 0.4, 0.0}));
    if (is_wet) ++wet;
  }
  EXPECT_GT(wet, 2);
  EXPECT_LT(wet, 14);
}

/// Returns the projection of a facet onto the xy plane, in the part frame.
Polygon plan_of(const Part& part, std::uint32_t placement, const PatchFacet& facet) {
  const SurfacePatch& patch = part.patches[part.placements[placement].patch];
  Polygon plan;
  for (std::uint32_t c = 0; c < facet.corner_count; ++c)
    plan.push_back(patch.vertices[patch.corners[facet.first_corner + c]].head<2>() +
                   part.placements[placement].offset_mm);
  return plan;
}

/// Returns true if the element above a point of the xy plane is wet, and false if the element is dry. Returns an empty
/// value for a point below land, because land may be wet at some points and dry at others.
std::optional<bool> is_wet_below(const Part& part, const ChosenElements& chosen, const Vec2& place_mm) {
  for (std::uint32_t p = 0; p < part.placements.size(); ++p) {
    const SurfacePatch& patch = part.patches[part.placements[p].patch];
    for (std::uint32_t f = 0; f < patch.facets.size(); ++f) {
      if (is_wall(patch.facets[f])) continue;
      Polygon plan = plan_of(part, p, patch.facets[f]);
      if (area(plan) < 0.0) std::reverse(plan.begin(), plan.end());
      if (!contains(plan, place_mm)) continue;
      return patch.facets[f].role == FacetRole::retro_facet ? std::optional(chosen.has(p, f)) : std::nullopt;
    }
  }
  ADD_FAILURE() << "no facet at " << place_mm.transpose();
  return std::nullopt;
}

// The space behind a wall lies below a facet of the neighbouring element. It contains the medium, air or water, that is
// behind this facet.
TEST(ChosenElements, WallsHaveTheMediumOfTheirNeighbour) {
  int unlike = 0;
  for (const PartSpec& spec : arrays()) {
    const Part part = build_part(spec);
    const ChosenElements chosen(part, RandomFraction{0.5, 3});
    for (std::uint32_t p = 0; p < part.placements.size(); ++p) {
      const SurfacePatch& patch = part.patches[part.placements[p].patch];
      for (const PatchCell& cell : patch.cells)
        for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f) {
          if (!is_wall(patch.facets[f])) continue;
          Vec2 middle = Vec2::Zero();
          const Polygon plan = plan_of(part, p, patch.facets[f]);
          for (const Vec2& corner : plan) middle += corner / static_cast<double>(plan.size());
          const std::optional<bool> is_wet =
              is_wet_below(part, chosen, middle + 1e-4 * patch.facets[f].normal.head<2>());
          if (!is_wet) continue;
          EXPECT_EQ(chosen.has(p, f), *is_wet);
          if (chosen.has(p, f) != chosen.has(p, cell.first_facet)) ++unlike;
        }
    }
  }
  EXPECT_GT(unlike, 10);
}

// If another index is set behind all elements one by one, the results equal those of a part with this index behind its
// whole back. If it is set behind no element, the results equal those of the dry part. Both are equal to the last bit.
TEST(WetBack, OfAllElementsAndOfNoneAreTheBacksOwn) {
  for (const PartSpec& spec : arrays()) {
    const Part part = build_part(spec);
    Optics rough = pmma();
    rough.facet_scatter = surface_models::Abg(1e-3, 1e-3, 2.0);
    for (const Optics& dry : {pmma(), rough}) {
      Optics wet = dry;
      wet.back_index = kWater;
      for (const Illumination& at : {from(0.0), from(25.0, 20.0), from(60.0, 200.0)}) {
        const ConeResult one_by_one = traced(part, wet_behind(dry, part, RandomFraction{1.0, 1}, kWater), at, 1024);
        EXPECT_EQ(one_by_one.ledger.power, traced(part, wet, at, 1024).ledger.power);
        const ConeResult of_none = traced(part, wet_behind(dry, part, RandomFraction{0.0, 1}, kWater), at, 1024);
        EXPECT_EQ(of_none.ledger.power, traced(part, dry, at, 1024).ledger.power);
      }
    }
  }
}

// At normal incidence, the light that a dry prism returns never leaves this prism. Light that leaves a wet prism enters
// its neighbours. It returns only through a further prism that is also wet. With a single wet prism, or a single column
// of wet prisms, there is no such prism. Sobol points are distributed equally over the 16 x 16 elements. The mean over
// the elements is therefore exact except for 2e-9 that returns by other paths.
TEST(WetBack, PrismsReturnTheMeanOverTheirElements) {
  const Part part = build_part(prisms());
  const double dry = returned_by_prism(kPmma, 1.0);
  for (const double index : {1.1, kWater}) {
    const double wet = returned_by_prism(kPmma, index);
    for (const auto& [choice, count] :
         {std::pair(ElementChoice(Disc{{3.25, 5.75}, 0.1}), 1), std::pair(ElementChoice(Disc{{3.0, 5.5}, 0.0}), 0),
          std::pair(ElementChoice(geometry::HalfPlane{{7.6, 0.0}, 0.0}), 16),
          std::pair(ElementChoice(Rectangle{{2.0, 0.0}, {2.5, 3.0}}), 6)}) {
      EXPECT_EQ(ChosenElements(part, choice).count(), count);
      const double share = count / 256.0;
      const MonteCarloResult result = MonteCarlo(part).trace(wet_behind(pmma(), part, choice, index), from(0.0), {0.5},
                                                             rays(32 * 1024), {1e-11, 0.0, 1'000'000});
      EXPECT_NEAR(result.cones[0].rre, share * wet + (1.0 - share) * dry, 1e-8) << index << " " << share;
    }
  }
}

// Light in the plane across the roof edges stays in its row. In every account, wet rows among dry rows therefore have
// the same power as in a completely wet part.
TEST(WetBack, WetRowsAmongDryOnes) {
  const Part part = build_part(prisms());
  const Rectangle rows{{0.0, 3.0}, {8.0, 7.0}};  // 8 of 16 rows
  for (const double index : {1.1, kWater})
    for (const double incidence_deg : {0.0, 12.0, 40.0}) {
      const Illumination at = from(incidence_deg, 0.0);
      Optics wet = pmma();
      wet.back_index = index;
      constexpr std::uint64_t kRays = 1 << 16;
      const ConeResult all_wet = traced(part, wet, at, kRays), dry = traced(part, pmma(), at, kRays);
      const ConeResult mixed = traced(part, wet_behind(pmma(), part, rows, index), at, kRays);
      const double error = std::hypot(mixed.spread, 0.5 * std::hypot(all_wet.spread, dry.spread));
      EXPECT_GT(dry.rre - all_wet.rre, 20.0 * error) << incidence_deg;
      EXPECT_NEAR(mixed.rre, 0.5 * (all_wet.rre + dry.rre), 4.0 * error + 1e-9) << index << " " << incidence_deg;
      for (std::size_t k = 0; k < kAccountCount; ++k)
        EXPECT_NEAR(mixed.ledger.power[k], 0.5 * (all_wet.ledger.power[k] + dry.ledger.power[k]), 1e-3)
            << index << " " << incidence_deg << " " << kAccountNames[k];
    }
}

TEST(WetBack, LedgersAddUpToOne) {
  for (const PartSpec& spec : arrays()) {
    const Part part = build_part(spec);
    for (const Illumination& at : {from(0.0), from(21.0, 30.0), from(75.0, 211.0)}) {
      const MonteCarloResult result =
          MonteCarlo(part).trace(wet_behind(pmma(), part, RandomFraction{0.5, 4}, kWater), at, {0.5}, rays(4096), {});
      EXPECT_NEAR(result.cones[0].ledger.total(), 1.0, 1e-9);
      EXPECT_EQ(result.misses, 0U);
      for (const double power : result.cones[0].ledger.power) EXPECT_GE(power, 0.0);
    }
  }
}

/// Below z = 0, the sides of notches and holes are in contact with the medium behind the adjacent element.
TEST(WetBack, NotchesAndHolesAreWetTogetherWithTheirElements) {
  for (const Outline& outline : {bent_outline(), ring_outline()}) {
    const Part part =
        build_part(with_outline(finite(HexagonalCube{0.5}, Arrangement::honeycomb, 0.0, 0.0, 0.4), outline));
    const ChosenElements all(part, RandomFraction{1.0, 9});
    EXPECT_TRUE(all.contains_all());
    EXPECT_EQ(all.count(), part.elements_full + part.elements_partial);
    EXPECT_TRUE(ChosenElements(part, RandomFraction{0.0, 9}).is_empty());
    Optics behind = pmma();
    behind.back_index = kWater;
    const Optics wet = wet_behind(pmma(), part, RandomFraction{1.0, 9}, kWater);
    const Illumination light = from(20.0, 50.0);
    const Ledger a = traced(part, behind, light).ledger;
    const Ledger b = traced(part, wet, light).ledger;
    for (std::size_t k = 0; k < kAccountCount; ++k) EXPECT_NEAR(a.power[k], b.power[k], 1e-12);
  }
}

}  // namespace
}  // namespace retrace::testing::wet_back_test

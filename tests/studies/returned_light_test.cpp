// Tests of footprints and far fields of studies against closed forms and the ledger.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/threads.h"
#include "studies/rre/beam_tracing.h"
#include "studies/rre/io/rre_files.h"
#include "studies/rre/rre.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"

namespace retrace::studies::returned_light_test {
namespace {

using namespace testing;
using geometry::Arrangement;
using Json = nlohmann::ordered_json;

design::Design design_of(const geometry::PartSpec& part, bool is_ideal = false) {
  design::Design design;
  design.part() = part;
  design.substance.refractive_index = kPmma;
  design.idealisation = {is_ideal, is_ideal};
  return design;
}

RreResult run(const design::Design& design, std::vector<double> incidence_deg, std::vector<double> azimuth_deg = {0.0},
              std::optional<double> cutoff = {}) {
  RreSettings request;
  request.incidence_deg = std::move(incidence_deg);
  request.azimuth_deg = std::move(azimuth_deg);
  request.engine = raytrace::Engine::exact;
  request.cutoff = cutoff;
  request.footprint = true;
  request.far_field = true;
  return RreStudy({design}, request).run();
}

double area_above(const Footprint& footprint, double efficiency) {
  double area = 0.0;
  for (const ActiveRegion& region : footprint.regions)
    if (region.efficiency > efficiency) area += geometry::area(region.outline_mm);
  return area;
}

geometry::PartSpec honeycomb() {
  return infinite(geometry::HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0);
}

geometry::PartSpec bricks() {
  geometry::PartSpec spec = finite(geometry::RtpElement{2.0, 2.0, 90.0}, Arrangement::offset, 10.0, 10.0, 2.0);
  spec.array.shifted_rows = geometry::RowParity::odd;
  return spec;
}

// Cube corners of mirrors are behind a lossless entrance face. Each active point returns all light, and the active
// points form the effective aperture.
TEST(Footprint, OfIdealCubesIsTheEffectiveAperture) {
  const RreResult result = run(design_of(honeycomb(), true), {0.0, 12.0, 25.0, 40.0}, {0.0, 25.0});
  ASSERT_EQ(result.returned.size(), 8U);
  for (const ReturnedLight& light : result.returned) {
    const double expected = honeycomb_rre(light.at.incidence_deg, light.at.azimuth_deg, kPmma);
    EXPECT_NEAR(light.footprint->active_fraction(), expected, 1e-9);
    EXPECT_NEAR(light.footprint->rre_contribution(), expected, 1e-9);
    for (const ActiveRegion& region : light.footprint->regions) EXPECT_NEAR(region.efficiency, 1.0, 1e-9);
  }
}

// The honeycomb has the symmetry of its cube corners. If the cant and the light are rotated by 120 degrees, the
// footprint is rotated as well. If they are mirrored, the footprint is mirrored.
TEST(Footprint, OfCantedCubesTurnsWithThem) {
  const auto footprint = [](double cant_azimuth_deg, double incidence_deg, double azimuth_deg) {
    const geometry::HexagonalCube cube{kCubeAperture, {8.0, cant_azimuth_deg}};
    const RreResult result =
        run(design_of(infinite(cube, Arrangement::honeycomb, 1.5), true), {incidence_deg}, {azimuth_deg});
    const Footprint& shown = *result.returned.at(0).footprint;
    EXPECT_NEAR(shown.rre_contribution(), result.points.at(0).rre, 2e-3) << "faint paths are left out";
    EXPECT_GT(shown.active_fraction(), 0.3);
    return shown;
  };
  const Footprint here = footprint(20.0, 9.0, 50.0);
  const Footprint turned = footprint(140.0, 9.0, 170.0);
  EXPECT_NEAR(here.active_fraction(), turned.active_fraction(), 1e-9);
  EXPECT_NEAR(here.rre_contribution(), turned.rre_contribution(), 1e-9);
  EXPECT_GT(std::abs(here.active_fraction() - footprint(80.0, 9.0, 110.0).active_fraction()), 1e-3)
      << "not by 60 degrees, which takes roots to rims";
  EXPECT_NEAR(footprint(25.0, 9.0, 70.0).active_fraction(), footprint(-25.0, 9.0, -70.0).active_fraction(), 1e-9);
}

TEST(Footprint, OfPrismsAtNormalIncidenceIsTheWholeFace) {
  for (const geometry::PartSpec& spec : {single(geometry::RtpElement{0.45, 0.45, 90.0}, 0.5),
                                         infinite(geometry::RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 0.6)}) {
    const Footprint footprint = *run(design_of(spec), {0.0}).returned.at(0).footprint;
    EXPECT_NEAR(footprint.active_fraction(), 1.0, 1e-9);
    EXPECT_EQ(footprint.regions.size(), 1U) << "neighbours of one efficiency are joined";
  }
}

// A full element returns all light that enters (docs/theory/closed_forms.md, section 1). In a half element, which the
// border of the part cuts, the wall and the entrance face are parallel. A half element therefore returns only the light
// that its wall reflects.
TEST(Footprint, ShowsTheHalvesOfABrickArray) {
  const Footprint footprint = *run(design_of(bricks()), {0.0}).returned.at(0).footprint;
  const double r = std::pow((kPmma - 1.0) / (kPmma + 1.0), 2.0);
  EXPECT_NEAR(area_above(footprint, 0.5) / footprint.entrance_area_mm2, 0.88, 1e-9);
  for (const ActiveRegion& region : footprint.regions) {
    const bool is_full = region.efficiency > 0.5;
    const double expected = is_full ? 1.0 - r : 2.0 * r / (1.0 + r) - r;
    EXPECT_NEAR(region.efficiency, expected, 1e-2 * expected) << "paths below the least efficiency are left out";
  }
}

// At oblique incidence, the light that the border walls reflect is outside of the cone. The halves then return nothing.
TEST(Footprint, HalvesAreDeadOffTheNormal) {
  const double t = 1.0;
  const Footprint footprint = *run(design_of(bricks()), {t}).returned.at(0).footprint;
  // The light reaches the elements at a horizontal distance of `shift` from its entry point.
  const double shift = 3.0 * std::tan(std::asin(std::sin(t * kDeg) / kPmma));
  const auto covers = [&](double x, double y) {
    for (const ActiveRegion& region : footprint.regions) {
      const geometry::Rectangle box = geometry::bounding_box(region.outline_mm);
      if (x > box.lower.x() && x < box.upper.x() && y > box.lower.y() && y < box.upper.y()) return true;
    }
    return false;
  };
  for (const double y : {1.0, 5.0, 9.0}) {
    EXPECT_FALSE(covers(0.5 + shift, y));
    EXPECT_FALSE(covers(9.5 + shift, y));
    EXPECT_TRUE(covers(4.5 + shift, y));
  }
  EXPECT_LE(footprint.active_fraction(), 0.88);
  EXPECT_GT(footprint.active_fraction(), 0.85);
}

/// Returns the efficiency at a point of the entrance face.
double efficiency_at(const Footprint& footprint, const geometry::Vec2& at) {
  for (const ActiveRegion& region : footprint.regions) {
    bool is_inside = true;
    const geometry::Polygon& outline = region.outline_mm;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const geometry::Vec2 along = outline[(k + 1) % outline.size()] - outline[k];
      const geometry::Vec2 to = at - outline[k];
      is_inside = is_inside && along.x() * to.y() - along.y() * to.x() >= 0.0;
    }
    if (is_inside) return region.efficiency;
  }
  return 0.0;
}

// Equal elements are traced only one time, but shown at all their positions. For an infinite part, these are all
// positions within a period.
TEST(Footprint, OfElementsFollowedOnceIsThatOfAll) {
  using Elements = raytrace::BeamTracer::Elements;
  const std::vector<geometry::PartSpec> specs = {
      honeycomb(), infinite(geometry::TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0),
      finite(geometry::HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 8.0, 8.0, 1.0)};
  for (const geometry::PartSpec& spec : specs) {
    const geometry::Part part = geometry::build_part(spec);
    const raytrace::Illumination light = from(14.0, 35.0);
    const std::vector<double> cones = {0.5};
    raytrace::BeamPolicy policy;
    policy.cutoff = 1e-7;
    const auto answer = [&](Elements elements) {
      return trace_exact_beams(raytrace::BeamTracer(part, elements), part, pmma(), light, cones, policy, {true, true},
                               nullptr, nullptr);
    };
    const BeamOutputs each = answer(Elements::individual);
    const BeamOutputs once = answer(Elements::instanced);
    if (part.period_mm) {
      EXPECT_LT(once.traced.beams, 0.7 * static_cast<double>(each.traced.beams));
    }
    // The two runs truncate different beams, because the light enters in different polygons.
    const auto truncated = [](const BeamOutputs& of) { return of.traced.ledgers[0][raytrace::Account::truncated]; };
    const double left = truncated(once) + truncated(each);
    EXPECT_LT(left, 2e-3);
    EXPECT_NEAR(once.footprint->rre_contribution(), each.footprint->rre_contribution(), left);
    EXPECT_NEAR(once.far_field->total_power, each.far_field->total_power, left);
    const geometry::Rectangle face = geometry::bounding_box(
        part.period_mm ? geometry::to_polygon({geometry::Vec2::Zero(), *part.period_mm}) : part.outline);
    for (int k = 0; k < 200; ++k) {
      const geometry::Vec2 share(std::fmod(0.754877 * k, 1.0), std::fmod(0.569840 * k, 1.0));
      const geometry::Vec2 at = face.lower + share.cwiseProduct(face.size());
      EXPECT_NEAR(efficiency_at(*once.footprint, at), efficiency_at(*each.footprint, at), 2e-3);
    }
  }
}

TEST(Footprint, AddsUpToWhatIsReturnedAndStaysOnTheFace) {
  const geometry::PartSpec triangles = infinite(geometry::TriangularCube{kCubeAperture}, Arrangement::triangular, 1.0);
  for (const geometry::PartSpec& spec : {bricks(), triangles}) {
    const RreResult result = run(design_of(spec), {4.0, 15.0}, {10.0}, 1e-6);
    for (const ReturnedLight& light : result.returned) {
      const Footprint& footprint = *light.footprint;
      EXPECT_LE(footprint.rre_contribution(), light.at.rre + 1e-9);
      EXPECT_NEAR(footprint.rre_contribution(), light.at.rre, 5e-3);
      const geometry::Rectangle face = geometry::bounding_box(result.faces.at(0).outline_mm);
      double sum = 0.0;
      for (const ActiveRegion& region : footprint.regions) {
        EXPECT_TRUE(geometry::contains(face, region.outline_mm, 1e-9));
        sum += geometry::area(region.outline_mm);
      }
      EXPECT_NEAR(sum, footprint.active_area_mm2, 1e-8);
    }
  }
}

TEST(EntranceFace, HasTheRimsAndRootsOfItsElements) {
  const geometry::Part prism = geometry::build_part(single(geometry::RtpElement{2.0, 1.0, 90.0}, 0.5));
  const EntranceFace face = entrance_face_of(prism);
  EXPECT_FALSE(face.is_periodic);
  EXPECT_EQ(face.outline_mm.size(), 4U);
  EXPECT_EQ(face.rims_mm.size(), 6U);
  ASSERT_EQ(face.roots_mm.size(), 1U);
  EXPECT_NEAR(face.roots_mm[0][0].x(), 1.0, 1e-12);
  EXPECT_TRUE(entrance_face_of(geometry::build_part(honeycomb())).is_periodic);
}

TEST(FootprintFiles, AreClosedRingsAndOneEntryADirection) {
  const RreResult result = run(design_of(bricks()), {0.0, 1.0});
  const Json json = Json::parse(footprint_json(result));
  EXPECT_EQ(json["schema"], "retrace.footprint/2");
  EXPECT_EQ(json["type"], "FeatureCollection");
  EXPECT_EQ(json["complete"], true);
  ASSERT_EQ(json["regions"].size(), 2U);
  std::vector<double> area(2), power(2);
  for (const Json& feature : json["features"]) {
    EXPECT_EQ(feature["geometry"]["type"], "Polygon");
    const Json& ring = feature["geometry"]["coordinates"][0];
    EXPECT_EQ(ring.front(), ring.back());
    geometry::Polygon outline;
    for (std::size_t k = 0; k + 1 < ring.size(); ++k) outline.emplace_back(ring[k][0], ring[k][1]);
    const std::size_t k = feature["properties"]["incidence_deg"] == 0.0 ? 0 : 1;
    area[k] += geometry::area(outline);
    power[k] += geometry::area(outline) * feature["properties"]["efficiency"].get<double>();
    EXPECT_EQ(feature["properties"]["acceptance_half_angle_deg"], 0.5);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(json["regions"][k]["active_area_mm2"].get<double>(), area[k], 1e-9);
    EXPECT_NEAR(json["regions"][k]["rre_shown"].get<double>(), power[k] / 100.0, 1e-12);
    EXPECT_EQ(json["regions"][k]["entrance_area_mm2"], 100.0);
  }
}

// At any incidence, the far field contains all light that leaves the entrance face.
TEST(FarField, AddsUpToTheLedger) {
  const RreResult result = run(design_of(bricks()), {0.0, 7.0, 30.0}, {0.0, 35.0}, 1e-6);
  ASSERT_EQ(result.returned.size(), 6U);
  for (const ReturnedLight& light : result.returned) {
    const FarField& field = *light.far_field;
    const raytrace::Ledger& ledger = light.at.ledger;
    using raytrace::Account;
    EXPECT_NEAR(field.total_power,
                ledger[Account::retroreflected] + ledger[Account::returned_elsewhere] + ledger[Account::front_specular],
                1e-12);
    double sum = field.other_power;
    double in_cone = 0.0;
    for (std::size_t k = 0; k < field.spots.size(); ++k) {
      const FarFieldSpot& spot = field.spots[k];
      sum += spot.stokes.i;
      if (spot.deviation.deg() <= 0.5) in_cone += spot.stokes.i;
      EXPECT_GE(field.spots[k > 0 ? k - 1 : 0].stokes.i, spot.stokes.i);
      EXPECT_LE(std::hypot(spot.stokes.q, spot.stokes.u, spot.stokes.v), spot.stokes.i * (1.0 + 1e-9));
    }
    EXPECT_NEAR(sum, field.total_power, 1e-12);
    EXPECT_NEAR(in_cone, light.at.rre, 1e-9);
  }
}

// The entrance face reflects light into the mirror direction. This direction is on the other side of the normal, and
// its angle to the source is twice the angle of incidence.
TEST(FarField, KnowsWhereTheFaceReflectsTo) {
  const double t = 10.0;
  const RreResult result = run(design_of(bricks()), {t}, {90.0});
  for (const FarFieldSpot& spot : result.returned.at(0).far_field->spots) {
    if (spot.min_depth != 0) continue;
    EXPECT_NEAR(spot.deviation.deg(), 2.0 * t, 1e-9);
    // The source is above +y. The first axis of its frame is +x, and the second axis points away from +y.
    EXPECT_NEAR(std::abs(spot.orientation.deg()), 90.0, 1e-9);
  }
}

// The apex angle A of a prism is not 90 degrees. The light that both facets reflect is deviated by 2 n (A - 90 deg) or
// more, to either side.
TEST(FarField, OfAWrongPrismAngleHasTwoSpots) {
  const double error_deg = 0.1;
  const RreResult result =
      run(design_of(infinite(geometry::RtpElement{0.5, 0.5, 90.0 + error_deg}, Arrangement::aligned, 0.5)), {0.0});
  const FarField& field = *result.returned.at(0).far_field;
  ASSERT_GE(field.spots.size(), 2U);
  const double expected = std::asin(kPmma * std::sin(2.0 * error_deg * kDeg)) / kDeg;
  double orientations = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(field.spots[k].deviation.deg(), expected, 1e-9);
    EXPECT_GT(field.spots[k].stokes.i, 0.4);
    orientations += field.spots[k].orientation.deg();
  }
  EXPECT_NEAR(orientations, 180.0, 1e-6) << "0 and 180 degrees";
}

TEST(FarFieldFiles, CsvAndJsonHoldTheSame) {
  const RreResult result = run(design_of(bricks()), {0.0, 7.0});
  const Json json = Json::parse(far_field_json(result));
  EXPECT_EQ(json["schema"], "retrace.far_field/1");
  ASSERT_EQ(json["directions"].size(), 2U);
  std::string csv =
      "design,incidence_deg,azimuth_deg,wavelength_nm,deviation_arcmin,deviation_azimuth_deg,power,s1,s2,s3,depth_"
      "min\n";
  for (const Json& direction : json["directions"]) {
    EXPECT_GE(direction["total_power"].get<double>(), direction["other_power"].get<double>());
    for (const Json& spot : direction["spots"]) {
      for (const char* key : {"design", "incidence_deg", "azimuth_deg", "wavelength_nm"})
        csv += direction[key].dump() + ',';
      std::string rest;
      for (const auto& [key, value] : spot.items()) rest += (rest.empty() ? "" : ",") + key;
      EXPECT_EQ(rest, "deviation_arcmin,deviation_azimuth_deg,power,s1,s2,s3,depth_min");
      csv += '\n';
    }
  }
  const std::string written = far_field_csv(result);
  EXPECT_EQ(std::count(written.begin(), written.end(), '\n'), std::count(csv.begin(), csv.end(), '\n'));
  EXPECT_TRUE(written.starts_with(csv.substr(0, csv.find('\n') + 1)));
}

TEST(ReturnedLight, IsTheSameAtAnyNumberOfThreads) {
  const auto written = [&](unsigned threads) {
    RreResult result;
    run_with_threads(threads, [&] { result = run(design_of(honeycomb()), {0.0, 8.0, 15.0}, {20.0}, 1e-5); });
    return footprint_json(result) + far_field_json(result) + far_field_csv(result);
  };
  EXPECT_EQ(written(1), written(2));
}

TEST(ReturnedLight, NeedsTheExactEngine) {
  RreSettings request;
  request.engine = raytrace::Engine::montecarlo;
  request.footprint = true;
  EXPECT_THROW(RreStudy({design_of(bricks())}, request), InputError);
}

TEST(ReturnedLight, IsNotGatheredUnasked) {
  RreSettings request;
  request.engine = raytrace::Engine::exact;
  const RreResult result = RreStudy({design_of(bricks())}, request).run();
  EXPECT_TRUE(result.returned.empty());
  EXPECT_TRUE(result.faces.empty());
}

}  // namespace
}  // namespace retrace::studies::returned_light_test

// Tests of the positions at which returned light enters and leaves, and of its polarisation: closed forms, reciprocity,
// and an independent tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raytrace/exact/beam_tracer.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"

namespace retrace::testing::returned_beams_test {
namespace {

using namespace geometry;
using namespace raytrace;

struct Traced {
  BeamResult result;
  std::vector<ReturnedBeam> beams;
};

Traced trace(const Part& part, const Optics& optics, const Illumination& illumination, double truncated = 1e-10,
             double cone_deg = 0.5) {
  Traced traced;
  BeamPolicy policy;
  policy.truncated_goal = truncated;
  traced.result = BeamTracer(part).trace(optics, illumination, {cone_deg}, policy, nullptr,
                                         [&](const ReturnedBeam& beam) { traced.beams.push_back(beam); });
  return traced;
}

TEST(ReturnedBeams, AddUpToTheLedger) {
  for (const bool is_infinite : {false, true}) {
    PartSpec spec = finite(RtpElement{0.7, 0.5, 91.0}, Arrangement::offset, 2.9, 2.1, 0.6);
    if (is_infinite) spec = infinite(RtpElement{0.7, 0.5, 91.0}, Arrangement::offset, 0.6);
    Optics optics = pmma();
    optics.absorption_per_mm = 0.05;
    const Traced traced = trace(build_part(spec), optics, from(31.0, 50.0), 1e-4);
    double in_cone = 0.0;
    double elsewhere = 0.0;
    for (const ReturnedBeam& beam : traced.beams) (beam.cone == 0 ? in_cone : elsewhere) += beam.stokes.i;
    const Ledger& ledger = traced.result.ledgers[0];
    EXPECT_NEAR(in_cone, ledger[Account::retroreflected], 1e-12);
    EXPECT_NEAR(elsewhere, ledger[Account::returned_elsewhere] + ledger[Account::front_specular], 1e-12);
  }
}

// On the entrance face, the region where a beam leaves a cube corner is the region where it entered, rotated by 180
// degrees about a center.
TEST(ReturnedBeams, CubeCornerTurnsTheEntryAboutItsAxis) {
  const Part part = build_part(single(HexagonalCube{kCubeAperture}, 0.4));
  const Vec2 centre = centroid(part.outline);
  int seen = 0;
  for (const ReturnedBeam& beam : trace(part, pmma(), from(12.0, 40.0), 1e-3).beams) {
    if (beam.depth != 4 || beam.cone != 0) continue;
    ++seen;
    EXPECT_NEAR(area(beam.entry_polygon_mm), area(beam.exit_polygon_mm), 1e-12);
    // This center is the projection of the apex onto the face, along the direction of the light inside.
    const double shift =
        (part.thickness_mm + part.element_depth_mm) * std::tan(std::asin(std::sin(12.0 * kDeg) / kPmma));
    const Vec2 axis = centre + shift * Vec2(std::cos(40.0 * kDeg), std::sin(40.0 * kDeg));
    EXPECT_NEAR((centroid(beam.entry_polygon_mm) + centroid(beam.exit_polygon_mm) - 2.0 * axis).norm(), 0.0, 1e-12);
  }
  EXPECT_GE(seen, 6);
}

// For mirror facets behind a lossless face, the region that returns light is the effective aperture.
TEST(ReturnedBeams, EnterWithinTheEffectiveAperture) {
  const Part part = build_part(infinite(HexagonalCube{kCubeAperture}, Arrangement::honeycomb, 1.0));
  for (const double t : {0.0, 12.0, 40.0}) {
    double active = 0.0;
    for (const ReturnedBeam& beam : trace(part, ideal(), from(t, 25.0)).beams) {
      if (beam.cone != 0) continue;
      EXPECT_NEAR(beam.efficiency, 1.0, 1e-12);
      active += area(beam.entry_polygon_mm);
    }
    EXPECT_NEAR(active / part.entrance_area_mm2, honeycomb_rre(t, 25.0, kPmma), 1e-9) << t;
  }
}

struct Spot {
  Vec3 direction;
  double power = 0.0;
};

std::vector<Spot> spots_of(const std::vector<ReturnedBeam>& beams) {
  std::vector<Spot> spots;
  for (const ReturnedBeam& beam : beams) {
    if (beam.depth == 0) continue;
    auto spot = std::find_if(spots.begin(), spots.end(),
                             [&](const Spot& s) { return (s.direction - beam.direction).norm() < 1e-7; });
    if (spot == spots.end()) spot = spots.insert(spots.end(), {beam.direction, 0.0});
    spot->power += beam.stokes.i;
  }
  return spots;
}

Illumination towards(const Vec3& direction) {
  return {Angle::from_rad(std::acos(direction.z())), Angle::from_rad(std::atan2(direction.y(), direction.x()))};
}

double power_towards(const std::vector<Spot>& spots, const Vec3& direction) {
  double power = 0.0;
  for (const Spot& spot : spots)
    if ((spot.direction - direction).norm() < 1e-7) power += spot.power;
  return power;
}

// Tests the reciprocity of each returned beam: f(s -> r) cos t'_s = f(r -> s) cos t'_r. f(s -> r) is the fraction of
// the light from the direction s that is returned into the direction r, and t' is the angle to the normal inside the
// part. A beam and its reverse have the same cross-section and the same Fresnel transmittance.
int expect_reciprocity(const Part& part, const Optics& optics, const Illumination& illumination) {
  const auto cos_inside = [&](const Vec3& d) {
    return std::sqrt(1.0 - (1.0 - d.z() * d.z()) / (optics.index * optics.index));
  };
  const Vec3 to_source = direction_to_source(illumination);
  int checked = 0;
  for (const Spot& spot : spots_of(trace(part, optics, illumination).beams)) {
    if (spot.power < 1e-6) continue;
    const std::vector<Spot> back = spots_of(trace(part, optics, towards(spot.direction)).beams);
    EXPECT_NEAR(power_towards(back, to_source) * cos_inside(spot.direction), spot.power * cos_inside(to_source), 1e-9)
        << "to " << spot.direction.transpose();
    ++checked;
  }
  return checked;
}

// With mirror facets, all light remains inside and beams keep their cross-section. Absorption weakens beams with many
// reflections.
TEST(Reciprocity, OfEveryEntranceToEntranceBeam) {
  Optics optics = pmma();
  optics.mirror_facets = true;
  optics.absorption_per_mm = 3.0;
  int checked = 0;
  for (const PartSpec& spec : {infinite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 0.6),
                               infinite(RtpElement{0.5, 0.5, 91.5}, Arrangement::checker, 0.3),
                               infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 0.3),
                               infinite(TriangularCube{1.0}, Arrangement::triangular, 0.3)}) {
    const Part part = build_part(spec);
    checked += expect_reciprocity(part, optics, from(33.0, 20.0));
    checked += expect_reciprocity(part, optics, from(8.0, 75.0));
  }
  EXPECT_GT(checked, 30);
}

}  // namespace
}  // namespace retrace::testing::returned_beams_test

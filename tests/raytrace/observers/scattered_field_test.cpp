// Tests of diffraction with roughness against a reference in which facets with random heights are phase screens. The
// reference traces rays one by one. It adds the fields of all paths over the aperture by fast Fourier transforms.
#include <gtest/gtest.h>

#include "tests/raytrace/observers/phase_screens.h"

namespace retrace::testing::scattered_field_test {
namespace {

using namespace phase_screens;

void expect_agreement(const Case& c) {
  const Screens screens = c.is_cube ? Screens::cube(c.size_mm, c.mirrors) : Screens::prism(c.size_mm, c.mirrors);
  const Part part =
      build_part(c.is_cube ? single(HexagonalCube{c.size_mm}, 0.3) : single(RtpElement{c.size_mm, c.size_mm}, 0.3));
  Aperture aperture(screens, c.pixels, c.nodes);
  const FarField smooth = engine_field(part, optics_of({}, c.mirrors));
  const Scattered all = screened(screens, aperture, c);
  for (std::size_t s = 0; s < kSqNm.size(); ++s) {
    const double sq_nm = kSqNm[s];
    const double mean_factor = all.mean_factors[s];
    const Pattern& scattered = all.patterns[s];
    const FarField field = engine_field(part, optics_of(rough(sq_nm, c.length_um), c.mirrors));
    const auto what = [&] {
      return ::testing::Message() << (c.is_cube ? "cube " : "prism ") << (c.mirrors ? "mirrors " : "") << "Sq " << sq_nm
                                  << " nm, l " << c.length_um << " um: ";
    };
    for (std::size_t k = 0; k < c.nodes.size(); ++k) {
      const Vec2& q = c.nodes[k];
      const Vec3 d(q.x(), q.y(), std::sqrt(1.0 - q.squaredNorm()));
      const double mean = mean_factor * mean_factor * smooth.diffracted_per_sr(d) / d.z();
      const double found = (field.diffracted_per_sr(d) + field.scattered_per_sr(d)) / d.z();
      EXPECT_NEAR(found, mean + scattered.nodes[k], 0.01 * (mean + scattered.nodes[k]))
          << what() << "direction " << q.transpose() << ", scattered: " << scattered.nodes[k] << " and "
          << found - mean;
    }
    for (const double cone_deg : c.cones_deg) {
      const double by_screens = aperture.within(scattered, cone_deg);
      const double mean = mean_factor * mean_factor * smooth.split({}, cone_deg * kDeg).inside;
      const double found = field.split({}, cone_deg * kDeg).inside;
      EXPECT_NEAR(found, mean + by_screens, 0.01 * (mean + by_screens))
          << what() << cone_deg << " degrees, scattered: " << by_screens << " and " << found - mean;
    }
  }
}

/// Cones of a hundredth of a degree are so narrow that the direction of their axis represents them.
const Vec2 kAxis = Vec2::Zero();

TEST(DiffractionWithRoughness, PrismsAgreeWithPhaseScreensThatBothPathsMeet) {
  expect_agreement({false, false, 0.45, 50.0, 64, 200, {0.05, 0.1, 0.3, 1.0}, {kAxis, {1.7e-4, 0.0}}});
  expect_agreement({false, false, 0.16, 5.0, 128, 24, {0.3, 1.0, 3.0, 5.0}, {kAxis, {1.7e-4, 0.0}}});
  expect_agreement({false, false, 0.08, 2.0, 160, 16, {0.5, 2.0, 5.0}, {kAxis, {1.7e-4, 0.0}}});
}

TEST(DiffractionWithRoughness, CubeCornersAgreeWithPhaseScreensThatPathsOfOppositeOrderMeet) {
  for (const bool mirrors : {true, false})
    expect_agreement({true, mirrors, 0.45, 50.0, 64, 200, {0.05, 0.1, 0.3, 1.0}, {kAxis, {1.7e-4, 0.0}}});
  expect_agreement({true, false, 0.16, 5.0, 128, 24, {0.3, 1.0, 3.0, 5.0}, {kAxis, {1.7e-4, 0.0}}});
  expect_agreement({true, false, 0.08, 2.0, 160, 16, {0.5, 2.0, 5.0}, {kAxis, {1.7e-4, 0.0}}});
}

}  // namespace
}  // namespace retrace::testing::scattered_field_test

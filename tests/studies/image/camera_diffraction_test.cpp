// Tests of the luminance of returned light with diffraction: comparison with the photometer, and with geometrical
// optics.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "studies/image/camera_study.h"
#include "studies/photometry/photometry.h"
#include "tests/support/designs.h"

namespace retrace::testing::camera_diffraction_test {
namespace {

using namespace geometry;
using std::numbers::pi;

struct Geometry {
  double observation_deg, v_deg, h_deg, rotation_deg;
  double lamp_arcmin = 10.0;
  double pupil_arcmin = 10.0;
};

using Geometries = std::vector<Geometry>;

const Geometries kGeometries = {{0.2, 0.0, 5.0, 0.0},
                                {0.33, 5.0, 0.0, 0.0},
                                {0.33, 10.0, 0.0, 90.0},
                                {0.5, 0.0, 10.0, 30.0},
                                {1.0, 0.0, -8.0, 0.0}};

design::Design design_of(const PartSpec& part, double dihedral_error_arcmin) {
  design::Design design;
  design.part() = part;
  design.part().angle_errors.dihedral_error_arcmin.fill(dihedral_error_arcmin);
  design.substance.refractive_index = kPmma;
  return design;
}

/// Returns R_A as `retrace photometry` computes it.
double r_a_of(const design::Design& design, const Geometry& at) {
  studies::PhotometrySettings request;
  request.test_plan.points.push_back({at.observation_deg, at.v_deg, at.h_deg, 1.0,
                                      studies::PhotometricUnit::cd_per_lx_per_m2, studies::LimitStatus::confirmed, 2});
  request.rotation_deg = {at.rotation_deg};
  request.area_cm2 = 10.0;
  request.apertures = {Angle::from_deg(at.lamp_arcmin / 60.0), Angle::from_deg(at.pupil_arcmin / 60.0)};
  request.advice = false;
  return studies::PhotometryStudy(design, request).run().points.front().r_a;
}

CameraRequest camera_of(const Geometry& at) {
  CameraRequest camera;
  camera.distance_m = 1000.0;  // so distant that all points of the part see the lamp in the same direction
  camera.observation_deg = at.observation_deg;
  camera.v_deg = at.v_deg;
  camera.h_deg = at.h_deg;
  camera.rotation_deg = at.rotation_deg;
  camera.lamp_arcmin = at.lamp_arcmin;
  camera.pupil_arcmin = at.pupil_arcmin;
  camera.columns = camera.rows = 32;
  camera.passes = 16;
  return camera;
}

/// The mean luminance of the part is L = R_A E / cos nu, with R_A of the photometer for the same discs.
void expect_luminance_of_photometer(const std::string& name, const design::Design& design,
                                    const Geometries& geometries = kGeometries) {
  for (const Geometry& at : geometries) {
    CameraRequest camera = camera_of(at);
    if (design.is_infinite()) {
      // Periods that the border of the sheet cuts have a negligible effect.
      camera.film_mm = {400.0, 400.0};
      camera.field_mm = 300.0;
    }
    const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
    const double r_a = r_a_of(design, at);
    const double expected = r_a * camera.illuminance_lx / std::cos(seen.viewing_deg * pi / 180.0);
    ASSERT_GT(expected, 0.0);
    EXPECT_FALSE(seen.no_diffraction);
    ASSERT_TRUE(seen.r_a);
    const auto where = ::testing::Message() << name << ", " << at.observation_deg << ' ' << at.v_deg << ' ' << at.h_deg
                                            << ' ' << at.rotation_deg << ", R_A " << r_a << ", picture "
                                            << seen.image.part_mean() << " +- " << seen.image.part_error();
    EXPECT_NEAR(*seen.r_a, r_a, 0.01 * r_a) << where;
    EXPECT_NEAR(seen.image.part_mean(), expected, 0.02 * expected) << where;
  }
}

TEST(CameraDiffraction, LuminanceOfHoneycombIsThatOfThePhotometer) {
  expect_luminance_of_photometer("honeycomb",
                                 design_of(infinite(HexagonalCube{0.5}, Arrangement::honeycomb, 1.0), 0.0));
}

TEST(CameraDiffraction, LuminanceOfCubesWithErrorsIsThatOfThePhotometer) {
  expect_luminance_of_photometer("honeycomb with errors",
                                 design_of(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0), 2.0));
}

TEST(CameraDiffraction, LuminanceOfTriangularCubesIsThatOfThePhotometer) {
  expect_luminance_of_photometer("triangular cubes",
                                 design_of(infinite(TriangularCube{0.4}, Arrangement::triangular, 1.0), 1.0));
}

/// The prisms are infinite, because the mean over a finite part includes its visible sides, which are dark. Two of the
/// geometries are left out: at V 0, H 5 the picture is 2.7 % too bright, and at V 0, H 10, rotation 30 degrees it
/// is 3.7 % too dark (docs/theory/images.md).
TEST(CameraDiffraction, LuminanceOfPrismsIsThatOfThePhotometer) {
  expect_luminance_of_photometer("prisms", design_of(infinite(RtpElement{2.0, 2.0}, Arrangement::offset, 2.0), 0.0),
                                 {kGeometries[1], kGeometries[2], kGeometries[4]});
}

/// Cells of 20 mm spread light by less than a hundredth of the discs. The picture is that of geometrical optics.
TEST(CameraDiffraction, LargeCellsLookAsInGeometricalOptics) {
  const design::Design design = design_of(infinite(HexagonalCube{20.0}, Arrangement::honeycomb, 5.0), 1.0);
  CameraRequest camera = camera_of({0.1, 0.0, 5.0, 0.0, 20.0, 20.0});
  camera.field_mm = 60.0;
  const studies::CameraResult with = studies::CameraStudy(design, camera).run();
  camera.diffraction = false;
  const studies::CameraResult without = studies::CameraStudy(design, camera).run();
  EXPECT_FALSE(with.no_diffraction);
  EXPECT_TRUE(without.no_diffraction);
  ASSERT_GT(without.image.part_mean(), 0.0);
  EXPECT_EQ(with.image.luminance, without.image.luminance);
}

/// For cells of 2 mm and large discs, diffraction is computed but changes the luminance little.
TEST(CameraDiffraction, LargeDiscsHideDiffraction) {
  const design::Design design = design_of(infinite(HexagonalCube{2.0}, Arrangement::honeycomb, 1.0), 0.5);
  CameraRequest camera = camera_of({0.1, 0.0, 5.0, 0.0, 60.0, 60.0});
  camera.film_mm = {200.0, 200.0};
  camera.field_mm = 60.0;
  camera.columns = camera.rows = 120;
  const studies::CameraResult with = studies::CameraStudy(design, camera).run();
  camera.diffraction = false;
  const studies::CameraResult without = studies::CameraStudy(design, camera).run();
  EXPECT_NEAR(with.image.part_mean(), without.image.part_mean(), 0.04 * without.image.part_mean());
  double difference = 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < with.image.luminance.size(); ++k) {
    difference += std::abs(with.image.luminance[k] - without.image.luminance[k]);
    sum += without.image.luminance[k];
  }
  EXPECT_LT(difference, 0.06 * sum);
}

/// Dead zones of the elements stay dark: the diffracted light has the distribution of the light that leaves the face.
TEST(CameraDiffraction, ShowsDeadZones) {
  const design::Design design = design_of(infinite(TriangularCube{2.0}, Arrangement::triangular, 1.0), 0.0);
  CameraRequest camera = camera_of({0.33, -5.0, 0.0, 0.0});
  camera.film_mm = {20.0, 20.0};
  camera.field_mm = 4.0;
  camera.columns = camera.rows = 80;
  const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
  std::size_t dark = 0;
  std::size_t bright = 0;
  const double mean = seen.image.part_mean();
  for (const double luminance : seen.image.luminance) {
    dark += luminance < 0.05 * mean ? 1 : 0;
    bright += luminance > mean ? 1 : 0;
  }
  const auto pixels = static_cast<double>(seen.image.luminance.size());
  // One third of the face of a triangular cube returns no light.
  EXPECT_GT(static_cast<double>(dark) / pixels, 0.15);
  EXPECT_GT(static_cast<double>(bright) / pixels, 0.4);
}

TEST(CameraDiffraction, ReasonIsGivenIfItIsMissing) {
  CameraRequest camera = camera_of(kGeometries[0]);
  camera.passes = 2;
  camera.diffraction = false;
  const design::Design design = design_of(infinite(HexagonalCube{0.5}, Arrangement::honeycomb, 1.0), 0.0);
  const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
  ASSERT_TRUE(seen.no_diffraction);
  EXPECT_EQ(std::get<studies::Undiffracted>(*seen.no_diffraction), studies::Undiffracted::not_requested);
  EXPECT_FALSE(seen.r_a);
}

}  // namespace
}  // namespace retrace::testing::camera_diffraction_test

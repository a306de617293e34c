// Tests of the luminance of returned light with diffraction: comparison with the photometer, and with geometrical
// optics.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
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

const std::vector<Geometry> kGeometries = {{0.2, 0.0, 5.0, 0.0},
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
/// \param cutoff minimum power of beams that are traced exactly; by default that of the command
double r_a_of(const design::Design& design, const Geometry& at, std::optional<double> cutoff = {}) {
  studies::PhotometrySettings request;
  request.test_plan.points.push_back({at.observation_deg, at.v_deg, at.h_deg, 1.0,
                                      studies::PhotometricUnit::cd_per_lx_per_m2, studies::LimitStatus::confirmed, 2});
  request.rotation_deg = {at.rotation_deg};
  request.area_cm2 = 10.0;
  request.apertures = {Angle::from_deg(at.lamp_arcmin / 60.0), Angle::from_deg(at.pupil_arcmin / 60.0)};
  request.advice = false;
  request.cutoff = cutoff;
  return studies::PhotometryStudy(design, request).run().points.front().r_a;
}

CameraRequest camera_of(const Geometry& at) {
  CameraRequest camera;
  // At this distance, the directions of lamp and eye are nearly the same for all points of the part, as in `retrace
  // photometry`.
  camera.distance_m = 1e5;
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
/// \param cutoff passed to r_a_of()
void expect_luminance_of_photometer(const std::string& name, const design::Design& design,
                                    std::optional<double> cutoff = {}) {
  for (const Geometry& at : kGeometries) {
    CameraRequest camera = camera_of(at);
    if (design.is_infinite()) {
      // Periods that the border of the sheet cuts have a negligible effect.
      camera.film_mm = {400.0, 400.0};
      camera.field_mm = 300.0;
    }
    const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
    const double r_a = r_a_of(design, at, cutoff);
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

/// Most light of prisms that returns at V 0, H 10 and a rotation of 30 degrees is in weak beams. With the usual cut-off
/// power, R_A then has a standard error of 9 %. The cut-off is lower here, so that R_A is known to 1 %.
TEST(CameraDiffraction, LuminanceOfPrismsIsThatOfThePhotometer) {
  expect_luminance_of_photometer("prisms", design_of(infinite(RtpElement{2.0, 2.0}, Arrangement::offset, 2.0), 0.0),
                                 1e-7);
}

/// The picture of a finite part also shows its sides, which are dark. The test therefore compares the intensity of the
/// whole picture with R_A E A.
TEST(CameraDiffraction, IntensityOfFinitePrismsIsThatOfThePhotometer) {
  const design::Design design = design_of(finite(RtpElement{2.0, 2.0}, Arrangement::offset, 10.0, 10.0, 2.0), 0.0);
  for (const Geometry& at : {kGeometries[0], kGeometries[1], kGeometries[4]}) {
    const CameraRequest camera = camera_of(at);
    const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
    double sum = 0.0;
    for (const double luminance : seen.image.luminance) sum += luminance;
    const double pixel_mm = seen.scene.view.width_mm / static_cast<double>(camera.columns);
    const double expected = r_a_of(design, at) * camera.illuminance_lx * 100.0;
    EXPECT_NEAR(sum * pixel_mm * pixel_mm, expected, 0.02 * expected) << at.observation_deg << ' ' << at.v_deg;
  }
}

/// The two facets of a prism reverse light in one plane only. At a distance of 1 km, the angle between the returned
/// light and the eye therefore depends on the position on the face, and the mean luminance is 2.6 % above that of the
/// centre. It agrees with the mean over the readings of the photometer at these positions: on a sheet of 300 mm, V is
/// -0.0086 to 0.0086 degrees.
TEST(CameraDiffraction, LuminanceVariesOverTheFaceAsForThePhotometer) {
  const design::Design design = design_of(infinite(RtpElement{2.0, 2.0}, Arrangement::offset, 2.0), 0.0);
  CameraRequest camera = camera_of(kGeometries[0]);
  camera.distance_m = 1000.0;
  camera.film_mm = {400.0, 400.0};
  camera.field_mm = 300.0;
  const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
  double mean = 0.0;
  const std::vector<double> simpson = {1.0, 4.0, 2.0, 4.0, 2.0, 4.0, 1.0};
  for (std::size_t k = 0; k < simpson.size(); ++k) {
    Geometry at = kGeometries[0];
    at.v_deg = std::atan(1e-6 * 50.0 * (static_cast<double>(k) - 3.0)) * 180.0 / pi;
    mean += simpson[k] / 18.0 * r_a_of(design, at);
  }
  const double in_centre = r_a_of(design, kGeometries[0]);
  EXPECT_GT(mean, 1.02 * in_centre);
  const double expected = mean * camera.illuminance_lx / std::cos(seen.viewing_deg * pi / 180.0);
  EXPECT_NEAR(seen.image.part_mean(), expected, 0.005 * expected);
}

/// If much of the returned light is in weak beams, more beams are traced until the standard error of R_A is small.
TEST(CameraDiffraction, WeakBeamsAreTracedUntilTheErrorIsSmall) {
  CameraRequest camera = camera_of(kGeometries[3]);
  camera.passes = 2;
  camera.light = "design";
  const design::Design design = design_of(infinite(RtpElement{2.0, 2.0}, Arrangement::offset, 2.0), 0.0);
  const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
  ASSERT_TRUE(seen.r_a);
  EXPECT_GT(seen.r_a_error, 0.0);
  EXPECT_LT(seen.r_a_error, 0.01 * *seen.r_a);
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

// Tests of camera pictures: uniform light, closed forms, coefficients of retroreflection, footprints and convergence.
#include "raytrace/observers/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/threads.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/observers/detector.h"
#include "raytrace/observers/photometric_geometry.h"
#include "studies/image/camera_study.h"
#include "studies/photometry/photometry.h"
#include "tests/support/designs.h"
#include "tests/support/outlined_parts.h"
#include "tests/support/statistics.h"

namespace retrace::testing::camera_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;

constexpr double kArcmin = pi / 180.0 / 60.0;

/// Returns a scene with camera and lamp at a distance of 1 km, so that the viewing direction is the same for the whole
/// part.
CameraScene far_scene(const Part& part, double alpha_deg, double v_deg, double h_deg, double lamp_arcmin,
                      double pupil_arcmin) {
  const PhotometricGeometry geometry =
      geometry_from({Angle::from_deg(v_deg), Angle::from_deg(h_deg)}, Angle::from_deg(alpha_deg), Angle::from_deg(0.0));
  const PhotometricDirections towards = directions_of(geometry);
  CameraScene scene;
  scene.view.target_mm = {0.0, 0.0, part.thickness_mm};
  scene.view.eye_mm = scene.view.target_mm + 1e6 * towards.to_observer;
  scene.view.up = return_frame(geometry).up;
  scene.view.columns = scene.view.rows = 8;
  scene.view.pupil = Angle::from_rad(pupil_arcmin * kArcmin);
  scene.lamp = {scene.view.target_mm + 1e6 * towards.to_source, 10.0, Angle::from_rad(lamp_arcmin * kArcmin)};
  if (part.period_mm) scene.film = Film{40.0, 40.0, {}};
  scene.view.width_mm = 20.0;
  return scene;
}

CameraImage pictured(const Part& part, const Optics& optics, const CameraScene& scene, std::uint32_t passes,
                     std::uint32_t seed = 1) {
  const CameraTracer tracer(part, {{optics, 1.0}}, scene, {}, seed);
  CameraImage image = tracer.empty_image();
  while (image.passes < passes) EXPECT_TRUE(tracer.add_pass(image));
  return image;
}

Part cubes(double error_arcmin = 0.0) {
  PartSpec spec = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  spec.angle_errors.dihedral_error_arcmin.fill(error_arcmin);
  return build_part(spec);
}

/// In light with equal luminance from all directions, a part that does not absorb light is invisible.
TEST(Camera, PartIsInvisibleInUniformLight) {
  const Part brick = build_part(finite(RtpElement{2.0, 2.0}, Arrangement::offset, 6.0, 6.0, 2.0));
  const Part cube = build_part(single(HexagonalCube{3.0}, 1.0));
  const PartSpec small = finite(HexagonalCube{0.5}, Arrangement::honeycomb, 0.0, 0.0, 0.5);
  const Part notch = build_part(with_outline(small, bent_outline()));
  const Part hole = build_part(with_outline(small, ring_outline()));
  for (const Part* part : {&brick, &cube, &notch, &hole})
    for (const double h_deg : {0.0, 30.0, 70.0}) {
      CameraScene scene = far_scene(*part, 0.0, 10.0, h_deg, 10.0, 10.0);
      scene.lamp.illuminance_lx = 0.0;
      scene.surroundings = {7.0, 7.0};
      scene.view.width_mm = part->entrance_pieces.empty() ? 9.0 : 3.0;
      Optics layered = pmma();
      layered.facet_layers = {{{1.9, 0.1}, {1.3777, 0.2}}};
      layered.entrance_layers = anti_reflection();
      for (const Optics& optics : {pmma(), layered}) {
        const CameraImage image = pictured(*part, optics, scene, 4);
        for (const double luminance : image.luminance) EXPECT_NEAR(luminance, 7.0, 1e-6);
        EXPECT_GT(*std::max_element(image.coverage.begin(), image.coverage.end()), 0.99);
      }
    }
}

/// A part with absorbing layers is darker. The missing fraction of the luminance is the fraction of the light from the
/// camera that the part absorbs.
TEST(Camera, LayersThatAbsorbAreDark) {
  const Part part = cubes();
  Optics optics = pmma();
  optics.facet_layers = thin_aluminium();
  optics.entrance_layers = thin_aluminium();
  CameraScene scene = far_scene(part, 0.0, 10.0, 0.0, 10.0, 10.0);
  scene.lamp.illuminance_lx = 0.0;
  scene.surroundings = {7.0, 7.0};
  const CameraImage image = pictured(part, optics, scene, 64);
  BeamPolicy policy;
  policy.cutoff = 1e-6;
  const Ledger ledger = BeamTracer(part).trace(optics, from(10.0, 90.0), {0.5}, policy).ledgers[0];
  EXPECT_GT(ledger[Account::absorbed], 0.2);
  EXPECT_NEAR(image.part_mean(), 7.0 * (1.0 - ledger[Account::absorbed]),
              student_bound(1, 64) * image.part_error() + 7.0 * ledger[Account::truncated] + 1e-4);
}

/// All light returns exactly to its source. The disc of the lamp is larger than the pupil, so that every ray from the
/// pupil ends on the lamp. Its luminance is E / Omega.
TEST(Camera, PerfectArrayShowsTheLamp) {
  const Part part = cubes();
  const double omega = pi * std::pow(6.0 * kArcmin, 2.0);
  for (const DiscAverage discs : {DiscAverage::kernel, DiscAverage::sampled}) {
    CameraScene scene = far_scene(part, 0.0, 0.0, 0.0, 12.0, 6.0);
    scene.discs = discs;
    const CameraImage image = pictured(part, ideal(), scene, 4);
    for (const double luminance : image.luminance) EXPECT_NEAR(luminance, 10.0 / omega, 1e-4 * 10.0 / omega);
  }
}

/// The expected mean luminance is L = R_A E / cos nu. R_A is computed by the photometer for the same discs, without
/// diffraction.
TEST(Camera, MeanLuminanceIsThatOfThePhotometer) {
  struct Case {
    double error_arcmin, alpha_deg, v_deg, h_deg, lamp_arcmin, pupil_arcmin;
  };
  for (const Case& c : {Case{0.0, 0.0, 0.0, 0.0, 10.0, 10.0}, Case{2.0, 0.2, 0.0, 0.0, 20.0, 10.0},
                        Case{2.0, 0.2, 10.0, 0.0, 10.0, 20.0}, Case{1.0, 0.1, 0.0, 20.0, 15.0, 15.0}}) {
    design::Design design;
    design.part() = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
    design.part().angle_errors.dihedral_error_arcmin.fill(c.error_arcmin);
    design.substance.refractive_index = kPmma;
    studies::PhotometrySettings request;
    request.test_plan.points.push_back({c.alpha_deg, c.v_deg, c.h_deg, 1.0, studies::PhotometricUnit::cd_per_lx_per_m2,
                                        studies::LimitStatus::confirmed, 2});
    request.area_cm2 = 10.0;
    request.apertures = {Angle::from_rad(c.lamp_arcmin * kArcmin), Angle::from_rad(c.pupil_arcmin * kArcmin)};
    request.light = studies::PhotometricLight::of_design;
    request.diffraction = false;
    request.advice = false;
    const double r_a = studies::PhotometryStudy(design, request).run().points.front().r_a;

    CameraRequest camera;
    camera.distance_m = 1e5;  // so distant that the whole entrance face reflects light back to the lamp
    camera.observation_deg = c.alpha_deg;
    camera.v_deg = c.v_deg;
    camera.h_deg = c.h_deg;
    camera.lamp_arcmin = c.lamp_arcmin;
    camera.pupil_arcmin = c.pupil_arcmin;
    camera.columns = camera.rows = 32;
    // The sheet has so many periods that cut periods at its border have a negligible effect.
    camera.film_mm = {500.0, 500.0};
    camera.field_mm = 400.0;
    camera.passes = 64;
    camera.diffraction = false;
    const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
    const double expected = r_a * camera.illuminance_lx / std::cos(seen.viewing_deg * pi / 180.0);
    ASSERT_GT(expected, 0.0);
    // The photometer truncates weak beams, which changes its value by up to 1e-3.
    EXPECT_NEAR(seen.image.part_mean(), expected, student_bound(4, 64) * seen.image.part_error() + 1e-3 * expected)
        << c.error_arcmin << ' ' << c.alpha_deg << ' ' << c.v_deg << ' ' << c.h_deg;
    EXPECT_LT(seen.image.part_error(), 0.03 * expected);
  }
}

/// The mean over both discs is computed in closed form and by sampling points of each disc.
TEST(Camera, DiscsAveragedAndSampledAgree) {
  const Part part = cubes(2.0);
  CameraScene scene = far_scene(part, 0.2, 5.0, 5.0, 20.0, 15.0);
  const CameraImage kernel = pictured(part, pmma(), scene, 32);
  scene.discs = DiscAverage::sampled;
  const CameraImage sampled = pictured(part, pmma(), scene, 256, 9);
  EXPECT_NEAR(kernel.part_mean(), sampled.part_mean(),
              student_bound(1) * std::hypot(kernel.part_error(), sampled.part_error()));
  EXPECT_LT(sampled.part_error(), 0.03 * sampled.part_mean());
}

/// At alpha = 0, a point of the entrance face is bright if and only if light that enters there returns.
TEST(Camera, IsBrightWhereTheFootprintIs) {
  const Part part = build_part(single(TriangularCube{4.0}, 1.0));
  const Rectangle bounds = bounding_box(part.outline);
  CameraScene scene = far_scene(part, 0.0, 0.0, 0.0, 10.0, 10.0);
  scene.view.width_mm = bounds.size().x();
  scene.view.columns = 60;
  scene.view.rows = static_cast<std::size_t>(std::lround(60.0 * bounds.size().y() / bounds.size().x()));
  // The detector has the same pixels as the camera, around the center of the entrance face.
  const Vec2 middle = 0.5 * (bounds.lower + bounds.upper);
  const Vec2 half = 0.5 * scene.view.width_mm / 60.0 * Vec2(60.0, static_cast<double>(scene.view.rows));
  const DetectorSetting setting{{{middle - half, middle + half}, scene.view.columns, scene.view.rows},
                                {DirectionGrid::Layout::square, 0.02, 1, 1},
                                {},
                                0.05};
  BeamPolicy policy;
  policy.truncated_goal = 1e-9;
  const DetectorMaps footprint = exact_detector_maps(part, ideal(), {}, setting, policy);
  const CameraImage image = pictured(part, ideal(), scene, 4);
  const double full = 10.0 / (pi * std::pow(5.0 * kArcmin, 2.0));
  std::size_t bright = 0;
  std::size_t dark = 0;
  for (std::size_t k = 0; k < image.luminance.size(); ++k) {
    if (footprint.entering.value[k] > 1.0 - 1e-9) {
      ++bright;
      EXPECT_NEAR(image.luminance[k], full, 1e-3 * full) << k;
    } else if (footprint.entering.value[k] < 1e-9) {
      ++dark;
      EXPECT_EQ(image.luminance[k], 0.0) << k;
    }
  }
  EXPECT_GT(bright, 800U);
  EXPECT_GT(dark, 500U);
}

CameraScene noisy_scene(const Part& part) {
  CameraScene scene = far_scene(part, 0.2, 5.0, 5.0, 20.0, 15.0);
  scene.view.columns = scene.view.rows = 24;
  return scene;
}

double rms_difference(const CameraImage& a, const CameraImage& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.luminance.size(); ++k) sum += std::pow(a.luminance[k] - b.luminance[k], 2.0);
  return std::sqrt(sum / static_cast<double>(a.luminance.size()));
}

/// The difference between two pictures of the same scene equals the difference that their standard errors predict. It
/// is halved if the number of passes is quadrupled.
TEST(Camera, ConvergesWithTheRootOfThePasses) {
  const Part part = cubes(2.0);
  const CameraScene scene = noisy_scene(part);
  double before = 0.0;
  for (const std::uint32_t passes : {8U, 32U, 128U}) {
    const CameraImage a = pictured(part, pmma(), scene, passes, 100 + passes);
    const CameraImage b = pictured(part, pmma(), scene, passes, 200 + passes);
    const double difference = rms_difference(a, b);
    double variance = 0.0;
    for (std::size_t k = 0; k < a.luminance.size(); ++k)
      variance += std::pow(a.std_error(k), 2.0) + std::pow(b.std_error(k), 2.0);
    EXPECT_NEAR(difference, std::sqrt(variance / static_cast<double>(a.luminance.size())), 0.15 * difference);
    if (before > 0.0) {
      EXPECT_NEAR(before / difference, 2.0, 0.3) << passes;
    }
    before = difference;
  }
}

TEST(Camera, GivesTheSameBytesWithAnyNumberOfThreads) {
  const Part part = cubes(2.0);
  const CameraScene scene = noisy_scene(part);
  CameraImage one;
  CameraImage five;
  run_with_threads(1, [&] { one = pictured(part, pmma(), scene, 4); });
  run_with_threads(5, [&] { five = pictured(part, pmma(), scene, 4); });
  EXPECT_EQ(one.luminance, five.luminance);
  EXPECT_EQ(one.squares, five.squares);
  EXPECT_EQ(one.part_means, five.part_means);
  EXPECT_NE(one.luminance, pictured(part, pmma(), scene, 4, 2).luminance);
}

/// A sheet around a cylinder is compared with a plane sheet that is rotated like the tangent plane of the cylinder. At
/// the point of contact, both sheets have the same luminance.
TEST(Camera, CylinderIsPlaneWhereItIsTouched) {
  const Part part = cubes(1.0);
  const double radius = 100.0;
  const double turn_deg = 15.0;
  CameraScene bent = far_scene(part, 0.1, 0.0, 0.0, 20.0, 20.0);
  bent.film = Film{200.0, 40.0, radius};
  // The picture shows a narrow region around the point at which the normal is rotated towards +x by `turn_deg`.
  const double phi = turn_deg * pi / 180.0;
  const Vec3 shift(radius * std::sin(phi), 0.0, radius * (std::cos(phi) - 1.0));
  bent.view.target_mm += shift;
  bent.view.width_mm = 2.0;
  const CameraImage on_cylinder = pictured(part, pmma(), bent, 64);
  // In the frame of the plane sheet, light then comes from the -x side.
  CameraScene plane = far_scene(part, 0.1, 0.0, -turn_deg, 20.0, 20.0);
  plane.view.width_mm = 2.0;
  const CameraImage on_plane = pictured(part, pmma(), plane, 64, 5);
  ASSERT_GT(on_plane.part_mean(), 0.0);
  EXPECT_NEAR(
      on_cylinder.part_mean(), on_plane.part_mean(),
      student_bound(1, 64) * std::hypot(on_cylinder.part_error(), on_plane.part_error()) + 0.02 * on_plane.part_mean());
}

void show(CameraScene& scene, const Film& film, double width_mm, std::size_t columns, std::size_t rows) {
  scene.film = film;
  scene.view.width_mm = width_mm;
  scene.view.columns = columns;
  scene.view.rows = rows;
}

TEST(Camera, SeesTheBodyOfASheetOnlyFromTheFront) {
  const Part part = cubes();
  CameraScene scene = far_scene(part, 0.0, 0.0, 0.0, 10.0, 10.0);
  scene.surroundings = {2.0, 3.0};
  show(scene, {10.0, 10.0, 5.0}, 40.0, 41, 3);
  const CameraImage image = pictured(part, pmma(), scene, 2);
  EXPECT_DOUBLE_EQ(image.luminance[0], 3.0) << "beside it";
  EXPECT_EQ(image.coverage[0], 0.0);
  EXPECT_GT(image.coverage[41 + 20], 0.99);
}

struct ReferencePixel {
  double mean = 0.0;
  double std_error = 0.0;
};

/// Returns the pixels of the stored picture row by row. If the file is missing, the test fails.
std::vector<ReferencePixel> stored_reference() {
  std::ifstream file(std::string(RETRACE_SOURCE_DIR) + "/tests/studies/image/camera_reference.csv");
  EXPECT_TRUE(file.good()) << "the reference is missing";
  std::vector<ReferencePixel> pixels;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#' || line.front() == 'm') continue;
    ReferencePixel pixel;
    char comma = 0;
    std::istringstream(line) >> pixel.mean >> comma >> pixel.std_error;
    pixels.push_back(pixel);
  }
  return pixels;
}

/// Returns a scene with a sheet of cube corners on a cylinder. Each pixel shows several cube corners. With smaller
/// pixels, only one of thousands of paths of some pixels would reach the lamp, and error estimates would be unreliable
/// until such a path occurs. If RETRACE_WRITE_REFERENCE=FILE is set, the test writes the reference picture to this
/// file.
CameraScene reference_scene(const Part& part) {
  CameraScene scene = far_scene(part, 0.1, 5.0, 12.0, 40.0, 5.0);
  scene.surroundings = {1.0, 0.2};
  show(scene, {40.0, 40.0, 30.0}, 50.0, 20, 16);
  return scene;
}

/// The picture is compared with a reference picture with many passes and another seed. The differences of single pixels
/// and the sum of their squares must agree with the standard errors of both pictures. The other tests show that the
/// picture is correct.
TEST(Camera, PictureAgreesWithItsReference) {
  const Part part = cubes();
  if (const char* file = std::getenv("RETRACE_WRITE_REFERENCE")) {
    const CameraImage made = pictured(part, pmma(), reference_scene(part), 1024, 77);
    std::ofstream out(file);
    out.precision(9);
    out << "# Luminance in cd/m2 of Camera.PictureAgreesWithItsReference: 1024 passes, seed 77.\n"
        << "mean,std_error\n";
    for (std::size_t k = 0; k < made.luminance.size(); ++k)
      out << made.luminance[k] << ',' << made.std_error(k) << '\n';
  }
  const std::vector<ReferencePixel> reference = stored_reference();
  const CameraImage image = pictured(part, pmma(), reference_scene(part), 256);
  ASSERT_EQ(reference.size(), image.luminance.size());
  double squares = 0.0;
  double count = 0.0;
  double most = 0.0;
  for (std::size_t k = 0; k < reference.size(); ++k) {
    // The added constant is necessary because the standard errors are 0 if all paths have the same luminance.
    const double error = std::hypot(reference[k].std_error, image.std_error(k)) + 1e-6;
    const double z = (image.luminance[k] - reference[k].mean) / error;
    squares += z * z;
    count += 1.0;
    most = std::max(most, std::abs(z));
  }
  EXPECT_LT(most, normal_bound(reference.size()) + 0.5);
  EXPECT_LT(squares, count + 4.0 * std::sqrt(2.0 * count)) << "chi square of " << count;
}

}  // namespace
}  // namespace retrace::testing::camera_test

// Tests of camera pictures and detector maps of parts with curved entrance faces: uniform light, plane faces given as
// surfaces, a lens over a mirror, reciprocity, and the ledger.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/threads.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/part/plate.h"
#include "raytrace/faces/back_surface.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/light/aperture_kernel.h"
#include "raytrace/observers/camera.h"
#include "raytrace/observers/detector.h"
#include "raytrace/observers/small_angle.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/sampling/entrance_sampler.h"
#include "tests/support/designs.h"
#include "tests/support/entrance_surfaces.h"
#include "tests/support/return_frames.h"
#include "tests/support/statistics.h"

namespace retrace::testing::curved_images_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;

constexpr double kFarMm = 1e6;

/// Returns a scene with an eye and a lamp far away. Directions point away from the part.
CameraScene scene_at(double target_z_mm, const Vec3& to_eye, const Vec3& to_lamp, double lamp_deg, double pupil_deg) {
  CameraScene scene;
  scene.view.target_mm = {0.0, 0.0, target_z_mm};
  scene.view.eye_mm = scene.view.target_mm + kFarMm * to_eye.normalized();
  scene.view.up = Vec3::UnitY();
  scene.view.columns = scene.view.rows = 12;
  scene.view.width_mm = 3.2;
  scene.view.pupil = Angle::from_deg(pupil_deg);
  scene.lamp = {scene.view.target_mm + kFarMm * to_lamp.normalized(), 10.0, Angle::from_deg(lamp_deg)};
  return scene;
}

CameraImage pictured(const Part& part, const Entrance* entrance, const Optics& optics, const CameraScene& scene,
                     std::uint32_t passes, std::uint32_t seed = 1) {
  const CameraTracer tracer(part, {{optics, 1.0}}, scene, kCameraPolicy, seed, CameraEngine::embree, entrance);
  EXPECT_FALSE(tracer.is_by_cells());
  CameraImage image = tracer.empty_image();
  while (image.passes < passes) EXPECT_TRUE(tracer.add_pass(image));
  return image;
}

Part bricks() {
  return build_part(finite(RtpElement{0.5, 0.4, 88.0}, Arrangement::offset, 2.4, 1.9, 1.0));
}

/// Returns a plate in front of a part. Its inner surface is 2 mm above the middle of the part and may be inclined. Its
/// outer surface may be curved.
Shell plate_in_front(double index, double absorption_per_mm, double wedge_deg = 0.0, double radius_mm = 0.0) {
  Shell shell;
  shell.inner.vertex_mm = {0.0, 0.0, 2.0};
  shell.outer.vertex_mm = {0.0, 0.0, 3.0};
  shell.inner.normal = {std::sin(wedge_deg * pi / 180.0), 0.0, std::cos(wedge_deg * pi / 180.0)};
  if (radius_mm != 0.0) shell.outer.curvature_per_mm = 1.0 / radius_mm;
  shell.thickness_mm = 1.0;
  shell.index = index;
  shell.absorption_per_mm = absorption_per_mm;
  return shell;
}

Entrance as_mesh(const Entrance& surface, const Part& part) {
  return std::make_shared<const SurfacePatch>(
      entrance_of_mesh(meshed(*std::get<0>(surface), 3.0, 40), MeshSide::top, Vec3::Zero(), part.outline));
}

// In light with equal luminance from all directions, a part that does not absorb light is invisible. No light may be
// lost at the curved face, including light that meets it several times.
TEST(CurvedCamera, PartIsInvisibleInUniformLight) {
  const Part part = bricks();
  const Entrance waves = egg_box_entrance(1.2, 0.08, 6.0);
  const Entrance mesh = as_mesh(waves, part);
  for (const Entrance* entrance : {&waves, &mesh})
    for (const Vec3& to_eye : {Vec3(0.0, 0.1, 1.0), Vec3(1.0, 0.3, 0.6), Vec3(0.2, -1.0, -0.4)}) {
      CameraScene scene = scene_at(1.0, to_eye, Vec3::UnitZ(), 0.2, 0.2);
      scene.lamp.illuminance_lx = 0.0;
      scene.surroundings = {7.0, 7.0};
      const CameraImage image = pictured(part, entrance, pmma(), scene, 3);
      for (const double luminance : image.luminance) EXPECT_NEAR(luminance, 7.0, 1e-6);
    }
}

// In uniform light, shells without absorption must be invisible, because the light that they reflect also comes from
// the uniform surroundings. A plate with absorption must darken the background by its transmittance at normal
// incidence.
TEST(CurvedCamera, ShellsAreInvisibleInUniformLight) {
  const Part part = bricks();
  const Entrance sphere = sphere_entrance(40.0, 1.2, centroid(part.outline));
  CameraScene scene = scene_at(1.0, Vec3(0.0, 0.1, 1.0), Vec3::UnitZ(), 0.2, 0.2);
  scene.lamp.illuminance_lx = 0.0;
  scene.surroundings = {7.0, 7.0};
  scene.view.width_mm = 6.0;
  for (const Entrance* const entrance : {static_cast<const Entrance*>(nullptr), &sphere})
    for (const Shell& shell :
         {plate_in_front(1.5, 0.0), plate_in_front(1.5, 0.0, 4.0), plate_in_front(1.5, 0.0, 0.0, 30.0)}) {
      Optics optics = pmma();
      optics.shells = {shell, shell};
      optics.shells.front().inner.vertex_mm.z() += 4.0;
      optics.shells.front().outer.vertex_mm.z() += 4.0;
      const CameraImage image = pictured(part, entrance, optics, scene, 2);
      for (const double luminance : image.luminance) EXPECT_NEAR(luminance, 7.0, 1e-6);
      // The first pixel shows only shells. It must not count as a pixel that shows the part.
      EXPECT_EQ(image.coverage.front(), 0.0);
    }
  Optics optics = pmma();
  const double absorption_per_mm = 0.3;
  optics.shells = {plate_in_front(1.5, absorption_per_mm)};
  scene = scene_at(1.0, Vec3::UnitZ(), Vec3::UnitZ(), 0.2, 0.0);
  scene.lamp.illuminance_lx = 0.0;
  scene.surroundings = {0.0, 7.0};
  scene.view.width_mm = 6.0;
  const double through_surface = 1.0 - std::pow(0.5 / 2.5, 2.0);
  EXPECT_NEAR(pictured(part, nullptr, optics, scene, 2).luminance.front(),
              7.0 * through_surface * through_surface * std::exp(-absorption_per_mm), 1e-6);
}

TEST(CurvedCamera, PlaneSurfaceIsThePlaneFace) {
  const Part part = bricks();
  const Entrance surface = plane_entrance(1.0);
  const Entrance mesh = as_mesh(surface, part);
  CameraScene scene = scene_at(1.0, Vec3(0.02, 0.0, 1.0), Vec3(0.03, 0.0, 1.0), 2.0, 1.0);
  scene.surroundings = {40.0, 20.0};
  const CameraImage plane = pictured(part, nullptr, pmma(), scene, 32);
  for (const Entrance* entrance : {&surface, &mesh}) {
    const CameraImage curved = pictured(part, entrance, pmma(), scene, 32, 5);
    std::size_t compared = 0;
    double chi2 = 0.0;
    for (std::size_t k = 0; k < plane.luminance.size(); ++k) {
      EXPECT_NEAR(curved.coverage[k], plane.coverage[k], 0.2) << k;
      if (plane.coverage[k] < 1.0 - 1e-9) continue;
      ++compared;
      const double error = std::hypot(plane.std_error(k), curved.std_error(k));
      chi2 += std::pow((plane.luminance[k] - curved.luminance[k]) / error, 2.0);
    }
    EXPECT_GT(compared, 30U);
    EXPECT_LT(chi2, 2.0 * static_cast<double>(compared));
    EXPECT_NEAR(plane.part_mean(), curved.part_mean(),
                student_bound(2) * std::hypot(plane.part_error(), curved.part_error()));
    EXPECT_LT(plane.part_error(), 0.05 * plane.part_mean());
  }
}

// A plano-convex lens over a mirror at its back is a curved mirror. A ray that enters at the distance y from the axis
// leaves at the angle -k y (docs/theory/fronts.md, "A lens and a mirror"). The eye therefore sees an image of the lamp
// with the luminance of the lamp. For a lamp at the angle a with the angular radius r, the image is a disc at y = -a /
// k with the radius r / k.
TEST(CurvedCamera, LensOverAMirrorShowsAnImageOfTheLamp) {
  const double radius_mm = 100.0;
  const double thickness_mm = 3.0;
  Optics optics = ideal();
  const double n = optics.index;
  const Part plate = build_plate({10.0, 10.0}, thickness_mm);
  const Entrance lens = sphere_entrance(radius_mm, thickness_mm, {5.0, 5.0});
  const double inner = (n - 1.0) / (n * radius_mm);
  const double k = n * inner + (n - 1.0) / radius_mm * (1.0 - 2.0 * thickness_mm * inner);
  const double lamp_deg = 1.6;
  const double lamp_rad = 0.5 * lamp_deg * pi / 180.0;
  for (const double aside_rad : {0.0, 0.012}) {
    CameraScene scene =
        scene_at(thickness_mm, Vec3::UnitZ(), Vec3(0.0, std::sin(aside_rad), std::cos(aside_rad)), lamp_deg, 0.0);
    scene.view.columns = scene.view.rows = 100;
    scene.view.width_mm = 9.0;
    const CameraImage image = pictured(plate, &lens, optics, scene, 8);
    const double full = 10.0 / (pi * lamp_rad * lamp_rad);
    const double pixel_mm = 0.09;
    double sum = 0.0;
    double sum_y = 0.0;
    for (std::size_t row = 0; row < 100; ++row)
      for (std::size_t column = 0; column < 100; ++column) {
        const double share = image.luminance[100 * row + column] / full;
        EXPECT_LT(share, 1.001);
        sum += share;
        sum_y += share * (49.5 - static_cast<double>(row)) * pixel_mm;
      }
    EXPECT_NEAR(sum * pixel_mm * pixel_mm, pi * std::pow(lamp_rad / k, 2.0), 0.01 * pi * std::pow(lamp_rad / k, 2.0));
    EXPECT_NEAR(sum_y / sum, -std::sin(aside_rad) / k, 0.005);
  }
}

/// Sums the light that leaves a part towards a receiver, per steradian, averaged over the discs of source and receiver.
class Receiver : public ExitObserver {
 public:
  Receiver(const Vec3& to_receiver, const PhotometricApertures& discs) : to_receiver_(to_receiver), kernel_(discs) {}
  void on_exit(const ExitEvent& event) override {
    if (!event.is_front_reflection)
      per_sr += event.light.power() * kernel_.per_sr(small_angle_between(event.direction, to_receiver_));
  }
  double per_sr = 0.0;

 private:
  Vec3 to_receiver_;
  ApertureKernel kernel_;
};

// The picture traces light backwards. Its intensity, the sum of luminance times area of the pixels, must be the
// intensity that light from the lamp causes: the illuminance times the area of the beam times the power per solid
// angle.
void expect_equal_intensities(const Optics& optics) {
  const Part part = build_part(finite(HexagonalCube{0.6}, Arrangement::honeycomb, 2.6, 2.2, 1.0));
  const Vec2 middle = centroid(part.outline);
  const Entrance sphere = sphere_entrance(40.0, 1.2, middle);
  const double incidence_deg = 8.0;
  const double discs_deg = 0.8;
  const Illumination light = from(incidence_deg, 30.0);
  const Vec3 to_lamp = direction_to_source(light);
  const Vec3 to_eye = (to_lamp + 0.008 * to_lamp.unitOrthogonal()).normalized();
  CameraScene scene = scene_at(1.2, to_eye, to_lamp, discs_deg, discs_deg);
  scene.view.columns = scene.view.rows = 40;
  scene.view.width_mm = 4.0;
  scene.has_front_reflection = false;
  const CameraImage image = pictured(part, &sphere, optics, scene, 32);
  double intensity = 0.0;
  double variance = 0.0;
  for (std::size_t k = 0; k < image.luminance.size(); ++k) {
    intensity += image.luminance[k] * 0.01;
    variance += std::pow(image.std_error(k) * 0.01, 2.0);
  }
  // Light from the lamp: rays at random points of the beam, each with its own receiver.
  const PhotometricApertures discs{Angle::from_deg(discs_deg), Angle::from_deg(discs_deg)};
  Receiver receiver(to_eye, discs);
  const EntranceSampler sampler(part);
  const BackSurface back(part, sampler.centre_mm());
  const auto face = make_entrance_face(sphere, part, sampler.centre_mm());
  const PathSetup setup(part, back, sampler.centre_mm(), optics, light, {0.5}, kCameraPolicy, face.get());
  Tally tally(1);
  PathWalker walker(setup, tally, &receiver);
  constexpr std::uint32_t kBatches = 32;
  constexpr std::uint32_t kRays = 4000;
  std::vector<double> batches;
  for (std::uint32_t batch = 0; batch < kBatches; ++batch) {
    receiver.per_sr = 0.0;
    for (std::uint32_t ray = 0; ray < kRays; ++ray) {
      const auto random = philox({7, 1}, batch, ray);
      walker.trace(sampler({unit_interval(random[0]), unit_interval(random[1])}), {7, 2}, batch, ray);
    }
    batches.push_back(10.0 * part.entrance_area_mm2 * to_lamp.z() * receiver.per_sr / kRays);
  }
  double forwards = 0.0;
  for (const double b : batches) forwards += b / kBatches;
  double spread = 0.0;
  for (const double b : batches) spread += std::pow(b - forwards, 2.0);
  const double error = std::hypot(std::sqrt(variance), std::sqrt(spread / (kBatches - 1.0) / kBatches));
  EXPECT_GT(forwards, 0.0);
  // Terms of higher order in the radii of the discs are neglected. Their relative contribution is at most 1e-2.
  EXPECT_NEAR(intensity, forwards, student_bound(1) * error + 0.01 * forwards);
  EXPECT_LT(error, 0.04 * forwards);
}

TEST(CurvedCamera, IntensityIsThatOfLightTracedForwards) {
  expect_equal_intensities(pmma());
  Optics behind_plate = pmma();
  behind_plate.shells = {plate_in_front(1.5, 0.1)};
  expect_equal_intensities(behind_plate);
}

TEST(CurvedCamera, GivesTheSameBytesWithAnyNumberOfThreads) {
  const Part part = bricks();
  const Entrance waves = egg_box_entrance(1.2, 0.08, 6.0);
  const CameraScene scene = scene_at(1.2, Vec3(0.02, 0.0, 1.0), Vec3(0.03, 0.0, 1.0), 2.0, 1.0);
  CameraImage one;
  CameraImage three;
  run_with_threads(1, [&] { one = pictured(part, &waves, pmma(), scene, 3); });
  run_with_threads(3, [&] { three = pictured(part, &waves, pmma(), scene, 3); });
  EXPECT_EQ(one.luminance, three.luminance);
  EXPECT_EQ(one.coverage, three.coverage);
}

DetectorSetting setting_of(const Part& part, const Illumination& light) {
  return {{bounding_box(part.outline), 24, 19}, {DirectionGrid::Layout::square, 0.05, 21, 21}, frame_at(light), 0.5};
}

DetectorMaps maps_of(const Part& part, const Entrance* entrance, const Illumination& light, std::uint64_t rays) {
  const Optics optics = pmma();
  const std::vector<DetectorLight> lights = {{&optics, 1.0, 3}};
  const DetectorSetting setting = setting_of(part, light);
  DetectorSampler sampler(part, lights, light, setting, rays, {}, entrance);
  EXPECT_TRUE(sampler.add_pass());
  return sampler.maps();
}

TEST(CurvedDetector, PlaneSurfaceGivesTheMapsOfThePlaneFace) {
  const Part part = bricks();
  const Illumination light = from(12.0, 30.0);
  const DetectorMaps plane = maps_of(part, nullptr, light, 1U << 15);
  const Entrance surface = plane_entrance(1.0);
  const DetectorMaps curved = maps_of(part, &surface, light, 1U << 15);
  EXPECT_NEAR(curved.rre, plane.rre, 1e-9);
  EXPECT_NEAR(curved.outside, plane.outside, 1e-9);
  for (std::size_t k = 0; k < plane.per_sr.value.size(); ++k)
    EXPECT_NEAR(curved.per_sr.value[k], plane.per_sr.value[k], 1e-9 * (1.0 + plane.per_sr.value[k])) << k;
  // Because of rounding errors, a ray near the border between two pixels may be recorded in either pixel.
  const double ray = part.entrance_area_mm2 / (1U << 15) / setting_of(part, light).face.pixel_area_mm2();
  for (std::size_t k = 0; k < plane.leaving.value.size(); ++k) {
    EXPECT_NEAR(curved.leaving.value[k], plane.leaving.value[k], 2.0 * ray) << k;
    EXPECT_NEAR(curved.entering.value[k], plane.entering.value[k], 2.0 * ray) << k;
  }
}

// The power in the maps must equal that of the ledger, which is traced separately.
TEST(CurvedDetector, PowerIsThatOfTheLedger) {
  const Part part = bricks();
  const Entrance waves = egg_box_entrance(1.2, 0.05, 6.0);
  const Entrance sphere = sphere_entrance(20.0, 1.3, {1.2, 0.9});
  const Entrance mesh = as_mesh(sphere, part);
  for (const Entrance* entrance : {&waves, &sphere, &mesh})
    for (const double incidence_deg : {0.0, 15.0}) {
      const Illumination light = from(incidence_deg, 20.0);
      const DetectorSetting setting = setting_of(part, light);
      const DetectorMaps maps = maps_of(part, entrance, light, 1U << 17);
      const MonteCarloResult whole =
          MonteCarlo(part, MonteCarlo::Engine::embree, entrance).trace(pmma(), light, {0.5}, rays(1U << 17, 9), {});
      const ConeResult& cone = whole.cones.front();
      const double error = std::hypot(maps.std_error, cone.std_error);
      EXPECT_NEAR(maps.rre, cone.ledger[Account::retroreflected], student_bound(6) * error);
      double power = maps.outside;
      for (std::size_t k = 0; k < setting.angles.size(); ++k)
        power += maps.per_sr.value[k] * setting.angles.solid_angle_sr(k);
      const double expected = cone.ledger[Account::retroreflected] + cone.ledger[Account::front_specular] +
                              cone.ledger[Account::scattered_out] + cone.ledger[Account::returned_elsewhere];
      EXPECT_NEAR(power, expected, 3e-3);
      const auto mean = [&](const std::vector<double>& irradiance) {
        double sum = 0.0;
        for (const double e : irradiance) sum += e;
        return sum * setting.face.pixel_area_mm2() / part.entrance_area_mm2;
      };
      EXPECT_NEAR(mean(maps.leaving.value), maps.rre, 1e-6);
      EXPECT_NEAR(mean(maps.entering.value), maps.rre, 1e-6);
    }
}

}  // namespace
}  // namespace retrace::testing::curved_images_test

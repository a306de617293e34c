// Tests of the engines of the camera: the cell engine, which traces paths in groups, gives the same pictures as Embree,
// which traces paths one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/threads.h"
#include "raytrace/observers/camera.h"
#include "raytrace/observers/photometric_geometry.h"
#include "tests/support/designs.h"

namespace retrace::testing::camera_engines_test {
namespace {

using namespace geometry;
using namespace raytrace;

struct Case {
  std::string name;
  Part part;
  CameraScene scene;
  std::vector<WeightedOptics> light;
};

/// Returns a scene with a camera that is so near that the viewing direction differs from pixel to pixel. Light comes
/// from all directions.
CameraScene near_scene(const Part& part, double width_mm) {
  const PhotometricDirections towards = directions_of(
      geometry_from({Angle::from_deg(8.0), Angle::from_deg(-12.0)}, Angle::from_deg(0.5), Angle::from_deg(0.0)));
  CameraScene scene;
  scene.view.target_mm = {0.0, 0.0, part.thickness_mm};
  scene.view.eye_mm = scene.view.target_mm + 300.0 * towards.to_observer;
  scene.view.columns = 24;
  scene.view.rows = 20;
  scene.view.width_mm = width_mm;
  scene.view.pupil = Angle::from_deg(0.2);
  scene.lamp = {scene.view.target_mm + 300.0 * towards.to_source, 10.0, Angle::from_deg(0.6)};
  scene.surroundings = {20.0, 300.0};
  return scene;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](std::string name, Part part, double width_mm, std::vector<WeightedOptics> light,
                       std::optional<double> radius_mm = {}) {
    CameraScene scene = near_scene(part, width_mm);
    if (part.period_mm) scene.film = Film{20.0, 16.0, radius_mm};
    all.push_back({std::move(name), std::move(part), scene, std::move(light)});
  };
  Optics dyed = pmma();
  dyed.absorption_per_mm = 0.2;
  Optics other = pmma();
  other.index = 1.52;
  const RtpElement prism{2.0, 2.0};
  add("finite prisms", build_part(finite(prism, Arrangement::offset, 18.0, 14.0, 2.0)), 22.0, {{dyed, 1.0}});
  add("finite cubes of two wavelengths",
      build_part(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 16.0, 12.0, 1.0)), 20.0,
      {{pmma(), 0.4}, {other, 0.6}});
  add("cubes over a cylinder", build_part(infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0)), 18.0,
      {{dyed, 1.0}}, 12.0);
  add("sheet of triangles", build_part(infinite(TriangularCube{1.0}, Arrangement::triangular, 1.0)), 24.0,
      {{pmma(), 1.0}});
  // Each element covers several pixels, so that the test detects cells at wrong positions.
  add("large prisms", build_part(infinite(RtpElement{6.0, 5.0}, Arrangement::aligned, 2.0)), 22.0, {{pmma(), 1.0}});
  return all;
}

CameraImage pictured(const Case& c, CameraEngine engine, std::uint32_t passes, std::uint32_t seed) {
  const CameraTracer tracer(c.part, c.light, c.scene, kCameraPolicy, seed, engine);
  EXPECT_EQ(tracer.is_by_cells(), engine == CameraEngine::fastest) << c.name;
  CameraImage image = tracer.empty_image();
  while (image.passes < passes) EXPECT_TRUE(tracer.add_pass(image));
  return image;
}

TEST(CameraEngines, SeeTheSamePixelByPixel) {
  for (const Case& c : cases()) {
    const CameraImage together = pictured(c, CameraEngine::fastest, 48, 1);
    const CameraImage single = pictured(c, CameraEngine::embree, 48, 2);
    EXPECT_NEAR(together.part_mean(), single.part_mean(), 5.0 * std::hypot(together.part_error(), single.part_error()))
        << c.name;
    EXPECT_LT(together.part_error(), 0.02 * together.part_mean()) << c.name;
    double sum = 0.0;
    std::size_t seen = 0;
    for (std::size_t k = 0; k < together.luminance.size(); ++k) {
      if (together.coverage[k] == 0.0) continue;
      const double error = std::hypot(together.std_error(k), single.std_error(k));
      const double z = (together.luminance[k] - single.luminance[k]) / (error + 1e-9 * single.luminance[k]);
      EXPECT_LT(std::abs(z), 6.5) << c.name << ", pixel " << k;
      sum += z * z;
      ++seen;
    }
    EXPECT_LT(sum / static_cast<double>(seen), 1.3) << c.name;
  }
}

/// In both engines, paths start at the same points. In uniform light, pictures therefore differ only by the random
/// choices of the paths.
TEST(CameraEngines, SeeEvenLightAlike) {
  for (Case& c : cases()) {
    if (c.light.front().optics.absorption_per_mm > 0.0) continue;
    c.scene.surroundings = {50.0, 50.0};
    c.scene.lamp.illuminance_lx = 0.0;
    const CameraImage image = pictured(c, CameraEngine::fastest, 2, 1);
    for (const double luminance : image.luminance) EXPECT_NEAR(luminance, 50.0, 50.0 * 1e-6) << c.name;
  }
}

TEST(CameraEngines, GiveTheSameOnAnyNumberOfThreads) {
  const Case c = cases()[1];
  std::vector<CameraImage> images(2);
  run_with_threads(1, [&] { images[0] = pictured(c, CameraEngine::fastest, 3, 1); });
  run_with_threads(4, [&] { images[1] = pictured(c, CameraEngine::fastest, 3, 1); });
  EXPECT_EQ(images[0].luminance, images[1].luminance);
  EXPECT_EQ(images[0].squares, images[1].squares);
  EXPECT_EQ(images[0].part_means, images[1].part_means);
}

/// Several processes divide the passes of a picture among them, and each process computes its passes in a different
/// order.
TEST(CameraEngines, PassesAreTheSameInAnyOrder) {
  const Case c = cases()[0];
  const auto tracer = [&] { return CameraTracer(c.part, c.light, c.scene, kCameraPolicy, 1); };
  const CameraTracer in_order = tracer();
  std::vector<CameraPass> passes;
  for (std::uint32_t number = 0; number < 4; ++number) passes.push_back(*in_order.pass(number));
  const CameraTracer other = tracer();
  for (const std::uint32_t number : {3U, 0U, 0U, 2U, 1U}) EXPECT_EQ(*other.pass(number), passes[number]) << number;
}

TEST(CameraEngines, AnInterruptedPassIsBegunAgain) {
  const Case c = cases()[0];
  const CameraTracer tracer(c.part, c.light, c.scene, kCameraPolicy, 1);
  const CameraTracer other(c.part, c.light, c.scene, kCameraPolicy, 1);
  Cancellation cancel;
  cancel.request();
  EXPECT_FALSE(tracer.pass(0, &cancel));
  EXPECT_EQ(*tracer.pass(0), *other.pass(0));
  EXPECT_FALSE(tracer.pass(1, &cancel));
  EXPECT_EQ(*tracer.pass(1), *other.pass(1));
}

TEST(CameraEngines, OfMirrorsWithLayersOnTheEntranceAgree) {
  Case c = cases()[1];
  for (WeightedOptics& at : c.light) {
    at.optics.mirror_facets = true;
    at.optics.entrance_layers = anti_reflection();
  }
  const CameraImage together = pictured(c, CameraEngine::fastest, 24, 1);
  const CameraImage single = pictured(c, CameraEngine::embree, 24, 2);
  EXPECT_NEAR(together.part_mean(), single.part_mean(), 5.0 * std::hypot(together.part_error(), single.part_error()));
}

TEST(CameraEngines, FollowsOneByOneWhereCellsDoNotServe) {
  const Part part = build_part(single(RtpElement{2.0, 2.0}, 1.0));
  const CameraTracer tracer(part, {{pmma(), 1.0}}, near_scene(part, 4.0), kCameraPolicy, 1);
  EXPECT_FALSE(tracer.is_by_cells());
}

}  // namespace
}  // namespace retrace::testing::camera_engines_test

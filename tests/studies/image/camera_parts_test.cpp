// Tests of camera pictures of parts with rough facets and of parts with masks.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/elements/facet_planes.h"
#include "studies/image/camera_study.h"
#include "studies/photometry/photometry.h"
#include "tests/support/designs.h"
#include "tests/support/refusals.h"
#include "tests/support/statistics.h"

namespace retrace::testing::camera_parts_test {
namespace {

using namespace geometry;
using namespace raytrace;
using design::Design;
using design::SurfaceFinish;
using std::numbers::pi;

Design rough_cubes(const design::SurfaceFinish& texture) {
  Design design;
  design.part() = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  design.substance.refractive_index = kPmma;
  design.surface.texture = texture;
  return design;
}

struct RoughCase {
  design::SurfaceFinish texture;
  double alpha_deg;
  double v_deg;
  double h_deg;
};

/// Returns R_A and its standard error, from light that is traced forwards: from the source to the disc of the receiver.
studies::PhotometricPoint forwards(const Design& design, const RoughCase& c, double disc_arcmin) {
  studies::PhotometrySettings request;
  request.test_plan.points.push_back({c.alpha_deg, c.v_deg, c.h_deg, 1.0, studies::PhotometricUnit::cd_per_lx_per_m2,
                                      studies::LimitStatus::confirmed, 2});
  request.area_cm2 = 10.0;
  request.apertures = {Angle::from_deg(disc_arcmin / 60.0), Angle::from_deg(disc_arcmin / 60.0)};
  request.light = studies::PhotometricLight::of_design;
  request.diffraction = false;
  request.advice = false;
  request.engine = raytrace::Engine::embree;
  request.rays = 1U << 17U;
  request.window_deg = 3.0;
  return studies::PhotometryStudy(design, request).run().points.front();
}

/// The camera traces light backwards, from the receiver to the source, with the same scatter models. If the models are
/// reciprocal, the mean luminance is R_A E / cos nu.
TEST(RoughCamera, SeesWhatIsSentForwards) {
  // The receiver is outside of the specular return of the discs of half a degree. Inside of it, the efficiency depends
  // on the angle of incidence. The two methods would then differ by an amount of the order of the radii of the discs,
  // even with smooth facets.
  const design::HarveyShackTexture rough = {.roughness_sq_nm = 25.0, .correlation_length_um = 12.0};
  const design::MicrofacetTexture wavy = {.waviness_sq_nm = 30.0, .waviness_length_um = 60.0};
  for (const RoughCase& c :
       {RoughCase{rough, 1.0, 10.0, 0.0}, RoughCase{rough, 0.8, 0.0, 0.0}, RoughCase{wavy, 0.5, 0.0, 15.0}}) {
    const Design design = rough_cubes(c.texture);
    const double disc_arcmin = 30.0;
    const studies::PhotometricPoint point = forwards(design, c, disc_arcmin);
    CameraRequest camera;
    camera.distance_m = 1e5;
    camera.observation_deg = c.alpha_deg;
    camera.v_deg = c.v_deg;
    camera.h_deg = c.h_deg;
    camera.lamp_arcmin = camera.pupil_arcmin = disc_arcmin;
    camera.columns = camera.rows = 16;
    camera.film_mm = {500.0, 500.0};
    camera.field_mm = 400.0;
    camera.passes = 16;
    camera.light = "design";
    camera.diffraction = false;
    const studies::CameraResult seen = studies::CameraStudy(design, camera).run();
    const double per_r_a = camera.illuminance_lx / std::cos(seen.viewing_deg * pi / 180.0);
    const double expected = point.r_a * per_r_a;
    const double forward_error = point.std_error_mcd_per_lx / point.r_i_mcd_per_lx * expected;
    ASSERT_GT(expected, 0.0);
    EXPECT_NEAR(seen.image.part_mean(), expected, student_bound(3) * std::hypot(seen.image.part_error(), forward_error))
        << c.alpha_deg << ' ' << c.v_deg << ' ' << c.h_deg;
    EXPECT_LT(std::hypot(seen.image.part_error(), forward_error), 0.05 * expected) << "the bound must bind";
  }
}

/// The elements of an array are arranged in the shape of an L. The picture is bright at these elements and dark
/// everywhere else.
TEST(MaskCamera, ShowsTheElementsThatAreThere) {
  const PartSpec spec = finite(RtpElement{1.0, 1.0}, Arrangement::aligned, 4.0, 4.0, 1.0);
  const auto is_there = [](int column, int row) { return column == 1 || (row == 0 && column < 3); };
  std::vector<ElementPlanes> elements;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      if (is_there(column, row)) {
        ElementPlanes element;
        element.centre_mm = {column + 0.5, row + 0.5};
        element.planes = {HeightPlane{-0.5, {-1.0, 0.0}}, HeightPlane{-0.5, {1.0, 0.0}}};
        elements.push_back(element);
      }
  const Part part = build_part(spec, FacetPlanes(elements, 1.0));
  CameraScene scene;
  scene.view.target_mm = {0.0, 0.0, part.thickness_mm};
  scene.view.eye_mm = scene.view.target_mm + Vec3(0.0, 0.0, 1e6);
  scene.lamp = {scene.view.eye_mm, 10.0, Angle::from_deg(0.2)};
  scene.view.pupil = Angle::from_deg(0.1);
  scene.view.width_mm = 4.0;
  scene.view.columns = scene.view.rows = 16;
  const CameraTracer tracer(part, {{ideal(), 1.0}}, scene, kCameraPolicy, 1);
  CameraImage image = tracer.empty_image();
  while (image.passes < 4) ASSERT_TRUE(tracer.add_pass(image));
  const double full = 10.0 / (pi * std::pow(0.1 * pi / 180.0, 2.0));
  for (std::size_t k = 0; k < image.luminance.size(); ++k) {
    const int column = static_cast<int>(k % 16) / 4;
    const int row = 3 - static_cast<int>(k / 16) / 4;
    // The flat back between the elements is also a mirror. At normal incidence, it is dark only where light passes
    // through it.
    if (is_there(column, row)) {
      EXPECT_NEAR(image.luminance[k], full, 1e-3 * full) << column << ' ' << row;
    } else {
      EXPECT_LT(image.luminance[k], 0.1 * full) << column << ' ' << row;
    }
  }
}

TEST(CameraStudy, RefusesAnEntranceFaceThatScatters) {
  Design design = rough_cubes(design::SmoothTexture());
  design.source = "d.toml";
  design.surface.entrance.haze = 0.1;
  design.surface.entrance.haze_spread_deg = 5.0;
  EXPECT_EQ(refusal_of([&] { studies::CameraStudy(design, {}); }), "d.toml: entrance.haze");
}

}  // namespace
}  // namespace retrace::testing::camera_parts_test

// Tests of the standard errors of single pixels, at borders and where paths to bright light are rare.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <vector>

#include "raytrace/observers/camera.h"
#include "raytrace/observers/photometric_geometry.h"
#include "tests/support/designs.h"
#include "tests/support/statistics.h"

namespace retrace::testing::camera_error_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr std::size_t kSide = 16;  ///< pixels
constexpr std::uint32_t kSeeds = 16;

/// Returns a scene for parts with cut elements and vertical sides. In some pixels, only a few of a thousand paths reach
/// the lamp.
CameraScene border_scene(const Part& part) {
  const PhotometricGeometry geometry =
      geometry_from({Angle::from_deg(5.0), Angle::from_deg(5.0)}, Angle::from_deg(0.2), Angle::from_deg(0.0));
  const PhotometricDirections towards = directions_of(geometry);
  CameraScene scene;
  scene.view.target_mm = {0.0, 0.0, part.thickness_mm};
  scene.view.eye_mm = scene.view.target_mm + 1e4 * towards.to_observer;
  scene.view.up = return_frame(geometry).up;
  scene.view.columns = scene.view.rows = kSide;
  scene.view.width_mm = 7.0;
  scene.view.pupil = Angle::from_deg(15.0 / 60.0);
  scene.lamp = {scene.view.target_mm + 1e4 * towards.to_source, 10.0, Angle::from_deg(20.0 / 60.0)};
  scene.surroundings = {1.0, 0.2};
  return scene;
}

std::vector<CameraImage> pictures_of(const Part& part, const CameraScene& scene, std::uint32_t passes,
                                     CameraEngine engine = CameraEngine::fastest) {
  std::vector<CameraImage> images;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const CameraTracer tracer(part, {{pmma(), 1.0}}, scene, kCameraPolicy, 100 + seed, engine);
    CameraImage image = tracer.empty_image();
    while (image.passes < passes) EXPECT_TRUE(tracer.add_pass(image));
    images.push_back(std::move(image));
  }
  return images;
}

/// Returns the mean square of the deviations of a pixel, each divided by the standard error that its picture reports.
/// The expected value is 1 if the reported errors are correct.
double z_variance(const std::vector<CameraImage>& images, std::size_t pixel) {
  double mean = 0.0;
  for (const CameraImage& image : images) mean += image.luminance[pixel] / kSeeds;
  double sum = 0.0;
  for (const CameraImage& image : images) {
    // Sums of equal values may differ by rounding errors.
    const double error = std::hypot(image.std_error(pixel), 1e-9 * mean);
    sum += std::pow((image.luminance[pixel] - mean) / error, 2.0);
  }
  return sum / (kSeeds - 1.0);
}

/// Returns an upper limit of z_variance() for normally distributed deviations. With a probability of 99 %, none of
/// `pixels` pixels exceeds this limit.
double variance_bound(std::size_t pixels) {
  const boost::math::chi_squared distribution(kSeeds - 1.0);
  return boost::math::quantile(boost::math::complement(distribution, sidak_level(pixels))) / (kSeeds - 1.0);
}

/// Pictures of a part with cut elements are computed with different seeds. In every pixel, the spread of the pictures
/// is at most as large as the reported errors predict.
TEST(CameraError, HoldsAtBorders) {
  const Part part = build_part(finite(RtpElement{2.0, 2.0}, Arrangement::offset, 6.0, 6.0, 2.0));
  const std::vector<CameraImage> images = pictures_of(part, border_scene(part), 48);
  std::size_t partly = 0;
  for (std::size_t k = 0; k < kSide * kSide; ++k) {
    if (images.front().coverage[k] == 0.0) continue;
    if (images.front().coverage[k] < 1.0) ++partly;
    EXPECT_LT(z_variance(images, k), variance_bound(kSide * kSide))
        << "column " << k % kSide << ", row " << k / kSide << ", luminance " << images.front().luminance[k];
  }
  EXPECT_GT(partly, 20U) << "there must be pixels on the border";
}

/// If all pixels are statistically equal, the reported errors are not only large enough but correct.
TEST(CameraError, IsRightWithinAnArray) {
  PartSpec spec = infinite(HexagonalCube{1.0}, Arrangement::honeycomb, 1.0);
  spec.angle_errors.dihedral_error_arcmin.fill(2.0);
  const Part part = build_part(spec);
  CameraScene scene = border_scene(part);
  scene.film = Film{40.0, 40.0, {}};
  scene.view.width_mm = 24.0;
  const std::vector<CameraImage> images = pictures_of(part, scene, 48);
  double sum = 0.0;
  for (std::size_t k = 0; k < kSide * kSide; ++k) {
    const double variance = z_variance(images, k);
    sum += variance / (kSide * kSide);
    EXPECT_LT(variance, variance_bound(kSide * kSide));
  }
  // The standard error follows from the larger of two estimates of the same variance. It is therefore slightly too
  // large on average.
  EXPECT_GT(sum, 0.8);
  EXPECT_LT(sum, 1.1);
}

/// If most pixels of a picture are dark, noisy pixels have more paths. The reported errors of the noisy pixels must be
/// correct on average, and none of these errors may be too small.
TEST(CameraError, IsRightForPixelsWithMorePaths) {
  const Part part = build_part(finite(RtpElement{2.0, 2.0}, Arrangement::offset, 6.0, 6.0, 2.0));
  CameraScene scene = border_scene(part);
  scene.view.width_mm = 25.0;
  scene.surroundings = {};
  constexpr std::uint32_t kPasses = 32;
  const std::vector<CameraImage> images = pictures_of(part, scene, kPasses, CameraEngine::embree);
  std::size_t compared = 0;
  double sum = 0.0;
  for (std::size_t k = 0; k < kSide * kSide; ++k) {
    if (std::ranges::all_of(images, [k](const CameraImage& image) { return image.luminance[k] == 0.0; })) continue;
    const double variance = z_variance(images, k);
    EXPECT_LT(variance, variance_bound(kSide * kSide)) << "column " << k % kSide << ", row " << k / kSide;
    const bool has_more = std::ranges::all_of(
        images, [k](const CameraImage& image) { return image.paths[k] > 4 * kPasses && image.std_error(k) > 0.0; });
    if (!has_more) continue;
    ++compared;
    sum += variance;
  }
  ASSERT_GT(compared, 5U);
  // Expected mean of sigma^2 / s^2, where s^2 is the sample variance of 32 normally distributed values with the
  // variance sigma^2: 31 / 29.
  const double expected = (kPasses - 1.0) / (kPasses - 3.0);
  const double error = expected * std::sqrt(2.0 / (kSeeds - 1.0) / static_cast<double>(compared));
  EXPECT_NEAR(sum / static_cast<double>(compared), expected, 4.0 * error);
}

/// A pixel that does not show the part has the standard error 0, even if its neighbours show the part.
TEST(CameraError, OfThePlainBackgroundIsNone) {
  const Part part = build_part(single(RtpElement{2.0, 2.0}, 1.0));
  const std::vector<CameraImage> images = pictures_of(part, border_scene(part), 2);
  EXPECT_EQ(images.front().coverage[0], 0.0);
  EXPECT_EQ(images.front().std_error(0), 0.0);
}

}  // namespace
}  // namespace retrace::testing::camera_error_test

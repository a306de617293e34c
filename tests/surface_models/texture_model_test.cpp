#include "surface_models/texture_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surface_models/form.h"
#include "surface_models/height_parameters.h"
#include "tests/support/synthetic_surface.h"

// Surfaces are generated from known components. The measured parameters must equal those of the components.

namespace retrace::surface_models::texture_model_test {
namespace {

TextureModel model_of(const HeightMap& map, double cutoff_um = 80.0) {
  return texture_model(gaussian_split(without_form(map, 1), cutoff_um), cutoff_um);
}

void expect_share(double measured, double made, double share, const char* what) {
  EXPECT_NEAR(measured / made, 1.0, share) << what << ": " << measured << " in place of " << made;
}

struct Made {
  double roughness_sq_nm;
  double correlation_length_um;
  double waviness_sq_nm;
  double waviness_length_um;
};

TEST(TextureModel, MeasuresBackWhatASurfaceWasMadeOf) {
  std::uint32_t seed = 20;
  for (const Made& made : {Made{8.0, 5.0, 20.0, 200.0}, Made{20.0, 3.0, 25.0, 150.0}, Made{5.0, 4.0, 30.0, 128.0},
                           Made{3.0, 4.0, 60.0, 250.0}})
    for (const bool along_x : {true, false}) {
      HeightMap map = testing::gaussian_surface(1024, 1024, made.roughness_sq_nm, made.correlation_length_um, ++seed);
      const double f = 1.0 / made.waviness_length_um;
      testing::add_wave(map, made.waviness_sq_nm, along_x ? f : 0.6 * f, along_x ? 0.0 : 0.8 * f, 1.0);
      testing::add_plane(map, 500.0, 300.0, -800.0);
      const TextureModel model = model_of(map);
      SCOPED_TRACE(std::to_string(made.roughness_sq_nm) + ", seed " + std::to_string(seed));
      expect_share(model.roughness_sq_nm, made.roughness_sq_nm, 0.02, "roughness");
      ASSERT_TRUE(model.correlation_length_um && model.waviness_length_um);
      expect_share(*model.correlation_length_um, made.correlation_length_um, 0.02, "correlation length");
      expect_share(model.waviness_sq_nm, made.waviness_sq_nm, 0.02, "waviness");
      expect_share(*model.waviness_length_um, made.waviness_length_um, 0.02, "waviness length");
    }
}

TEST(TextureModel, DoesNotDependOnTheCutoff) {
  HeightMap map = testing::gaussian_surface(1024, 1024, 8.0, 5.0, 77);
  testing::add_wave(map, 20.0, 1.0 / 250.0, 0.0, 0.3);
  for (const double cutoff : {50.0, 80.0, 120.0}) {
    const TextureModel model = model_of(map, cutoff);
    SCOPED_TRACE(cutoff);
    expect_share(model.roughness_sq_nm, 8.0, 0.02, "roughness");
    expect_share(*model.correlation_length_um, 5.0, 0.03, "correlation length");
    expect_share(model.waviness_sq_nm, 20.0, 0.02, "waviness");
    expect_share(*model.waviness_length_um, 250.0, 0.02, "waviness length");
  }
}

TEST(TextureModel, OfRoughnessAloneHasNoWaviness) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    const TextureModel model = model_of(testing::gaussian_surface(600, 600, 8.0, 5.0, seed));
    expect_share(model.roughness_sq_nm, 8.0, 0.03, "roughness");
    expect_share(*model.correlation_length_um, 5.0, 0.03, "correlation length");
    EXPECT_EQ(model.waviness_sq_nm, 0.0);
    EXPECT_FALSE(model.waviness_length_um);
  }
}

TEST(TextureModel, OfWavesAloneHasNoRoughness) {
  HeightMap map{800, 600, 1.0, 1.0, std::vector<double>(800 * 600, 0.0)};
  testing::add_wave(map, 20.0, 1.0 / 160.0, 0.0, 0.3);
  const TextureModel model = model_of(map);
  EXPECT_EQ(model.roughness_sq_nm, 0.0);
  EXPECT_FALSE(model.correlation_length_um);
  expect_share(model.waviness_sq_nm, 20.0, 0.02, "waviness");
  expect_share(*model.waviness_length_um, 160.0, 0.02, "waviness length");
}

/// Expects the parameters of a surface with Sq = 8 nm over 5 um and a wave of 20 nm every 200 um.
void expect_texture(const TextureModel& model, double roughness_share) {
  expect_share(model.roughness_sq_nm, 8.0, roughness_share, "roughness");
  expect_share(*model.correlation_length_um, 5.0, roughness_share, "correlation length");
  expect_share(model.waviness_sq_nm, 20.0, 0.02, "waviness");
  expect_share(*model.waviness_length_um, 200.0, 0.02, "waviness length");
}

TEST(TextureModel, ToleratesMissingPoints) {
  HeightMap map = testing::gaussian_surface(1024, 1024, 8.0, 5.0, 31);
  testing::add_wave(map, 20.0, 1.0 / 200.0, 0.0, 1.0);
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column)
      if (philox({3, 0}, static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row))[0] % 10 == 0 ||
          std::hypot(static_cast<double>(column) - 700.0, static_cast<double>(row) - 300.0) < 40.0)
        map.at(column, row) = kMissing;
  expect_texture(model_of(map), 0.02);
}

TEST(TextureModel, OfAProfile) {
  HeightMap map = testing::gaussian_surface(40000, 1, 8.0, 5.0, 13);
  testing::add_wave(map, 20.0, 1.0 / 200.0, 0.0, 1.0);
  expect_texture(model_of(map), 0.04);
}

TEST(TextureModel, OfAFlatSurfaceIsNothing) {
  const TextureModel model = model_of({100, 90, 1.0, 1.0, std::vector<double>(9000, 17.0)});
  EXPECT_EQ(model.roughness_sq_nm, 0.0);
  EXPECT_EQ(model.waviness_sq_nm, 0.0);
  EXPECT_FALSE(model.correlation_length_um);
  EXPECT_FALSE(model.waviness_length_um);
}

}  // namespace
}  // namespace retrace::surface_models::texture_model_test

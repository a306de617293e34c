// Tests of textured and rounded facets of designs: closed forms, limits, and monotonic changes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/number_format.h"
#include "design/io/design_reader.h"
#include "design/optical_model.h"
#include "studies/rre/rre.h"
#include "surface_models/form.h"
#include "surface_models/height_parameters.h"
#include "tests/support/refusals.h"
#include "tests/support/statistics.h"
#include "tests/support/synthetic_surface.h"

namespace retrace::studies::texture_test {
namespace {

namespace fs = std::filesystem;
using surface_models::HeightMap;
constexpr double kPi = std::numbers::pi;
constexpr double kWavelengthNm = 587.56;

/// A prism behind a lossless entrance face, so that the RRE depends on the facets only.
const std::string kPrism =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"single\"\n"
    "[body]\nthickness_mm = 0.5\n[idealisation]\nentrance = \"lossless\"\n";
const std::string kArray =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"offset\"\nextent = "
    "\"infinite\"\n[body]\nthickness_mm = 0.5\n";
const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1.0\n[array]\nextent = \"infinite\"\n[body]\nthickness_mm = "
    "0.5\n";
const std::string kTriangles =
    "[element]\nkind = \"triangular_icc\"\naperture_mm = 1.0\n[array]\nextent = \"infinite\"\n[body]\nthickness_mm = "
    "0.5\n";
/// Cut-off whose truncated power is negligible in these tests. A lower cut-off takes much longer, because cube corners
/// divide light into very many beams.
constexpr double kExactCutoff = 1e-7;
/// Acceptance cone that is so narrow that it contains no scattered light.
const std::string kNarrow = "detector.acceptance_half_angle_deg=0.001";
/// With mirrors, only the phase of the reflected light counts, for any correlation length of the heights.
const std::string kMirrors = "idealisation.facets=mirror";

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "retrace_texture_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }

  void write(const std::string& name, const HeightMap& map) const {
    std::string text =
        "x_pixel_um " + shortest(map.x_pixel_um) + "\ny_pixel_um " + shortest(map.y_pixel_um) + "\nheight_unit nm\n";
    for (std::size_t row = 0; row < map.rows; ++row)
      for (std::size_t column = 0; column < map.columns; ++column)
        text += shortest(map.at(column, row)) + (column + 1 == map.columns ? "\n" : " ");
    std::ofstream(path_ / name) << text;
  }

 private:
  fs::path path_;
};

struct Question {
  double incidence_deg = 0.0;
  raytrace::Engine engine = raytrace::Engine::montecarlo;
  std::uint64_t rays = 1U << 17;
};

RrePoint rre_of(const std::string& design, const std::vector<std::string>& overrides, const Question& asked = {},
                const std::string& source = "d.toml") {
  RreSettings request;
  request.incidence_deg = {asked.incidence_deg};
  request.engine = asked.engine;
  if (asked.engine == raytrace::Engine::montecarlo) request.rays = asked.rays;
  if (asked.engine == raytrace::Engine::exact) request.cutoff = kExactCutoff;
  return RreStudy({design::parse_design(design, source, overrides)}, request).run().points.at(0);
}

RrePoint exact(const std::string& design, std::vector<std::string> overrides, double incidence_deg = 0.0) {
  return rre_of(design, overrides, {incidence_deg, raytrace::Engine::exact});
}

double index_of(const std::string& design) {
  return design::make_model(design::parse_design(design, "d.toml"), materials::MaterialLibrary::shipped()).optics.index;
}

/// Allowed rounding error of specular light, which is traced without sampling.
constexpr double kRounding = 1e-12;

/// Returns the specular fraction after two successive facets (closed form 7 in docs/theory/closed_forms.md).
double specular_share_of_two(double index, double sq_nm, double incidence_deg) {
  const double inside = std::asin(std::sin(incidence_deg * kPi / 180.0) / index);
  double phase2 = 0.0;
  for (const double side : {-1.0, 1.0})
    phase2 += std::pow(4.0 * kPi * index * sq_nm * std::cos(0.25 * kPi + side * inside) / kWavelengthNm, 2);
  return std::exp(-phase2);
}

/// Returns the identifier and the position in the input of each warning about a design.
/// \param surface content of the design's table [surface]
/// \param file file name of the design
std::vector<std::string> warnings_of(const std::string& surface, const std::string& file) {
  const design::Design design = design::parse_design(kPrism + "[surface]\n" + surface, file);
  return facts_of(design::make_model(design, materials::MaterialLibrary::shipped()).warnings);
}

// Every texture model warns if its parameters are outside the range in which the model is valid.
TEST(DesignTexture, WarnsOutsideTheRangeOfEveryModel) {
  const Folder folder;
  const std::string file = (folder.path() / "d.toml").string();
  const std::string head = "height_unit nm\npixel_um ";
  std::string steep = head + "0.2\n", coarse = head + "5\n";
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column)
      steep += std::string(column % 16 < 8 ? "0" : "700") + (column == 63 ? "\n" : " ");
  for (int row = 0; row < 8; ++row) coarse += "0 0 nan 0 0 1 0 0\n";
  std::ofstream(folder.path() / "steep.txt") << steep;
  std::ofstream(folder.path() / "coarse.txt") << coarse;
  using Facts = std::vector<std::string>;
  const std::vector<std::pair<std::string, Facts>> cases = {
      {"roughness_sq_nm = 10\ncorrelation_length_um = 0.2\n", {"correlation_below_wavelength"}},
      {"roughness_sq_nm = 400\ncorrelation_length_um = 2\n", {"steep_roughness", "roughness_beyond_model"}},
      {"roughness_sq_nm = 250\ncorrelation_length_um = 9\n", {"roughness_beyond_model"}},
      {"waviness_sq_nm = 300\nwaviness_length_um = 5\n", {"steep_waviness"}},
      {"model = \"abg\"\nabg_a = 0.01\nabg_b = 1e-4\nabg_g = 2\n", {"strong_scatter"}},
      {"model = \"microfacet\"\nwaviness_sq_nm = 30\nwaviness_length_um = 80\n", {"low_waviness"}},
      {"model = \"microfacet\"\nwaviness_sq_nm = 900\nwaviness_length_um = 10\n", {"steep_facets"}},
      {"height_map = \"steep.txt\"\n", {"coarse_height_map", "steep_height_map", "heights_not_gaussian"}},
      {"height_map = \"coarse.txt\"\n", {"missing_points", "coarse_height_map", "heights_not_gaussian"}}};
  for (const auto& [surface, ids] : cases) {
    Facts expected;
    for (const std::string& id : ids)
      expected.push_back(id + " at TMP/d.toml" + (id == "missing_points" ? ": TMP/coarse.txt" : ""));
    EXPECT_EQ(warnings_of(surface, file), expected) << surface;
  }
}

// Low waviness diffracts light. In PMMA at the d line, 63 % of the light remains specular at each total reflection.
TEST(DesignTexture, WavinessOf30NmLeaves63PercentAtEachTotalReflection) {
  const double share = specular_share_of_two(index_of(kPrism), 30.0, 0.0);
  EXPECT_NEAR(std::sqrt(share), 0.63, 0.005);
  const double all = exact(kPrism, {kNarrow}).rre;
  const std::vector<std::string> waves = {kNarrow, "surface.waviness_sq_nm=30", "surface.waviness_length_um=100"};
  std::vector<std::string> mirrors = waves;
  mirrors.push_back(kMirrors);
  const RrePoint wavy = rre_of(kPrism, mirrors, {});
  EXPECT_NEAR(wavy.rre, all * share, testing::student_bound(2) * wavy.std_error + kRounding);
  EXPECT_LT(wavy.std_error, 2e-3);
  // At total reflection, the amplitude depends on the angle within the lobe. For waves of 100 um, this changes the
  // specular fraction by about 1e-4.
  const RrePoint real = rre_of(kPrism, waves, {});
  EXPECT_NEAR(real.rre / all, share, testing::student_bound(2) * real.std_error + 2e-4);
}

// If the correlation length is about the wavelength, roughness scatters less light than its phase predicts. At 0.39 um,
// it scatters about half. A tenth of the scattered light leaves through the facets (docs/theory/scatter.md).
TEST(DesignTexture, ShortRoughnessScattersLessAtTotalReflection) {
  const double all = exact(kPrism, {kNarrow}).rre;
  const RrePoint traced =
      rre_of(kPrism, {kNarrow, "surface.roughness_sq_nm=10", "surface.correlation_length_um=0.39"}, {});
  const double kept = traced.rre / all;
  const double phase = -std::log(specular_share_of_two(index_of(kPrism), 10.0, 0.0));
  EXPECT_NEAR(-std::log(kept) / phase, 0.543, 0.01);
  EXPECT_LE(traced.std_error, target_error_of(RreSettings{}));
  EXPECT_NEAR(traced.ledger.total(), 1.0, 1e-9);
  EXPECT_GT(traced.ledger[raytrace::Account::transmitted], 0.1 * (1.0 - kept));
}

// g is the variance of the phase of the reflected light. Above 10, no light remains specular. The waviness then acts
// like tilts of the facets, and the light counts as scattered.
TEST(DesignTexture, HighWavinessLeavesNothingSpecular) {
  const double sq_nm = std::sqrt(10.1) * kWavelengthNm / (4.0 * kPi * index_of(kPrism) * std::cos(0.25 * kPi));
  const RrePoint wavy =
      rre_of(kPrism, {kNarrow, "surface.waviness_sq_nm=" + shortest(sq_nm), "surface.waviness_length_um=100"}, {});
  EXPECT_LT(wavy.rre, 1e-3);
  EXPECT_GT(wavy.ledger[raytrace::Account::scattered_out], 0.9);
}

TEST(DesignTexture, SpecularSharesOfTwoFacetsMultiply) {
  const Folder folder;
  const double index = index_of(kPrism);
  HeightMap map = testing::gaussian_surface(192, 192, 12.0, 12.0, 5);
  // The correlation length is 3 um; the pixels are small enough to resolve half a wavelength.
  map.x_pixel_um = map.y_pixel_um = 0.25;
  folder.write("map.txt", map);
  const double map_sq_nm = surface_models::height_parameters(surface_models::without_form(map, 1).heights_nm).sq_nm;
  const std::string source = (folder.path() / "d.toml").string();
  for (const double incidence_deg : {0.0, 3.0}) {
    const double all = exact(kPrism, {kNarrow}, incidence_deg).rre;
    const RrePoint rough = rre_of(
        kPrism, {kNarrow, kMirrors, "surface.roughness_sq_nm=15", "surface.correlation_length_um=2"}, {incidence_deg});
    EXPECT_NEAR(rough.rre, all * specular_share_of_two(index, 15.0, incidence_deg),
                testing::student_bound(4) * rough.std_error + kRounding);
    const RrePoint mapped =
        rre_of(kPrism + "[surface]\nheight_map = \"map.txt\"\n", {kNarrow}, {incidence_deg}, source);
    EXPECT_NEAR(mapped.rre, all * specular_share_of_two(index, map_sq_nm, incidence_deg),
                testing::student_bound(4) * mapped.std_error + kRounding);
  }
}

// Waves along the roof edge deviate light by w / L out of the plane of incidence, where w is the wavelength and L the
// period of the waves. Waves across the edge deviate it by w / (L cos 45 degrees) within this plane. The half-angle of
// the cone is between both values, so that the RRE shows the orientation of the map.
TEST(DesignTexture, LevelAxisOfTheMapLiesAlongTheRoofEdge) {
  const Folder folder;
  const double period_um = 20.0;
  HeightMap map{512, 64, 1.25, 1.25, std::vector<double>(512 * 64, 0.0)};
  testing::add_wave(map, 15.0, 1.0 / period_um, 0.0);
  folder.write("grating.txt", map);
  const std::string source = (folder.path() / "d.toml").string();
  const double first_order_deg = 1e-3 * kWavelengthNm / period_um * 180.0 / kPi;
  const std::string cone = "detector.acceptance_half_angle_deg=" + shortest(1.2 * first_order_deg);
  const auto rre = [&](const std::string& axis) {
    return rre_of(kPrism + "[surface]\nheight_map = \"grating.txt\"\nheight_map_horizontal_axis = \"" + axis + "\"\n",
                  {cone}, {}, source)
        .rre;
  };
  const double specular = specular_share_of_two(index_of(kPrism), 15.0, 0.0);
  EXPECT_GT(rre("x"), specular + 0.8 * (1.0 - specular));
  EXPECT_LT(rre("y"), specular + 0.1 * (1.0 - specular));
}

// Roughness with a lay (a preferred direction) has different correlation lengths in two directions. If the length l
// along the roof edge is short, the standard deviation of the angles is w / (sqrt(2) pi l), out of the plane of
// incidence. If the length down the facets is short, it is this value divided by cos 45 degrees, within the plane. The
// half-angle of the cone is the first value. The fractions in the cone follow from the error function.
TEST(DesignTexture, LayLiesAsItsKeysSay) {
  const double level_rad = 1e-3 * kWavelengthNm / (std::sqrt(2.0) * kPi * 10.0);
  const std::string cone = "detector.acceptance_half_angle_deg=" + shortest(level_rad * 180.0 / kPi);
  const double specular = specular_share_of_two(index_of(kPrism), 20.0, 0.0);
  const auto share_in_cone = [&](const std::string& level_um, const std::string& down_um) {
    const double rre = rre_of(kPrism, {cone, "surface.roughness_sq_nm=20", "surface.correlation_length_um=" + level_um,
                                       "surface.correlation_length_down_um=" + down_um})
                           .rre;
    return (rre - specular) / (1.0 - specular);
  };
  EXPECT_NEAR(share_in_cone("10", "200"), std::erf(1.0 / std::sqrt(2.0)), 0.04);
  EXPECT_NEAR(share_in_cone("200", "10"), std::erf(0.5), 0.04);
  const std::vector<std::string> one = {cone, "surface.roughness_sq_nm=20", "surface.correlation_length_um=5"};
  std::vector<std::string> both = one;
  both.push_back("surface.correlation_length_down_um=5");
  EXPECT_EQ(rre_of(kPrism, one).rre, rre_of(kPrism, both).rre);
}

// A map of a surface with Gaussian autocorrelation has the same effect as `harvey_shack` with the Sq and the
// correlation length of the map.
TEST(DesignTexture, MapAndStatisticsOfOneSurfaceAgree) {
  const Folder folder;
  HeightMap map = testing::gaussian_surface(384, 384, 14.0, 8.0, 9);
  map.x_pixel_um = map.y_pixel_um = 0.25;
  const double measured_sq_nm =
      surface_models::height_parameters(surface_models::without_form(map, 1).heights_nm).sq_nm;
  folder.write("map.txt", map);
  const std::string cone = "detector.acceptance_half_angle_deg=5";
  const std::string source = (folder.path() / "d.toml").string();
  const RrePoint mapped = rre_of(kPrism + "[surface]\nheight_map = \"map.txt\"\n", {cone, kMirrors}, {}, source);
  const RrePoint stated = rre_of(
      kPrism,
      {cone, kMirrors, "surface.roughness_sq_nm=" + shortest(measured_sq_nm), "surface.correlation_length_um=2"}, {});
  EXPECT_GT(stated.rre, 0.84);
  EXPECT_LT(stated.rre, 0.92);
  // The map is small, so that its spectrum differs by a few percent. The cone contains about half of the scattered
  // light.
  EXPECT_NEAR(mapped.rre, stated.rre, 0.01);
}

TEST(DesignTexture, FormAndTiltOfTheMapAreRemoved) {
  const Folder folder;
  HeightMap map = testing::gaussian_surface(96, 96, 8.0, 8.0, 2);
  map.x_pixel_um = map.y_pixel_um = 0.25;
  folder.write("bare.txt", surface_models::without_form(map, 2));
  testing::add_plane(map, 1000.0, 400.0, -250.0);
  for (std::size_t row = 0; row < map.rows; ++row)
    for (std::size_t column = 0; column < map.columns; ++column)
      map.at(column, row) += 0.02 * std::pow(static_cast<double>(column) - 40.0, 2);
  folder.write("formed.txt", map);
  const std::string source = (folder.path() / "d.toml").string();
  const auto rre = [&](const std::string& surface) {
    return rre_of(kPrism + "[surface]\n" + surface, {kNarrow}, {0.0, raytrace::Engine::montecarlo, 1U << 14}, source)
        .rre;
  };
  const double bare = rre("height_map = \"bare.txt\"\n");
  EXPECT_NEAR(rre("height_map = \"formed.txt\"\nheight_map_form = \"poly2\"\n"), bare, 1e-3);
  EXPECT_LT(rre("height_map = \"formed.txt\"\n"), bare - 0.05);
}

TEST(DesignTexture, VanishingRoughnessGivesTheExactAnswer) {
  for (const std::string& design : {kArray, kCubes, kTriangles}) {
    const double incidence_deg = design == kArray ? 3.0 : 0.0;
    const RrePoint smooth = exact(design, {}, incidence_deg);
    EXPECT_EQ(exact(design, {"surface.roughness_sq_nm=0"}, incidence_deg).rre, smooth.rre);
    for (const std::string texture :
         {"roughness_sq_nm=0.001 correlation_length_um=5", "waviness_sq_nm=0.001 waviness_length_um=100"}) {
      const std::size_t blank = texture.find(' ');
      const RrePoint rough = rre_of(
          design, {"surface." + texture.substr(0, blank), "surface." + texture.substr(blank + 1)}, {incidence_deg});
      EXPECT_NEAR(rough.rre, smooth.rre,
                  testing::student_bound(6) * rough.std_error + smooth.ledger[raytrace::Account::truncated] + 1e-9)
          << texture;
    }
  }
}

/// Request of the two tests below. The smallest change of the RRE between two values is about ten standard errors, so
/// that more rays are not necessary.
const Question kSteps{0.0, raytrace::Engine::montecarlo, 1U << 14};

// The values of Sa differ so much that the RRE changes by more than the statistical error.
TEST(DesignTexture, RreFallsMonotonicallyWithSa) {
  for (const std::string& design : {kArray, kCubes, kTriangles}) {
    double before = exact(design, {}).rre;
    for (const double sa_nm : {3.0, 6.0, 12.0, 25.0, 50.0, 100.0}) {
      const double sq_nm = sa_nm * std::sqrt(0.5 * kPi);
      const RrePoint point =
          rre_of(design, {"surface.roughness_sq_nm=" + shortest(sq_nm), "surface.correlation_length_um=5"}, kSteps);
      EXPECT_LT(point.rre + 4.0 * point.std_error, before) << sa_nm;
      before = point.rre - 4.0 * point.std_error;
    }
  }
}

/// Returns designs, each with the key of a radius of its edges.
std::vector<std::pair<std::string, std::string>> edges() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& design : {kArray, kCubes, kTriangles})
    for (const char* const key : {"root_radius_um", "rim_radius_um"}) all.emplace_back(design, key);
  return all;
}

TEST(DesignTexture, RreFallsMonotonicallyWithTheRadiusOfEdges) {
  for (const auto& [design, key] : edges()) {
    const double sharp = rre_of(design, {}, kSteps).rre;
    double before = sharp;
    for (const double radius_um : {5.0, 10.0, 20.0, 40.0}) {
      const RrePoint point = rre_of(design, {"surface." + key + "=" + shortest(radius_um)}, kSteps);
      EXPECT_LT(point.rre + 4.0 * point.std_error, before) << key << " " << radius_um;
      before = point.rre - 4.0 * point.std_error;
    }
  }
}

TEST(DesignTexture, VanishingRadiusGivesTheExactAnswer) {
  for (const auto& [design, key] : edges()) {
    const double sharp = exact(design, {}).rre;
    // A radius of 0.001 um makes 3e-6 of the smallest element ineffective.
    const RrePoint round = rre_of(design, {"surface." + key + "=0.001"}, {0.0, raytrace::Engine::montecarlo, 1U << 18});
    EXPECT_NEAR(round.rre, sharp, testing::student_bound(6) * round.std_error + 2e-5) << key;
  }
}

// The plane of a chamfered root is horizontal, but it still needs the direction of the roof edge for its texture.
TEST(DesignTexture, WavyFacetsWithAChamferCloseTheLedger) {
  const RrePoint point =
      rre_of(kArray,
             {"surface.root_chamfer_um=60", "surface.waviness_sq_nm=400", "surface.waviness_length_um=60",
              "surface.roughness_sq_nm=10", "surface.correlation_length_um=2"},
             {5.0, raytrace::Engine::montecarlo, 1U << 15});
  EXPECT_NEAR(point.ledger.total(), 1.0, 1e-9);
  EXPECT_LT(point.ledger[raytrace::Account::lost], 1e-9);
}

}  // namespace
}  // namespace retrace::studies::texture_test

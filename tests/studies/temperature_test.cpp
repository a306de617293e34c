// Tests of the temperature of a part: its refractive index, and equal use of this index in all studies.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/number_format.h"
#include "design/io/design_json.h"
#include "design/io/design_reader.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/rre/rre.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"

namespace retrace::studies::temperature_test {
namespace {

using Overrides = std::vector<std::string>;

const std::string kPrisms =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nextent = \"infinite\"\n[body]\n"
    "thickness_mm = 2\n";
const std::string kBall = "[element]\nkind = \"ball\"\ndiameter_mm = 1\n[array]\narrangement = \"single\"\n";
const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 0.5\n[array]\narrangement = \"honeycomb\"\nextent = "
    "\"infinite\"\n[body]\nthickness_mm = 1\n";

design::Design design(const Overrides& overrides, const std::string& text = kPrisms) {
  return design::parse_design(text, "d.toml", overrides);
}

Inspection inspected(const Overrides& overrides, const std::string& text = kPrisms) {
  return inspect(design(overrides, text), materials::MaterialLibrary::shipped());
}

/// Returns the index at a temperature in closed form. The index relative to vacuum changes by the coefficient D0 only.
/// For air, n - 1 is proportional to its density.
double warm_index(double n, double d0_per_k, double air_at_15, double temperature_c) {
  const auto air = [&](double c) { return 1.0 + (air_at_15 - 1.0) * (1.0 + 0.00367 * 15.0) / (1.0 + 0.00367 * c); };
  const double grown = (n * n - 1.0) / (2.0 * n) * d0_per_k * (temperature_c - 20.0);
  return (n * air(20.0) + grown) / air(temperature_c);
}

// By Ciddor 1996, the index of air at 587.56 nm and 15 degrees C is 1.000277175.
TEST(Temperature, IndexOfPmmaIsTheClosedForm) {
  const double n = inspected({}).refractive_index;
  for (const double temperature_c : {-40.0, 0.0, 35.0, 80.0})
    EXPECT_NEAR(inspected({"body.temperature_c=" + shortest(temperature_c)}).refractive_index,
                warm_index(n, -2.592e-4, 1.000277175, temperature_c), 1e-9)
        << temperature_c;
  EXPECT_NEAR(inspected({"body.temperature_c=80"}).refractive_index - n, -60.0 * 1.05e-4, 1e-4);
}

TEST(Temperature, OfTheDataIsTheDefault) {
  for (const std::string temperature : {"20", "20.0"})
    EXPECT_EQ(inspected({"body.temperature_c=" + temperature}).refractive_index, inspected({}).refractive_index);
  EXPECT_FALSE(design::to_json(design({}))["body"].contains("temperature_c"));
  EXPECT_EQ(design::to_json(design({"body.temperature_c=60"}))["body"]["temperature_c"], 60.0);
}

// A given index must have exactly the same effect as an equal index that follows from a temperature.
TEST(Temperature, IsTheSameIndexInEveryEngine) {
  struct Case {
    const std::string& text;
    raytrace::Engine engine;
  };
  for (const auto& [text, engine] : {Case{kPrisms, raytrace::Engine::exact}, Case{kPrisms, raytrace::Engine::cell},
                                     Case{kPrisms, raytrace::Engine::embree}, Case{kCubes, raytrace::Engine::cell},
                                     Case{kBall, raytrace::Engine::automatic}}) {
    const Overrides warm = {"body.temperature_c=75", "body.material=PC"};
    const Overrides given = {"body.refractive_index=" + shortest(inspected(warm, text).refractive_index)};
    RreSettings request;
    request.incidence_deg = {12.0};
    request.engine = engine;
    if (engine != raytrace::Engine::exact) request.rays = 1U << 11;
    const RreStudy study({design(warm, text), design(given, text), design({"body.material=PC"}, text)}, request);
    const std::vector<RrePoint> points = study.run().points;
    ASSERT_EQ(points.size(), 3U);
    EXPECT_EQ(points[0].rre, points[1].rre) << engine_name(engine);
    EXPECT_NE(points[0].rre, points[2].rre) << engine_name(engine);
  }
}

TEST(Temperature, IsTheSameIndexInPhotometry) {
  const auto r_a = [](const Overrides& overrides) {
    return PhotometryStudy(design(overrides, kCubes),
                           photometric_requests::request_of(photometric_requests::points_at({0.33}, 1.0)))
        .run()
        .points.front()
        .r_a;
  };
  const Overrides warm = {"body.temperature_c=-30", "surface.dihedral_error_arcmin=3"};
  const std::string index = shortest(inspected(warm, kCubes).refractive_index);
  EXPECT_EQ(r_a(warm), r_a({"body.refractive_index=" + index, "surface.dihedral_error_arcmin=3"}));
  EXPECT_NE(r_a(warm), r_a({"surface.dihedral_error_arcmin=3"}));
}

// With a spectrum, the index at each wavelength depends on the temperature.
TEST(Temperature, MovesTheIndexOfEveryWavelength) {
  const Inspection cold = inspected({"light.spectrum=A", "body.material=N-BK7"});
  const Inspection warm = inspected({"light.spectrum=A", "body.material=N-BK7", "body.temperature_c=70"});
  ASSERT_EQ(cold.light.size(), warm.light.size());
  for (std::size_t k = 0; k < cold.light.size(); ++k) {
    const double per_k = (warm.light[k].optics.index - cold.light[k].optics.index) / 50.0;
    EXPECT_GT(per_k, 2.4e-6);  // value of the data sheet at 1060 nm: lower bound
    EXPECT_LT(per_k, 3.7e-6);  // value of the data sheet at 436 nm: upper bound
  }
}

TEST(Temperature, IsToldByInspect) {
  EXPECT_NE(inspect_text(inspected({"body.temperature_c=60"})).find(" at 587.56 nm and 60 degrees C\n"),
            std::string::npos);
  EXPECT_EQ(inspect_text(inspected({})).find("degrees C"), std::string::npos);
}

TEST(Temperature, BeyondTheDataIsAWarning) {
  EXPECT_TRUE(inspected({"body.material=N-BK7", "body.temperature_c=140"}).warnings.empty());
  const Inspection hot = inspected({"body.material=N-BK7", "body.temperature_c=150"});
  ASSERT_EQ(hot.warnings.size(), 1U);
  EXPECT_EQ(facts_of(hot.warnings[0]), "thermo_optic_extrapolated at d.toml");
}

TEST(Temperature, BadInputIsRefused) {
  const auto complaint = [](const std::string& line) {
    return refusal_of(
        [&] { inspect(design::parse_design(kPrisms + line, "d.toml", {}), materials::MaterialLibrary::shipped()); });
  };
  expect_refusals(complaint, {{"temperature_c = -201\n", "d.toml:9: body.temperature_c"},
                              {"temperature_c = 1e3\n", "d.toml:9: body.temperature_c"},
                              {"temperature_c = nan\n", "d.toml:9: body.temperature_c"},
                              {"temperature_c = \"warm\"\n", "d.toml:9: body.temperature_c"},
                              {"temperature_c = [20, 30]\n", "d.toml:9: body.temperature_c"},
                              {"temperature_c = 40\nrefractive_index = 1.5\n", "d.toml:9: body.temperature_c"},
                              {"temperature_c = 40\nmaterial = \"air\"\n", "d.toml:9: body.temperature_c"}});
}

}  // namespace
}  // namespace retrace::studies::temperature_test

// Tests of designs with a contaminated entrance face: keys, refused values, engines, and the report of inspect.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "design/io/design_document.h"
#include "design/optical_model.h"
#include "materials/io/material_library.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/photometry/photometry.h"
#include "studies/rre/rre.h"
#include "tests/studies/design_texts.h"
#include "tests/support/refusals.h"

namespace retrace::studies::entrance_state_test {
namespace {

const materials::MaterialLibrary& library() {
  static const materials::MaterialLibrary shipped = materials::MaterialLibrary::shipped();
  return shipped;
}

std::string entrance(const std::string& lines) {
  return with_line(11, "[entrance]\n" + lines);
}

design::Design read(const std::string& lines, const std::vector<std::string>& overrides = {}) {
  return design::parse_design(entrance(lines), "d.toml", overrides);
}

const std::string kDust = "dust_coverage = 0.1\ndust_albedo = 0.8\ndust_forward_fraction = 0.75\n";
const std::string kHaze = "haze = 0.05\nhaze_spread_deg = 5\n";
const std::string kFilthy =
    "layers = [{ refractive_index = 1.6, thickness_um = 10, absorption_per_mm = 0.5 }]\n"
    "film_coverage = 0.25\nwater_index = 1.34\ndrop_coverage = 0.2\n"
    "drop_contact_angle_deg = 50\nscratch_coverage = 0.05\nscratch_spread_deg = 6\n"
    "scratch_azimuth_deg = 30\n" +
    kDust + kHaze;

TEST(EntranceState, WhatIsWrongIsRefusedWithItsPlace) {
  const auto refused = [](const std::string& lines) { return complaint(entrance(lines)); };
  std::string list = "{ refractive_index = 1.5, thickness_um = 1 }";
  for (int k = 0; k < 20; ++k) list += ", { refractive_index = 1.5, thickness_um = 1 }";
  expect_refusals(
      refused,
      {{"film_coverage = 1.5", "d.toml:12: entrance.film_coverage"},
       {"drop_coverage = -0.1", "d.toml:12: entrance.drop_coverage"},
       {"drop_coverage = 0.1\ndrop_contact_angle_deg = 120", "d.toml:13: entrance.drop_contact_angle_deg"},
       {"water_index = 0.9", "d.toml:12: entrance.water_index"},
       {"scratch_coverage = 0.1\nscratch_spread_deg = 0", "d.toml:13: entrance.scratch_spread_deg"},
       {"haze = 0.5\nhaze_spread_deg = 1", "d.toml:12: entrance.haze"},
       {"roughness_sq_nm = 5\ncorrelation_length_um = 2\nfilm_coverage = 0.1", "d.toml:12: entrance.roughness_sq_nm"},
       {"drop_coverage = 0.6\ndrop_contact_angle_deg = 30\nscratch_coverage = 0.6\nscratch_spread_deg = 5",
        "d.toml:12: entrance.drop_coverage"},
       {"layers = [{ refractive_index = 0.5, thickness_um = 1 }]", "d.toml:12: entrance.layers[1].refractive_index"},
       {"layers = [{ refractive_index = 1.5, thickness_um = 0 }]", "d.toml:12: entrance.layers[1].thickness_um"},
       {"layers = [" + list + "]", "d.toml:12: entrance.layers"}});
  for (const auto& [lines, needed] : {std::pair{"drop_coverage = 0.1", "drop_contact_angle_deg"},
                                      {"dust_coverage = 0.1\ndust_forward_fraction = 0.5", "dust_albedo"},
                                      {"dust_coverage = 0.1\ndust_albedo = 0.5", "dust_forward_fraction"},
                                      {"scratch_coverage = 0.1", "scratch_spread_deg"},
                                      {"haze = 0.1", "haze_spread_deg"},
                                      {"roughness_sq_nm = 5", "correlation_length_um"}})
    EXPECT_EQ(refused(lines), std::string("d.toml:11: entrance.") + needed);
  EXPECT_TRUE(refused("layers = [{ refractive_index = 1.5 }]").find("entrance.layers[1].thickness_um") !=
              std::string::npos);
  EXPECT_EQ(refused("dirt = 1"), "d.toml:12: entrance.dirt");
  EXPECT_EQ(refused(kFilthy), "");
}

TEST(EntranceState, WhatWouldNotCountIsRefused) {
  EXPECT_EQ(complaint(entrance(kDust), {"idealisation.entrance=lossless"}), "d.toml:11: entrance");
  const std::string ball = "[element]\nkind = \"ball\"\ndiameter_mm = 1\n[entrance]\n";
  EXPECT_EQ(complaint(ball + kDust), "d.toml:4: entrance");
  EXPECT_EQ(complaint(entrance(kDust), {"entrance_surface.turned_part=lens.toml"}),
            "d.toml:12: entrance.dust_coverage");
  EXPECT_EQ(complaint(entrance("film_coverage = 0.5"), {"entrance_surface.turned_part=lens.toml"}), "");
}

TEST(EntranceState, DesignsAreWrittenAsTheyWereRead) {
  for (const std::string& lines : {kFilthy, kDust, std::string("film_coverage = 1\n"),
                                   std::string("roughness_sq_nm = 8\ncorrelation_length_um = 3\n")}) {
    const design::Design design = read(lines);
    const std::string text = design::design_text(design);
    EXPECT_EQ(design::design_text(design::parse_design(text, "again.toml")), text);
    EXPECT_NE(text.find("[entrance]"), std::string::npos) << text;
    const raytrace::Optics one = design::make_light_model(design, library()).optics;
    const raytrace::Optics other = design::make_light_model(design::parse_design(text, "again.toml"), library()).optics;
    EXPECT_EQ(one.entrance.covered_fraction(), other.entrance.covered_fraction());
    EXPECT_EQ(one.entrance.haze.fraction, other.entrance.haze.fraction);
    EXPECT_EQ(one.entrance.layers.size(), other.entrance.layers.size());
    EXPECT_EQ(one.entrance.is_rough(), other.entrance.is_rough());
  }
  EXPECT_EQ(design::design_text(set({})).find("[entrance]"), std::string::npos);
}

TEST(EntranceState, OpticsAreThoseOfTheKeys) {
  const raytrace::EntranceCondition face = design::make_light_model(read(kFilthy), library()).optics.entrance;
  ASSERT_EQ(face.layers.size(), 2U);
  EXPECT_EQ(face.layers[0].index, 1.6);
  EXPECT_NEAR(face.layers[0].thickness_mm, 0.01, 1e-15);
  EXPECT_EQ(face.layers[1].index, 1.34);
  EXPECT_EQ(face.layers_under_film().size(), 1U);
  EXPECT_NEAR(face.covered_fraction(), 0.35, 1e-15);
  const auto sine = [](double deg) { return std::sin(deg * std::numbers::pi / 180.0); };
  EXPECT_NEAR(face.haze.fraction, 0.05 * std::exp(std::pow(sine(2.5) / sine(5.0), 2.0)), 1e-14);
  EXPECT_NEAR(face.haze.spread, sine(5.0), 1e-15);
  EXPECT_NEAR(face.scratches.spread, sine(6.0), 1e-15);
  EXPECT_NEAR(*face.scratches.azimuth_rad, std::numbers::pi / 6.0, 1e-15);
  // An empty table [entrance], or fractions of 0, describe a clean face.
  EXPECT_FALSE(
      design::make_light_model(read("dust_coverage = 0\ndust_albedo = 0.5\n"), library()).optics.entrance.scatters());
  EXPECT_TRUE(make_light_model(read(""), library()).optics.has_bare_entrance());
}

RreResult rre(const design::Design& design, raytrace::Engine engine = raytrace::Engine::automatic) {
  RreSettings request;
  request.engine = engine;
  request.incidence_deg = {5.0};
  if (engine != raytrace::Engine::exact) request.rays = 1U << 12;
  return RreStudy({design}, request).run();
}

// If no light is scattered, the exact engine can be used. Otherwise, `auto` selects rays, and `exact` is refused with a
// message that reports the key.
TEST(EntranceState, EnginesThatServe) {
  const std::string infinite =
      "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"offset\"\nextent = "
      "\"infinite\"\n[body]\nthickness_mm = 2.0\n[entrance]\n";
  const auto design = [&](const std::string& lines) { return design::parse_design(infinite + lines, "d.toml", {}); };
  EXPECT_EQ(rre(design("film_coverage = 0.5"), raytrace::Engine::exact).points.at(0).engine, "exact");
  const RreResult soiled = rre(design(kFilthy));
  EXPECT_EQ(soiled.points.at(0).engine, "cell");
  EXPECT_NEAR(soiled.points[0].ledger.total(), 1.0, 1e-9);
  EXPECT_GT(soiled.points[0].ledger[raytrace::Account::scattered_out], 0.0);
  EXPECT_EQ(refusal_of([&] { rre(design(kHaze), raytrace::Engine::exact); }), "d.toml:11: entrance.haze");
  // Photometry uses rays. It reports that diffraction is left out, and why.
  PhotometrySettings request;
  request.test_plan.points.push_back(
      {0.2, 0.0, 0.0, 1.0, PhotometricUnit::cd_per_lx_per_m2, LimitStatus::confirmed, 2});
  request.area_cm2 = 10.0;
  request.apertures = {Angle::from_deg(1.0 / 6.0), Angle::from_deg(1.0 / 6.0)};
  request.light = PhotometricLight::of_design;
  request.rays = 1U << 12;
  const PhotometryResult photometry = PhotometryStudy(design(kDust), request).run();
  EXPECT_TRUE(photometry.points.at(0).lacks_diffraction);
  EXPECT_EQ(photometry.reason.no_diffraction, NoDiffraction(raytrace::Obstacle::scattering_entrance));
  record_message(photometry.reason.text);
}

// The report is compared with closed forms for a film and for dust.
TEST(EntranceState, InspectionTellsTheFace) {
  const Inspection seen = inspect(read(kDust + "film_coverage = 1\n"), library());
  ASSERT_TRUE(seen.entrance_state);
  const EntranceStateReport& face = *seen.entrance_state;
  const double n = seen.refractive_index;
  const auto r = [](double a, double b) { return std::pow((a - b) / (a + b), 2.0); };
  const double r1 = r(1.0, 1.333);
  const double r2 = r(1.333, n);
  EXPECT_NEAR(face.reflectance, r1 + (1.0 - r1) * (1.0 - r1) * r2 / (1.0 - r1 * r2), 1e-12);
  EXPECT_NEAR(face.transmittance, 1.0 - face.reflectance, 1e-12);
  EXPECT_NEAR(face.clean_fraction, 0.9, 1e-15);
  EXPECT_NEAR(face.specular_transmittance, 0.9 * face.transmittance, 1e-12);
  EXPECT_EQ(face.absorptance, 0.0);
  // The expected R_A is rho / pi, where rho includes multiple reflections between dust and face. Without a film, the
  // mean reflectance of the face for Lambertian light is the integral of Fresnel's formulas in closed form.
  const Inspection dry = inspect(read(kDust), library());
  const double m = n * n;
  const double mean = 0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0)) +
                      m * (m - 1.0) * (m - 1.0) / std::pow(m + 1.0, 3.0) * std::log((n - 1.0) / (n + 1.0)) -
                      2.0 * n * m * (m + 2.0 * n - 1.0) / ((m + 1.0) * (m * m - 1.0)) +
                      8.0 * m * m * (m * m + 1.0) / ((m + 1.0) * (m * m - 1.0) * (m * m - 1.0)) * std::log(n);
  const double rho = 0.1 * (0.2 + 0.6 * 0.6 * mean / (1.0 - 0.2 * mean));
  EXPECT_NEAR(dry.entrance_state->dust_cd_per_lx_m2, rho / std::numbers::pi, 1e-7);
  const std::string text = inspect_text(dry);
  EXPECT_NE(text.find("  entrance state      90.000 % free of drops"), std::string::npos) << text;
  EXPECT_NE(text.find("dust returns"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(inspect_json(inspect(read(kFilthy), library())));
  EXPECT_NEAR(json["entrance"]["clean_fraction"].get<double>(), 0.65, 1e-12);
  EXPECT_GT(json["entrance"]["absorptance"].get<double>(), 0.0);
  EXPECT_GT(json["entrance"]["haze_fraction"].get<double>(), 0.05);
  EXPECT_FALSE(inspect(set({}), library()).entrance_state);
}

}  // namespace
}  // namespace retrace::studies::entrance_state_test

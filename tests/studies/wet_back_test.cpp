// Tests of designs with a medium other than air behind some elements: the keys, and the engines and studies that accept
// such designs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "design/io/design_document.h"
#include "materials/io/material_library.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/rre/rre.h"
#include "tests/studies/design_texts.h"

namespace retrace::studies::wet_back_test {
namespace {

std::string wet(const std::string& lines) {
  return with_line(11, "[wet_back]\n" + lines);
}

design::Design read(const std::string& lines, const std::vector<std::string>& overrides = {}) {
  return design::parse_design(wet(lines), "d.toml", overrides);
}

RreResult rre(const design::Design& design, raytrace::Engine engine = raytrace::Engine::automatic) {
  RreSettings request;
  request.incidence_deg = {0.0, 20.0};
  request.azimuth_deg = {0.0, 40.0};
  request.engine = engine;
  request.target_error = 1e-3;
  return RreStudy({design}, request).run();
}

void expect_same(const RreResult& one, const RreResult& other) {
  ASSERT_EQ(one.points.size(), other.points.size());
  for (std::size_t k = 0; k < one.points.size(); ++k) {
    EXPECT_EQ(one.points[k].ledger.power, other.points[k].ledger.power);
    EXPECT_EQ(one.points[k].engine, other.points[k].engine);
  }
}

TEST(WetBackDesign, WhatIsWrongIsRefusedWithItsPlace) {
  const auto refused = [](const std::string& lines) { return complaint(wet(lines)); };
  expect_refusals(refused, {{"fraction = 0.5", "d.toml:11: wet_back.index"},
                            {"index = 1.333", "d.toml:11: wet_back"},
                            {"index = 1.333\nfraction = 0.5\ndisc_mm = [1, 2, 3]", "d.toml:14: wet_back.disc_mm"},
                            {"index = 0.9\nfraction = 0.5", "d.toml:12: wet_back.index"},
                            {"index = 1.333\nfraction = 1.5", "d.toml:13: wet_back.fraction"},
                            {"index = 1.333\nfraction = 0.5\nseed = 0.5", "d.toml:14: wet_back.seed"},
                            {"index = 1.333\ndisc_mm = [1, 2, 3]\nseed = 1", "d.toml:14: wet_back.seed"},
                            {"index = 1.333\ndisc_mm = [1, 2, 0]", "d.toml:13: wet_back.disc_mm"},
                            {"index = 1.333\ndisc_mm = [1, 2]", "d.toml:13: wet_back.disc_mm"},
                            {"index = 1.333\nrectangle_mm = [1, 2, 1, 3]", "d.toml:13: wet_back.rectangle_mm"},
                            {"index = 1.333\nhalf_plane = [1, 2, 2000000]", "d.toml:13: wet_back.half_plane"},
                            {"index = 1.333\nhalf_plane = [1, 2, 90]", ""}});
}

TEST(WetBackDesign, ArraysAreFiniteAndStandOnAPlane) {
  const std::string lines = "index = 1.333\nfraction = 0.5\n";
  const auto refused = [&](const std::string& element, const std::string& array) {
    return complaint(design_of(element, array) + "[wet_back]\n" + lines);
  };
  EXPECT_EQ(refused(kRtp, "arrangement = \"aligned\"; extent = \"infinite\""), "d.toml:11: wet_back.index");
  EXPECT_EQ(refused(kHexagonal, "arrangement = \"single\""), "d.toml:9: wet_back.index");
  EXPECT_EQ(complaint(wet(lines + "[substrate]\nkind = \"sphere\"\nradius_mm = 100\n")), "d.toml:12: wet_back.index");
  EXPECT_EQ(complaint("[element]\nkind = \"ball\"\ndiameter_mm = 1\n[wet_back]\n" + lines), "d.toml:4: wet_back");
}

TEST(WetBackDesign, DesignsAreWrittenAsTheyWereRead) {
  for (const std::string where : {"fraction = 0.25\nseed = 7\n", "rectangle_mm = [1, 2, 3.5, 4]\n",
                                  "disc_mm = [1, 2, 0.3]\n", "half_plane = [1, 2, 30]\n"}) {
    const std::string text = design::design_text(read("index = 1.333\n" + where));
    EXPECT_NE(text.find("[wet_back]\nindex = 1.333\n" + where), std::string::npos) << text;
    EXPECT_EQ(design::design_text(design::parse_design(text, "again.toml")), text);
  }
}

// If no element or every element is wet, results and engines are the same as for a design with a uniform medium behind
// all elements.
TEST(WetBackDesign, NoShareAndAllAreTheWholeBack) {
  expect_same(rre(read("index = 1.333\nfraction = 0")), rre(set({})));
  expect_same(rre(read("index = 1.333\nfraction = 1")), rre(set({"body.back_index=1.333"})));
  expect_same(rre(read("index = 1.333\nrectangle_mm = [0, 0, 10, 10]", {"body.back_index=1.1"})),
              rre(set({"body.back_index=1.333"})));
}

TEST(WetBackDesign, PartlyWetBacksAreTracedByRays) {
  const design::Design design = read("index = 1.333\nhalf_plane = [5, 5, 0]");
  const RreResult result = rre(design);
  for (const RrePoint& point : result.points) EXPECT_EQ(point.engine, "embree");
  // Half of the 20 columns of elements return light like dry elements, and half like wet ones. Near the border, this is
  // only approximate, because rows are shifted.
  const double dry = rre(set({})).points[0].rre, wet = rre(set({"body.back_index=1.333"})).points[0].rre;
  EXPECT_NEAR(result.points[0].rre, 0.5 * (dry + wet), 0.03 * (dry - wet));
  for (const raytrace::Engine engine : {raytrace::Engine::exact, raytrace::Engine::cell})
    EXPECT_EQ(refusal_of([&, e = engine] { rre(design, e); }), "engine");
  RreSettings footprint;
  footprint.footprint = true;
  EXPECT_EQ(refusal_of([&] { RreStudy({design}, footprint); }), "d.toml:12: wet_back.index");
}

// Rows 1 and 3 have 10 wet elements each. Rows 2 and 4 are shifted and have 11 each: 10 up to the element at x = 5, and
// one that the border of the part cuts.
TEST(WetBackDesign, InspectionTellsWhichElementsAreWet) {
  const auto library = materials::MaterialLibrary::shipped();
  const Inspection some = inspect(read("index = 1.333\nrectangle_mm = [0, 0, 5, 2]"), library);
  ASSERT_TRUE(some.wet_back);
  EXPECT_EQ(some.wet_back->elements, 42);
  EXPECT_EQ(some.wet_back->of_all, some.elements_full + some.elements_partial);
  const std::string text = inspect_text(some);
  EXPECT_NE(text.find("wet back            " + std::to_string(some.wet_back->elements) +
                      " of 410 elements, index 1.333 behind their facets: x 0 to 5, y 0 to 2 mm\n"),
            std::string::npos)
      << text;
  const auto json = nlohmann::json::parse(inspect_json(some));
  EXPECT_EQ(json["wet_back"]["elements"], some.wet_back->elements);
  EXPECT_EQ(json["wet_back"]["refractive_index"], 1.333);
  EXPECT_EQ(json["design"]["wet_back"]["index"], 1.333);
  EXPECT_TRUE(some.tir_limit_deg);             // limit of the dry elements
  EXPECT_FALSE(some.wet_back->tir_limit_deg);  // no total reflection, because 1.333 > n sin 45 degrees
  EXPECT_FALSE(inspect(set({}), library).wet_back);
  EXPECT_FALSE(inspect(read("index = 1.333\nfraction = 1"), library).tir_limit_deg);
}

}  // namespace
}  // namespace retrace::studies::wet_back_test

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/app/program.h"

// Tests of `retrace rre --footprint` and `--far-field`: the files that they write and the options that they need.

namespace retrace::test::returned_light_test {
namespace {

const std::string kDesign = example("rtp_brick_2mm.toml");

Arguments exact(const Arguments& more) {
  Arguments arguments = {"rre", kDesign, "--engine=exact", "--incidence=0,1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(ReturnedLight, FilesAreWrittenAsAskedFor) {
  const Arguments plain = {"result", "result/rre.csv", "result/rre.json", "result/rre.png", "result/rre.svg"};
  for (const auto& [option, files] :
       {std::pair{"--footprint", Arguments{"result/footprint.json", "result/footprint.png", "result/footprint.svg"}},
        std::pair{"--far-field", Arguments{"result/far_field.csv", "result/far_field.json"}}}) {
    const TemporaryFolder folder;
    const Outcome outcome = retrace(folder, exact({option, "-o", "result"}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    Arguments expected = plain;
    expected.insert(expected.end(), files.begin(), files.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(folder.names(), expected);
    for (const std::string& file : files) EXPECT_NE(outcome.out.find("wrote " + file), std::string::npos);
  }
}

TEST(ReturnedLight, FootprintHoldsTheDirectionsOfTheResult) {
  const TemporaryFolder folder;
  ASSERT_EQ(retrace(folder, exact({"--footprint", "-o", "."})).code, 0);
  const Json footprint = folder.json("footprint.json");
  const Json rre = folder.json("rre.json");
  EXPECT_EQ(footprint["schema"], "retrace.footprint/2");
  EXPECT_EQ(footprint["version"], rre["version"]);
  EXPECT_EQ(footprint["warnings"], Json::array());
  EXPECT_EQ(footprint["complete"], true);
  ASSERT_EQ(footprint["regions"].size(), 2U);
  for (std::size_t k = 0; k < 2; ++k)
    for (const char* key : {"design", "incidence_deg", "azimuth_deg", "wavelength_nm", "acceptance_half_angle_deg"})
      EXPECT_EQ(footprint["regions"][k][key], rre["points"][k][key]) << key;
  EXPECT_NEAR(footprint["regions"][0]["active_fraction"].get<double>(), 1.0, 1e-9);
  EXPECT_LT(footprint["regions"][1]["active_fraction"].get<double>(), 0.88) << "the halves are dead";
  EXPECT_NEAR(footprint["regions"][1]["rre_shown"].get<double>(), rre["points"][1]["rre"].get<double>(), 1e-3);
  EXPECT_TRUE(folder.read("footprint.png").starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_NE(folder.read("footprint.svg").find("</svg>"), std::string::npos);
}

TEST(ReturnedLight, FarFieldHoldsWhatLeavesTheFace) {
  const TemporaryFolder folder;
  ASSERT_EQ(retrace(folder, exact({"--far-field", "-o", "."})).code, 0);
  const Json field = folder.json("far_field.json");
  EXPECT_EQ(field["schema"], "retrace.far_field/1");
  ASSERT_EQ(field["directions"].size(), 2U);
  // At normal incidence, the entrance face and the elements return light only to the source.
  EXPECT_EQ(field["directions"][0]["spots"][0]["deviation_arcmin"], 0);
  EXPECT_EQ(field["directions"][0]["spots"][0]["depth_min"], 0);
  const std::vector<std::string> csv = lines_of(folder.read("far_field.csv"));
  std::size_t spots = 0;
  for (const Json& direction : field["directions"]) spots += direction["spots"].size();
  EXPECT_EQ(csv.size(), spots + 1);
}

TEST(ReturnedLight, SameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  for (const char* threads : {"1", "3"})
    ASSERT_EQ(retrace(folder, exact({"--footprint", "--far-field", "--threads", threads, "-o", threads})).code, 0);
  for (const std::string file :
       {"/footprint.json", "/footprint.svg", "/footprint.png", "/far_field.json", "/far_field.csv"})
    EXPECT_EQ(folder.read("1" + file), folder.read("3" + file)) << file;
}

TEST(ReturnedLight, ManyDirectionsAreWrittenButNotAllDrawn) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"rre", example("rtp_single_10mm.toml"), "--engine=exact",
                                           "--incidence=0:2.4:0.1", "--footprint", "-o", "."});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;
  EXPECT_EQ(folder.json("footprint.json")["regions"].size(), 25U);
  EXPECT_EQ(folder.json("rre.json")["warnings"].size(), 1U);
}

TEST(ReturnedLight, NeedsAnOutputFolder) {
  expect_refused(TemporaryFolder(), {{{"--footprint"}, "--footprint"}, {{"--far-field", "--json", "-"}, "--far-field"}},
                 exact({}), {});
}

TEST(ReturnedLight, NeedsTheExactEngine) {
  expect_refused(
      TemporaryFolder(),
      {{{"--engine=montecarlo", "--footprint"}, "--footprint"}, {{"--engine=embree", "--far-field"}, "--far-field"}},
      {"rre", kDesign}, {"-o", "result"});
}

}  // namespace
}  // namespace retrace::test::returned_light_test

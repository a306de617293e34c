// Tests of `retrace verify` for planed and turned parts: programs of all examples in all dialects, and refused input.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/app/program.h"

namespace retrace::test::verify_parts_test {
namespace {

const Arguments kDialects = {"rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"};

class VerifyParts : public ::testing::Test {
 protected:
  Json verified(Arguments arguments, int code = 0) {
    arguments.insert(arguments.begin(), "verify");
    arguments.insert(arguments.end(), {"--json", "-"});
    const Outcome outcome = retrace(folder_, arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err << outcome.out.substr(0, 2000);
    return outcome.out.empty() ? Json() : Json::parse(outcome.out);
  }

  TemporaryFolder folder_;
};

TEST_F(VerifyParts, ProgramsOfPlaneInAllDialects) {
  const std::string mill = example("planing/zone_lens_60ghz.toml");
  // With a PMAC control, the file of a lathe must contain the lines that start and stop the spindle.
  std::string lathe = read_text(example("planing/round_zone_lens.toml"));
  folder_.write("lathe.toml", lathe + "spindle_start = \"M103\"\nspindle_stop = \"M105\"\n");
  for (const std::string& part : {mill, std::string("lathe.toml")})
    for (const std::string& dialect : kDialects) {
      const Outcome made = retrace(folder_, {"plane", part, "--dialect", dialect, "-o", dialect, "--quiet"});
      ASSERT_EQ(made.code, 0) << made.err;
      const Json planed = folder_.json(dialect + "/planing.json");
      Arguments programs = {part};
      for (const Json& program : planed["programs"])
        programs.push_back(dialect + "/" + program["program"].get<std::string>());
      const Json json = verified(programs);
      EXPECT_EQ(json["schema"], "retrace.verification/2");
      EXPECT_EQ(json["verdict"], "pass");
      EXPECT_EQ(json["process"], "planing");
      EXPECT_EQ(json["programs"][0]["dialect"], dialect);
      EXPECT_EQ(json["form_error_mm_max"], planed["form_error_mm_max"]);
      EXPECT_EQ(json["programs"][0]["blocks"], planed["programs"][0]["blocks"]);
      std::filesystem::remove_all(folder_.path() / dialect);
    }
}

TEST_F(VerifyParts, ProgramsOfTurnInAllDialects) {
  const std::string part = example("turning/flat_raster.toml");
  ASSERT_EQ(retrace(folder_, {"turn", part, "-o", "out", "--quiet"}).code, 0);
  const Json turned = folder_.json("out/turning.json");
  for (const Json& program : turned["programs"]) {
    const Json json = verified({part, "out/" + program["file"].get<std::string>()});
    EXPECT_EQ(json["verdict"], "pass");
    EXPECT_EQ(json["process"], "turning");
    EXPECT_EQ(json["programs"][0]["dialect"], program["dialect"]);
    for (const char* key : {"form_error_nm", "interference_nm", "scallop_nm", "block_low_nm", "step_um_max"})
      // Fanuc programs contain increments. Their sums differ in the last digits.
      EXPECT_NEAR(json[key].get<double>(), turned["verification"][key].get<double>(), 1e-3) << key;
  }
}

TEST_F(VerifyParts, EditedProgramsHaveFindingsWithTheirLines) {
  const std::string part = example("turning/flat_raster.toml");
  ASSERT_EQ(retrace(folder_, {"turn", part, "-o", "out", "--quiet"}).code, 0);
  std::vector<std::string> lines = lines_of(folder_.read("out/part.ngc"));
  const std::size_t at = 40;
  ASSERT_TRUE(lines[at].starts_with("G1 X")) << lines[at];
  const std::size_t z = lines[at].find(" Z") + 2;
  lines[at] = lines[at].substr(0, z) + "-0.060000" + lines[at].substr(lines[at].find(" F"));
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  folder_.write("edited.ngc", text);
  const Json json = verified({part, "edited.ngc"}, 1);
  EXPECT_EQ(json["verdict"], "fail");
  ASSERT_FALSE(json["findings"].empty());
  const auto is_here = [&](const Json& f) {
    return f["kind"] == "gouge" && f.value("line", 0) == static_cast<int>(at) + 1;
  };
  EXPECT_TRUE(std::any_of(json["findings"].begin(), json["findings"].end(), is_here)) << json["findings"].dump(1);
  const Outcome table = retrace(folder_, {"verify", part, "edited.ngc", "-o", "checked"});
  EXPECT_EQ(table.code, 1);
  EXPECT_NE(table.out.find("edited.ngc:41: gouge: "), std::string::npos) << table.out;
  EXPECT_EQ(folder_.json("checked/verification.json")["verdict"], "fail");
}

TEST_F(VerifyParts, BadInputIsOneLine) {
  const std::string raster = example("turning/flat_raster.toml");
  const std::string lens = example("planing/zone_lens_60ghz.toml");
  folder_.write("p.ngc", "%\nG21 G90\nG0 Z1\nM2\n%\n");
  folder_.write("wrong.ngc", "%\nG21 G90\nG0 Q1\nM2\n%\n");
  folder_.write("none.ngc", "nothing\n");
  folder_.write("other.toml", "schema = \"retrace.design/1\"\n");
  folder_.write("newer.toml", "\nschema = \"retrace.turned_part/2\"\n");
  folder_.write("broken.toml", "schema = [\n");
  folder_.write("fast.toml",
                "schema = \"retrace.turned_part/1\"\n[base]\nkind = \"plane\"\n[tool]\nnose_radius_mm = "
                "0.2\nclearance_deg = 15\n[path]\nradius_mm = 0.1\nfeed_um = 10\nspindle_rpm = 60\nservo = \"fast\"\n");
  folder_.write("strokes.csv", "c_deg,stroke_mm\n0,x\n");
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"other.toml", "p.ngc"}, "other.toml:1: schema"},
      {{"newer.toml", "p.ngc"}, "newer.toml:2: schema"},
      {{"broken.toml", "p.ngc"}, "broken.toml:1"},
      {{"missing.toml", "p.ngc"}, "missing.toml"},
      {{raster, "missing.ngc"}, "missing.ngc"},
      {{raster, "wrong.ngc"}, "wrong.ngc:3"},
      {{lens, "wrong.ngc"}, "wrong.ngc:3"},
      {{lens, "none.ngc"}, "none.ngc"},
      {{lens, "p.ngc", "--dialect", "heidenhain"}, "--dialect"},
      {{lens, "p.ngc", "--tolerance-nm", "10"}, "--tolerance-nm"},
      {{lens, "p.ngc", "--map", "m.png"}, "--map"},
      {{raster, "p.ngc", "--as-machined", "m.toml"}, "--as-machined"},
      {{lens, "p.ngc", "--servo", "strokes.csv"}, "--servo"},
      {{raster, "p.ngc", "--servo", "strokes.csv"}, "--servo"},
      {{"fast.toml", "p.ngc"}, "--servo"},
      {{"fast.toml", "p.ngc", "--servo", "strokes.csv"}, "strokes.csv:2: stroke_mm"},
      {{raster, "p.ngc", "--json", "p.ngc"}, "--json"}};
  const std::vector<std::string> before = folder_.names();
  for (const auto& [given, message] : cases) {
    Arguments arguments = given;
    arguments.insert(arguments.begin(), "verify");
    arguments.insert(arguments.end(), {"-o", "out"});
    EXPECT_EQ(refused_at(retrace(folder_, arguments)), message);
    EXPECT_EQ(folder_.names(), before);
  }
}

TEST_F(VerifyParts, AProgramWithoutCutsFails) {
  folder_.write("p.ngc", "%\nG17 G21 G40 G49 G80 G90 G94\nG54 G61 G92.1\nM5\nG0 Z20\nM2\n%\n");
  for (const char* part :
       {"turning/flat_raster.toml", "planing/zone_lens_60ghz.toml", "planing/round_zone_lens.toml"}) {
    const Json json = verified({example(part), "p.ngc"}, 1);
    EXPECT_FALSE(json["findings"].empty());
  }
}

}  // namespace
}  // namespace retrace::test::verify_parts_test

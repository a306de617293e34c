// Tests of `retrace turn`: its files, its verdict, and refused input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/app/program.h"

namespace retrace::test::turn_command_test {
namespace {

const std::string kHead = "schema = \"retrace.turned_part/1\"\n";
const std::string kBase = "[base]\nkind = \"formula\"\nformula = \"0.05*x^2-0.08*y^2\"\n";
const std::string kTool = "[tool]\nnose_radius_mm = 0.2\nclearance_deg = 15\n";
const std::string kPath = "[path]\nradius_mm = 0.6\nfeed_um = 10\nspindle_rpm = 60\n";
const std::string kPart = kHead + kBase + kTool + kPath + "points_per_turn = 900\n";

class Turn : public ::testing::Test {
 protected:
  TemporaryFolder folder_;

  Json turned(const std::string& text, int code = 0) {
    folder_.write("part.toml", text);
    const Outcome outcome = retrace(folder_, {"turn", "part.toml", "--json", "-", "-o", "out"});
    EXPECT_EQ(outcome.code, code) << outcome.err;
    return Json::parse(outcome.out);
  }
};

TEST_F(Turn, WritesProgramsInAllDialectsAndInspectsThem) {
  const Json json = turned(kPart);
  EXPECT_EQ(json["schema"], "retrace.turning/2");
  EXPECT_EQ(json["points"], 60 * 900 + 1);
  EXPECT_NEAR(json["time_s"].get<double>(), 60.0, 1e-6);
  EXPECT_EQ(json["verification"]["verdict"], "pass");
  EXPECT_LT(json["verification"]["form_error_nm"].get<double>(), 1.0);
  EXPECT_GT(json["verification"]["scallop_ratio_low"].get<double>(), 0.98);
  EXPECT_LT(json["verification"]["scallop_ratio_high"].get<double>(), 1.02);
  EXPECT_TRUE(json["complete"].get<bool>());
  ASSERT_EQ(json["programs"].size(), 6U);
  for (const Json& program : json["programs"])
    EXPECT_GT(folder_.read("out/" + program["file"].get<std::string>()).size(), 1000000U);
  EXPECT_EQ(folder_.json("out/turning.json"), json);
  EXPECT_TRUE(folder_.read("out/path.csv").starts_with("time_s,x_mm,y_mm,z_mm,c_deg,"));
  EXPECT_TRUE(folder_.read("out/cusps.csv").starts_with("x_mm,y_mm,scallop_nm,predicted_nm,valley_nm\n"));
  for (const char* name : {"out/acceleration.svg", "out/profile.svg"})
    EXPECT_NE(folder_.read(name).find("<svg"), std::string::npos) << name;
  EXPECT_TRUE(folder_.read("out/maps.png").starts_with("\x89PNG"));
}

TEST_F(Turn, ControlsThatJoinPointsByCubicsGetFewMoves) {
  const Json json = turned(kPart + "cubic_error_nm = 1\n[machine]\nc_acceleration_deg_per_s2 = 1000\n");
  EXPECT_EQ(json["verification"]["verdict"], "pass");
  const Json& cubics = json["cubics"];
  EXPECT_LE(cubics["error_nm"].get<double>(), 1.0);
  EXPECT_LT(20 * cubics["moves"].get<int>(), json["points"].get<int>());
  EXPECT_LT(10 * cubics["bytes"].get<int>(), cubics["bytes_of_straight_moves"].get<int>());
  EXPECT_LT(cubics["form_error_nm"].get<double>(), 2.0);
  for (const char* file : {"part.pmc", "part.pgm", "part.ascript", "part.ngc"}) {
    const Outcome verified = retrace(folder_, {"verify", "part.toml", std::string("out/") + file});
    EXPECT_EQ(verified.code, 0) << verified.out;
  }
}

TEST_F(Turn, WritesNothingWithoutAFolder) {
  folder_.write("part.toml", kHead + kBase + kTool + kPath + "points_per_turn = 90\n");
  const Outcome outcome = retrace(folder_, {"turn", "part.toml"});
  EXPECT_EQ(outcome.code, 1) << "chords of 90 points a turn are longer than 10 nm: " << outcome.out;
  EXPECT_NE(outcome.out.find("form error"), std::string::npos);
  EXPECT_EQ(folder_.names().size(), 1U);
}

TEST_F(Turn, WhatIsLeftCanBeTraced) {
  // A plane with cusps of 0.6 nm acts as a plane plate, which returns 2 R / (1 + R) at normal incidence.
  const Json json =
      turned(kHead + "[base]\nkind = \"plane\"\n[tool]\nnose_radius_mm = 0.2\nclearance_deg = 15\n[path]\n" +
             "radius_mm = 0.1\nfeed_um = 1\nspindle_rpm = 60\n[inspect]\nmesh_thickness_mm = "
             "0.5\nmesh_rings = 20\n");
  EXPECT_EQ(json["verification"]["verdict"], "pass");
  folder_.write("plate.toml", "[part]\nmesh = \"out/machined.stl\"\n[body]\nrefractive_index = 1.4917\n");
  const Json rre = retrace_json(folder_, {"rre", "plate.toml", "--engine", "embree", "--samples", "4096"});
  const double r = std::pow(0.4917 / 2.4917, 2);
  EXPECT_NEAR(rre["points"][0]["rre"].get<double>(), 2.0 * r / (1.0 + r), 1e-3);
  double sum = 0.0;
  for (const auto& account : rre["points"][0]["ledger"]) sum += account.get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-6);
}

TEST_F(Turn, AFastServoSharesTheStroke) {
  const Json json = turned(kPart + "servo = \"fast\"\n[machine.servo]\nacceleration_mm_per_s2 = 1e-3\n", 1);
  EXPECT_LT(json["verification"]["form_error_nm"].get<double>(), 1.0);
  ASSERT_EQ(json["verification"]["findings"].size(), 1U);
  EXPECT_NE(json["verification"]["findings"][0].get<std::string>().find("servo: acceleration"), std::string::npos);
  const std::string servo = folder_.read("out/servo.csv");
  EXPECT_EQ(std::count(servo.begin(), servo.end(), '\n'), 60 * 900 + 2);
  EXPECT_LT(json["axes"]["z"]["acceleration_mm_per_s2"].get<double>(),
            0.1 * json["axes"]["servo"]["acceleration_mm_per_s2"].get<double>());
}

TEST_F(Turn, FindsTheLeastSkew) {
  const Json json = turned(kHead +
                           "[base]\nkind = \"formula\"\nformula = \"sqrt(1-x^2)-1\"\n[tool]\nnose_radius_mm = "
                           "0.1\nclearance_deg = 12\nfind_min_skew = true\n[path]\nradius_mm = 0.766\nfeed_um = "
                           "50\nspindle_rpm = 60\nsampling = \"arc\"\narc_um = 4\n");
  EXPECT_NEAR(json["tool"]["skew_deg"].get<double>(), -27.2, 0.05);
  EXPECT_LE(json["tool"]["clearance_needed_deg"].get<double>(), 12.0);
}

TEST_F(Turn, FindsTheLeastSkewOfARaster) {
  // For a slope of 18 degrees along the lines, the skew s must satisfy sin 18 cos s <= sin 12, where 12 degrees is the
  // clearance angle of the tool.
  const Json json = turned(kHead +
                           "[base]\nkind = \"formula\"\nformula = \"0.325*y\"\n[tool]\nnose_radius_mm = "
                           "0.1\nclearance_deg = 12\nfind_min_skew = true\n[path]\nstrategy = \"raster\"\nsize_mm = "
                           "[0.4, 0.4]\nfeed_um = 20\narc_um = 4\ncutting_mm_per_min = 60\n");
  const double slope = std::atan(0.325);
  const double skew = std::acos(std::sin(12.0 * std::numbers::pi / 180.0) / std::sin(slope)) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(std::abs(json["tool"]["skew_deg"].get<double>()), skew, 0.05);
  EXPECT_EQ(json["verification"]["verdict"], "pass");
}

TEST_F(Turn, WarnsOfUntriedTools) {
  folder_.write("part.toml", kHead + "[base]\nkind = \"plane\"\n" + kTool + "skew_deg = 65\n" + kPath);
  const Outcome outcome = retrace(folder_, {"turn", "part.toml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;
}

TEST_F(Turn, BadInputEndsWithOneLineAndWritesNothing) {
  const std::string rest = kTool + kPath;
  const auto base = [&](const std::string& text) { return kHead + "[base]\n" + text + rest; };
  const auto formula = [&](const std::string& text) {
    return base("kind = \"formula\"\nformula = \"" + text + "\"\n");
  };
  const auto boundary = [&](const std::string& text) { return kHead + kBase + "[boundary]\n" + text + rest; };
  const auto lenslets = [&](const std::string& text) { return kHead + kBase + "[lenslets]\n" + text + rest; };
  const std::string cap =
      "positions_mm = [[0.1, 0.1]]\nkind = \"conic\"\nradius_mm = -1\nheight_mm = 0.01\nboundary = ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "part.toml: schema"},
      {kHead + kBase + kTool, "part.toml: path"},
      {formula("x +"), "part.toml:4: base.formula"},
      {formula("x + q"), "part.toml:4: base.formula"},
      {formula("sqrt(0.1-x^2-y^2)"), "part.toml:2: base"},
      {formula("sqrt(0.7-x^2)"), "part.toml:7: tool.clearance_deg"},
      {formula("tanh(200*x)"), "part.toml:2: base"},
      {formula("0.4*x+3*x*y"), "part.toml:7: tool.clearance_deg"},
      {base("kind = \"sphere\"\n"), "part.toml:3: base.kind"},
      {base("kind = \"conic\"\nradius_mm = 0\n"), "part.toml:4: base.radius_mm"},
      {base("kind = \"plane\"\nradius = 3\n"), "part.toml:4: base.radius"},
      {base("kind = \"zernike\"\naperture_radius_mm = 1\nterms = [[3, 0, 1e-3]]\n"), "part.toml:5: base.terms"},
      {base("kind = \"xy_polynomial\"\nterms = [[1.5, 0, 1e-3]]\n"), "part.toml:4: base.terms"},
      {base("kind = \"asphere\"\nradius_mm = 5\neven = [[5, 1e-3]]\n"), "part.toml:5: base.even"},
      {boundary("kind = \"points\"\npoints_mm = [[1,0],[0,1],[-1,0],[0.9,0.1],[0,-1],[0.5,-0.5]]\n"),
       "part.toml:7: boundary.points_mm"},
      {boundary("kind = \"points\"\npoints_mm = [[1,0],[0,1]]\n"), "part.toml:7: boundary.points_mm"},
      {boundary("kind = \"formula\"\nformula = \"cos(theta)\"\n"), "part.toml:7: boundary.formula"},
      {boundary("kind = \"circle\"\nradius_mm = -1\n"), "part.toml:7: boundary.radius_mm"},
      {kHead + kBase + "[extrapolation]\norder = 2\n" + rest, "part.toml:5: extrapolation"},
      {boundary("kind = \"circle\"\nradius_mm = 1\n[extrapolation]\norder = 0\n"), "part.toml:9: extrapolation.order"},
      {lenslets(cap + "\"circle\"\nboundary_radius_mm = 0.1\ninner_radius_ratio = 1\nouter_radius_ratio = 0.9\n"),
       "part.toml:13: lenslets.outer_radius_ratio"},
      {lenslets(cap + "\"intersection\"\nsearch_mm = 0.01\ninner_radius_ratio = 0.8\nouter_radius_ratio = 1.1\n"),
       "part.toml:10: lenslets.boundary"},
      {lenslets(
           "positions_mm = [[0.1, 0.1], [0.2, 0.1]]\nkind = \"plane\"\nboundary = \"circle\"\nboundary_radius_mm = "
           "0.1\ninner_radius_ratio = 0.8\nouter_radius_ratio = 1.1\n"),
       "part.toml:5: lenslets"},
      {kHead + kBase + kTool + "[path]\nradius_mm = 1\nspindle_rpm = 60\n", "part.toml:8: path"},
      {kHead + kBase + kTool + "[path]\nradius_mm = 1\nfeed_um = 1\nscallop_nm = 3\nspindle_rpm = 60\n",
       "part.toml:11: path.scallop_nm"},
      {kHead + kBase + kTool + kPath + "sampling = \"arc\"\narc_um = 5\nservo = \"fast\"\n",
       "part.toml:14: path.servo"},
      {kHead + kBase + "[tool]\nnose_radius_mm = 0\nclearance_deg = 15\n" + kPath, "part.toml:6: tool.nose_radius_mm"},
      {kHead + "[base]\nkind = \"formula\"\nformula = \"sqrt(1-x^2)-1\"\n[tool]\nnose_radius_mm = 0.1\nclearance_deg = "
               "0.3\nfind_min_skew = true\n[path]\nradius_mm = 0.8\nfeed_um = 10\nspindle_rpm = 60\n",
       "part.toml:7: tool.clearance_deg"},
      {kHead + "[base]\nkind = \"plane\"\n" + kTool +
           "[path]\nstrategy = \"raster\"\nsize_mm = [1, 1]\nfeed_um = 10\narc_um = "
           "10\ncutting_mm_per_min = 60\n[inspect]\nmesh_thickness_mm = 1\n",
       "part.toml:14: inspect.mesh_thickness_mm"},
      {kHead + "[base]\nkind = \"plane\"\n" + kTool +
           "[path]\nstrategy = \"raster\"\nsize_mm = [1, 1]\nfeed_um = 10\narc_um = 10\ncutting_mm_per_min = 4e-4\n",
       "part.toml:12: path.cutting_mm_per_min"},
      {kHead + kBase + kTool + kPath + "[machine.x]\ntravel_mm = [3, 1]\n", "part.toml:13: machine.x.travel_mm"},
      {kHead + kBase + kTool + "[path]\nradius_mm = 0.6\nfeed_um = 0.001\nspindle_rpm = 60\n", "part.toml: path"}};
  for (const auto& [text, place] : cases) {
    folder_.write("part.toml", text);
    const Outcome outcome = retrace(folder_, {"turn", "part.toml", "-o", "out"});
    EXPECT_EQ(refused_at(outcome), place) << text;
    EXPECT_EQ(folder_.names().size(), 1U);
  }
  EXPECT_EQ(retrace(folder_, {"turn", "nothing.toml"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"turn"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"turn", "part.toml", "--set", "a=1"}).code, 2);
}

}  // namespace
}  // namespace retrace::test::turn_command_test

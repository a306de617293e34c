// Tests of the program with shells: design files, all commands that support shells, commands that refuse them, and
// invalid keys.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/app/program.h"

namespace retrace::test::shell_test {
namespace {

const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 2\n[array]\nx_length_mm = 16\ny_length_mm = 12\n"
    "[body]\nthickness_mm = 1.5\nrefractive_index = 1.49\nabsorption_per_mm = 0\n";
const std::string kEndless =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 3\n[array]\nextent = \"infinite\"\n"
    "[body]\nthickness_mm = 1.5\nrefractive_index = 1.49\nabsorption_per_mm = 0\n[light]\nwavelength_nm = 600\n";
const std::string kClear = "refractive_index = 1.5\nabsorption_per_mm = 0\n";
const std::string kPlate = "[[shell]]\nthickness_mm = 2\ngap_mm = 5\n" + kClear;
const std::string kLens = kPlate + "outer_radius_mm = 60\ninner_radius_mm = 55\n";

/// Returns the power transmittance of a surface of index 1.5 (Born and Wolf, 1.5.2).
double through_face(double incidence_deg, bool s_polarised) {
  const double a = incidence_deg * std::numbers::pi / 180.0;
  const double b = std::asin(std::sin(a) / 1.5);
  if (a < 1e-9) return 0.96;
  const double r = s_polarised ? std::sin(a - b) / std::sin(a + b) : std::tan(a - b) / std::tan(a + b);
  return 1.0 - r * r;
}

double total(const Json& point) {
  double sum = 0.0;
  for (const auto& [account, power] : point["ledger"].items()) sum += power.get<double>();
  return sum;
}

class Shell : public ::testing::Test {
 protected:
  TemporaryFolder folder_;

  Json run(const std::string& design, const Arguments& arguments) {
    folder_.write("design.toml", design);
    return retrace_json(folder_, arguments);
  }
  Json rre(const std::string& design, const Arguments& more) { return run(design, with({"rre", "design.toml"}, more)); }

  /// Returns the position, as `file:line: key`, of the error that the program reports for a design.
  std::string refusal(const std::string& design, const Arguments& command = {"rre", "design.toml", "-o", "out"}) {
    folder_.write("design.toml", design);
    const auto before = folder_.names();
    const Outcome outcome = retrace(folder_, command);
    EXPECT_EQ(folder_.names(), before);
    return refused_at(outcome);
  }
};

TEST_F(Shell, OfIndexOneChangesNothing) {
  const std::string nothing = "[[shell]]\nthickness_mm = 2\ngap_mm = 5\nrefractive_index = 1\nabsorption_per_mm = 0\n";
  for (const std::string engine : {"exact", "embree", "cell"}) {
    Arguments how = {"--engine", engine, "--incidence=0,25", "--azimuth=20"};
    if (engine != "exact") how = with(how, {"--samples", "4096"});
    const Json bare = rre(kEndless, how);
    const Json behind = rre(kEndless + nothing, how);
    EXPECT_EQ(behind["engine"], engine);
    for (std::size_t k = 0; k < 2; ++k)
      for (const auto& [account, power] : bare["points"][k]["ledger"].items())
        EXPECT_NEAR(behind["points"][k]["ledger"][account].get<double>(), power.get<double>(), 1e-12) << account;
  }
}

// A plate multiplies the efficiency at normal incidence by the transmittance of four surfaces. The light that the shell
// reflects is in the ledger and in a column of the table.
TEST_F(Shell, PlateMultipliesTheEfficiency) {
  const double factor = std::pow(0.96, 4.0);
  const Json bare = rre(kEndless, {"--incidence=0"});
  const Json behind = rre(kEndless + kPlate, {"--incidence=0", "-o", "out"});
  EXPECT_EQ(behind["points"][0]["engine"], "exact");
  EXPECT_NEAR(behind["points"][0]["rre"].get<double>(), factor * bare["points"][0]["rre"].get<double>(), 1e-6);
  EXPECT_NEAR(total(behind["points"][0]), 1.0, 1e-9);
  EXPECT_GT(behind["points"][0]["ledger"]["shell_reflected"].get<double>(), 0.1);
  EXPECT_FALSE(bare["points"][0]["ledger"].contains("shell_reflected"));
  EXPECT_NE(lines_of(folder_.read("out/rre.csv"))[0].find(",lost,shell_reflected,engine"), std::string::npos);
}

TEST_F(Shell, LensIsTracedByRays) {
  const Json json = rre(kCubes + kLens, {"--incidence=0,20", "--samples", "16384"});
  EXPECT_EQ(json["engine"], "embree");
  for (const Json& point : json["points"]) {
    EXPECT_NEAR(total(point), 1.0, 1e-9);
    EXPECT_EQ(point["ledger"]["lost"], 0.0);
    EXPECT_GT(point["rre"].get<double>(), 0.01);
  }
}

// Result files contain the design with the keys of its shells, including their defaults.
TEST_F(Shell, DesignsKeepTheirShells) {
  const std::string tilted =
      "[[shell]]\nthickness_mm = 2\ngap_mm = 4\nmaterial = \"PC\"\ntilt_deg = [3, -4]\n"
      "absorption_per_mm = [[400, 0.1], [700, 0.02]]\n";
  const Json json = rre(kCubes + tilted + kLens, {"--samples", "64"});
  const Json& shells = json["designs"][0]["shell"];
  ASSERT_EQ(shells.size(), 2U);
  EXPECT_EQ(shells[0]["material"], "PC");
  EXPECT_EQ(shells[0]["tilt_deg"], Json::array({3.0, -4.0}));
  EXPECT_EQ(shells[0]["absorption_per_mm"][1], Json::array({700.0, 0.02}));
  EXPECT_EQ(shells[1]["outer_radius_mm"], 60.0);
  EXPECT_EQ(shells[1]["wedge_deg"], Json::array({0.0, 0.0}));
}

// Behind a plate, photometry computes diffraction and gives a verdict. The plate multiplies each intensity by a factor
// between the factors for s- and p-polarised light.
TEST_F(Shell, PhotometryBehindAPlateHasAVerdict) {
  folder_.write("limits.csv",
                "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n"
                "S,,white,0.33,10,0,1,mcd/lx,confirmed\nS,,white,0.33,5,20,1,mcd/lx,confirmed\n");
  const Arguments how = {"photometry", "design.toml", "--standard", "limits.csv", "--area-cm2", "30",
                         "--light",    "design",      "--json",     "-",          "--no-advice"};
  folder_.write("design.toml", kEndless);
  const Json bare = Json::parse(retrace(folder_, how).out);
  folder_.write("design.toml", kEndless + kPlate);
  const Outcome outcome = retrace(folder_, how);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json behind = Json::parse(outcome.out);
  EXPECT_EQ(behind["engine"], bare["engine"]);
  EXPECT_EQ(behind["verdict"], "pass");
  for (std::size_t k = 0; k < 2; ++k) {
    const double factor =
        behind["points"][k]["value_mcd_per_lx"].get<double>() / bare["points"][k]["value_mcd_per_lx"].get<double>();
    const double incidence_deg = k == 0 ? 10.0 : 20.6;
    const double s = std::pow(through_face(incidence_deg, true), 4.0);
    const double p = std::pow(through_face(incidence_deg, false), 4.0);
    EXPECT_GT(factor, s - 1e-3) << k;
    EXPECT_LT(factor, p + 1e-3) << k;
  }
}

TEST_F(Shell, PhotometryBehindALensTracesRays) {
  folder_.write("limits.csv",
                "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n"
                "S,,white,0.33,10,0,1,mcd/lx,confirmed\n");
  folder_.write("design.toml", kCubes + kLens);
  const Outcome outcome = retrace(folder_, {"photometry", "design.toml", "--standard", "limits.csv", "--area-cm2", "30",
                                            "--light", "design", "--json", "-", "--no-advice", "--samples", "4096"});
  ASSERT_LT(outcome.code, 2) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["engine"], "embree");
  EXPECT_GT(json["points"][0]["value_mcd_per_lx"].get<double>(), 0.0);
}

TEST_F(Shell, InspectDescribesAndDrawsThem) {
  folder_.write("design.toml", kCubes + kLens);
  const Outcome outcome = retrace(folder_, {"inspect", "design.toml", "-o", "out"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json shell = folder_.json("out/inspect.json")["shells"][0];
  // The corners of the part are 10 mm from its middle.
  const auto sag = [](double radius) { return radius - std::sqrt(radius * radius - 100.0); };
  EXPECT_NEAR(shell["min_thickness_mm"].get<double>(), 2.0, 1e-9);
  EXPECT_NEAR(shell["max_thickness_mm"].get<double>(), 2.0 - sag(60.0) + sag(55.0), 1e-9);
  EXPECT_NEAR(shell["min_gap_mm"].get<double>(), 5.0 - sag(55.0), 1e-9);
  EXPECT_NEAR(shell["transmittance"].get<double>(), 0.96 * 0.96, 1e-9);
  EXPECT_TRUE(shell["deflects_light"].get<bool>());
  EXPECT_NE(folder_.read("out/shells.svg").find("<svg"), std::string::npos);
}

// An emitter is placed in front of the shells. Its light crosses the shells on its way to the part and back.
TEST_F(Shell, RaysPassThem) {
  const std::string plate =
      "[part]\nplate_mm = [20, 20]\n[body]\nthickness_mm = 1\nfacet_coating = \"aluminium\"\n"
      "refractive_index = 1\nabsorption_per_mm = 0\n[idealisation]\nfacets = \"mirror\"\n";
  const Arguments how = {"rays", "design.toml", "--emitter", "collimated", "--disc-mm",
                         "4",    "--rays",      "500",       "--split",    "1e-6"};
  const Json bare = run(plate, how);
  const Json behind = run(plate + kPlate, how);
  EXPECT_NEAR(behind["ledger"]["retroreflected"].get<double>(),
              std::pow(0.96, 4.0) * bare["ledger"]["retroreflected"].get<double>(), 1e-6);
  EXPECT_GT(behind["ledger"]["shell_reflected"].get<double>(), 0.1);
}

// The light crosses the plate on its way to the part and on its way back, so it passes four surfaces of the plate in
// total.
TEST_F(Shell, CameraSeesThePartThroughThem) {
  const Arguments camera = {"image",          "design.toml", "--camera", "--observation-deg=0", "--no-diffraction",
                            "--pixels=40x30", "--passes=16"};
  const Json bare = run(kCubes, camera);
  const Json behind = run(kCubes + kPlate, camera);
  const double expected = std::pow(0.96, 4.0) * bare["part_luminance_cd_per_m2"].get<double>();
  const double error =
      std::hypot(bare["part_std_error_cd_per_m2"].get<double>(), behind["part_std_error_cd_per_m2"].get<double>());
  EXPECT_LT(error, 0.02 * expected);
  EXPECT_NEAR(behind["part_luminance_cd_per_m2"].get<double>(), expected, 4.0 * error);
  folder_.write("design.toml", kCubes + kPlate);
  const Outcome outcome =
      retrace(folder_, {"image", "design.toml", "--camera", "--observation-deg=0", "--pixels=8x6", "--passes=2"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;  // the warning states that the picture has no diffraction
  EXPECT_EQ(refusal(kEndless + kPlate, {"image", "design.toml", "--camera", "-o", "out"}),
            "design.toml:5: array.extent");
}

// The light of a headlamp crosses the four surfaces of the plate, at angles of incidence below a degree.
TEST_F(Shell, RoadsShowThePartBehindThem) {
  const Arguments road = {"image", "design.toml", "--road", "--road-distance-m=100"};
  const auto r_a = [&](const std::string& design) {
    return run(design, road)["views"][0]["reflectors"][0]["r_a_cd_per_lx_m2"][0].get<double>();
  };
  EXPECT_NEAR(r_a(kCubes + kPlate) / r_a(kCubes), std::pow(0.96, 4.0), 1e-3);
}

TEST_F(Shell, OthersRefuseThem) {
  const std::string design = kCubes + kPlate;
  const std::string where = "design.toml:11: shell[1]";
  EXPECT_EQ(refusal(kCubes + kLens, {"rre", "design.toml", "--engine=exact"}), "--engine");
  EXPECT_EQ(refusal(kCubes + kLens, {"rre", "design.toml", "--engine=cell"}), "--engine");
  for (const char* option : {"--footprint", "--far-field", "--derivatives"})
    EXPECT_EQ(refusal(kCubes + kLens, {"rre", "design.toml", option, "-o", "out"}), where);
  EXPECT_EQ(refusal(design, {"image", "design.toml", "--detector", "-o", "out"}), where);
  EXPECT_EQ(refusal(design, {"export", "design.toml", "out.stl"}), where);
  EXPECT_EQ(refusal(design, {"explore", "design.toml", "-o", "out.html"}), where);
  EXPECT_EQ(refusal(design, {"job", "design.toml", "--tool-width-mm=0.2", "-o", "job.toml"}), where);
}

TEST_F(Shell, KeysThatMakeNoSenseAreRefused) {
  const auto shell = [&](const std::string& keys) { return kCubes + "[[shell]]\n" + keys; };
  EXPECT_EQ(refusal(shell("gap_mm = 1\n")), "design.toml:11: shell[1].thickness_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 0\ngap_mm = 1\n")), "design.toml:12: shell[1].thickness_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 1\ngap_mm = -1\n")), "design.toml:13: shell[1].gap_mm");
  const std::string sizes = "thickness_mm = 1\ngap_mm = 1\n";
  EXPECT_EQ(refusal(shell(sizes + "outer_radius_mm = 0\n")), "design.toml:14: shell[1].outer_radius_mm");
  EXPECT_EQ(refusal(shell(sizes + "wedge_deg = [1]\n")), "design.toml:14: shell[1].wedge_deg");
  EXPECT_EQ(refusal(shell(sizes + "tilt_deg = [0, 90]\n")), "design.toml:14: shell[1].tilt_deg");
  EXPECT_EQ(refusal(shell(sizes + "material = \"cheese\"\n")), "design.toml:14: shell[1].material");
  EXPECT_EQ(refusal(shell(sizes + "refractive_index = 0.9\n")), "design.toml:14: shell[1].refractive_index");
  EXPECT_EQ(refusal(shell(sizes + "absorption_per_mm = [[600, 1], [500, 1]]\n")),
            "design.toml:14: shell[1].absorption_per_mm");
  EXPECT_EQ(refusal(shell(sizes + "absorption_per_mm = [[400, 1], [500, 1]]\n")),
            "design.toml:14: shell[1].absorption_per_mm");
  std::string five = kCubes;
  for (int k = 0; k < 5; ++k) five += kPlate;
  EXPECT_EQ(refusal(five), "design.toml:11: shell");
  EXPECT_EQ(refusal(kCubes + kPlate + "[idealisation]\nentrance = \"lossless\"\n"), "design.toml:11: shell");
  const std::string ball = "[element]\nkind = \"ball\"\ndiameter_mm = 1\n[body]\nrefractive_index = 1.9\n";
  EXPECT_EQ(refusal(ball + kPlate), "design.toml:6: shell");
}

// The surfaces of a shell must extend over the whole part. They must not cross each other, the next shell or the part.
TEST_F(Shell, SurfacesThatCrossAreRefused) {
  const auto shell = [&](const std::string& keys) { return kCubes + "[[shell]]\n" + keys; };
  EXPECT_EQ(refusal(shell("thickness_mm = 1\ngap_mm = 5\nouter_radius_mm = 9\n")),
            "design.toml:14: shell[1].outer_radius_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 1\ngap_mm = 5\ninner_radius_mm = -9\n")),
            "design.toml:14: shell[1].inner_radius_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 0.5\ngap_mm = 5\nouter_radius_mm = 40\n")),
            "design.toml:12: shell[1].thickness_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 0.5\ngap_mm = 5\nwedge_deg = [0, 10]\n")),
            "design.toml:12: shell[1].thickness_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 2\ngap_mm = 1\ntilt_deg = [10, 10]\n")), "design.toml:13: shell[1].gap_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 2\ngap_mm = 0.5\ninner_radius_mm = 40\nouter_radius_mm = 42\n")),
            "design.toml:13: shell[1].gap_mm");
  EXPECT_EQ(refusal(shell("thickness_mm = 2\ngap_mm = 1\ntilt_deg = [10, 0]\n") + kPlate),
            "design.toml:13: shell[1].gap_mm");
  const std::string endless = kEndless.substr(0, kEndless.find("[light]"));
  EXPECT_EQ(refusal(endless + "[[shell]]\nthickness_mm = 1\ngap_mm = 1\nouter_radius_mm = 50\n"),
            "design.toml:13: shell[1].outer_radius_mm");
  EXPECT_EQ(refusal(endless + "[[shell]]\nthickness_mm = 1\ngap_mm = 1\ntilt_deg = [0, 1]\n"),
            "design.toml:13: shell[1].tilt_deg");
}

}  // namespace
}  // namespace retrace::test::shell_test

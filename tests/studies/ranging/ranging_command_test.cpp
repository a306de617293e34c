// Tests of the command `retrace ranging`: output files, values, exit codes and refused options.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/app/program.h"

namespace retrace::test::ranging_command_test {
namespace {

const std::string kCube =
    "schema = \"retrace.design/1\"\n[element]\nkind = \"hexagonal_icc\"\naperture_mm = 30\n[array]\narrangement = "
    "\"single\"\n[body]\nmaterial = \"fused-silica\"\nthickness_mm = 0.5\n[light]\nwavelength_nm = 532\n";
const std::string kRing = "schema = \"retrace.cubes/1\"\n[[ring]]\nradius_mm = 100\nlatitude_deg = 60\ncount = 6\n";

void write_inputs(const TemporaryFolder& folder) {
  folder.write("cube.toml", kCube);
  folder.write("ring.toml", kRing);
}

TEST(RangingCommand, WritesPointsMapAndDrawings) {
  const TemporaryFolder folder;
  write_inputs(folder);
  const Outcome outcome =
      retrace(folder, {"ranging", "cube.toml", "--wavelength", "532,1064", "--incidence", "0,10", "--orbit-km", "5860",
                       "--polarisation", "linear", "--map-points", "11", "-o", "out"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"cube.toml", "out", "out/map.csv", "out/map.png", "out/map.svg",
                                                      "out/ranging.csv", "out/ranging.json", "out/rings.png",
                                                      "out/rings.svg", "ring.toml"}));
  const Json json = folder.json("out/ranging.json");
  ASSERT_EQ(json["points"].size(), 4u);
  const Json& point = json["points"][0];
  EXPECT_EQ(json["schema"], "retrace.ranging/1");
  EXPECT_NEAR(point["centre"]["parallel_m2"].get<double>() + point["centre"]["crossed_m2"].get<double>(),
              point["centre"]["total_m2"].get<double>(), 1.0);
  // The cross section of the mirror is inversely proportional to the square of the wavelength.
  EXPECT_NEAR(json["points"][2]["mirror_m2"].get<double>(), 0.25 * point["mirror_m2"].get<double>(), 1.0);
  EXPECT_NEAR(point["range_correction_mm"].get<double>(),
              json["depth_mm"].get<double>() * point["group_index"].get<double>(), 1e-6);
}

TEST(RangingCommand, ArraysHaveCubesPulsesAndShots) {
  const TemporaryFolder folder;
  write_inputs(folder);
  const Arguments arguments = {"ranging", "cube.toml",   "--cubes", "ring.toml",    "--pulse-ps", "100", "--shots",
                               "50",      "--incidence", "10",      "--map-points", "11",         "-o",  "out"};
  const Outcome outcome = retrace(folder, arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* const name : {"cubes.csv", "response.csv", "response.svg", "shots.csv"})
    EXPECT_FALSE(folder.read(std::string("out/") + name).empty()) << name;
  const Json json = folder.json("out/ranging.json");
  EXPECT_EQ(json["points"][0]["ranges"]["lit_cubes"], 6);
  EXPECT_EQ(json["points"][0]["shots"]["count"], 50);
  // A different seed must change only the single shots.
  Arguments other = arguments;
  other.insert(other.end(), {"--seed", "2"});
  EXPECT_EQ(retrace(folder, other).code, 0);
  const Json again = folder.json("out/ranging.json");
  EXPECT_EQ(again["points"][0]["ranges"], json["points"][0]["ranges"]);
  EXPECT_NE(again["points"][0]["shots"], json["points"][0]["shots"]);
}

TEST(RangingCommand, EndingsOfFilesHaveNoCase) {
  const TemporaryFolder folder;
  write_inputs(folder);
  folder.write("CUBES.CSV", "x_mm,y_mm,z_mm,axis_x,axis_y,axis_z\n0,0,0,0,0,1\n50,0,0,0,0,1\n");
  const Json json = retrace_json(folder, {"ranging", "cube.toml", "--cubes", "CUBES.CSV", "--map-points", "3"});
  EXPECT_EQ(json["points"][0]["ranges"]["lit_cubes"], 2);
}

TEST(RangingCommand, CubesOnTheFarSideAreDark) {
  const TemporaryFolder folder;
  write_inputs(folder);
  const Json json = retrace_json(
      folder, {"ranging", "cube.toml", "--cubes", "ring.toml", "--incidence", "180", "--aberration-arcsec", "1,2"});
  EXPECT_EQ(json["points"][0]["ranges"]["lit_cubes"], 0);
  EXPECT_EQ(json["points"][0]["centre"]["total_m2"], 0.0);
}

TEST(RangingCommand, WrongOptionsAreRefused) {
  const TemporaryFolder folder;
  write_inputs(folder);
  folder.write(
      "prism.toml",
      "schema = \"retrace.design/1\"\n[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement "
      "= \"single\"\n[body]\nthickness_mm = 1\n");
  folder.write("array.toml",
               "schema = \"retrace.design/1\"\n[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\n[array]\nextent = "
               "\"infinite\"\n[body]\nthickness_mm = 1\n");
  folder.write("rough.toml", kCube + "[surface]\nmodel = \"abg\"\nabg_a = 1e-4\nabg_b = 1e-4\nabg_g = 1.5\n");
  folder.write("white.toml", kCube.substr(0, kCube.find("[light]")) + "[light]\nspectrum = \"A\"\n");
  folder.write("bad_cubes.toml", "schema = \"retrace.cubes/1\"\n[[cube]]\n");
  const auto refused = [&](Arguments arguments) {
    arguments.insert(arguments.begin(), "ranging");
    return refused_at(retrace(folder, arguments));
  };
  const auto with = [&](const std::string& option, const std::string& value) {
    return refused({"cube.toml", option, value});
  };
  EXPECT_EQ(refused({"prism.toml"}), "prism.toml:3: element.kind");
  EXPECT_EQ(refused({"array.toml"}), "array.toml:5: array.arrangement");
  EXPECT_EQ(refused({"rough.toml"}), "rough.toml:13: surface.model");
  EXPECT_EQ(refused({"white.toml"}), "--wavelength");
  EXPECT_EQ(with("--wavelength", "50"), "--wavelength");
  EXPECT_EQ(with("--incidence", "90"), "--incidence");
  EXPECT_EQ(with("--incidence", "181"), "--incidence");
  EXPECT_EQ(with("--azimuth", "361"), "--azimuth");
  EXPECT_EQ(with("--polarisation", "round"), "--polarisation");
  EXPECT_EQ(with("--polarisation-deg", "10"), "--polarisation-deg");
  EXPECT_EQ(with("--aberration-arcsec", "3,2"), "--aberration-arcsec");
  EXPECT_EQ(with("--aberration-arcsec", "3"), "--aberration-arcsec");
  EXPECT_EQ(with("--aberration-arcsec", "1,36000"), "--aberration-arcsec");
  EXPECT_EQ(with("--source-arcsec", "36000"), "--map-points");
  EXPECT_EQ(with("--orbit-km", "0"), "--orbit-km");
  EXPECT_EQ(with("--elevation-deg", "10"), "--elevation-deg");
  EXPECT_EQ(with("--window", "0"), "--window");
  EXPECT_EQ(with("--map-points", "2"), "--map-points");
  EXPECT_EQ(with("--source-arcsec", "-1"), "--source-arcsec");
  EXPECT_EQ(with("--receiver-arcsec", "-1"), "--receiver-arcsec");
  EXPECT_EQ(with("--pulse-ps", "10"), "--pulse-ps");
  EXPECT_EQ(with("--shots", "10"), "--shots");
  EXPECT_EQ(with("--observation-arcsec", "1,2"), "--observation-arcsec");
  EXPECT_EQ(with("--cubes", "bad_cubes.toml"), "--cubes");
  EXPECT_EQ(with("--cubes", "missing.toml"), "--cubes");
  EXPECT_EQ(refused({"cube.toml", "--cubes", "ring.toml", "--pulse-ps", "0"}), "--pulse-ps");
  EXPECT_EQ(refused({"cube.toml", "--cubes", "ring.toml", "--shots", "-1"}), "--shots");
}

}  // namespace
}  // namespace retrace::test::ranging_command_test

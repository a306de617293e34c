// Tests of the command `retrace image`: its files, and refused options.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/app/program.h"

namespace retrace::test::image_command_test {
namespace {

const std::string kBrick =
    "[element]\nkind = \"rtp\"\nbase_mm = 2\nwidth_mm = 2\n[array]\narrangement = \"offset\"\nx_length_mm = "
    "6\ny_length_mm = 6\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";
const std::string kEndless =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\n[array]\nextent = \"infinite\"\n[body]\nthickness_mm = "
    "1\nrefractive_index = 1.4917\n";

class Image : public ::testing::Test {
 protected:
  Image() {
    folder_.write("brick.toml", kBrick);
    folder_.write("cubes.toml", kEndless);
  }
  TemporaryFolder folder_;
};

TEST_F(Image, DetectorWritesItsMaps) {
  const Json json = retrace_json(folder_, {"image", "brick.toml", "--detector", "--pixels=40", "-o", "out"});
  EXPECT_EQ(json["schema"], "retrace.image/1");
  EXPECT_EQ(json["kind"], "detector");
  EXPECT_EQ(json["engine"], "exact");
  EXPECT_TRUE(json["complete"].get<bool>());
  const Json rre = retrace_json(folder_, {"rre", "brick.toml", "--engine=exact"});
  EXPECT_NEAR(json["rre"].get<double>(), rre["points"][0]["rre"].get<double>(), 2e-5);
  EXPECT_EQ(json["face"]["columns"], 40);
  for (const char* name : {"irradiance.exr", "angular.exr"})
    EXPECT_EQ(folder_.read(std::string("out/") + name).substr(0, 4), std::string("\x76\x2f\x31\x01")) << name;
  for (const char* name : {"irradiance.png", "angular.png"})
    EXPECT_TRUE(folder_.read(std::string("out/") + name).starts_with("\x89PNG")) << name;
}

TEST_F(Image, CameraWritesTheSameBytesWithAnyNumberOfThreads) {
  const auto run = [&](const std::string& out, const std::string& threads) {
    const Outcome outcome = retrace(folder_, {"image", "brick.toml", "--camera", "--pixels=24x18", "--passes=3",
                                              "--false-colour", "--ambient-lx=1", "--threads", threads, "-o", out});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  };
  run("a", "1");
  run("b", "3");
  for (const char* name : {"camera.exr", "camera.png", "false_colour.png"})
    EXPECT_TRUE(folder_.read(std::string("a/") + name) == folder_.read(std::string("b/") + name)) << name;
  EXPECT_EQ(without_elapsed(folder_.read("a/image.json")), without_elapsed(folder_.read("b/image.json")));
  const Json json = folder_.json("a/image.json");
  EXPECT_EQ(json["kind"], "camera");
  EXPECT_EQ(json["passes"], 3);
  EXPECT_GT(json["part_luminance_cd_per_m2"].get<double>(), 0.0);
}

TEST_F(Image, CameraSeesASheetOnACylinder) {
  const Json json = retrace_json(folder_, {"image", "cubes.toml", "--camera", "--film-mm=60x40", "--cylinder-mm=40",
                                           "--pixels=30x20", "--noise=0.5", "--observation-deg=0"});
  EXPECT_EQ(json["cylinder_mm"], 40);
  EXPECT_GT(json["luminance_max_cd_per_m2"].get<double>(), 0.0);
}

TEST_F(Image, CameraTakesALampOfAFile) {
  const auto lit = [&](const std::string& aim) {
    return retrace_json(folder_, {"image", "brick.toml", "--camera", "--passes=2", "--pixels=8x6", "--distance-m=20",
                                  "--lamp=" + example("low_beam.ies"), "--lamp-aim-deg=" + aim, "-o", "out"});
  };
  // The expected intensities, in cd, are in the row X = 0 of the file, at Y = -1 and Y = 1.
  EXPECT_NEAR(lit("-1")["illuminance_lx"].get<double>() * 400.0, 26637.0, 3000.0);
  EXPECT_LT(lit("1")["illuminance_lx"].get<double>() * 400.0, 300.0);
  EXPECT_EQ(lit("1")["lamp"]["aim_deg"], 1);
}

/// If the requested noise cannot be reached, the run ends with a warning.
TEST_F(Image, CameraSaysThatANoiseIsOutOfReach) {
  const Json json =
      retrace_json(folder_, {"image", "brick.toml", "--camera", "--pixels=24x18", "--ambient-lx=1", "--noise=1e-7"});
  EXPECT_EQ(json["passes"], 64);
  EXPECT_EQ(json["complete"], true);
  EXPECT_NE(json["warnings"].dump().find("is above the target of 1e-07 after 64 passes, which would take about"),
            std::string::npos)
      << json["warnings"];
}

TEST_F(Image, CameraSaysThatThePartIsBlack) {
  const Json json =
      retrace_json(folder_, {"image", "cubes.toml", "--camera", "--pixels=24x18", "--observation-deg=40"});
  EXPECT_EQ(json["luminance_max_cd_per_m2"], 0);
  EXPECT_NE(json["warnings"].dump().find("no light comes to the camera from the part in 8 passes"), std::string::npos)
      << json["warnings"];
}

TEST_F(Image, WrongOptionsAreRefused) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{}, "image: one of --detector, --camera and --road is required"},
      {{"--detector", "--camera"}, "image: one of "},
      {{"--camera", "--pixels=0x300"}, "--pixels: must be 1x1 to 16384x16384 and at most 67108864 in all, got 0x300"},
      {{"--camera", "--pixels=1000000x1000000"}, "--pixels: must be 1x1 to "},
      {{"--camera", "--pixels=16384x16384"}, "--pixels: must be 1x1 to "},
      {{"--camera", "--pixels=300"}, "--pixels: must be columns and rows, such as 400x300, got \"300\""},
      {{"--camera", "--pixels=-3x4"}, "--pixels: must be columns and rows"},
      {{"--camera", "--pixels=3x4x5"}, "--pixels: must be columns and rows"},
      {{"--camera", "--pixels=99999999999999999999999x4"}, "--pixels: must be columns and rows"},
      {{"--detector", "--pixels=0"}, "--pixels: must be 1 to 8192 along the longer side, got 0"},
      {{"--detector", "--pixels=1000000"}, "--pixels: must be 1 to 8192"},
      {{"--detector", "--pixels="}, "--pixels: "},
      {{"--detector", "--angle-pixels=0"}, "--angle-pixels: must be 1 to 2049, got 0"},
      {{"--detector", "--angle-pixels=9999"}, "--angle-pixels: must be 1 to 2049, got 9999"},
      {{"--detector", "--window-deg=0"}, "--window-deg: must be above 0"},
      {{"--detector", "--incidence=90"}, "--incidence: must lie between -90 and 90 degrees, got 90"},
      {{"--detector", "--incidence=nan"}, "--incidence: must lie between"},
      {{"--detector", "--engine=cell"}, "--engine: must be auto, exact, montecarlo or embree for pictures, got cell"},
      {{"--detector", "--cutoff=2"}, "--cutoff: must lie between 0 and 1, got 2"},
      {{"--detector", "--samples=0"}, "--samples: must be a whole number from 1 to 68719476736, got 0"},
      {{"--camera", "--eye-mm=0,0,0.5"}, "--eye-mm: the camera must be outside the part, got 0,0,0.5 mm"},
      {{"--camera", "--eye-mm=0,0,-0.2"}, "--eye-mm: the camera must be outside the part"},
      {{"--camera", "--lamp-mm=1,1,0.9"}, "--lamp-mm: the lamp must be outside the part, got 1,1,0.9 mm"},
      {{"--camera", "--eye-mm=0,0,1"}, "--eye-mm: "},
      {{"--camera", "--eye-mm=0,0"}, "--eye-mm: must be three numbers X,Y,Z in mm, got \"0,0\""},
      {{"--camera", "--eye-mm=a,b,c"}, "--eye-mm: must be three numbers"},
      {{"--camera", "--eye-mm=inf,0,0"}, "--eye-mm: must be three numbers"},
      {{"--camera", "--distance-m=0"}, "--distance-m: must be above 0 and at most 1e6, got 0"},
      {{"--camera", "--observation-deg=-1"}, "--observation-deg: must be >= 0 and < 180, got -1"},
      {{"--camera", "--v-deg=90"}, "--v-deg: must lie between -90 and 90, got 90"},
      {{"--camera", "--h-deg=nan"}, "--h-deg: must lie between"},
      {{"--camera", "--rotation-deg=nan"}, "--rotation-deg: must be -360 to 360, got nan"},
      {{"--camera", "--rotation-deg=1e300"}, "--rotation-deg: must be -360 to 360, got 1e+300"},
      {{"--detector", "--azimuth=1e300"}, "--azimuth: must be -360 to 360 degrees, got 1e+300"},
      {{"--camera", "--lamp-arcmin=0"}, "--lamp-arcmin: must be above 0 and at most 600, got 0"},
      {{"--camera", "--pupil-arcmin=-1"}, "--pupil-arcmin: must be 0 to 600, got -1"},
      {{"--camera", "--illuminance-lx=-1"}, "--illuminance-lx: must be >= 0, got -1"},
      {{"--camera", "--illuminance-lx=inf"}, "--illuminance-lx: must be >= 0"},
      {{"--camera", "--ambient-lx=bright"}, "--ambient-lx: must be a number, got bright"},
      {{"--camera", "--field-mm=0"}, "--field-mm: must be > 0, got 0"},
      {{"--camera", "--noise=0"}, "--noise: must lie between 0 and 1, got 0"},
      {{"--camera", "--passes=1"}, "--passes: must be 2 to 65536, got 1"},
      {{"--camera", "--passes=some"}, "--passes: must be a whole number from 0 to 4294967295, got some"},
      {{"--road", "--lamp=no.ies"}, "no.ies: cannot be read"},
      {{"--road", "--lamp=brick.toml"}, "--lamp: must end in .ies or .ldt, got \"brick.toml\""},
      {{"--road", "--lamp-aim-deg=1"}, "--lamp-aim-deg"},
      {{"--road", "--lamp-height-m=0"}, "--lamp-height-m: must lie between 0.2 and 3, got 0"},
      {{"--road", "--lamp=" + example("low_beam.ies"), "--lamp-aim-deg=46"},
       "--lamp-aim-deg: must lie between -45 and 45, got 46"},
      {{"--camera", "--cylinder-mm=50"}, "--cylinder-mm: needs a design with extent = \"infinite\""},
      {{"--camera", "--set", "light.polarisation=linear"}, "light.polarisation: "},
  };
  const auto before = folder_.names();
  for (const auto& [more, message] : cases) {
    SCOPED_TRACE(message + " " + (more.empty() ? "" : more.back()));
    Arguments arguments = {"image", "brick.toml", "-o", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = retrace(folder_, arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_EQ(folder_.names(), before);
  }
}

/// Some options apply to certain kinds of picture only. They are refused for all other kinds, whatever their
/// values.
TEST_F(Image, OptionsOfAnotherKindOfPictureAreRefused) {
  const Arguments all = {"--detector", "--camera", "--road"};
  const std::vector<std::pair<Arguments, Arguments>> options = {
      {{"--detector"},
       {"--incidence", "--azimuth", "--engine", "--cutoff", "--samples", "--window-deg", "--angle-pixels"}},
      {{"--camera"},
       {"--distance-m", "--observation-deg", "--v-deg", "--h-deg", "--rotation-deg", "--eye-mm", "--lamp-mm",
        "--lamp-arcmin", "--pupil-arcmin", "--illuminance-lx", "--ambient-lx", "--backlight-lx", "--field-mm",
        "--film-mm", "--cylinder-mm", "--noise", "--passes", "--false-colour"}},
      {{"--road"}, {"--road-distance-m", "--lamp-cd", "--lamp-height-m", "--dye"}},
      {{"--detector", "--camera"}, {"--pixels"}},
      {{"--camera", "--road"}, {"--lamp"}}};
  for (const auto& [kinds, names] : options)
    for (const std::string& name : names)
      for (const std::string& kind : all) {
        if (std::ranges::count(kinds, kind) > 0) continue;
        SCOPED_TRACE(kind + " " + name);
        Arguments arguments = {"image", "brick.toml", "-o", "out", kind, name};
        if (name != "--false-colour") arguments.emplace_back("1");
        const Outcome outcome = retrace(folder_, arguments);
        EXPECT_EQ(outcome.code, 2);
        const std::string needed = kinds.size() == 1 ? kinds[0] : kinds[0] + " or " + kinds[1];
        EXPECT_NE(outcome.err.find(name + ": needs " + needed), std::string::npos) << outcome.err;
      }
}

TEST_F(Image, WrongSheetsAreRefused) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"--film-mm=100"}, "--film-mm: must be width and height, such as 100x100, got \"100\""},
      {{"--film-mm=0x5"}, "--film-mm: must be above 0 and at most 1e5, got 0"},
      {{"--cylinder-mm=0"}, "--cylinder-mm: must be at least "},
      {{"--cylinder-mm=10"}, "--cylinder-mm: must be at least "},
      {{"--eye-mm=0,0,0.5"}, "--eye-mm: the camera must be outside the body, in front of its face, got 0,0,0.5 mm"},
      {{"--eye-mm=0,0,1e155"}, "--eye-mm: must be three numbers from -1e9 to 1e9, got 1e+155"},
      {{"--lamp-mm=1e155,0,9"}, "--lamp-mm: must be three numbers from -1e9 to 1e9, got 1e+155"},
      {{"--cylinder-mm=1e300"}, "--cylinder-mm: must be -1e9 to 1e9, got 1e+300"},
      {{"--cylinder-mm=50", "--lamp-mm=0,0,-30"}, "--lamp-mm: the lamp must be outside the body"},
      {{"--observation-deg=120"}, "--observation-deg: the camera must be outside the body"},
  };
  for (const auto& [more, message] : cases) {
    SCOPED_TRACE(message);
    Arguments arguments = {"image", "cubes.toml", "--camera"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = retrace(folder_, arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
  }
}

/// A finite part is shown at its own size. Options for the size of a sheet are therefore refused.
TEST_F(Image, FinitePartsTakeNoSheet) {
  const Arguments camera = {"image", example("rtp_brick_2mm.toml"), "--camera", "-o", "i", "--json", "i.json"};
  const auto names = folder_.names();
  for (const std::string option : {"--film-mm=60x40", "--film-mm=100x100", "--cylinder-mm=40"})
    expect_refused(retrace(folder_, with(camera, {option})),
                   option.substr(0, option.find('=')) + ": needs a design with extent = \"infinite\": ");
  EXPECT_EQ(folder_.names(), names);
}

}  // namespace
}  // namespace retrace::test::image_command_test

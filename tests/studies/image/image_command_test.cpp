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

TEST_F(Image, DetectorStatesTheErrorOfItsBins) {
  const auto run = [&](const std::string& error, const std::string& out) {
    return retrace_json(folder_, {"image", "brick.toml", "--detector", "--engine=montecarlo", "--pixels=60",
                                  "--samples=262144", "--bin-error=" + error, "-o", out});
  };
  const Json merged = run("0.03", "merged");
  EXPECT_EQ(merged["bins"]["error_requested"], 0.03);
  EXPECT_LE(merged["bins"]["face_error"].get<double>(), 0.0301);
  EXPECT_GT(merged["bins"]["face_error"].get<double>(), 0.001);
  EXPECT_LE(merged["bins"]["angle_error"].get<double>(), 0.0301);
  EXPECT_FALSE(merged["angles"]["has_diffraction"].get<bool>());
  const Json pixels = run("0", "pixels");
  EXPECT_GT(pixels["bins"]["face_error"].get<double>(), 0.03) << "pixels without merging are noisy";
  EXPECT_GT(merged["bins"]["face_pixels"].get<int>(), 1);
  EXPECT_EQ(pixels["bins"]["face_pixels"], 1);
  EXPECT_FALSE(merged["bins"]["limit_reached"].get<bool>());
  EXPECT_EQ(pixels["rre"], merged["rre"]);
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
  ASSERT_EQ(json["warnings"].size(), 1U);
}

TEST_F(Image, CameraSaysThatThePartIsBlack) {
  const Json json = retrace_json(
      folder_, {"image", "cubes.toml", "--camera", "--no-diffraction", "--pixels=24x18", "--observation-deg=40"});
  EXPECT_EQ(json["luminance_max_cd_per_m2"], 0.0);
  ASSERT_EQ(json["warnings"].size(), 1U);
}

/// A list of equal values gives one picture. A bar of luminances can also be drawn below a narrow picture.
TEST_F(Image, ListsOfOneValueAndNarrowPicturesAreOnePicture) {
  const Json json = retrace_json(folder_, {"image", "brick.toml", "--camera", "--no-diffraction", "--pixels=1x200",
                                           "--passes=2", "--tone=log", "--distance-m=3,3,3", "-o", "out"});
  EXPECT_EQ(json["kind"], "camera");
  EXPECT_NEAR(json["eye_mm"][2].get<double>(), 3001.0, 0.5);
  EXPECT_TRUE(folder_.read("out/camera.png").starts_with("\x89PNG"));
}

/// The error for a damaged picture is one line: the message that libpng writes to standard error is discarded.
TEST_F(Image, DamagedBackgroundsAreRefusedWithOneLine) {
  retrace(folder_, {"image", "brick.toml", "--camera", "--no-diffraction", "--pixels=8x6", "--passes=2", "-o", "out"});
  const std::string png = folder_.read("out/camera.png");
  folder_.write("short.png", png.substr(0, png.size() / 2));
  folder_.write("text.png", "not a picture");
  for (const char* name : {"short.png", "text.png", "none.png"}) {
    const Outcome outcome =
        retrace(folder_, {"image", "brick.toml", "--camera", std::string("--background=") + name, "-o", "out"});
    EXPECT_EQ(refused_at(outcome), "--background");
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  }
}

/// A message about absorption that does not cover the light names the design or the file of the dye.
TEST_F(Image, MessagesNameTheFileOfTheAbsorption) {
  const std::string list = kBrick + "absorption_per_mm = [[560.0, 0.01], [600.0, 0.02]]\n";
  folder_.write("narrow.toml", list);
  folder_.write("dye.csv", "wavelength_nm,absorption_per_mm\n560,0.1\n600,0.2\n");
  EXPECT_TRUE(refused_at(retrace(folder_, {"image", "narrow.toml", "--camera"})).starts_with("narrow.toml"));
  EXPECT_TRUE(
      refused_at(retrace(folder_, {"image", "brick.toml", "--camera", "--dye=dye.csv"})).starts_with("dye.csv"));
}

TEST_F(Image, WrongOptionsAreRefused) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{}, "image"},
      {{"--detector", "--camera"}, "image"},
      {{"--camera", "--pixels=0x300"}, "--pixels"},
      {{"--camera", "--pixels=1000000x1000000"}, "--pixels"},
      {{"--camera", "--pixels=16384x16384"}, "--pixels"},
      {{"--camera", "--pixels=300"}, "--pixels"},
      {{"--camera", "--pixels=-3x4"}, "--pixels"},
      {{"--camera", "--pixels=3x4x5"}, "--pixels"},
      {{"--camera", "--pixels=99999999999999999999999x4"}, "--pixels"},
      {{"--detector", "--pixels=0"}, "--pixels"},
      {{"--detector", "--pixels=1000000"}, "--pixels"},
      {{"--detector", "--pixels="}, "--pixels"},
      {{"--detector", "--angle-pixels=0"}, "--angle-pixels"},
      {{"--detector", "--angle-pixels=9999"}, "--angle-pixels"},
      {{"--detector", "--window-deg=0"}, "--window-deg"},
      {{"--detector", "--bin-error=1"}, "--bin-error"},
      {{"--detector", "--bin-error=-0.1"}, "--bin-error"},
      {{"--detector", "--engine=exact", "--bin-error=0.1"}, "--bin-error"},
      {{"--detector", "--incidence=90"}, "--incidence"},
      {{"--detector", "--incidence=nan"}, "--incidence"},
      {{"--detector", "--engine=cell"}, "--engine"},
      {{"--detector", "--cutoff=2"}, "--cutoff"},
      {{"--detector", "--samples=0"}, "--samples"},
      {{"--camera", "--eye-mm=0,0,0.5"}, "--eye-mm"},
      {{"--camera", "--eye-mm=0,0,-0.2"}, "--eye-mm"},
      {{"--camera", "--lamp-mm=1,1,0.9"}, "--lamp-mm"},
      {{"--camera", "--eye-mm=0,0,1"}, "--eye-mm"},
      {{"--camera", "--eye-mm=0,0"}, "--eye-mm"},
      {{"--camera", "--eye-mm=a,b,c"}, "--eye-mm"},
      {{"--camera", "--eye-mm=inf,0,0"}, "--eye-mm"},
      {{"--camera", "--distance-m=0"}, "--distance-m"},
      {{"--camera", "--observation-deg=-1"}, "--observation-deg"},
      {{"--camera", "--v-deg=90"}, "--v-deg"},
      {{"--camera", "--h-deg=nan"}, "--h-deg"},
      {{"--camera", "--rotation-deg=nan"}, "--rotation-deg"},
      {{"--camera", "--rotation-deg=1e300"}, "--rotation-deg"},
      {{"--detector", "--azimuth=1e300"}, "--azimuth"},
      {{"--camera", "--lamp-arcmin=0"}, "--lamp-arcmin"},
      {{"--camera", "--pupil-arcmin=-1"}, "--pupil-arcmin"},
      {{"--camera", "--illuminance-lx=-1"}, "--illuminance-lx"},
      {{"--camera", "--illuminance-lx=inf"}, "--illuminance-lx"},
      {{"--camera", "--illuminance-lx=1e300"}, "--illuminance-lx"},
      {{"--camera", "--ambient-lx=1e300"}, "--ambient-lx"},
      {{"--camera", "--backlight-lx=1e300"}, "--backlight-lx"},
      {{"--camera", "--distance-m=1,2", "--v-deg=1,2"}, "--v-deg"},
      {{"--camera", "--ambient-lx=bright"}, "--ambient-lx"},
      {{"--camera", "--field-mm=0"}, "--field-mm"},
      {{"--camera", "--noise=0"}, "--noise"},
      {{"--camera", "--passes=1"}, "--passes"},
      {{"--camera", "--passes=some"}, "--passes"},
      {{"--road", "--lamp=no.ies"}, "no.ies"},
      {{"--road", "--lamp=brick.toml"}, "--lamp"},
      {{"--road", "--lamp-aim-deg=1"}, "--lamp-aim-deg"},
      {{"--road", "--lamp-height-m=0"}, "--lamp-height-m"},
      {{"--road", "--eye-height-m=-1"}, "--eye-height-m"},
      {{"--road", "--mount=lorry"}, "--mount"},
      {{"--road", "--mast-m=3"}, "--mast-m"},
      {{"--road", "--symbol=none"}, "--symbol"},
      {{"--road", "--mount=sign", "--mast-m=2"}, "--mast-m"},
      {{"--road", "--mount=sign", "--reflector-height-m=-1"}, "--reflector-height-m"},
      {{"--road", "--reflector-mm=-120x25"}, "--reflector-mm"},
      {{"--road", "--reflector-mm=1000x25"}, "--reflector-mm"},
      {{"--road", "--outline=star"}, "--outline"},
      {{"--road", "--lateral-m=2"}, "--lateral-m"},
      {{"--road", "--asphalt-mcd=-1"}, "--asphalt-mcd"},
      {{"--road", "--marking-mcd=nan"}, "--marking-mcd"},
      {{"--road", "--field-deg=0"}, "--field-deg"},
      {{"--road", "--pixels=0x10"}, "--pixels"},
      {{"--road", "--pixels=10000x10000"}, "--pixels"},
      {{"--road", "--pixels=4096x2048", "--road-distance-m=10,20,30"}, "--pixels"},
      {{"--road", "--exposure-ev=100"}, "--exposure-ev"},
      {{"--road", "--tone=film"}, "--tone"},
      {{"--road", "--dye=no.csv"}, "--dye"},
      {{"--road", "--lamp=" + example("low_beam.ies"), "--lamp-aim-deg=46"}, "--lamp-aim-deg"},
      {{"--camera", "--cylinder-mm=50"}, "--cylinder-mm"},
      {{"--camera", "--set", "light.polarisation=linear"}, "brick.toml: light.polarisation"},
  };
  const auto before = folder_.names();
  for (const auto& [more, place] : cases) {
    SCOPED_TRACE(place + " " + (more.empty() ? "" : more.back()));
    Arguments arguments = {"image", "brick.toml", "-o", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = retrace(folder_, arguments);
    EXPECT_EQ(refused_at(outcome), place);
    EXPECT_EQ(folder_.names(), before);
  }
}

/// Some options apply to certain kinds of picture only. They are refused for all other kinds, whatever their
/// values.
TEST_F(Image, OptionsOfAnotherKindOfPictureAreRefused) {
  const Arguments all = {"--detector", "--camera", "--road"};
  const std::vector<std::pair<Arguments, Arguments>> options = {
      {{"--detector"},
       {"--incidence", "--azimuth", "--engine", "--cutoff", "--samples", "--window-deg", "--angle-pixels",
        "--bin-error"}},
      {{"--camera"},
       {"--distance-m", "--observation-deg", "--v-deg", "--h-deg", "--rotation-deg", "--eye-mm", "--lamp-mm",
        "--lamp-arcmin", "--pupil-arcmin", "--illuminance-lx", "--ambient-lx", "--backlight-lx", "--field-mm",
        "--film-mm", "--cylinder-mm", "--noise", "--passes", "--false-colour"}},
      {{"--road"},
       {"--road-distance-m", "--mount", "--reflector-mm", "--outline", "--lateral-m", "--lamp-cd", "--lamp-height-m",
        "--field-deg"}},
      {{"--camera", "--road"}, {"--lamp", "--dye", "--exposure-ev", "--tone"}}};
  for (const auto& [kinds, names] : options)
    for (const std::string& name : names)
      for (const std::string& kind : all) {
        if (std::ranges::count(kinds, kind) > 0) continue;
        SCOPED_TRACE(kind + " " + name);
        Arguments arguments = {"image", "brick.toml", "-o", "out", kind, name};
        if (name != "--false-colour") arguments.emplace_back("1");
        const Outcome outcome = retrace(folder_, arguments);
        EXPECT_EQ(refused_at(outcome), name);
      }
}

TEST_F(Image, WrongSheetsAreRefused) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"--film-mm=100"}, "--film-mm"},
      {{"--film-mm=0x5"}, "--film-mm"},
      {{"--cylinder-mm=0"}, "--cylinder-mm"},
      {{"--cylinder-mm=10"}, "--cylinder-mm"},
      {{"--eye-mm=0,0,0.5"}, "--eye-mm"},
      {{"--eye-mm=0,0,1e155"}, "--eye-mm"},
      {{"--lamp-mm=1e155,0,9"}, "--lamp-mm"},
      {{"--cylinder-mm=1e300"}, "--cylinder-mm"},
      {{"--cylinder-mm=50", "--lamp-mm=0,0,-30"}, "--lamp-mm"},
      {{"--observation-deg=120"}, "--observation-deg"},
  };
  for (const auto& [more, place] : cases) {
    SCOPED_TRACE(place);
    Arguments arguments = {"image", "cubes.toml", "--camera"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = retrace(folder_, arguments);
    EXPECT_EQ(refused_at(outcome), place);
  }
}

/// A finite part is shown at its own size. Options for the size of a sheet are therefore refused.
TEST_F(Image, FinitePartsTakeNoSheet) {
  const Arguments camera = {"image", example("rtp_brick_2mm.toml"), "--camera", "-o", "i", "--json", "i.json"};
  const auto names = folder_.names();
  for (const std::string option : {"--film-mm=60x40", "--film-mm=100x100", "--cylinder-mm=40"})
    EXPECT_EQ(refused_at(retrace(folder_, with(camera, {option}))), option.substr(0, option.find('=')));
  EXPECT_EQ(folder_.names(), names);
}

}  // namespace
}  // namespace retrace::test::image_command_test

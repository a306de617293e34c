#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/app/program.h"
#include "tests/studies/solids/step_reader.h"
#include "tests/studies/solids/step_writer.h"

// Tests of commands on parts that are given as solids in STEP files.

namespace retrace::test::solid_command_test {
namespace {

const std::string kBody = "[body]\nrefractive_index = 1.4917\n";
const std::string kPrisms =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"offset\"\nx_length_mm = 2\n"
    "y_length_mm = 2\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";
const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 3\n[array]\narrangement = \"single\"\n[body]\nthickness_mm = "
    "1\n"
    "refractive_index = 1.4917\n[surface]\ndihedral_error_arcmin = [1, -0.5, 2]\n";
const std::string kSolid = "[part]\nsolid = \"part.step\"\n" + kBody;

std::string in(const TemporaryFolder& folder, const std::string& name) {
  return (folder.path() / name).string();
}

std::vector<double> rre_of(const TemporaryFolder& folder, const std::string& design) {
  std::vector<double> values;
  const Json result =
      retrace_json(folder, {"rre", design, "--engine", "exact", "--cutoff", "1e-10", "--incidence=0,12,25", "--set",
                            "detector.acceptance_half_angle_deg=[0.5, 3]"});
  for (const Json& point : result.at("points")) values.push_back(point.at("rre"));
  return values;
}

TEST(SolidPart, ReturnsTheLightOfTheDesignThatWasExported) {
  for (const std::string& text : {kPrisms, kCubes}) {
    const TemporaryFolder folder;
    folder.write("direct.toml", text);
    folder.write("solid.toml", kSolid);
    ASSERT_EQ(retrace(folder, {"export", "direct.toml", "part.step", "--quiet"}).code, 0);
    const std::vector<double> expected = rre_of(folder, "direct.toml");
    const std::vector<double> found = rre_of(folder, "solid.toml");
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-6) << k;
  }
}

/// The outline of the part has a notch and a hole.
TEST(SolidPart, OutlinesWithNotchesAndHolesReturnTheLightOfTheDesign) {
  const TemporaryFolder folder;
  folder.write("direct.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[outline]\n"
               "polygon_mm = [[0, 0], [4, 0], [4, 3], [2.5, 3], [2.5, 1.7], [1.3, 1.7], [1.3, 3], [0, 3]]\n"
               "holes_mm = [[3, 0.8, 0.5]]\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n");
  folder.write("solid.toml", kSolid);
  ASSERT_EQ(retrace(folder, {"export", "direct.toml", "part.step", "--quiet"}).code, 0);
  const std::vector<double> expected = rre_of(folder, "direct.toml");
  const std::vector<double> found = rre_of(folder, "solid.toml");
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-6) << k;
}

TEST(SolidPart, HasThePhotometryOfTheDesignThatWasExported) {
  const TemporaryFolder folder;
  folder.write("direct.toml", kCubes);
  folder.write("solid.toml", kSolid);
  ASSERT_EQ(retrace(folder, {"export", "direct.toml", "part.step", "--quiet"}).code, 0);
  // Without resampling of weak beams, the results have no random errors. The verdict is negative: exit code 1.
  const auto points = [&](const char* design) {
    std::vector<double> values;
    const Outcome outcome = retrace(folder, {"photometry", design, "--standard=r150", "--class=IA", "--colour=white",
                                             "--area-cm2=30", "--engine=exact", "--cutoff=1e-6", "--json=p.json"});
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    const Json result = folder.json("p.json");
    for (const Json& point : result.at("points")) values.push_back(point.at("value_mcd_per_lx"));
    return values;
  };
  const std::vector<double> expected = points("direct.toml");
  const std::vector<double> found = points("solid.toml");
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_GT(found.size(), 3U);
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k] / expected[k], 1.0, 1e-3) << k;
}

/// The design has a curved entrance face, which is exact in the exported file. A solid whose entrance face is not
/// horizontal cannot be traced.
TEST(SolidPart, CurvedEntranceFacesAreExportedButNotRead) {
  const TemporaryFolder folder;
  folder.write("direct.toml", kPrisms + "[entrance_surface]\nkind = \"sphere\"\nradius_mm = 20\n");
  folder.write("solid.toml", kSolid);
  const Json json = retrace_json(folder, {"export", "direct.toml", "part.step"});
  const StepFindings found = read_step(in(folder, "part.step"));
  EXPECT_TRUE(found.is_valid);
  EXPECT_EQ(found.spheres, 1);
  EXPECT_EQ(json.at("entrance_face"), "sphere");
  EXPECT_EQ(json.at("faces"), found.faces);
  EXPECT_EQ(json.at("surface_error_mm"), 0.0);
  EXPECT_NEAR(found.volume_mm3, json.at("volume_mm3").get<double>(), 1e-6 * found.volume_mm3);
  EXPECT_NEAR(found.area_mm2, json.at("area_mm2").get<double>(), 1e-6 * found.area_mm2);
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "solid.toml", "-o", "out"})), "solid.toml:2: part.solid");
}

TEST(SolidPart, EntranceFacesOfDesignsKeepTheirSurface) {
  const TemporaryFolder folder;
  const auto face = [&](const std::string& keys) {
    folder.write("d.toml", kPrisms + "[entrance_surface]\n" + keys);
    const Json json = retrace_json(folder, {"export", "d.toml", "part.step"});
    const StepFindings found = read_step(in(folder, "part.step"));
    EXPECT_TRUE(found.is_valid) << keys;
    EXPECT_NEAR(found.volume_mm3, json.at("volume_mm3").get<double>(), 1e-6 * found.volume_mm3) << keys;
    EXPECT_NEAR(found.area_mm2, json.at("area_mm2").get<double>(), 1e-6 * found.area_mm2) << keys;
    EXPECT_LE(json.at("surface_error_mm").get<double>(), 1e-6) << keys;
    return json.at("entrance_face").get<std::string>();
  };
  const std::string inclined = "incidence_deg = 20\nazimuth_deg = 30\nrotation_deg = 25\n";
  EXPECT_EQ(face("kind = \"plane\"\n" + inclined), "plane");
  EXPECT_EQ(face("kind = \"cylinder\"\nradius_mm = 9\n" + inclined), "cylinder");
  EXPECT_EQ(face("kind = \"cylinder\"\nradius_mm = -9\n" + inclined), "cylinder");
  EXPECT_EQ(face("kind = \"sphere\"\nradius_mm = -15\n" + inclined), "sphere");
  EXPECT_EQ(face("kind = \"sphere\"\nradius_mm = 15\nconic = -1\n"), "B-spline");
  EXPECT_EQ(face("kind = \"biconic\"\nradii_mm = [15, 40]\n" + inclined), "B-spline");
  EXPECT_EQ(face("kind = \"formula\"\nformula = \"0.01 * cos(3 * x) - r^2 / 50\"\n"), "B-spline");
}

/// Boxes in metres, and a box that is upside down.
TEST(SolidPart, UnitsAndRotationsAreThoseOfTheFileAndTheDesign) {
  const TemporaryFolder folder;
  folder.write("solid.toml", kSolid);
  const auto measures = [&](const Arguments& more) {
    return retrace_json(folder, with({"export", "solid.toml"}, more));
  };
  write_boxes(in(folder, "part.step"), {{{0, 0, 0}, {4, 3, 2}}}, "M");
  const Json upright = measures({});
  EXPECT_NEAR(upright.at("volume_mm3").get<double>(), 24.0, 1e-12);
  EXPECT_NEAR(upright.at("upper_mm").at(2).get<double>(), 2.0, 1e-12);
  const Json turned = measures({"--set", "part.rotate_deg=[90, 0, 90]"});
  // A rotation about x exchanges y and z; the rotation about z then exchanges x and y.
  for (const auto& [axis, length] : {std::pair(0U, 2.0), std::pair(1U, 4.0), std::pair(2U, 3.0)})
    EXPECT_NEAR(turned.at("upper_mm").at(axis).get<double>() - turned.at("lower_mm").at(axis).get<double>(), length,
                1e-12);
  const Json down = measures({"--set", "part.facing=\"down\""});
  EXPECT_NEAR(down.at("upper_mm").at(2).get<double>(), 0.0, 1e-12);
  EXPECT_NEAR(down.at("lower_mm").at(1).get<double>(), -3.0, 1e-12);
}

TEST(SolidPart, SolidsOfOneFileAreUnitedWithAWarning) {
  const TemporaryFolder folder;
  folder.write("solid.toml", kSolid);
  const auto united = [&](const std::vector<Box>& boxes) {
    write_boxes(in(folder, "part.step"), boxes);
    const Outcome outcome = retrace(folder, {"export", "solid.toml", "--json", "e.json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;
    return folder.json("e.json").at("volume_mm3").get<double>();
  };
  const Box plate{{0, 0, 0}, {4, 4, 2}};
  EXPECT_NEAR(united({plate, {{1, 1, -0.5}, {2, 3, 0.5}}}), 33.0, 1e-9);  // overlapping
  EXPECT_NEAR(united({plate, {{1, 1, -0.5}, {2, 3, 0.0}}}), 33.0, 1e-9);  // touching
}

/// The chords of a half cylinder below a plate remove less than two thirds of the tolerance times the width of the arc.
TEST(SolidPart, CurvedFacesAreTracedWithinTheirTolerance) {
  const TemporaryFolder folder;
  folder.write("solid.toml", kSolid);
  write_plate_with_half_cylinder(in(folder, "part.step"), 4.0, 1.0, 1.0);
  const double exact_mm3 = 16.0 + 4.0 * 0.5 * 3.14159265358979;
  for (const double chord_mm : {1e-2, 1e-4}) {
    const Outcome outcome = retrace(
        folder, {"export", "solid.toml", "--json", "e.json", "--set", "part.chord_mm=" + std::to_string(chord_mm)});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;
    const double volume_mm3 = folder.json("e.json").at("volume_mm3");
    EXPECT_LT(volume_mm3, exact_mm3);
    EXPECT_GT(volume_mm3, exact_mm3 - 4.0 * 3.1416 * chord_mm);
  }
  const Json light = retrace_json(folder, {"rre", "solid.toml", "--samples", "4096", "--incidence=0"});
  EXPECT_LT(light.at("points").at(0).at("ledger").at("lost"), 1e-9);
}

TEST(SolidPart, WrongFilesAndKeysAreRefused) {
  const TemporaryFolder folder;
  write_boxes(in(folder, "part.step"), {{{0, 0, 0}, {4, 3, 2}}});
  const std::string step = folder.read("part.step");
  folder.write("cut.step", step.substr(0, step.size() / 2));
  folder.write("text.step", "hello");
  folder.write("empty.step", "");
  folder.write("header.step", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
  write_shell(in(folder, "shell.step"));
  const auto refused = [&](const std::string& part, const std::string& place) {
    folder.write("d.toml", "[part]\n" + part + kBody);
    EXPECT_EQ(refused_at(retrace(folder, {"rre", "d.toml", "--samples", "64", "-o", "out"})), place) << part;
  };
  for (const char* const file : {"none", "cut", "text", "empty", "header", "shell"})
    refused("solid = \"" + std::string(file) + ".step\"\n", "d.toml:2: part.solid");
  const std::string solid = "solid = \"part.step\"\n";
  refused("solid = 3\n", "d.toml:2: part.solid");
  refused(solid + "mesh = \"part.stl\"\n", "d.toml:3: part.mesh");
  refused(solid + "plate_mm = [1, 1]\n", "d.toml:2: part.solid");
  refused(solid + "facets = \"planes.csv\"\n", "d.toml:3: part.facets");
  refused(solid + "scale = 2\n", "d.toml:3: part.scale");
  refused(solid + "weld_mm = 0.1\n", "d.toml:3: part.weld_mm");
  refused(solid + "allow_open = true\n", "d.toml:3: part.allow_open");
  refused(solid + "chord_mm = 0\n", "d.toml:3: part.chord_mm");
  refused(solid + "rotate_deg = [1, 2]\n", "d.toml:3: part.rotate_deg");
  refused(solid + "rotate_deg = 90\n", "d.toml:3: part.rotate_deg");
  refused(solid + "facing = \"left\"\n", "d.toml:3: part.facing");
  refused(solid + "[array]\nx_length_mm = 1\n", "d.toml:3: array");
  refused(solid + "[surface]\nroot_radius_um = 1\n", "d.toml:4: surface.root_radius_um");
  refused("rotate_deg = [0, 0, 90]\nplate_mm = [1, 1]\n", "d.toml:2: part.rotate_deg");
  folder.write("d.toml", "[part]\n" + solid + "[body]\nthickness_mm = 5\n");
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "d.toml", "-o", "out"})), "d.toml:2: part.solid");
  folder.write("d.toml", "[part]\n" + solid + kBody);
  EXPECT_EQ(refused_at(retrace(folder, {"export", "d.toml", "--what", "mould"})), "d.toml:2: part.solid");
}

}  // namespace
}  // namespace retrace::test::solid_command_test

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "tests/support/refusals.h"

#include "tests/app/program.h"

// Tests of the commands inspect, init, list and help, and of interrupts.

namespace retrace::test::commands_test {
namespace {

using namespace std::chrono_literals;

/// Returns a design with n x n elements in brick rows on 10 mm x 10 mm.
std::string brick(int n, const std::string& shifted_rows) {
  const std::string size = std::to_string(10.0 / n);
  return "[element]\nkind = \"rtp\"\nbase_mm = " + size + "\nwidth_mm = " + size +
         "\n[array]\narrangement = \"offset\"\nshifted_rows = \"" + shifted_rows +
         "\"\nx_length_mm = 10\ny_length_mm = 10\n[body]\nthickness_mm = 2\nrefractive_index = 1.4917\n";
}

std::string infinite_cubes(const std::string& kind, double index) {
  return "[element]\nkind = \"" + kind + "\"\naperture_mm = " + std::to_string(2.0 * std::sqrt(2.0 / 3.0)) +
         "\n[array]\nextent = \"infinite\"\n[body]\nthickness_mm = 1\nrefractive_index = " + std::to_string(index) +
         "\n";
}

Json inspect(const std::string& design) {
  const TemporaryFolder folder;
  return retrace_json(folder, {"inspect", "-"}, design);
}

TEST(Inspect, CountsAndMeasuresBrickRows) {
  const Json json = inspect(brick(25, "even"));
  for (const char* key :
       {"schema", "version", "warnings", "complete", "elements_full", "elements_partial", "element_depth_mm",
        "facet_area_mm2", "entrance_area_mm2", "tir_limit_deg", "dead_zone_fraction"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["schema"], "retrace.inspect/2");
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["elements_full"], 613) << "n n - floor(n / 2)";
  EXPECT_EQ(json["elements_partial"], 24) << "two at each of the twelve shifted rows";
  EXPECT_NEAR(json["element_depth_mm"].get<double>(), 0.2, 1e-12);
  EXPECT_NEAR(json["entrance_area_mm2"].get<double>(), 100.0, 1e-9);
  EXPECT_NEAR(json["facet_area_mm2"].get<double>(), 100.0 * std::sqrt(2.0), 1e-6) << "facets at 45 degrees";
  EXPECT_NEAR(json["tir_limit_deg"].get<double>(), 4.33, 0.005);
  EXPECT_EQ(json["dead_zone_fraction"], 0);
}

TEST(Inspect, OddRowsShiftedGiveTheCountOfThePaper) {
  const Json json = inspect(brick(5, "odd"));
  EXPECT_EQ(json["elements_full"], 22);
  EXPECT_EQ(json["elements_partial"], 6);
  EXPECT_EQ(json["warnings"].size(), 1U) << "elements that the border cuts";
}

/// A fillet of radius r in a root of 90 degrees touches both facets at the distance r from the root. The fillet
/// therefore removes a strip of width sqrt(2) r of each base, even if this is a large fraction of the base.
TEST(Inspect, ReportsTheFractionThatARootTakesOfPrisms) {
  for (const double fraction : {0.01, 0.1, 0.3}) {
    const double radius_um = 1e3 * fraction / std::sqrt(2.0);
    const Json json = inspect(
        "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"aligned\"\n"
        "extent = \"infinite\"\n[body]\nthickness_mm = 1\nrefractive_index = 1.5\n[surface]\nroot_radius_um = " +
        std::to_string(radius_um) + "\n");
    EXPECT_NEAR(json["dead_zone_fraction"].get<double>(), fraction, 1e-8);
  }
}

// Rounded edges of radius r make strips of the aperture ineffective. The roots are the edges between two facets. Each
// of the three roots has the length a sqrt(2/3), where a is the edge length of the cube, and a strip r / sqrt(2) wide
// on either side. The rims are the edges between two elements. The strips along the six rims of a hexagon are r /
// sqrt(2) wide. The strips along the three rims of a triangle are sqrt(2/3) r wide. The overlap of strips is of second
// order in r.
TEST(Inspect, TellsWhatEdgesTakeOfCubeCorners) {
  const auto share = [](const std::string& kind, const std::string& key, double radius_um) {
    return inspect(infinite_cubes(kind, 1.5) + "[surface]\n" + key + " = " +
                   std::to_string(radius_um))["dead_zone_fraction"]
        .get<double>();
  };
  const double r = 1e-3;  // radius in mm; the edge of the cube is 1 mm long
  const double hexagon = std::sqrt(3.0);
  const double triangle = 0.5 * std::sqrt(3.0);
  const double root = 3.0 * std::sqrt(2.0 / 3.0) * std::sqrt(2.0) * r;
  const auto slope = [&](const std::string& kind, const std::string& key) {
    return 2.0 * share(kind, key, 1.0) - 0.5 * share(kind, key, 2.0);
  };
  EXPECT_NEAR(slope("hexagonal_icc", "root_radius_um"), root / hexagon, 1e-7);
  EXPECT_NEAR(slope("triangular_icc", "root_radius_um"), root / triangle, 1e-7);
  EXPECT_NEAR(slope("hexagonal_icc", "rim_radius_um"), root / hexagon, 1e-7);
  EXPECT_NEAR(slope("triangular_icc", "rim_radius_um"), 3.0 * std::sqrt(2.0) * std::sqrt(2.0 / 3.0) * r / triangle,
              1e-7);
}

TEST(Inspect, CubeCornersHaveTheLimitsOfTheirIndex) {
  for (const std::string kind : {"hexagonal_icc", "triangular_icc"}) {
    EXPECT_NEAR(inspect(infinite_cubes(kind, 1.4906))["tir_limit_deg"].get<double>(), 19.0, 0.05) << kind;
    EXPECT_NEAR(inspect(infinite_cubes(kind, 1.585))["tir_limit_deg"].get<double>(), 25.3, 0.05) << kind;
    EXPECT_NEAR(inspect(infinite_cubes(kind, 1.4607))["tir_limit_deg"].get<double>(), 17.0, 0.05) << kind;
  }
  EXPECT_NEAR(inspect(infinite_cubes("hexagonal_icc", 1.5))["element_depth_mm"].get<double>(), 2.0 / std::sqrt(3.0),
              1e-5);
  EXPECT_NEAR(inspect(infinite_cubes("triangular_icc", 1.5))["element_depth_mm"].get<double>(), 1.0 / std::sqrt(3.0),
              1e-5);
}

TEST(Inspect, DihedralErrorOfAPrismIsItsApexAngle) {
  const Json error = inspect(brick(5, "odd") + "[surface]\ndihedral_error_arcmin = 30\n");
  const std::string plain = brick(5, "odd");
  const std::size_t array = plain.find("[array]");
  const Json apex = inspect(plain.substr(0, array) + "apex_angle_deg = 90.5\n" + plain.substr(array));
  for (const char* key : {"element_depth_mm", "facet_area_mm2", "tir_limit_deg"})
    EXPECT_NEAR(error[key].get<double>(), apex[key].get<double>(), 1e-12) << key;
  // At the limit, light hits the first facet at the critical angle. This facet is inclined by 44.75 degrees instead of
  // 45.
  const double inside = std::asin(std::sin(apex["tir_limit_deg"].get<double>() * std::numbers::pi / 180.0) / 1.4917);
  EXPECT_NEAR(inside, 44.75 * std::numbers::pi / 180.0 - std::asin(1.0 / 1.4917), 1e-9);
}

TEST(Inspect, SaysHowUnlikeErrorsCloseTheBoundary) {
  const std::string unlike = "[surface]\ndihedral_error_arcmin = [1, -2, 3]\n";
  EXPECT_EQ(inspect(infinite_cubes("hexagonal_icc", 1.5) + unlike)["boundary"],
            "closed, free of self-intersections (checked on a smaller array of the same elements)");
  EXPECT_EQ(inspect(infinite_cubes("triangular_icc", 1.5) + unlike)["boundary"],
            "closed, touches itself along edges (checked on a smaller array of the same elements)");
}

/// Smallest angle of incidence at which a facet of a canted cube corner loses total reflection, and its azimuth. Before
/// canting, the dihedral edges are at the azimuths 0, 120 and 240 degrees. first_loss() searches all directions on a
/// fine grid.
struct FirstLoss {
  double incidence_deg = 90.0;
  double azimuth_deg = 0.0;
};
FirstLoss first_loss(double cant_deg, double cant_azimuth_deg, double index, double back_index) {
  constexpr double deg = std::numbers::pi / 180.0;
  FirstLoss first;
  for (double azimuth = 0.0; azimuth < 360.0; azimuth += 0.5) {
    for (double incidence = 0.0; incidence < first.incidence_deg; incidence += 0.005) {
      const double sine = std::sin(incidence * deg) / index;
      // Rotate the direction of the light by the cant, into the frame of the cube corner.
      const double x = sine * std::cos((azimuth - cant_azimuth_deg) * deg);
      const double y = sine * std::sin((azimuth - cant_azimuth_deg) * deg);
      const double z = std::sqrt(1.0 - sine * sine);
      const double along = x * std::cos(cant_deg * deg) - z * std::sin(cant_deg * deg);
      const double axial = x * std::sin(cant_deg * deg) + z * std::cos(cant_deg * deg);
      double most_square = -1.0;
      for (const double edge : {0.0, 120.0, 240.0}) {
        const double a = (edge - cant_azimuth_deg) * deg;
        const double cosine = std::sqrt(2.0 / 3.0) * (along * std::cos(a) + y * std::sin(a)) + axial / std::sqrt(3.0);
        most_square = std::max(most_square, cosine);
      }
      if (index * std::sqrt(1.0 - most_square * most_square) < back_index) first = {incidence, azimuth};
    }
  }
  return first;
}

TEST(Inspect, CantedCubesHaveTheLimitThatTryingFinds) {
  for (const std::string kind : {"hexagonal_icc", "triangular_icc"})
    for (const auto& [cant, azimuth, back] : {std::array{0.0, 0.0, 1.0}, std::array{6.0, 0.0, 1.0},
                                              std::array{9.0, 100.0, 1.0}, std::array{5.0, 180.0, 1.1}}) {
      std::string design = infinite_cubes(kind, 1.5);
      design.insert(design.find("[array]"),
                    "cant_deg = " + std::to_string(cant) + "\ncant_azimuth_deg = " + std::to_string(azimuth) + "\n");
      design += "back_index = " + std::to_string(back) + "\n";
      design.replace(design.find("thickness_mm = 1"), 16, "thickness_mm = 5");
      const Json json = inspect(design);
      const FirstLoss expected = first_loss(cant, azimuth, 1.5, back);
      EXPECT_NEAR(json["tir_limit_deg"].get<double>(), expected.incidence_deg, 0.012) << kind << cant;
      EXPECT_NEAR(json["tir_limit_azimuth_deg"].get<double>(), expected.azimuth_deg, 2.0);
      EXPECT_EQ(json["warnings"].size(), cant > 0.0 ? 1U : 0U);
    }
}

// Let b = atan(sqrt(2)) - cant be the angle between the flattest facet and the xy plane. Total reflection is lost above
// the angle of incidence asin(n sin(b - critical angle)).
TEST(Inspect, WarnsWhereTotalReflectionIsLost) {
  const auto warnings = [](const std::string& kind, const std::string& element, const std::string& body) {
    std::string design = infinite_cubes(kind, 1.5);
    design.insert(design.find("[array]"), element);
    design.replace(design.find("thickness_mm = 1"), 16, "thickness_mm = 5");
    const Json given = inspect(design + body)["warnings"];
    for (const Json& warning : given) EXPECT_EQ(recorded_place_of(warning.get<std::string>()), "standard input");
    return given.size();
  };
  const std::string hexagonal = "hexagonal_icc";
  EXPECT_EQ(warnings(hexagonal, "", ""), 0U);
  EXPECT_EQ(warnings(hexagonal, "cant_deg = 6\ncant_azimuth_deg = 180\n", ""), 1U);
  EXPECT_EQ(warnings("triangular_icc", "", "back_index = 1.1\n"), 1U);
  EXPECT_EQ(warnings(hexagonal, "cant_deg = 15\ncant_azimuth_deg = 180\n", ""), 1U);
  EXPECT_EQ(warnings(hexagonal, "", "back_index = 1.333\n"), 1U);
  EXPECT_EQ(warnings(hexagonal, "cant_deg = 15\ncant_azimuth_deg = 180\n", "[idealisation]\nfacets = \"mirror\"\n"),
            0U);
}

TEST(Inspect, LimitIsLeftOutWhereThereIsNone) {
  const Json json = inspect(infinite_cubes("hexagonal_icc", 1.2));
  EXPECT_FALSE(json.contains("tir_limit_deg"));
  EXPECT_EQ(json["warnings"].size(), 1U);
}

TEST(Inspect, TextSaysTheSameAsTheJson) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"inspect", "-"}, brick(25, "even"));
  EXPECT_EQ(outcome.code, 0);
  for (const char* part : {"613 full, 24 partial", "0.200000 mm", "100.0000 mm2", "1.49170 at 587.56 nm",
                           "up to 4.33 degrees across the roof edge", "closed, free of self-intersections"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos);
  EXPECT_EQ(warnings_of(outcome).size(), 1U) << outcome.err;
  EXPECT_TRUE(folder.names().empty());
  const Outcome quiet = retrace(folder, {"inspect", "-", "--quiet"}, brick(25, "even"));
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST(Inspect, OutHoldsTheDocument) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"inspect", "-", "--json", "-", "-o", "result"}, brick(5, "odd"));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(folder.names(),
            (Arguments{"result", "result/inspect.json", "result/plan.svg", "result/section.svg", "result/view.png"}));
  EXPECT_EQ(folder.read("result/inspect.json"), outcome.out);
}

TEST(Init, EveryKindCanBeInspectedAndTracedAsItIs) {
  for (const std::string kind : {"rtp", "hexagonal_icc", "triangular_icc"}) {
    const TemporaryFolder folder;
    const Outcome printed = retrace(folder, {"init", kind});
    EXPECT_EQ(printed.code, 0) << printed.err;
    EXPECT_EQ(retrace_json(folder, {"inspect", "-"}, printed.out)["design"]["element"]["kind"], kind);
    EXPECT_EQ(retrace_json(folder, {"rre", "-", "--samples=64"}, printed.out)["complete"], true);
    EXPECT_TRUE(folder.names().empty());
    EXPECT_EQ(retrace(folder, {"init", kind, "--out", "new.toml"}).code, 0);
    EXPECT_EQ(folder.read("new.toml"), printed.out);
  }
}

TEST(Init, ThePartOfALatheCanBeMadeAsItIs) {
  const TemporaryFolder folder;
  EXPECT_EQ(retrace(folder, {"init", "round_zone_lens", "-o", "lens.toml"}).code, 0);
  EXPECT_EQ(retrace_json(folder, {"plane", "lens.toml"})["spindle_rpm"], 800);
}

TEST(Init, DoesNotOverwrite) {
  const TemporaryFolder folder;
  folder.write("mine.toml", "months of work");
  const Outcome outcome = retrace(folder, {"init", "rtp", "-o", "mine.toml"});
  EXPECT_EQ(refused_at(outcome, 3), "mine.toml");
  EXPECT_EQ(folder.read("mine.toml"), "months of work");
}

TEST(Init, JsonHoldsTheTemplate) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"init", "rtp"});
  for (const char* key : {"schema", "version", "warnings", "complete"}) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["text"], retrace(folder, {"init", "rtp"}).out);
}

TEST(List, MaterialsAsTextAndJson) {
  const TemporaryFolder folder;
  const Outcome text = retrace(folder, {"list", "materials"});
  EXPECT_EQ(text.code, 0);
  const Json json = retrace_json(folder, {"list", "materials"});
  EXPECT_EQ(json["schema"], "retrace.materials/1");
  for (const char* key : {"version", "warnings", "complete"}) EXPECT_TRUE(json.contains(key)) << key;
  ASSERT_GE(json["materials"].size(), 4U);
  EXPECT_EQ(lines_of(text.out).size(), json["materials"].size() + json["metals"].size() + 1);
  ASSERT_GE(json["metals"].size(), 1U);
  for (const Json& metal : json["metals"]) {
    EXPECT_NE(text.out.find("\n" + metal["name"].get<std::string>() + " "), std::string::npos) << metal;
    EXPECT_GT(metal["extinction_coefficient"].get<double>(), 0.0) << metal;
  }
  for (const Json& material : json["materials"]) {
    const std::string name = material["name"];
    EXPECT_NE(text.out.find("\n" + name + " "), std::string::npos) << name;
    EXPECT_FALSE(material["source"].get<std::string>().empty()) << name;
    EXPECT_GE(material["refractive_index"].get<double>(), 1.0) << name;
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(Help, ShowsEveryOptionWithItsDefault) {
  const TemporaryFolder folder;
  const std::string common = retrace(folder, {"--help"}).out;
  for (const char* option : {"--json FILE", "-o,--out DIR", "--threads N", "--seed S=1", "--set KEY=VALUE", "--quiet",
                             "--version", "-h,--help", "rre", "inspect", "init", "list"})
    EXPECT_NE(common.find(option), std::string::npos) << option;
  for (const Arguments& run : {Arguments{"rre", "--help"}, Arguments{"--help", "rre"}, Arguments{"rre", "-h"}}) {
    const Outcome rre = retrace(folder, run);
    EXPECT_EQ(rre.code, 0);
    if (run.front() != "rre") continue;
    for (const char* option :
         {"--incidence LIST", "[0; with --map", "--azimuth LIST", "--engine ENGINE=auto", "--samples N",
          "--target-error E", "[0.0001;", "--cutoff W", "[1e-10;", "--threads N", "--seed S [1]"})
      EXPECT_NE(rre.out.find(option), std::string::npos) << option;
  }
  for (const Arguments& run : {Arguments{"--version"}, Arguments{"rre", "--version"}}) {
    const Outcome version = retrace(folder, run);
    EXPECT_EQ(version.code, 0);
    EXPECT_TRUE(version.out.starts_with("retrace ")) << version.out;
    EXPECT_EQ(lines_of(version.out).size(), 1U);
  }
}

TEST(Interrupt, WritesTheFinishedPointsAndEndsWith130) {
  const std::string design = example("rtp_brick_2mm.toml");
  Arguments arguments = {RETRACE_PROGRAM, "rre", design, "--samples=65536", "--incidence=-80:80:0.01", "-o", "r"};
  // The complete run takes far longer than any wait. The wait is doubled until at least one point is finished, so that
  // the test also passes on a slow machine.
  for (auto wait = 1s;; wait *= 2) {
    ASSERT_LE(wait, 64s) << "no point was finished";
    const TemporaryFolder folder;
    Child child(folder.path(), arguments);
    std::this_thread::sleep_for(wait);
    child.interrupt();
    const Outcome outcome = child.wait();
    ASSERT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_EQ(folder.names(), (Arguments{"r", "r/rre.csv", "r/rre.json", "r/rre.png", "r/rre.svg"}));
    const Json json = folder.json("r/rre.json");
    EXPECT_EQ(json["complete"], false);
    const std::size_t finished = json["points"].size();
    EXPECT_EQ(lines_of(folder.read("r/rre.csv")).size(), finished + 1);
    ASSERT_LT(finished, 16001U);
    if (finished == 0) continue;

    // The file contains only finished points. The last point must equal the result of an uninterrupted run for this
    // direction.
    const Json& last = json["points"][finished - 1];
    const std::string incidence = "--incidence=" + last["incidence_deg"].dump();
    const Json whole = retrace_json(folder, {"rre", design, "--samples=65536", incidence});
    EXPECT_EQ(whole["points"][0], last);
    EXPECT_EQ(json["rays"], 65536 * finished);
    return;
  }
}

TEST(Interrupt, BeforeAPointIsFinishedWritesAValidDocumentWithoutPoints) {
  // The wait is doubled until the run has something to write, so that the test also passes on a slow machine.
  for (auto wait = 3s;; wait *= 2) {
    ASSERT_LE(wait, 48s) << "nothing was begun";
    const TemporaryFolder folder;
    Child child(folder.path(), {RETRACE_PROGRAM, "rre", example("tail_lamp_100cm2.toml"), "--incidence=25",
                                "--samples=4294967296", "--json", "-", "-o", "r"});
    std::this_thread::sleep_for(wait);
    child.interrupt();
    const Outcome outcome = child.wait();
    EXPECT_EQ(outcome.code, 130);
    if (outcome.out.empty() && outcome.err.empty() && folder.names().empty()) continue;
    const Json json = Json::parse(outcome.out, nullptr, false);
    ASSERT_TRUE(json.is_object()) << outcome.out << outcome.err;
    EXPECT_EQ(json["complete"], false);
    EXPECT_TRUE(json["points"].empty());
    EXPECT_EQ(folder.names(), (Arguments{"r", "r/rre.csv", "r/rre.json", "r/rre.png", "r/rre.svg"}));
    return;
  }
}

TEST(Interrupt, WhileWaitingForStandardInputEndsAtOnce) {
  const TemporaryFolder folder;
  Child child(folder.path(), {RETRACE_PROGRAM, "rre", "-", "-o", "r"}, "", Input::silent);
  std::this_thread::sleep_for(1s);
  child.interrupt();
  EXPECT_EQ(child.wait().code, 130);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace retrace::test::commands_test

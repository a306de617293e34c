#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "tests/app/program.h"

// Tests of jobs for cube corners: from a design to NC text, and back to a machined part that is traced.

namespace retrace::test::chiseling_command_test {
namespace {

std::string design(bool is_hexagonal) {
  // The design has 3 x 3 triangles, or a central hexagon with 6 hexagons around it.
  return std::string("[element]\nkind = \"") + (is_hexagonal ? "hexagonal_icc" : "triangular_icc") +
         "\"\naperture_mm = 0.3\n[array]\nx_length_mm = " + "0.76" +
         "\ny_length_mm = " + (is_hexagonal ? "0.79" : "0.53") +
         "\npartial_elements = \"omit\"\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";
}

class ChiselingCommand : public ::testing::Test {
 protected:
  void make(bool is_hexagonal) {
    folder_.write("design.toml", design(is_hexagonal));
    const Outcome job = retrace(
        folder_, {"job", "design.toml", "--strategy", "dmc", "--tool-width-mm", "0.5", "-o", "job.toml", "--quiet"});
    ASSERT_EQ(job.code, 0) << job.err;
    ASSERT_NE(folder_.read("job.toml").find("machine = \"ideal-dmc\""), std::string::npos);
  }
  Json fabricated(const std::string& dialect) {
    const Outcome made = retrace(folder_, {"fabricate", "job.toml", "--dialect", dialect, "-o", dialect, "--quiet"});
    EXPECT_EQ(made.code, 0) << made.err;
    return folder_.json(dialect + "/fabrication.json");
  }
  double rre_of(const std::string& name) {
    const Json json = retrace_json(folder_, {"rre", name, "--engine", "exact", "--cutoff", "1e-6", "--set",
                                             "detector.acceptance_half_angle_deg=0.5"});
    return json["points"][0]["rre"].get<double>();
  }
  /// Writes the design without the surface texture of the cuts.
  void write_smooth(const std::string& from, const std::string& to) {
    folder_.write(to, without_texture(folder_.read(from)));
  }

  TemporaryFolder folder_;
};

TEST_F(ChiselingCommand, EveryDialectVerifiesAndTakesItsTime) {
  make(false);
  give_mist_lines(folder_, "job.toml");
  for (const std::string dialect : {"rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"}) {
    const Json made = fabricated(dialect);
    EXPECT_EQ(made["strategy"], "dmc");
    EXPECT_EQ(made["elements"], 9);
    EXPECT_EQ(made["plunge_rake_deg"], 22.0);
    EXPECT_NEAR(made["poses"][0]["b_deg"].get<double>(), 35.2643897, dialect == "fanuc" ? 5e-7 : 1e-7);
    // Each layer requires six rotations, and the return requires one more. The face of the blank is 61 um above every
    // facet. This depth is removed in four layers of 15 um and two of 5 um.
    EXPECT_EQ(made["cuts_per_facet"], 4);
    const std::string file = dialect + "/" + made["programs"][0].get<std::string>();
    const Json json = retrace_json(folder_, {"verify", "job.toml", file});
    EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
    EXPECT_LT(json["facet_distance_nm_max"].get<double>(), 1.0);
    EXPECT_EQ(json["border_overcut_mm3"], 0.0);
    const double a = 0.3 * std::sqrt(3.0 / 8.0);
    EXPECT_NEAR(json["removed_volume_mm3"].get<double>(), 9.0 * a * a * a / 6.0, 1e-7);
    // The axis C of a Sinumerik rotates in the shorter direction.
    const double planned_s = made["time_s"].get<double>();
    EXPECT_NEAR(json["time_s"].get<double>(), planned_s, (dialect == "sinumerik" ? 0.1 : 0.01) * planned_s);
  }
}

TEST_F(ChiselingCommand, TrianglesAsMachinedReturnWhatTheDesignDoes) {
  make(false);
  fabricated("rs274ngc");
  ASSERT_EQ(retrace(folder_, {"verify", "job.toml", "rs274ngc/program.ngc", "--as-machined", "part.toml", "--map",
                              "map.png", "--quiet"})
                .code,
            0);
  EXPECT_NE(folder_.read("part.toml").find("facet_tilt_arcmin = ["), std::string::npos) << folder_.read("part.toml");
  write_smooth("part.toml", "smooth.toml");
  EXPECT_NEAR(rre_of("smooth.toml"), rre_of("design.toml"), 1e-6);
}

TEST_F(ChiselingCommand, HexagonsAsMachinedHaveFlares) {
  make(true);
  fabricated("rs274ngc");
  const Json json = retrace_json(
      folder_, {"verify", "job.toml", "rs274ngc/program.ngc", "--as-machined", "part.toml", "--map", "map.png"});
  EXPECT_EQ(json["verdict"], "pass");
  ASSERT_EQ(json["elements_cut"], 7);
  // The outline of seven hexagons has 12 corners at which a dihedral edge ends. The total volume of the cuts beyond the
  // outline is (12 - 7) / 6 = 5 / 6 of the volume of a cube.
  const double a = 0.3 * std::sqrt(3.0 / 8.0);
  EXPECT_NEAR(json["border_overcut_mm3"].get<double>(), 5.0 / 6.0 * a * a * a, 1e-12);
  ASSERT_NE(folder_.read("part.toml").find("facets = \"part_facets.csv\""), std::string::npos);
  const Json inspected = retrace_json(folder_, {"inspect", "part.toml"});
  EXPECT_EQ(inspected["elements_full"], 7);
  EXPECT_EQ(inspected["boundary"], "closed, free of self-intersections");
  // Each element has three square facets. The area of the flares (cuts beyond the hexagons) within the extent is added.
  EXPECT_GT(inspected["facet_area_mm2"].get<double>(), 21.0 * a * a);
  write_smooth("part.toml", "smooth.toml");
  // The hexagons return as much light as in the design. At normal incidence, flares add little or no light.
  EXPECT_NEAR(rre_of("smooth.toml"), rre_of("design.toml"), 0.05);
}

std::string cube_design(bool is_hexagonal) {
  return std::string("[element]\nkind = \"") + (is_hexagonal ? "hexagonal_icc" : "triangular_icc") +
         "\"\naperture_mm = 1\n[array]\nx_length_mm = 2.6\ny_length_mm = 2.7\npartial_elements = \"omit\"\n[body]\n"
         "thickness_mm = 1\nrefractive_index = 1.4917\n";
}

/// A chisel cannot reach a triangular region of each facet at the apex. The height of the region is half the length of
/// the edge of the chisel. The material that remains above the apex ends where three rake faces meet. The planes of the
/// cut must give the same height of this material.
TEST(ReachablePart, IsAllButTheApexAndIsTraced) {
  const TemporaryFolder folder;
  for (const bool is_hexagonal : {false, true}) {
    folder.write("d.toml", cube_design(is_hexagonal));
    const Outcome made = retrace(folder, {"job", "d.toml", "--strategy", "unidirectional", "--tool-width-mm", "0.2",
                                          "--reachable", "part.toml", "--json", "reach.json"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Json reach = folder.json("reach.json");
    const double a = std::sqrt(3.0 / 8.0);
    const double area = (is_hexagonal ? 1.0 : 0.5) * a * a;
    EXPECT_EQ(reach["schema"], "retrace.reach/2");
    EXPECT_NEAR(reach["facet_area_mm2"].get<double>(), area, 1e-12);
    EXPECT_NEAR(reach["reached_fraction"].get<double>(), 1.0 - 0.01 / area, 1e-12);
    EXPECT_NEAR(reach["reached_fraction_cut"].get<double>(), 1.0 - 0.01 / area, 0.01);
    // The highest point of the remaining material is on the axis. Its distance t from each facet follows from the
    // equation sqrt(2) t - 0.1 = t / tan(53 degrees).
    const double t = 0.1 / (std::sqrt(2.0) - 1.0 / std::tan(53.0 * 3.14159265358979 / 180.0));
    EXPECT_NEAR(reach["core_mm"].get<double>(), std::sqrt(3.0) * t, 1e-9);
    EXPECT_NEAR(reach["core_mm_cut"].get<double>(), std::sqrt(3.0) * t, 1e-6);
    const Json inspected = retrace_json(folder, {"inspect", "part.toml"});
    EXPECT_EQ(inspected["elements_full"], reach["elements"]);
    EXPECT_EQ(inspected["boundary"], "closed, free of self-intersections");
    const auto rre = [&](const std::string& name) {
      return retrace_json(folder, {"rre", name, "--engine", "montecarlo", "--samples", "20000"})["points"][0]["rre"]
          .get<double>();
    };
    const double whole = rre("d.toml");
    const double part = rre("part.toml");
    EXPECT_LT(part, whole);
    // Light that meets the core is lost, both incident and returning light. Seen from above, the core covers 3 (0.2 /
    // 2)^2 / sqrt(3) mm^2 of each cell.
    EXPECT_GT(part, 0.4 * whole);
  }
}

TEST(ReachablePart, WhatIsWrongIsRefusedInOneLine) {
  const TemporaryFolder folder;
  folder.write("d.toml", cube_design(false));
  folder.write("p.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"single\"\n"
               "[body]\nthickness_mm = 1\n");
  const Arguments before = folder.names();
  const std::pair<Arguments, std::string> cases[] = {
      {{"job", "d.toml", "--tool-width-mm", "0.5", "--reachable", "o.toml"}, "--tool-width-mm"},
      {{"job", "d.toml", "--tool-width-mm", "0.2", "--strategy", "dmc", "--reachable", "o.toml"}, "--reachable"},
      {{"job", "p.toml", "--tool-width-mm", "0.2", "--reachable", "o.toml"}, "--reachable"},
      {{"job", "d.toml", "--tool-width-mm", "0.2", "--reachable", "o.toml", "-o", "j.toml"}, "--out"},
      {{"job", "d.toml", "--tool-width-mm", "0.2", "--reachable", "d.toml"}, "--reachable"},
      {{"job", "d.toml", "--tool-width-mm", "0.2", "--set", "array.x_length_mm=0.1", "--reachable", "o.toml"},
       "--set array.x_length_mm=0.1: array.x_length_mm"}};
  for (const auto& [arguments, message] : cases) {
    EXPECT_EQ(refused_at(retrace(folder, arguments)), message);
    EXPECT_EQ(folder.names(), before);
  }
}

}  // namespace
}  // namespace retrace::test::chiseling_command_test

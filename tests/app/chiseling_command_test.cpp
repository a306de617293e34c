#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/app/program.h"

// Cube corners from a design to NC text, and back to a part that is traced.

namespace retrace::test {
namespace {

std::string design(bool is_hexagonal) {
  // 3 x 3 triangles, or 7 hexagons round the one in the middle.
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
  /// The design without what the cuts' texture adds.
  void write_smooth(const std::string& from, const std::string& to) {
    std::string text = folder_.read(from);
    const std::size_t texture = text.find("# Sa ");
    ASSERT_NE(texture, std::string::npos);
    folder_.write(to, text.erase(texture, text.find("\n[detector]") - texture));
  }

  TemporaryFolder folder_;
};

TEST_F(ChiselingCommand, EveryDialectVerifiesAndTakesItsTime) {
  make(false);
  for (const std::string dialect : {"rs274ngc", "sinumerik", "fanuc", "pmac"}) {
    const Json made = fabricated(dialect);
    EXPECT_EQ(made["strategy"], "dmc");
    EXPECT_EQ(made["elements"], 9);
    EXPECT_EQ(made["plunge_rake_deg"], 22.0);
    EXPECT_NEAR(made["poses"][0]["b_deg"].get<double>(), 35.2643897, 1e-7);
    // Six turns a layer, four layers of 15 um, two of 5: the blank's face is 61 um from every facet. And the return.
    EXPECT_EQ(made["cuts_per_facet"], 4);
    const std::string file = dialect + "/" + made["programs"][0].get<std::string>();
    const Json json = retrace_json(folder_, {"verify", "job.toml", file});
    EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
    EXPECT_LT(json["facet_distance_nm_max"].get<double>(), 1.0);
    EXPECT_EQ(json["border_overcut_mm3"], 0.0);
    const double a = 0.3 * std::sqrt(3.0 / 8.0);
    EXPECT_NEAR(json["removed_volume_mm3"].get<double>(), 9.0 * a * a * a / 6.0, 1e-7);
    EXPECT_NEAR(json["time_s"].get<double>(), made["time_s"].get<double>(), 0.01 * made["time_s"].get<double>());
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
  // Six hexagons round one have 12 corners at dihedral edges: (12 - 7) / 6 of a cube.
  const double a = 0.3 * std::sqrt(3.0 / 8.0);
  EXPECT_NEAR(json["border_overcut_mm3"].get<double>(), 5.0 / 6.0 * a * a * a, 1e-12);
  ASSERT_NE(folder_.read("part.toml").find("facets = \"part_facets.csv\""), std::string::npos);
  const Json inspected = retrace_json(folder_, {"inspect", "part.toml"});
  EXPECT_EQ(inspected["elements_full"], 7);
  EXPECT_EQ(inspected["boundary"], "closed, free of self-intersections");
  // Three squares each, and the flares within the extent.
  EXPECT_GT(inspected["facet_area_mm2"].get<double>(), 21.0 * a * a);
  write_smooth("part.toml", "smooth.toml");
  // The hexagons return what they do in the design; flares add little or nothing at normal incidence.
  EXPECT_NEAR(rre_of("smooth.toml"), rre_of("design.toml"), 0.05);
}

}  // namespace
}  // namespace retrace::test

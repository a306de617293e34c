#include <gtest/gtest.h>

#include <string>

#include "tests/app/program.h"

// Tests of elements on substrates with the program: from a design to NC text and back.

namespace retrace::test::substrate_job_test {
namespace {

const char* const kExample = "fabrication/prisms_on_cylinder.toml";

class SubstrateJob : public ::testing::Test {
 protected:
  /// Expects that the arguments are refused with exit code 2 and one line, and that nothing is written. Returns the
  /// position in the message.
  std::string refusal(const Arguments& arguments) {
    const auto before = folder_.names();
    const Outcome refused = retrace(folder_, arguments);
    EXPECT_EQ(folder_.names(), before);
    return refused_at(refused);
  }
  Json verified(const std::string& dialect) {
    const Outcome made = retrace(folder_, {"fabricate", "job.toml", "--dialect", dialect, "-o", dialect, "--quiet"});
    EXPECT_EQ(made.code, 0) << made.err;
    const Json plan = folder_.json(dialect + "/fabrication.json");
    const std::string file = dialect + "/" + plan["programs"][0].get<std::string>();
    const Json json = retrace_json(folder_, {"verify", "job.toml", file});
    EXPECT_NEAR(json["time_s"].get<double>(), plan["time_s"].get<double>(), 0.01 * plan["time_s"].get<double>());
    return json;
  }

  TemporaryFolder folder_;
};

TEST_F(SubstrateJob, OfTheExampleVerifiesInEveryDialect) {
  const Outcome job =
      retrace(folder_, {"job", example(kExample), "--tool-width-mm", "0.5", "-o", "job.toml", "--quiet"});
  ASSERT_EQ(job.code, 0) << job.err;
  give_mist_lines(folder_, "job.toml");
  for (const std::string dialect : {"rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"}) {
    const Json json = verified(dialect);
    EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
    EXPECT_EQ(json["elements"], json["elements_cut"]);
    EXPECT_EQ(json["elements"], 60);
    EXPECT_LT(json["facet_distance_nm_max"].get<double>(), 1.0);
    // There are ten rows of prisms. Each facet of a row has its own angle A.
    EXPECT_EQ(json["poses"].size(), 20U);
  }
  EXPECT_EQ(refusal({"verify", "job.toml", "rs274ngc/program.ngc", "--map", "map.png"}), "job.toml:29: substrate");
}

/// The machined part has the RRE (retroreflective efficiency) of the design, except for the effect of the surface
/// texture.
TEST_F(SubstrateJob, AsMachinedReturnsWhatTheDesignDoes) {
  std::string design = read_text(example(kExample));
  design.replace(design.find("x_length_mm = 5"), 15, "x_length_mm = 2");
  design.replace(design.find("y_length_mm = 3"), 15, "y_length_mm = 1");
  folder_.write("design.toml", design);
  ASSERT_EQ(retrace(folder_, {"job", "design.toml", "--tool-width-mm", "0.5", "-o", "job.toml", "--quiet"}).code, 0);
  EXPECT_EQ(verified("rs274ngc")["verdict"], "pass");
  const Arguments verify = {"verify", "job.toml", "rs274ngc/program.ngc", "--as-machined", "part.toml", "--quiet"};
  ASSERT_EQ(retrace(folder_, verify).code, 0);
  std::string part = folder_.read("part.toml");
  EXPECT_NE(part.find("[substrate]\nkind = \"cylinder\"\nradius_mm = 20\n"), std::string::npos) << part;
  part = without_texture(part);
  folder_.write("smooth.toml", part);
  const auto rre = [&](const std::string& name) {
    return retrace_json(folder_, {"rre", name, "--engine", "exact", "--incidence=0,3", "--set",
                                  "detector.acceptance_half_angle_deg=0.5"})["points"];
  };
  const Json designed = rre("design.toml");
  const Json machined = rre("smooth.toml");
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_NEAR(machined[k]["rre"].get<double>(), designed[k]["rre"].get<double>(), 1e-6);
  // Without the cut of one element, the machined part corresponds to no design and is refused.
  const std::string text = folder_.read("rs274ngc/program.ngc");
  std::string cut;
  bool skips = false;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with("(element ")) skips = line == "(element 7)";
    if (!(skips && line.find("call") != std::string::npos)) cut += line + "\n";
  }
  folder_.write("cut.ngc", cut);
  EXPECT_EQ(refusal({"verify", "job.toml", "cut.ngc", "--as-machined", "other.toml"}), "--as-machined");
}

TEST_F(SubstrateJob, OfCubeCornersOnASphere) {
  folder_.write("design.toml",
                "[element]\nkind = \"triangular_icc\"\naperture_mm = 0.3\n[array]\nx_length_mm = 0.76\n"
                "y_length_mm = 0.53\npartial_elements = \"omit\"\n[substrate]\nkind = \"sphere\"\nradius_mm = 8\n"
                "[body]\nthickness_mm = 1\nrefractive_index = 1.49\n");
  ASSERT_EQ(retrace(folder_,
                    {"job", "design.toml", "--strategy", "dmc", "--tool-width-mm", "0.6", "-o", "job.toml", "--quiet"})
                .code,
            0);
  const Json json = verified("rs274ngc");
  EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
  EXPECT_LT(json["facet_distance_nm_max"].get<double>(), 1.0);
  EXPECT_EQ(refusal({"job", "design.toml", "--strategy", "dmc", "--tool-width-mm", "0.6", "--workpiece", "direct", "-o",
                     "d.toml"}),
            "--workpiece");
}

TEST_F(SubstrateJob, OfWhatCannotBeCutIsRefused) {
  EXPECT_EQ(
      refusal({"job", example("pin_bundle.toml"), "--strategy", "dmc", "--tool-width-mm", "9", "-o", "pins.toml"}),
      "examples/pin_bundle.toml: array.arrangement");
  ASSERT_EQ(retrace(folder_, {"job", example(kExample), "--tool-width-mm", "0.5", "-o", "job.toml", "--quiet", "--set",
                              "substrate.axis=x"})
                .code,
            0);
  EXPECT_EQ(refusal({"fabricate", "job.toml", "-o", "program"}), "job.toml:5: machine");
}

}  // namespace
}  // namespace retrace::test::substrate_job_test

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/app/program.h"

// Tests of parts with zones (groups of elements with the same size, rotation and angle errors): from the design to a
// job and NC text, and back to a part with zones that is traced.

namespace retrace::test::zone_job_command_test {
namespace {

std::string zoned_design(const std::string& kind, double length_mm = 6.0) {
  return "title = \"Zones\"\n[element]\nkind = \"" + kind +
         "\"\naperture_mm = 0.5\n[array]\nx_length_mm = " + std::to_string(length_mm) +
         "\ny_length_mm = 4\npartial_elements = \"omit\"\n[body]\nthickness_mm = 2\nrefractive_index = 1.4917\n"
         "[[zone]]\narea_fraction = 0.5\nset = [\"surface.dihedral_error_arcmin=9.5\"]\n"
         "[[zone]]\narea_fraction = 0.3\nrotation_deg = 33\n"
         "set = [\"surface.dihedral_error_arcmin=[3, 0, -8]\", \"surface.facet_tilt_arcmin=[1, 0, 2]\"]\n"
         "[[zone]]\narea_fraction = 0.2\nrotation_deg = 180\nset = [\"element.aperture_mm=0.4\"]\n";
}

class ZoneJobCommand : public ::testing::Test {
 protected:
  Outcome job(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"job", "design.toml", "-o", "job.toml", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    for (const auto& [option, value] : {std::pair("--strategy", "dmc"), {"--tool-width-mm", "0.75"}})
      if (std::ranges::find(more, option) == more.end()) words.insert(words.end(), {option, value});
    return retrace(folder_, words);
  }
  /// Verifies the program of the job and writes the machined part.
  /// \return the result document
  Json verified() {
    const Outcome run = retrace(
        folder_, {"verify", "job.toml", "nc/program.ngc", "--as-machined", "part.toml", "--json", "v.json", "--quiet"});
    EXPECT_EQ(run.code, 0) << run.err;
    return folder_.json("v.json");
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_.path() / name); }

  TemporaryFolder folder_;
};

TEST_F(ZoneJobCommand, ComesBackAsThePartOfZonesThatItIsMadeOf) {
  for (const std::string kind : {"hexagonal_icc", "triangular_icc"}) {
    folder_.write("design.toml", zoned_design(kind));
    const Outcome made = job();
    ASSERT_EQ(made.code, 0) << made.err;
    ASSERT_EQ(retrace(folder_, {"fabricate", "job.toml", "-o", "nc", "--quiet", "--dialect", "rs274ngc"}).code, 0);
    const Json planned = folder_.json("nc/fabrication.json");
    const Json design = retrace_json(folder_, {"inspect", "design.toml"});
    EXPECT_EQ(planned["elements"], design["elements_full"]);
    const Json json = verified();
    EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
    EXPECT_EQ(json["elements_cut"], design["elements_full"]);
    EXPECT_LT(json["facet_distance_nm_max"].get<double>(), 1.0);
    folder_.write("smooth.toml", without_texture(folder_.read("part.toml")));
    for (const std::string angle : {"0", "20"}) {
      const auto rre = [&](const std::string& name) {
        return retrace_json(folder_, {"rre", name, "--incidence", angle, "--engine", "embree", "--samples", "100000",
                                      "--set", "detector.acceptance_half_angle_deg=0.5"})["points"][0]["rre"]
            .get<double>();
      };
      // Both parts are traced with the same rays. The facets of the machined part deviate from the design by at most 1
      // nm.
      EXPECT_NEAR(rre("smooth.toml"), rre("design.toml"), 2e-3) << kind << " " << angle;
    }
  }
}

TEST_F(ZoneJobCommand, RowsInTurnAreCutInTheirPlaces) {
  folder_.write("design.toml",
                "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 0.5\n[array]\nx_length_mm = 4\ny_length_mm = 3\n"
                "[body]\nthickness_mm = 2\n[[zone]]\nrows = [1]\nevery = 2\n[[zone]]\nrest = true\nrotation_deg = 180\n"
                "set = [\"surface.dihedral_error_arcmin=5\"]\n");
  const Outcome made = job();
  ASSERT_EQ(made.code, 0) << made.err;
  ASSERT_EQ(retrace(folder_, {"fabricate", "job.toml", "-o", "nc", "--quiet"}).code, 0);
  const Json json = verified();
  EXPECT_EQ(json["verdict"], "pass") << json.dump().substr(0, 1000);
  const Json design = retrace_json(folder_, {"inspect", "design.toml"});
  EXPECT_EQ(json["elements_cut"], design["elements_full"]);
  const Json part = retrace_json(folder_, {"inspect", "part.toml"});
  EXPECT_EQ(part["elements_full"], design["elements_full"]);
}

TEST_F(ZoneJobCommand, WhatCannotBeCutIsRefusedAndNothingWritten) {
  struct Case {
    std::string from, to;
    std::vector<std::string> more;
    std::string message;
  };
  const std::string good = zoned_design("hexagonal_icc");
  const std::vector<Case> cases = {
      {"", "", {"--strategy", "two-step"}, "--strategy"},
      {"", "", {"--workpiece", "direct"}, "--workpiece"},
      {"", "", {"--tool-width-mm", "0.3"}, "--tool-width-mm"},
      {"element.aperture_mm=0.4", "element.cant_deg=3", {}, "design.toml:19: zone[3]"},
      {"element.aperture_mm=0.4",
       "element.kind=\\\"triangular_icc\\\"\", \"element.aperture_mm=0.5",
       {},
       "design.toml:19: zone[3]"},
      {"\"element.aperture_mm=0.4\"",
       "'element.kind=\"rtp\"', \"element.base_mm=0.5\", \"element.width_mm=0.5\"",
       {},
       "design.toml:19: zone[3]"},
  };
  for (const Case& wrong : cases) {
    SCOPED_TRACE(wrong.message);
    std::string text = good;
    if (!wrong.from.empty()) {
      const std::size_t at = text.find(wrong.from);
      ASSERT_NE(at, std::string::npos);
      text.replace(at, wrong.from.size(), wrong.to);
    }
    folder_.write("design.toml", text);
    const Outcome made = job(wrong.more);
    EXPECT_EQ(refused_at(made), wrong.message);
    EXPECT_FALSE(exists("job.toml"));
  }
}

/// A job file that the user has edited is cut as edited. `--as-machined` writes the edited angle errors. It refuses a
/// job whose zones have another size or rotation than the zones of the design.
TEST_F(ZoneJobCommand, EditedJobsComeBackAsTheyAreCut) {
  folder_.write("design.toml", zoned_design("hexagonal_icc"));
  ASSERT_EQ(job().code, 0);
  const std::string made = folder_.read("job.toml");
  const auto edit = [&](const std::string& from, const std::string& to) {
    std::string text = made;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    folder_.write("job.toml", text.replace(at, from.size(), to));
    ASSERT_EQ(retrace(folder_, {"fabricate", "job.toml", "-o", "nc", "--quiet"}).code, 0);
  };
  edit("dihedral_error_arcmin = [3, 0, -8]", "dihedral_error_arcmin = [13, 1, -8]");
  EXPECT_EQ(verified()["verdict"], "pass");
  EXPECT_NE(folder_.read("part.toml").find("surface.dihedral_error_arcmin=[13, 1, -8]"), std::string::npos)
      << folder_.read("part.toml");
  std::filesystem::remove(folder_.path() / "part.toml");
  struct Edit {
    std::string from, to, place;
  };
  for (const Edit& e : {Edit{"rotation_deg = 33", "rotation_deg = 33.01", "job.toml:32: zone[2]"},
                        Edit{"aperture_mm = 0.4", "aperture_mm = 0.39", "job.toml:38: zone[3]"}}) {
    edit(e.from, e.to);
    const Outcome run = retrace(folder_, {"verify", "job.toml", "nc/program.ngc", "--as-machined", "part.toml"});
    EXPECT_EQ(refused_at(run), e.place);
    EXPECT_FALSE(exists("part.toml"));
  }
}

TEST_F(ZoneJobCommand, AsMachinedNeedsTheDesignOfTheJob) {
  folder_.write("design.toml", zoned_design("hexagonal_icc"));
  ASSERT_EQ(job().code, 0);
  ASSERT_EQ(retrace(folder_, {"fabricate", "job.toml", "-o", "nc", "--quiet"}).code, 0);
  std::string text = folder_.read("job.toml");
  const std::string name = "design = \"design.toml\"";
  folder_.write("other.toml", text.replace(text.find(name), name.size(), "design = \"gone.toml\""));
  const Outcome gone = retrace(folder_, {"verify", "other.toml", "nc/program.ngc", "--as-machined", "part.toml"});
  EXPECT_EQ(refused_at(gone), "--as-machined");
  EXPECT_FALSE(exists("part.toml"));
}

}  // namespace
}  // namespace retrace::test::zone_job_command_test

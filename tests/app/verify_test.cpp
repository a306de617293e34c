#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/app/program.h"

// Tests of `retrace verify` and `retrace forces`: from a design to programs, from their text to a verdict, and to the
// machined part.

namespace retrace::test::verify_test {
namespace {

const std::string kDesign =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.451\nwidth_mm = 0.451\n[array]\narrangement = \"aligned\"\nx_length_mm = "
    "0.902\n"
    "y_length_mm = 0.902\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n";

/// Fixture with a folder that contains a job and its program in every dialect.
class VerifyCommand : public ::testing::Test {
 protected:
  void make(const std::string& machine, const std::string& strategy) {
    folder_.write("design.toml", kDesign);
    const Outcome job = retrace(folder_, {"job", "design.toml", "--machine", machine, "--tool-width-mm", "0.451",
                                          "--strategy", strategy, "-o", "job.toml", "--quiet"});
    ASSERT_EQ(job.code, 0) << job.err;
  }
  std::string program(const std::string& dialect) {
    const Outcome made = retrace(folder_, {"fabricate", "job.toml", "--dialect", dialect, "-o", dialect, "--quiet"});
    EXPECT_EQ(made.code, 0) << made.err;
    return dialect + "/" + folder_.json(dialect + "/fabrication.json")["programs"][0].get<std::string>();
  }
  Json verified(const std::vector<std::string>& arguments, int code) {
    Arguments all = {"verify", "job.toml"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"--json", "-"});
    const Outcome outcome = retrace(folder_, all);
    EXPECT_EQ(outcome.code, code) << outcome.err << outcome.out.substr(0, 2000);
    return outcome.out.empty() ? Json() : Json::parse(outcome.out);
  }

  TemporaryFolder folder_;
};

TEST_F(VerifyCommand, CorrectProgramsOfEveryDialectPass) {
  make("paper", "two-step");
  give_mist_lines(folder_, "job.toml");
  for (const std::string dialect : {"rs274ngc", "sinumerik", "fanuc", "pmac", "a3200", "automation1"}) {
    const std::string file = program(dialect);
    const Json json = verified({file}, 0);
    EXPECT_EQ(json["schema"], "retrace.verification/2");
    EXPECT_EQ(json["verdict"], "pass");
    EXPECT_EQ(json["programs"][0]["dialect"], dialect);
    EXPECT_EQ(json["elements_cut"], 4);
    EXPECT_TRUE(json["findings"].empty());
    EXPECT_LT(json["facet_distance_nm_max"].get<double>(), 10.0);
    EXPECT_LT(json["facet_angle_arcmin_max"].get<double>(), 0.01);
    EXPECT_LE(json["root_residual_nm_max"].get<double>(), json["root_residual_nm_predicted"].get<double>() + 10.0);
    EXPECT_NEAR(json["wall_overcut_nm_max"].get<double>(), json["wall_overcut_nm_predicted"].get<double>(), 10.0);
    EXPECT_NEAR(json["removed_volume_mm3"].get<double>(), 4 * 0.451 * 0.451 * 0.2255 / 2, 1e-5);
    // The planner and the verification compute the time with different models.
    const double planned_s = folder_.json(dialect + "/fabrication.json")["time_s"].get<double>();
    EXPECT_NEAR(json["time_s"].get<double>(), planned_s, 0.01 * planned_s);
    EXPECT_EQ(json["complete"], true);
  }
}

/// Verifies the programs of single phases, and a program that was stopped after a line. `--next-stage` names the phase
/// that is next when the programs start.
TEST_F(VerifyCommand, PartsOfAJob) {
  make("paper", "two-step");
  const std::string whole = program("rs274ngc");
  const auto part = [&](const Arguments& how, const std::string& name) {
    const Outcome made = retrace(folder_, with({"fabricate", "job.toml", "-o", name, "--quiet"}, how));
    EXPECT_EQ(made.code, 0) << made.err;
    return name + "/" + folder_.json(name + "/fabrication.json")["programs"][0].get<std::string>();
  };
  const std::string roughing = part({"--phase", "roughing"}, "roughing");
  EXPECT_EQ(verified({roughing}, 1)["verdict"], "incomplete");
  const std::string finishing = part({"--phase", "finishing"}, "finishing");
  EXPECT_EQ(verified({finishing}, 1)["verdict"], "fail");
  const Json after = verified({finishing, "--next-stage", "finishing"}, 0);
  EXPECT_EQ(after["verdict"], "pass");
  EXPECT_EQ(after["programs"].size(), 1U);
  EXPECT_EQ(verified({roughing, finishing}, 0)["verdict"], "pass");
  // The operator stops the program after the third call.
  const std::string text = folder_.read(whole);
  std::size_t call = 0;
  for (int k = 0; k < 3; ++k) call = text.find(" call\n", call + 1);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(call), '\n');
  const std::string stopped = whole + "@" + std::to_string(line);
  EXPECT_NE(verified({stopped}, 1)["verdict"], "pass");
  EXPECT_EQ(verified({stopped, whole}, 1)["verdict"], "fail") << "cuts what is gone";
  const auto refusal = [&](const Arguments& arguments) {
    const Outcome outcome = retrace(folder_, with({"verify", "job.toml"}, arguments));
    return refused_at(outcome);
  };
  EXPECT_EQ(refusal({whole + "@99999"}), "rs274ngc/program.ngc");
  EXPECT_EQ(refusal({whole + "@x"}), "rs274ngc/program.ngc@x");
  EXPECT_EQ(refusal({whole, "--next-stage", "polishing"}), "--next-stage");
  EXPECT_EQ(refusal({whole, "--next-stage", "roughing"}), "--next-stage");
}

TEST_F(VerifyCommand, AFaultIsAFindingWithItsLine) {
  make("ideal", "unidirectional");
  std::string text = folder_.read(program("rs274ngc"));
  const std::size_t dwell = text.find("G4 P0.100\n");
  ASSERT_NE(dwell, std::string::npos);
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(dwell), '\n');
  folder_.write("bad.ngc", text.replace(dwell, 9, "(G4 lost)"));
  const Json json = verified({"bad.ngc", "-o", "out"}, 1);
  EXPECT_EQ(json["verdict"], "fail");
  ASSERT_EQ(json["findings"].size(), 1U);
  EXPECT_EQ(json["findings"][0]["kind"], "missing_dwell");
  EXPECT_EQ(json["findings"][0]["program"], "bad.ngc");
  EXPECT_EQ(json["findings"][0]["line"], line);
  EXPECT_TRUE(json["findings"][0].contains("element"));
  EXPECT_EQ(folder_.json("out/verification.json")["verdict"], "fail");
}

TEST_F(VerifyCommand, ATruncatedProgramIsAFinding) {
  make("ideal", "unidirectional");
  const std::string text = folder_.read(program("rs274ngc"));
  folder_.write("cut.ngc", text.substr(0, 2 * text.size() / 3));
  const Json json = verified({"cut.ngc"}, 1);
  bool is_found = false;
  for (const Json& finding : json["findings"]) is_found = is_found || finding["kind"] == "truncated";
  EXPECT_TRUE(is_found);
}

TEST_F(VerifyCommand, BadInputEndsWithOneLineAndWritesNothing) {
  make("paper", "two-step");
  const std::string good = program("rs274ngc");
  folder_.write("empty.ngc", "");
  folder_.write("binary.ngc", std::string("%\n\x01\x02\x03", 5));
  folder_.write("long.ngc", "%\n" + std::string(1 << 20, 'G') + "\n");
  folder_.write("loop.ngc", "%\no1 sub\no1 call\no1 endsub\nG21\no1 call\nM2\n%\n");
  folder_.write("strange.ngc", "%\nG21\nG2 X1 Y1 I1\nM2\n%\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"empty.ngc", "empty.ngc"}, {"binary.ngc", "binary.ngc:2"},   {"long.ngc", "long.ngc:2"},
      {"loop.ngc", "loop.ngc:3"}, {"strange.ngc", "strange.ngc:3"}, {"missing.ngc", "missing.ngc"}};
  for (const auto& [file, message] : cases) {
    const Outcome outcome = retrace(
        folder_, {"verify", "job.toml", file, "--as-machined", "out.toml", "-o", "out", "--dialect", "rs274ngc"});
    EXPECT_EQ(refused_at(outcome), message);
  }
  for (const std::string& name : folder_.names()) EXPECT_FALSE(name.starts_with("out")) << name;
  EXPECT_EQ(retrace(folder_, {"verify", "job.toml", good, "--dialect", "heidenhain"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"verify", "job.toml", good, "--tolerance-nm", "0"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"verify", "job.toml", good, "--as-machined", "job.toml"}).code, 2);
}

TEST_F(VerifyCommand, AProgramForAnotherMachineIsRefused) {
  make("thesis", "two-step");
  const std::string file = program("rs274ngc");
  const std::string text = folder_.read(file);
  make("paper", "two-step");
  folder_.write("other.ngc", text);
  const Outcome outcome = retrace(folder_, {"verify", "job.toml", "other.ngc"});
  EXPECT_EQ(refused_at(outcome), "other.ngc");
}

/// Returns the outward normals of the facets of the part, from a table of planes. The order is facet 1 and facet 2 of
/// each element.
std::vector<std::array<double, 3>> normals_of(const std::string& csv) {
  std::vector<std::array<double, 3>> normals;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::vector<double> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
    if (values.size() != 6) throw std::runtime_error(line);
    const double length = std::hypot(values[4], values[5], 1.0);
    normals.push_back({values[4] / length, values[5] / length, -1.0 / length});
  }
  return normals;
}

double between_arcmin(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 * 60.0 / std::numbers::pi;
}

std::string without_texture(const std::string& design) {
  std::istringstream lines(design);
  std::string text;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("roughness") && !line.starts_with("correlation") && !line.starts_with("waviness"))
      text += line + "\n";
  return text;
}

/// Complete cycle: design, job, NC text, machined part and its RRE (retroreflective efficiency). The program is planned
/// for ideal axes and runs on the machine of the paper. The facet normals are therefore wrong by 5.06 and 5.42 arcmin,
/// and the apex angle by 3.32 arcmin. This reduces the RRE for an acceptance of 0.05 degrees, but not for 0.5 degrees.
TEST_F(VerifyCommand, TheAsMachinedPartIsTraced) {
  make("ideal", "two-step");
  const std::string file = program("rs274ngc");
  EXPECT_EQ(retrace(folder_, {"verify", "job.toml", file, "--as-machined", "right.toml", "--quiet"}).code, 0);
  std::string job = folder_.read("job.toml");
  const std::size_t at = job.find("machine = \"ideal\"");
  ASSERT_NE(at, std::string::npos);
  folder_.write("job.toml", job.replace(at, 17, "machine = \"paper\""));
  EXPECT_EQ(retrace(folder_, {"verify", "job.toml", file, "--as-machined", "wrong.toml", "--quiet"}).code, 1);
  EXPECT_EQ(folder_.read("right.toml").find("facet_tilt"), std::string::npos) << "left as designed";
  EXPECT_NE(folder_.read("wrong.toml").find("[part]\nfacets = \"wrong_facets.csv\""), std::string::npos);
  const auto normals = normals_of(folder_.read("wrong_facets.csv"));
  ASSERT_EQ(normals.size(), 8U);
  const double h = std::sqrt(0.5);
  for (std::size_t k = 0; k < normals.size(); k += 2) {
    // Facet 1 of a cut is the facet on the -x side of the part.
    EXPECT_NEAR(between_arcmin(normals[k], {-h, 0, -h}), 5.06, 0.01);
    EXPECT_NEAR(between_arcmin(normals[k + 1], {h, 0, -h}), 5.42, 0.01);
    EXPECT_NEAR(std::abs(between_arcmin(normals[k], normals[k + 1]) - 90.0 * 60.0), 3.32, 0.01);
  }
  folder_.write("right_smooth.toml", without_texture(folder_.read("right.toml")));
  folder_.write("wrong_smooth.toml", without_texture(folder_.read("wrong.toml")));
  const auto rre = [&](const std::string& design) {
    const Json json = retrace_json(folder_, {"rre", design, "--engine", "exact", "--cutoff", "1e-6"});
    return std::pair(json["points"][0]["rre"].get<double>(), json["points"][1]["rre"].get<double>());
  };
  const auto right = rre("right_smooth.toml");
  const auto wrong = rre("wrong_smooth.toml");
  EXPECT_NEAR(wrong.second, right.second, 5e-3) << "0.5 degrees";
  EXPECT_LT(wrong.first, 0.2 * right.first) << "0.05 degrees";
  // Monte Carlo traces the part with its surface texture.
  const Json textured = retrace_json(folder_, {"rre", "wrong.toml", "--target-error", "5e-3"});
  EXPECT_LT(textured["points"][1]["rre"].get<double>(), right.second);
}

/// A part that is planned for the machine on which it is cut has the RRE of the design. A facet that is finished by
/// plunges (cuts down the facet) equals the facet of the design. A facet that is finished by a plough (a cut along the
/// facet, from the root) is rotated by delta about the normal of the other facet. The angle between the facets remains
/// exact, but the root is tilted. The returned light then deviates by 2 n delta sin(45 degrees).
TEST_F(VerifyCommand, WhatMachinesAndStrategiesCostInLight) {
  constexpr double index = 1.4917;
  for (const std::string machine : {"ideal", "paper", "thesis"})
    for (const std::string strategy : {"unidirectional", "bidirectional", "two-step"}) {
      SCOPED_TRACE(machine + " " + strategy);
      make(machine, strategy);
      const std::string file = program("rs274ngc");
      const Json planned = folder_.json("rs274ngc/fabrication.json");
      ASSERT_EQ(retrace(folder_, {"verify", "job.toml", file, "--as-machined", "part.toml", "--quiet"}).code, 0);
      folder_.write("smooth.toml", without_texture(folder_.read("part.toml")));
      const auto rre = [&](const std::string& design) {
        return retrace_json(folder_, {"rre", design, "--engine", "exact", "--cutoff", "1e-6", "--set",
                                      "detector.acceptance_half_angle_deg=[0.05,0.5]"})["points"];
      };
      const Json design = rre("design.toml");
      const Json part = rre("smooth.toml");
      EXPECT_NEAR(part[1]["rre"].get<double>(), design[1]["rre"].get<double>(), 1e-3) << "0.5 degrees";
      // Light that the entrance face reflects back into the part is deviated twice by a tilted root. It then misses the
      // narrow cone.
      const double lost = strategy == "unidirectional" && machine != "ideal" ? 0.05 : 1e-3;
      EXPECT_NEAR(part[0]["rre"].get<double>(), design[0]["rre"].get<double>(), lost) << "0.05 degrees";
      if (strategy != "unidirectional") continue;
      ASSERT_EQ(
          retrace(folder_, {"rre", "smooth.toml", "--engine", "exact", "--cutoff", "1e-6", "--far-field", "-o", "far"})
              .code,
          0);
      double brightest = 0.0;
      double deviation_arcmin = -1.0;
      const Json far_field = folder_.json("far/far_field.json");
      for (const Json& spot : far_field["directions"][0]["spots"])
        if (spot["power"].get<double>() > brightest) {
          brightest = spot["power"].get<double>();
          deviation_arcmin = spot["deviation_arcmin"].get<double>();
        }
      const double delta_arcmin = std::abs(planned["poses"][0]["root_tilt_arcmin"].get<double>());
      EXPECT_NEAR(deviation_arcmin, 2.0 * index * delta_arcmin * std::sqrt(0.5), 0.01);
    }
}

TEST_F(VerifyCommand, ElementsThatAreNotCutAreNotThere) {
  make("ideal", "two-step");
  std::string job = folder_.read("job.toml");
  const std::size_t at = job.find("x_offset_mm");
  ASSERT_NE(at, std::string::npos);
  folder_.write("job.toml", job.insert(at, "pattern = [\"#-\", \"##\"]\n"));
  const std::string file = program("rs274ngc");
  ASSERT_EQ(retrace(folder_, {"verify", "job.toml", file, "--as-machined", "part.toml", "--quiet"}).code, 0);
  const Json json = retrace_json(folder_, {"inspect", "part.toml"});
  EXPECT_EQ(json["elements_full"], 3);
  EXPECT_EQ(json["boundary"], "closed, free of self-intersections");
  EXPECT_EQ(json["design"]["part"]["facets"], "part_facets.csv");
  // The elements at the lower left, lower right and upper left exist. No element exists at the upper right.
  const std::string csv = folder_.read("part_facets.csv");
  for (const char* place : {"0.2255,0.2255,", "0.6765,0.2255,", "0.2255,0.6765,"})
    EXPECT_NE(csv.find(place), std::string::npos) << place << "\n" << csv;
  EXPECT_EQ(csv.find("0.6765,0.6765,"), std::string::npos) << csv;
  folder_.write("smooth.toml", without_texture(folder_.read("part.toml")));
  const double part = retrace_json(folder_, {"rre", "smooth.toml", "--engine", "exact"})["points"][0]["rre"];
  const double design = retrace_json(folder_, {"rre", "design.toml", "--engine", "exact"})["points"][0]["rre"];
  // A quarter of the back is flat. Its single reflection returns about 4 % of the light that elements would return
  // there.
  EXPECT_NEAR(part, 0.75 * design, 0.04);
  EXPECT_EQ(retrace(folder_, {"rre", "part.toml", "--derivatives", "--engine", "exact"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"job", "part.toml", "--tool-width-mm", "0.451"}).code, 2);
}

TEST_F(VerifyCommand, TheTextureIsTheProcesses) {
  make("ideal", "bidirectional");
  std::string job = folder_.read("job.toml");
  const std::size_t at = job.find("roughing_plunge_sa_nm = ");
  ASSERT_NE(at, std::string::npos);
  folder_.write("job.toml", job.replace(at, job.find('\n', at) - at, "roughing_plunge_sa_nm = 48.9"));
  const std::size_t feed = job.find("roughing_feed_mm_per_min = ");
  folder_.write("job.toml", job.replace(feed, job.find('\n', feed) - feed, "roughing_feed_mm_per_min = 10"));
  ASSERT_EQ(retrace(folder_, {"verify", "job.toml", program("rs274ngc"), "--as-machined", "part.toml", "--quiet"}).code,
            0);
  const std::string part = folder_.read("part.toml");
  const auto value = [&](const std::string& key) {
    return std::stod(part.substr(part.find(key + " = ") + key.size() + 3));
  };
  // Expected values: Sa is 19.7 nm for the roughness and 29.9 nm for the waviness of facets with Sa 48.9 nm. Sq follows
  // from Sa for Gaussian heights. There are 42.4 feed marks per mm at 10 mm/min.
  EXPECT_NEAR(value("roughness_sq_nm"), 19.7 * std::sqrt(0.5 * std::numbers::pi), 1e-3);
  EXPECT_NEAR(value("waviness_sq_nm"), 29.9 * std::sqrt(0.5 * std::numbers::pi), 1e-3);
  EXPECT_NEAR(1e3 / value("waviness_length_um"), 42.4, 0.05);
}

// A chip of 9.02 um in a tool edge of 451 um leaves a scratch on both facets. If facet 2 is ploughed (cut along its
// length from the root), both scratches are at the same position along the roof edge and deflect 2 % of the returned
// light. If facet 2 is plunged from the other side, the scratches are at different positions and deflect twice as much.
TEST_F(VerifyCommand, ChipsOfTheEdgeBecomeScratches) {
  for (const auto& [strategy, kept] : {std::pair{"unidirectional", 0.98}, {"two-step", 0.96}}) {
    make("ideal", strategy);
    const std::string chip = "[[tool.edge_chips]]\nposition_um = 60\nwidth_um = 9.02\ndepth_um = 2\n";
    folder_.write("job.toml", folder_.read("job.toml") + chip);
    const std::string file = program("rs274ngc");
    ASSERT_EQ(retrace(folder_, {"verify", "job.toml", file, "--as-machined", "part.toml", "--quiet"}).code, 0);
    folder_.write("part.toml", without_texture(folder_.read("part.toml")));
    const Json scratches = retrace_json(folder_, {"inspect", "part.toml"})["design"]["surface"]["scratches"];
    ASSERT_EQ(scratches.size(), 2U);
    EXPECT_EQ(scratches[0]["facet"], "-x");
    EXPECT_NEAR(scratches[0]["position_um"].get<double>(), 60.0, 1e-9);
    EXPECT_EQ(scratches[1]["facet"], "+x");
    EXPECT_NEAR(scratches[1]["position_um"].get<double>(), kept > 0.97 ? 60.0 : -60.0, 1e-9);
    EXPECT_NEAR(scratches[1]["depth_um"].get<double>(), 2.0, 1e-9);
    const auto lossless = [&](const std::string& part) {
      return retrace_json(folder_, {"rre", part, "--engine", "exact", "--set",
                                    "idealisation.entrance=lossless"})["points"][0]["rre"]
          .get<double>();
    };
    // Light that one scratch deflects may return by another scratch. This effect is of second order.
    const double share = lossless("part.toml") / lossless("design.toml");
    EXPECT_GT(share, kept - 1e-6);
    EXPECT_LT(share, kept + 0.02 * (1.0 - kept) * (1.0 - kept));
  }
}

TEST_F(VerifyCommand, WhatIsLeftIsDrawn) {
  make("paper", "two-step");
  const std::string file = program("rs274ngc");
  ASSERT_EQ(retrace(folder_, {"verify", "job.toml", file, "--map", "map.png", "--quiet"}).code, 0);
  EXPECT_EQ(folder_.read("map.png").substr(1, 3), "PNG");
  EXPECT_EQ(retrace(folder_, {"verify", "job.toml", file, "--map", "job.toml"}).code, 2);
  EXPECT_NE(folder_.read("job.toml").find("retrace.job/1"), std::string::npos) << "left alone";
}

TEST_F(VerifyCommand, ForcesOfAJob) {
  folder_.write("design.toml", kDesign);
  ASSERT_EQ(retrace(folder_, {"job", "design.toml", "--tool-width-mm", "0.451", "--process", "thesis-forces", "-o",
                              "job.toml", "--quiet"})
                .code,
            0);
  const Outcome outcome = retrace(folder_, {"forces", "job.toml", "--json", "-", "-o", "f"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "retrace.forces/1");
  EXPECT_NEAR(json["full_chip_fz_n"].get<double>(), -1.57 * 0.451 / 0.982, 1e-6);
  EXPECT_EQ(folder_.read("f/forces.csv").substr(0, 38), "time_s,phase,engaged_mm,fx_n,fy_n,fz_n");
  EXPECT_NE(folder_.read("f/forces.svg").find("<svg"), std::string::npos);
  EXPECT_EQ(retrace(folder_, {"forces", "job.toml", "--configuration", "oblique"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"forces", "job.toml", "--facet", "3"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"forces", "job.toml", "--plunge-mm", "5"}).code, 2);
  EXPECT_EQ(retrace(folder_, {"forces", "job.toml", "--set", "a=1"}).code, 2);
  const Outcome warned = retrace(folder_, {"forces", "job.toml"});
  EXPECT_EQ(warnings_of(warned).size(), 1U) << "5 um is measured";
}

}  // namespace
}  // namespace retrace::test::verify_test

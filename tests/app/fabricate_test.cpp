#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/app/program.h"

// Tests of `retrace job` and `retrace fabricate`: from a design to files of NC text, and refused input.

namespace retrace::test::fabricate_test {
namespace {

std::string design(const std::string& arrangement, double length_mm, const std::string& more = {}) {
  const std::string length = std::to_string(length_mm);
  return "[element]\nkind = \"rtp\"\nbase_mm = 0.451\nwidth_mm = 0.451\n[array]\narrangement = \"" + arrangement +
         "\"\n" + (arrangement == "single" ? "" : "x_length_mm = " + length + "\ny_length_mm = " + length + "\n") +
         more + "[body]\nthickness_mm = 0.5\n";
}

const Arguments kJob = {"job", "d.toml", "--tool-width-mm", "0.451", "--machine", "thesis", "--strategy", "two-step"};

/// Returns a portable grey map with the given pixel values, row by row from the upper left corner.
std::string grey_map(int columns, int rows, const std::vector<int>& values) {
  std::string text = "P2\n" + std::to_string(columns) + " " + std::to_string(rows) + "\n255\n";
  for (const int value : values) text += std::to_string(value) + "\n";
  return text;
}

TEST(Fabricate, CutsTheSquareOfTheThesis) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("offset", 25 * 0.451, "partial_elements = \"omit\"\n"));
  const Outcome job = retrace(folder, with(kJob, {"-o", "j.toml", "--json", "job.json"}));
  ASSERT_EQ(job.code, 0) << job.err;
  EXPECT_EQ(job.err, "");
  EXPECT_EQ(folder.json("job.json")["elements"], 613);
  EXPECT_EQ(folder.json("job.json")["partial_elements"], 24);
  EXPECT_EQ(folder.json("job.json")["process"], "thesis-acrylic");
  const Json json = retrace_json(folder, {"fabricate", "j.toml"});
  EXPECT_EQ(json["schema"], "retrace.fabrication/2");
  EXPECT_EQ(json["elements"], 613);
  EXPECT_EQ(json["cuts_per_facet"], 21);
  EXPECT_EQ(json["c_rotations"], 4);
  const double time_s = json["time_s"].get<double>();
  EXPECT_NEAR(json["time_per_element_s"].get<double>(), time_s / 613.0, 1e-9);
  EXPECT_NEAR(json["time_per_element_s"].get<double>(), 29.16, 0.15 * 29.16);
  EXPECT_NEAR(json["area_rate_mm2_per_h"].get<double>(), 25.1, 0.15 * 25.1);
  EXPECT_GT(json["time_fixed_s"].get<double>(), 0.0);
  EXPECT_LT(json["time_fixed_s"].get<double>(), 0.02 * time_s);
  EXPECT_EQ(json["programs"], Json::array({"program.ngc"}));
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"d.toml", "j.toml", "job.json"}));
}

TEST(Fabricate, WritesProgramsPicturesAndTimesTheSameInEveryRun) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("checker", 0.902));
  ASSERT_EQ(retrace(folder, with(kJob, {"-o", "j.toml"})).code, 0);
  for (const std::string out : {"a", "b"})
    ASSERT_EQ(retrace(folder, {"fabricate", "j.toml", "--dialect", "sinumerik", "--quiet", "-o", out}).code, 0);
  for (const std::string file : {"program.mpf", "fabrication.json", "stages.csv", "roughing.svg", "roughing.png",
                                 "setup.html", "finishing.svg", "finishing.png", "arrangement.svg", "arrangement.png"})
    EXPECT_EQ(folder.read("a/" + file), folder.read("b/" + file)) << file;
  EXPECT_EQ(folder.json("a/fabrication.json")["c_rotations"], 8);
  EXPECT_EQ(folder.json("a/fabrication.json")["poses"].size(), 4U);
  EXPECT_TRUE(folder.read("a/stages.csv").starts_with("name,a_deg,c_deg,elements,time_s,"));
}

TEST(Fabricate, TakesAsManyCutsAsTheThesis) {
  // Expected numbers of cuts: Milliken 2017, 4.1.3, for a prism of 1 mm with depths of cut of 10 um and 5 um.
  const TemporaryFolder folder;
  folder.write("d.toml", design("single", 0));
  const std::pair<std::string, int> cases[] = {{"thesis-forces-10um", 71}, {"thesis-forces", 142}};
  for (const auto& [process, cuts] : cases) {
    ASSERT_EQ(
        retrace(folder, {"job", "d.toml", "--set", "element.base_mm=1", "--set", "element.width_mm=1",
                         "--tool-width-mm", "1", "--strategy", "unidirectional", "--process", process, "-o", "j.toml"})
            .code,
        0);
    EXPECT_EQ(retrace_json(folder, {"fabricate", "j.toml"})["cuts_per_facet"], cuts);
  }
}

TEST(Fabricate, EveryDialectHasItsEnding) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("single", 0));
  ASSERT_EQ(retrace(folder, with(kJob, {"-o", "j.toml"})).code, 0);
  const Outcome refused = retrace(folder, {"fabricate", "j.toml", "--dialect", "pmac"});
  EXPECT_EQ(refused_at(refused), "--dialect");
  give_mist_lines(folder, "j.toml");
  const std::pair<std::string, std::string> dialects[] = {
      {"rs274ngc", "program.ngc"}, {"sinumerik", "program.mpf"}, {"fanuc", "program.nc"},
      {"pmac", "program.pmc"},     {"a3200", "program.pgm"},     {"automation1", "program.ascript"}};
  for (const auto& [dialect, file] : dialects) {
    const Json json = retrace_json(folder, {"fabricate", "j.toml", "--dialect", dialect, "-o", dialect});
    EXPECT_EQ(json["programs"], Json::array({file}));
    EXPECT_FALSE(folder.read(dialect + "/" + file).empty());
  }
}

TEST(Fabricate, SplitsAndResumes) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("offset", 4 * 0.451));
  ASSERT_EQ(retrace(folder, with(kJob, {"-o", "j.toml", "--quiet"})).code, 0);
  const Json split = retrace_json(folder, {"fabricate", "j.toml", "--split-hours", "0.05", "-o", "s"});
  EXPECT_GT(split["programs"].size(), 1U);
  for (const Json& name : split["programs"]) EXPECT_FALSE(folder.read("s/" + name.get<std::string>()).empty());
  const Json rest = retrace_json(folder, {"fabricate", "j.toml", "--phase", "finishing-2-facet-1+", "--from-element",
                                          "5", "--stop-every", "3", "-o", "r"});
  EXPECT_EQ(rest["stages"].size(), 2U);
  EXPECT_EQ(rest["programs"], Json::array({"finishing-2-facet-1_and_after_from_element_5.ngc"}));
  EXPECT_NE(folder.read("r/finishing-2-facet-1_and_after_from_element_5.ngc").find("M1\n"), std::string::npos);
}

TEST(Fabricate, TakesAMask) {
  const TemporaryFolder folder;
  // Cells whose pixels are at most 178 are cut. Cells whose pixels are 179 or more are not. The first row of the
  // picture has the largest y.
  folder.write("m.pgm", grey_map(3, 2, {255, 178, 179, 0, 255, 255}));
  folder.write("d.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nx_length_mm = 1.5\n"
               "y_length_mm = 1\nmask = \"m.pgm\"\n[body]\nthickness_mm = 1\n");
  ASSERT_EQ(retrace(folder, {"job", "d.toml", "--tool-width-mm", "0.5", "-o", "j.toml"}).code, 0);
  EXPECT_NE(folder.read("j.toml").find("pattern = [\n  \"-#-\",\n  \"#--\",\n]"), std::string::npos)
      << folder.read("j.toml");
  EXPECT_EQ(retrace_json(folder, {"fabricate", "j.toml"})["elements"], 2);
  EXPECT_EQ(retrace_json(folder, {"inspect", "d.toml"})["elements_full"], 2) << "what is traced is what is cut";
}

TEST(Fabricate, AWiderToolHalvesTheTimeForTheArea) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("aligned", 8 * 0.451));
  ASSERT_EQ(retrace(folder, with(kJob, {"-o", "a.toml"})).code, 0);
  ASSERT_EQ(retrace(folder, {"job", "d.toml", "--set", "element.width_mm=0.902", "--set", "array.y_length_mm=7.216",
                             "--tool-width-mm", "0.902", "--machine", "thesis", "-o", "b.toml"})
                .code,
            0);
  const double narrow = retrace_json(folder, {"fabricate", "a.toml"})["time_per_cm2_s"].get<double>();
  const double wide = retrace_json(folder, {"fabricate", "b.toml"})["time_per_cm2_s"].get<double>();
  EXPECT_NEAR(wide / narrow, 0.5, 0.01);
}

TEST(Fabricate, AMachineOfTheUserIsNamedFromTheJob) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("single", 0));
  std::filesystem::create_directories(folder.path() / "m");
  std::filesystem::create_directories(folder.path() / "jobs");
  folder.write("m/mine.toml", read_text(std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml"));
  ASSERT_EQ(
      retrace(folder, {"job", "d.toml", "--tool-width-mm", "0.451", "--machine", "m/mine.toml", "-o", "jobs/j.toml"})
          .code,
      0);
  EXPECT_NE(folder.read("jobs/j.toml").find("machine = \"../m/mine.toml\""), std::string::npos);
  EXPECT_EQ(retrace_json(folder, {"fabricate", "jobs/j.toml"})["machine"], "paper");
}

/// A job contains the path of its design relative to the folder of the job. This must also work if that folder is a
/// symbolic link, whose target has another parent folder.
TEST(Job, NamesItsDesignFromWhereItLies) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("single", 0) + "\n");
  std::filesystem::create_directories(folder.path() / "far/away");
  std::filesystem::create_directories(folder.path() / "jobs");
  std::filesystem::create_directory_symlink(folder.path() / "far/away", folder.path() / "link");
  const auto named = [&](const Arguments& out) {
    const Outcome made = retrace(folder, with({"job", "d.toml", "--tool-width-mm", "0.451"}, out));
    EXPECT_EQ(made.code, 0) << made.err;
    const std::string text = out.empty() ? made.out : folder.read(out[1]);
    const std::size_t at = text.find("design = ");
    return at == std::string::npos ? "nothing" : text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(named({}), "design = \"d.toml\"");
  EXPECT_EQ(named({"-o", "j.toml"}), "design = \"d.toml\"");
  EXPECT_EQ(named({"-o", "jobs/j.toml"}), "design = \"../d.toml\"");
  EXPECT_EQ(named({"-o", "link/j.toml"}), "design = \"../../d.toml\"");
  // The machined part uses the plate of the design.
  ASSERT_EQ(retrace(folder, {"fabricate", "jobs/j.toml", "--dialect", "rs274ngc", "-o", "programs"}).code, 0);
  const Outcome verified = retrace(folder, {"verify", "jobs/j.toml", "programs/program.ngc", "--as-machined",
                                            "parts.toml", "--quiet", "--json", "-"});
  EXPECT_EQ(verified.code, 0) << verified.err;
  EXPECT_EQ(Json::parse(verified.out)["warnings"], Json::array());
  EXPECT_EQ(retrace(folder, {"rre", "parts.toml", "--incidence=0", "--target-error", "0.01"}).code, 0);
}

TEST(Job, DoesNotReplaceWhatItReads) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("single", 0));
  folder.write("p.toml", read_text(std::string(RETRACE_SOURCE_DIR) + "/data/processes/paper-pmma.toml"));
  for (const std::string file : {"d.toml", "p.toml"}) {
    const std::string before = folder.read(file);
    for (const std::string option : {"-o", "--json"}) {
      const Outcome outcome = retrace(folder, with(kJob, {"--process", "p.toml", option, file}));
      EXPECT_EQ(outcome.code, 2) << outcome.err;
      EXPECT_EQ(folder.read(file), before);
    }
  }
}

TEST(Job, WarnsOfWhatItLeavesOut) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("offset", 5 * 0.451) + "[surface]\nfacet_tilt_arcmin = [1, 0]\n");
  const Outcome outcome = retrace(folder, with(kJob, {"-o", "j.toml"}));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(warnings_of(outcome).size(), 2U) << outcome.err;
  EXPECT_NE(folder.read("j.toml").find("4 partial elements are left out"), std::string::npos);
}

TEST(Job, ADihedralErrorOpensTheApex) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("single", 0) + "[surface]\ndihedral_error_arcmin = 3\n");
  ASSERT_EQ(retrace(folder, with(kJob, {"-o", "j.toml"})).code, 0);
  EXPECT_NE(folder.read("j.toml").find("apex_angle_deg = 90.05\n"), std::string::npos) << folder.read("j.toml");
}

TEST(Fabricate, RefusesInOneLineAndLeavesNothing) {
  const TemporaryFolder folder;
  folder.write("d.toml", design("offset", 3 * 0.451));
  folder.write("cube.toml",
               "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\n[array]\narrangement = \"single\"\n"
               "[body]\nthickness_mm = 1\n");
  folder.write("white.pgm", grey_map(3, 3, std::vector<int>(9, 255)));
  folder.write("small.pgm", grey_map(2, 2, {0, 0, 0, 0}));
  folder.write("text.png", "no picture\n");
  for (const std::string mask : {"white.pgm", "small.pgm", "text.png", "none.png"})
    folder.write("mask_" + mask + ".toml", design("offset", 3 * 0.451, "mask = \"" + mask + "\"\n"));
  ASSERT_EQ(retrace(folder, with(kJob, {"-o", "j.toml", "--quiet"})).code, 0);
  const std::string good = folder.read("j.toml");
  const auto changed = [&](const std::string& name, const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    folder.write(name, text);
  };
  changed("doc0.toml", "roughing_depth_um = 15", "roughing_depth_um = 0");
  changed("wide.toml", "[tool]\nwidth_mm = 0.451", "[tool]\nwidth_mm = 0.5");
  changed("far.toml", "machine = \"thesis\"", "machine = \"tight.toml\"");
  changed("zero.toml", "machine = \"thesis\"", "machine = \"zero_axis.toml\"");
  changed("unknown.toml", "machine = \"thesis\"", "machine = \"thesiz\"");
  std::string machine = read_text(std::string(RETRACE_SOURCE_DIR) + "/data/machines/ideal.toml");
  const std::string x_limits = "limits_mm = { value = [-120, 120]";
  machine.replace(machine.find(x_limits), x_limits.size(), "limits_mm = { value = [-0.3, 120]");
  folder.write("tight.toml", machine);
  machine = read_text(std::string(RETRACE_SOURCE_DIR) + "/data/machines/ideal.toml");
  const std::string axis = "direction = { value = [0, 0, 1], assumed = \"ideal\"";
  ASSERT_NE(machine.find(axis), std::string::npos);
  machine.replace(machine.find(axis), axis.size(), "direction = { value = [0, 0, 0], assumed = \"ideal\"");
  folder.write("zero_axis.toml", machine);
  const std::vector<Refused> cases = {
      {{"job", "d.toml", "--tool-width-mm", "0.46"}, "--tool-width-mm"},
      {{"job", "d.toml", "--tool-width-mm", "3"}, "--tool-width-mm"},
      {{"job", "d.toml"}, ""},
      {{"job", "d.toml", "--tool-width-mm", "0.4", "--machine", "kugler"}, "--machine"},
      {{"job", "d.toml", "--tool-width-mm", "0.4", "--strategy", "dmc"}, "--strategy"},
      {{"job", "d.toml", "--tool-width-mm", "0.4", "--strategy", "spiral"}, "--strategy"},
      {{"job", "d.toml", "--tool-width-mm", "0.4", "--process", "steel"}, "--process"},
      {{"job", "d.toml", "--tool-width-mm", "0.4", "--workpiece", "die"}, "--workpiece"},
      {{"job", "d.toml", "--tool-width-mm", "0.4", "--shrinkage-percent", "50"}, "--shrinkage-percent"},
      {{"job", "cube.toml", "--tool-width-mm", "0.4"}, "--strategy"},
      {{"job", "cube.toml", "--tool-width-mm", "0.4", "--strategy", "dmc"}, "--tool-width-mm"},
      {{"job", "cube.toml", "--tool-width-mm", "1", "--strategy", "dmc", "--machine", "thesis"}, "--machine"},
      {{"job", "d.toml", "--tool-width-mm", "0.451", "--machine", "ideal-dmc"}, "--machine"},
      {{"job", "cube.toml", "--tool-width-mm", "1", "--strategy", "dmc", "--workpiece", "direct"}, "--workpiece"},
      {{"job", "cube.toml", "--tool-width-mm", "1", "--strategy", "dmc", "--set", "element.cant_deg=5"},
       "cube.toml: element.cant_deg"},
      {{"job", "d.toml", "--tool-width-mm", "0.4", "--set", "array.extent=infinite"}, "d.toml:7: array.x_length_mm"},
      {{"job", "mask_white.pgm.toml", "--tool-width-mm", "0.451"}, "mask_white.pgm.toml:9: array.mask"},
      {{"job", "mask_small.pgm.toml", "--tool-width-mm", "0.451"}, "mask_small.pgm.toml:9: array.mask"},
      {{"job", "mask_text.png.toml", "--tool-width-mm", "0.451"}, "mask_text.png.toml:9: array.mask"},
      {{"job", "mask_none.png.toml", "--tool-width-mm", "0.451"}, "mask_none.png.toml:9: array.mask"},
      {{"fabricate", "j.toml", "--dialect", "kugler"}, "--dialect"},
      {{"fabricate", "missing.toml"}, "missing.toml"},
      {{"fabricate", "d.toml"}, "d.toml: schema"},
      {{"fabricate", "doc0.toml"}, "doc0.toml:42: process.roughing_depth_um"},
      {{"fabricate", "wide.toml"}, "wide.toml:32: tool.width_mm"},
      {{"fabricate", "far.toml"}, "far.toml:7: machine"},
      {{"fabricate", "zero.toml"}, "zero.toml:7: machine"},
      {{"fabricate", "unknown.toml"}, "unknown.toml:7: machine"},
      {{"fabricate", "j.toml", "--phase", "polishing"}, "--phase"},
      {{"fabricate", "j.toml", "--from-element", "8"}, "--from-element"},
      {{"fabricate", "j.toml", "--stop-every", "0"}, "--stop-every"},
      {{"fabricate", "j.toml", "--split-hours", "0"}, "--split-hours"},
      {{"fabricate", "j.toml", "--set", "a=1"}, "--set"},
  };
  expect_refused(folder, cases, {});
}

TEST(List, NamesMachinesAndProcesses) {
  const TemporaryFolder folder;
  const Json machines = retrace_json(folder, {"list", "machines"});
  EXPECT_EQ(machines["schema"], "retrace.machines/1");
  std::vector<std::string> names;
  for (const Json& machine : machines["machines"]) names.push_back(machine["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"ideal-dmc", "ideal", "paper", "thesis"}));
  const Json processes = retrace_json(folder, {"list", "processes"});
  ASSERT_GE(processes["processes"].size(), 3U);
  for (const Json& process : processes["processes"]) EXPECT_FALSE(process["source"].get<std::string>().empty());
}

}  // namespace
}  // namespace retrace::test::fabricate_test

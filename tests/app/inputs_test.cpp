// Tests that retrace never overwrites a file that it reads, for any path or link that names the file. Files that are
// longer than their limit are refused.

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/app/program.h"

namespace retrace::test::inputs_test {
namespace {

namespace fs = std::filesystem;

/// Returns the names and contents of all files in a folder.
std::map<std::string, std::string> contents(const TemporaryFolder& folder) {
  std::map<std::string, std::string> all;
  for (const std::string& name : folder.names())
    if (fs::is_regular_file(folder.path() / name)) all[name] = folder.read(name);
  return all;
}

/// Expects that the command is refused at this option, and that no file in the folder changes.
void expect_refused(const TemporaryFolder& folder, const Arguments& arguments, const std::string& option) {
  std::string shown;
  for (const std::string& word : arguments) shown += word + " ";
  SCOPED_TRACE(shown);
  const auto before = contents(folder);
  const auto names = folder.names();
  const Outcome outcome = retrace(folder, arguments);
  EXPECT_EQ(refused_at(outcome), option);
  EXPECT_EQ(folder.names(), names);
  EXPECT_TRUE(contents(folder) == before) << "a file was changed";
}

/// Expects that retrace refuses a file as an output of --json, for every name that the file can have: path, symbolic
/// link and hard link.
void expect_protected(const TemporaryFolder& folder, const Arguments& command, const std::string& file) {
  fs::create_directories(folder.path() / "beside");
  fs::remove(folder.path() / "link");
  fs::remove(folder.path() / "twin");
  fs::create_symlink(file, folder.path() / "link");
  fs::create_hard_link(folder.path() / file, folder.path() / "twin");
  for (const std::string& name :
       {file, "./beside/../" + file, (folder.path() / file).string(), std::string("link"), std::string("twin")})
    expect_refused(folder, with(command, {"--json", name}), "--json");
}

std::string ascii_stl(const std::vector<std::array<double, 3>>& vertices,
                      const std::vector<std::array<std::size_t, 3>>& triangles) {
  std::string text = "solid s\n";
  for (const auto& t : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::size_t v : t) {
      text += "vertex";
      for (const double c : vertices[v]) text += " " + std::to_string(c);
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid s\n";
}

std::string sheet() {
  return ascii_stl({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, {{0, 1, 2}, {0, 2, 3}});
}

std::string box() {
  return ascii_stl({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                   {{0, 2, 1},
                    {0, 3, 2},
                    {4, 5, 6},
                    {4, 6, 7},
                    {0, 1, 5},
                    {0, 5, 4},
                    {1, 2, 6},
                    {1, 6, 5},
                    {2, 3, 7},
                    {2, 7, 6},
                    {3, 0, 4},
                    {3, 4, 7}});
}

const std::string kPrisms =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nx_length_mm = 1\ny_length_mm = 1\n";
const std::string kBody = "[body]\nthickness_mm = 1.2\nrefractive_index = 1.49\n";

/// A key of a design that names a file.
struct FileKey {
  std::string name;
  std::string content;
  // Text of the design before the name of the file, including the opening quotation mark.
  std::string before;
  std::string after;
};

std::vector<FileKey> file_keys() {
  return {
      {"mask.pgm", "P2\n2 2\n255\n0 255\n0 0\n", kPrisms + "mask = \"", "\"\n" + kBody},
      {"planes.csv", "x_mm,y_mm,facet,height_mm,x_slope,y_slope\n0.25,0.25,1,-0.25,-1,0.001\n0.25,0.25,2,-0.25,1,0\n",
       kPrisms + kBody + "[part]\nfacets = \"", "\"\n"},
      {"map.txt", read_text(example("facet_height_map.txt")),
       kPrisms + kBody + "[surface]\nmodel = \"height_map\"\nheight_map = \"", "\"\n"},
      {"lamp.csv", "wavelength_nm,power\n500,1\n600,1\n", kPrisms + kBody + "[light]\nspectrum = \"", "\"\n"},
      {"lens.toml",
       "schema = \"retrace.turned_part/1\"\n[base]\nkind = \"plane\"\n[tool]\nnose_radius_mm = 0.05\nclearance_deg = "
       "40\n[path]\nradius_mm = 1\nfeed_um = 10\nspindle_rpm = 60\n",
       kPrisms + kBody + "[entrance_surface]\nturned_part = \"", "\"\n"},
      {"front.stl", sheet(), kPrisms + kBody + "[entrance_surface]\nmesh = \"", "\"\n"},
      {"part.stl", box(), "[body]\nrefractive_index = 1.49\n[part]\nmesh = \"", "\"\n"},
  };
}

TEST(Inputs, FilesThatADesignNamesAreNoOutputs) {
  for (const FileKey& key : file_keys()) {
    SCOPED_TRACE(key.name);
    const TemporaryFolder folder;
    fs::create_directory(folder.path() / "d");
    folder.write("d/" + key.name, key.content);
    folder.write("d/design.toml", key.before + key.name + key.after);
    ASSERT_EQ(retrace(folder, {"inspect", "d/design.toml"}).code, 0)
        << retrace(folder, {"inspect", "d/design.toml"}).err;
    expect_protected(folder, {"inspect", "d/design.toml"}, "d/" + key.name);
    for (const std::string& file : {"d/" + key.name, std::string("d/design.toml")})
      expect_refused(folder, {"rre", "d/design.toml", "--samples=64", "--json", file}, "--json");
  }
}

// Files that a design names are not replaced if they are in the output folder of --out and have the name of a result.
TEST(Inputs, FilesThatADesignNamesAreNotReplacedInTheOutputFolder) {
  for (const FileKey& key : file_keys())
    for (const std::string name : {"rre.csv", "rre.json", "rre.svg"}) {
      SCOPED_TRACE(key.name);
      if (key.name == "lamp.csv" && name != "rre.csv") continue;  // spectra must be .csv files
      const TemporaryFolder folder;
      fs::create_directory(folder.path() / "out");
      folder.write("out/" + name, key.content);
      folder.write("design.toml", key.before + "out/" + name + key.after);
      expect_refused(folder, {"rre", "design.toml", "--samples=64", "-o", "out"}, "--out");
    }
}

TEST(Inputs, CommandsThatWriteOneFileSpareWhatTheyRead) {
  const FileKey planes = file_keys()[1];
  const TemporaryFolder folder;
  folder.write("planes.csv", planes.content);
  folder.write("design.toml", planes.before + "planes.csv" + planes.after);
  folder.write("plain.toml", kPrisms + kBody);
  for (const char* file : {"design.toml", "planes.csv", "plain.toml"})
    fs::create_hard_link(folder.path() / file, folder.path() / (fs::path(file).stem().string() + ".stl"));
  expect_refused(folder, {"export", "design.toml", "design.stl"}, "--out");
  expect_refused(folder, {"export", "design.toml", "planes.stl"}, "--out");
  expect_refused(folder, {"export", "design.toml", "x.stl", "--json", "planes.csv"}, "--json");
  folder.write("mine.toml", read_text(std::string(RETRACE_SOURCE_DIR) + "/data/machines/paper.toml"));
  folder.write("cut.toml", read_text(std::string(RETRACE_SOURCE_DIR) + "/data/processes/paper-pmma.toml"));
  const Arguments job = {"job",       "plain.toml", "--tool-width-mm", "0.5",
                         "--machine", "mine.toml",  "--process",       "cut.toml"};
  for (const std::string file : {"plain.toml", "plain.stl", "mine.toml", "cut.toml"}) {
    expect_refused(folder, with(job, {"-o", file}), "--out");
    expect_refused(folder, with(job, {"--json", file}), "--json");
  }
  ASSERT_EQ(retrace(folder, with(job, {"-o", "job.toml"})).code, 0);
  ASSERT_EQ(retrace(folder, {"fabricate", "job.toml", "-o", "out"}).code, 0);
  const Json made = folder.json("out/fabrication.json");
  const std::string program = "out/" + made["programs"][0].get<std::string>();
  for (const std::string& file : {std::string("job.toml"), std::string("mine.toml"), program})
    for (const std::string option : {"--map", "--as-machined", "--json"})
      expect_refused(folder, {"verify", "job.toml", program, option, file}, option);
  for (const std::string file : {"job.toml", "mine.toml"})
    expect_refused(folder, {"fabricate", "job.toml", "--json", file}, "--json");
}

TEST(Inputs, FilesOfStudiesAreNoOutputs) {
  const TemporaryFolder folder;
  folder.write("a.txt", read_text(example("facet_height_map.txt")));
  folder.write("b.txt", read_text(example("facet_height_map.txt")));
  folder.write("planes.csv", file_keys()[1].content);
  folder.write("dye.csv", read_text(std::string(RETRACE_SOURCE_DIR) + "/data/dye_red.csv"));
  folder.write("limits.csv", read_text(example("luminance_fixture/fixture.csv")));
  folder.write("design.toml", kPrisms + kBody + "[surface]\nmodel = \"height_map\"\n[part]\nfacets = \"planes.csv\"\n");
  folder.write(
      "study.toml",
      "design = \"design.toml\"\n[[parameter]]\nkey = \"surface.height_map\"\nvalues = [\"a.txt\", \"b.txt\"]\n"
      "[[quantity]]\nkind = \"rre\"\n[[quantity]]\nkind = \"photometry\"\nstandard = \"limits.csv\"\n"
      "area_cm2 = 10\ndye = \"dye.csv\"\n[analysis]\nsamples = 64\n");
  for (const std::string file : {"study.toml", "design.toml", "planes.csv", "a.txt", "b.txt", "limits.csv", "dye.csv"})
    expect_protected(folder, {"sweep", "study.toml"}, file);
}

TEST(Inputs, ResultsAreNotReplacedByTheSummaryOfTheirPage) {
  const TemporaryFolder folder;
  folder.write("design.toml", kPrisms + kBody);
  ASSERT_EQ(retrace(folder, {"rre", "design.toml", "--samples=64", "-o", "out"}).code, 0);
  for (const std::string file : {"out/rre.json", "out/rre.svg"})
    expect_refused(folder, {"report", "out", "--json", file}, "--json");
}

/// Returns the command that reads an example.
Arguments command_of(const std::string& text, const std::string& file) {
  const auto has = [&](const char* what) { return text.find(what) != std::string::npos; };
  if (has("retrace.turned_part/")) return {"turn", file};
  if (has("retrace.planed_part/")) return {"plane", file};
  if (has("retrace.cubes/")) return {"ranging", "round_cube.toml", "--cubes", file};
  if (!has("[[parameter]]")) return {"inspect", file};
  for (const std::string command : {"optimize", "tolerance", "compose"})
    if (text.find("[" + command + "]") != std::string::npos) return {command, file};
  return {"sweep", file};
}

/// Adds an example and all files that it names, directly or through other files.
void add_named(const fs::path& root, const fs::path& file, std::set<std::string>& named) {
  if (!named.insert(file.lexically_normal().string()).second || file.extension() != ".toml") return;
  const std::string text = read_text(root / file);
  const std::regex quoted("\"([^\"\\n]+)\"");
  for (std::sregex_iterator match(text.begin(), text.end(), quoted), end; match != end; ++match) {
    const fs::path other = file.parent_path() / (*match)[1].str();
    if (fs::is_regular_file(root / other)) add_named(root, other, named);
  }
}

// The test has no list of files. It assumes that an example reads every existing file that is named in the example.
TEST(Inputs, WhatExamplesReadIsNotOverwritten) {
  const TemporaryFolder folder;
  fs::copy(fs::path(example("rtp_gaps.toml")).parent_path(), folder.path(), fs::copy_options::recursive);
  std::size_t studies = 0;
  std::size_t others = 0;
  for (const std::string& name : folder.names()) {
    if (fs::path(name).extension() != ".toml") continue;
    if (folder.read(name).find("schema = \"retrace.machine/1\"") != std::string::npos) continue;  // read with jobs
    std::set<std::string> named;
    add_named(folder.path(), name, named);
    const Arguments command = command_of(folder.read(name), name);
    if (command.front() == "turn") continue;  // names no files and takes long before it writes
    for (const std::string& file : named) expect_refused(folder, with(command, {"--json", file}), "--json");
    (command.front() == "sweep" ? studies : others) += named.size() - 1;
  }
  EXPECT_GE(studies, 5U);
  EXPECT_GE(others, 3U);
}

constexpr std::size_t kDesign = std::size_t{1} << 20;
constexpr std::size_t kTable = std::size_t{1} << 20;
constexpr std::size_t kText = std::size_t{64} << 20;
constexpr std::size_t kPlanes = std::size_t{512} << 20;
constexpr std::size_t kData = std::size_t{1} << 30;

/// A command that reads a file, and the size limit of this file.
struct Endless {
  Arguments command;
  std::string file;
  std::size_t max_bytes;
};

// The files are one byte longer than their limit. They are sparse and take no disk space.
TEST(Inputs, LongFilesAreRefusedWithTheirLimit) {
  const TemporaryFolder folder;
  folder.write("plain.toml", kPrisms + kBody);
  ASSERT_EQ(retrace(folder, {"job", "plain.toml", "--tool-width-mm", "0.5", "-o", "job.toml"}).code, 0);
  const Arguments photometry = {"photometry", "plain.toml", "--area-cm2", "10", "--standard"};
  std::vector<Endless> cases = {
      {{"rre", "x.toml"}, "x.toml", kDesign},
      {{"sweep", "x.toml"}, "x.toml", kDesign},
      {{"optimize", "x.toml"}, "x.toml", kDesign},
      {{"tolerance", "x.toml"}, "x.toml", kDesign},
      {{"metrology", "x.txt"}, "x.txt", kData},
      {{"roughness", "plain.toml", "--facets", "x.csv"}, "x.csv", kTable},
      {with(photometry, {"x.csv"}), "x.csv", kTable},
      {with(photometry, {"r150", "--class", "IA", "--colour", "red", "--dye", "x.csv"}), "x.csv", kTable},
      {{"job", "plain.toml", "--tool-width-mm", "0.5", "--machine", "x.toml"}, "x.toml", kText},
      {{"job", "plain.toml", "--tool-width-mm", "0.5", "--process", "x.toml"}, "x.toml", kText},
      {{"fabricate", "x.toml"}, "x.toml", kText},
      {{"forces", "x.toml"}, "x.toml", kText},
      {{"turn", "x.toml"}, "x.toml", kText},
      {{"plane", "x.toml"}, "x.toml", kText},
      {{"verify", "x.toml", "p.ngc"}, "x.toml", kText},
      {{"verify", "job.toml", "x.ngc"}, "x.ngc", kData},
      {{"report", "results"}, "results/x.json", std::size_t{256} << 20},
  };
  fs::create_directory(folder.path() / "results");
  const std::map<std::string, std::size_t> limits = {
      {"mask.pgm", kData},  {"planes.csv", kPlanes}, {"map.txt", kData}, {"lamp.csv", kTable},
      {"lens.toml", kText}, {"front.stl", kData},    {"part.stl", kData}};
  for (const FileKey& key : file_keys()) {
    folder.write(key.name + ".design.toml", key.before + key.name + key.after);
    cases.push_back({{"rre", key.name + ".design.toml", "--samples=64"}, key.name, limits.at(key.name)});
  }
  for (const Endless& c : cases) {
    folder.write(c.file, "");
    fs::resize_file(folder.path() / c.file, c.max_bytes + 1);
    Arguments arguments = with(c.command, {"--quiet", "--json", "r.json"});
    const Outcome outcome = retrace(folder, arguments);
    refused_at(outcome);
    EXPECT_NE(outcome.err.find(c.file + ": "), std::string::npos) << c.command.front() << outcome.err;
    EXPECT_NE(outcome.err.find(" " + std::to_string(c.max_bytes) + " "), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder.path() / "r.json"));
    fs::remove(folder.path() / c.file);
    // Replace the file by a folder of the same name. The folder must be refused as well.
    if (c.command.front() == "report") continue;
    fs::create_directory(folder.path() / c.file);
    const Outcome as_folder = retrace(folder, arguments);
    refused_at(as_folder);
    EXPECT_NE(as_folder.err.find(c.file + ": "), std::string::npos) << c.command.front() << as_folder.err;
    fs::remove(folder.path() / c.file);
  }
}

/// Expects that a shell command ends in time, with exit code 2 and one line.
void expect_ends(const std::string& shell, const std::string& place) {
  SCOPED_TRACE(shell);
  const TemporaryFolder folder;
  folder.write("plain.toml", kPrisms + kBody);
  Child child(folder.path(), {"/bin/sh", "-c", shell});
  const Outcome outcome = child.wait(patient(60));
  EXPECT_EQ(refused_at(outcome), place);
}

TEST(Inputs, FilesWithoutEndAreRefused) {
  const std::string program = "'" + std::string(RETRACE_PROGRAM) + "' ";
  for (const std::string file : {"/dev/zero", "/dev/urandom"})
    for (const std::string command : {"rre ", "inspect ", "sweep ", "fabricate ", "turn ", "metrology "})
      expect_ends(program + command + file, file);
  expect_ends("yes | " + program + "rre -", "standard input");
  expect_ends("yes | " + program + "sweep -", "standard input");
  // Nothing ever writes to this pipe.
  for (const std::string command : {"rre ", "turn "}) expect_ends("mkfifo f; " + program + command + "f", "f");
  expect_ends("mkfifo f; " + program + "rre plain.toml --set array.mask=f", "--set array.mask=f: array.mask");
}

}  // namespace
}  // namespace retrace::test::inputs_test

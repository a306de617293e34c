#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "tests/app/program.h"

// Tests of refused input: one line with the position of the error, exit code 2, and no file written. An output that
// cannot be written gives exit code 3.

namespace retrace::test::bad_input_test {
namespace {

namespace fs = std::filesystem;

/// Lines of a valid design. Test cases replace a line by its number.
const std::vector<std::string> kLines = {
    "[element]",                 // 1
    "kind = \"rtp\"",            // 2
    "base_mm = 0.5",             // 3
    "width_mm = 0.5",            // 4
    "apex_angle_deg = 90",       // 5
    "[array]",                   // 6
    "arrangement = \"offset\"",  // 7
    "x_length_mm = 10",          // 8
    "y_length_mm = 10",          // 9
    "[body]",                    // 10
    "thickness_mm = 2.0",        // 11
    "refractive_index = 1.49",   // 12
};

std::string design_with(std::size_t number, const std::string& line) {
  std::string text;
  for (std::size_t k = 0; k < kLines.size(); ++k) text += (k + 1 == number ? line : kLines[k]) + "\n";
  return text;
}

struct BadLine {
  std::size_t number;
  std::string line;
  std::string where;
};

TEST(BadInput, WrongDesignsAreRefusedWithFileLineAndKey) {
  const std::vector<BadLine> cases = {
      {3, "base_mn = 0.5", "d.toml:3: element.base_mn"},                       // unknown key
      {10, "[bodi]", "d.toml:10: bodi"},                                       // unknown table
      {3, "base_mm = \"0.5\"", "d.toml:3: element.base_mm"},                   // wrong type
      {7, "arrangement = 3", "d.toml:7: array.arrangement"},                   //
      {3, "", "d.toml:1: element.base_mm"},                                    // missing key
      {11, "", "d.toml:10: body.thickness_mm"},                                //
      {9, "", "d.toml:6: array.y_length_mm"},                                  //
      {3, "base_mm = 0", "d.toml:3: element.base_mm"},                         // size zero
      {3, "base_mm = -0.5", "d.toml:3: element.base_mm"},                      // negative
      {12, "[light]\nwavelength_nm = 1e9", "d.toml:13: light.wavelength_nm"},  // no index at this wavelength
      {11, "thickness_mm = -1", "d.toml:11: body.thickness_mm"},               //
      {3, "base_mm = inf", "d.toml:3: element.base_mm"},                       // not finite
      {4, "width_mm = nan", "d.toml:4: element.width_mm"},                     //
      {8, "x_length_mm = -inf", "d.toml:8: array.x_length_mm"},                //
      {5, "apex_angle_deg = 59.9", "d.toml:5: element.apex_angle_deg"},        // outside 60..120
      {5, "apex_angle_deg = 120.1", "d.toml:5: element.apex_angle_deg"},       //
      {12, "refractive_index = 0.99", "d.toml:12: body.refractive_index"},     // n < 1
      {8, "x_length_mm = 0.4", "d.toml:8: array.x_length_mm"},                 // smaller than an element
      {9, "y_length_mm = 0.4", "d.toml:9: array.y_length_mm"},                 //
      {12, "material = \"Glas\"", "d.toml:12: body.material"},                 // unknown material
      {7, "arrangement = \"honeycomb\"", "d.toml:7: array.arrangement"},       // only for cube corners
      {2, "kind = \"prism\"", "d.toml:2: element.kind"},                       //
      {4, "this is no TOML", "d.toml:4"},                                      //
      {4, "base_mm = 1", "d.toml:4"},                                          // the same key twice
      {12, "[light]\nspectrum = \"B\"", "d.toml:13: light.spectrum"},
      {12, "[light]\nspectrum = \"no.csv\"", "d.toml:13: light.spectrum"},
      {12, "[light]\nspectrum = \"d.toml/a.csv\"", "d.toml:13: light.spectrum"},
      {12, "[light]\nspectrum = [[555, -1]]", "d.toml:13: light.spectrum"},
      {12, "[light]\nspectrum = [[1000, 1]]", "d.toml:13: light.spectrum"},
      {12, "[light]\nspectrum = \"A\"\nwavelength_nm = 1", "d.toml:14: light.wavelength_nm"},
      {12, "[light]\nweighting = \"radiant\"", "d.toml:13: light.weighting"},
      {12, "[surface]\nroughness_sq_nm = 5", "d.toml:12: surface.correlation_length_um"},
      {12, "[surface]\nroughness_sq_nm = 5\ncorrelation_length_um = 2\ncorrelation_length_down_um = 0",
       "d.toml:15: surface.correlation_length_down_um"},
      {12, "[surface]\ncorrelation_length_down_um = \"long\"", "d.toml:13: surface.correlation_length_down_um"},
  };
  for (const BadLine& bad : cases)
    for (const std::string command : {"rre", "inspect"}) {
      SCOPED_TRACE(command + ", line " + std::to_string(bad.number) + ": " + bad.line);
      const TemporaryFolder folder;
      folder.write("d.toml", design_with(bad.number, bad.line));
      EXPECT_EQ(refused_at(retrace(folder, {command, "d.toml", "-o", "out", "--json", "r.json"})), bad.where);
      EXPECT_EQ(folder.names(), Arguments{"d.toml"});
    }
}

TEST(BadInput, WrongFilesOfSpectraAreRefusedWithFileLineAndColumn) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "lamp.csv: "},
      {"wavelength_nm,power\n", "lamp.csv: "},
      {"400,1\n500,1\n", "lamp.csv:1: "},
      {"wavelength_nm,power\n400,1\n500,nan\n", "lamp.csv:3: power: "},
      {"wavelength_nm,power\n400,1\n500,-1\n", "lamp.csv:3: power: "},
      {"wavelength_nm,power\n500,1\n400,1\n", "lamp.csv:3: wavelength_nm: "},
      {"wavelength_nm,power\n400,0\n500,0\n", ""},   // a valid file without any light
      {"wavelength_nm,power\n900,1\n1000,1\n", ""},  // a valid file with only invisible light
  };
  for (const auto& [text, at] : cases)
    for (const std::string command : {"rre", "inspect"}) {
      SCOPED_TRACE(text);
      const TemporaryFolder folder;
      folder.write("d.toml", design_with(12, "[light]\nspectrum = \"lamp.csv\""));
      folder.write("lamp.csv", text);
      const Outcome outcome = retrace(folder, {command, "d.toml", "-o", "out", "--json", "r.json"});
      EXPECT_EQ(refused_at(outcome), "d.toml:13: light.spectrum");
      EXPECT_TRUE(outcome.err.starts_with("retrace: d.toml:13: light.spectrum: " + at)) << outcome.err;
      EXPECT_EQ(folder.names(), (Arguments{"d.toml", "lamp.csv"}));
    }
}

TEST(BadOutput, NoOutputReplacesTheFileOfASpectrum) {
  const TemporaryFolder folder;
  const std::string lamp = "wavelength_nm,power\n400,1\n700,1\n";
  folder.write("d.toml", design_with(12, "[light]\nspectrum = \"rre.csv\""));
  folder.write("rre.csv", lamp);
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "d.toml", "-o", "."})), "--out");
  EXPECT_EQ(refused_at(retrace(folder, {"inspect", "d.toml", "--json", "rre.csv"})), "--json");
  EXPECT_EQ(folder.read("rre.csv"), lamp);
}

TEST(BadInput, ErrorsOfStandardInputAndOverridesSayWhere) {
  const TemporaryFolder folder;
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "-", "-o", "out"}, design_with(3, "base_mm = -1"))),
            "standard input:3: element.base_mm");
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "-", "-o", "out", "--set", "element.base_mm=-2"}, design_with(0, ""))),
            "--set element.base_mm=-2: element.base_mm");
  EXPECT_TRUE(folder.names().empty());
}

TEST(BadInput, OneBadDesignOfSeveralStopsAllOfThem) {
  const TemporaryFolder folder;
  folder.write("bad.toml", design_with(3, "base_mm = 0"));
  EXPECT_EQ(refused_at(retrace(folder, {"rre", example("rtp_brick_2mm.toml"), "bad.toml", "-o", "out"})),
            "bad.toml:3: element.base_mm");
  EXPECT_EQ(folder.names(), Arguments{"bad.toml"});
}

TEST(BadInput, FilesThatCannotBeReadAreRefused) {
  for (const std::string command : {"rre", "inspect"}) {
    SCOPED_TRACE(command);
    const TemporaryFolder folder;
    folder.write("empty.toml", "");
    folder.write("binary.toml", std::string("\x89PNG\r\n\x1a\n\0\0\xff", 11));
    fs::create_directory(folder.path() / "folder.toml");
    const Arguments before = folder.names();
    EXPECT_EQ(refused_at(retrace(folder, {command, "missing.toml", "-o", "out"})), "missing.toml");
    EXPECT_EQ(refused_at(retrace(folder, {command, "folder.toml", "-o", "out"})), "folder.toml");
    EXPECT_EQ(refused_at(retrace(folder, {command, "empty.toml/d.toml", "-o", "out"})), "empty.toml/d.toml");
    EXPECT_EQ(refused_at(retrace(folder, {command, "empty.toml", "-o", "out"})), "empty.toml: element.kind");
    EXPECT_EQ(refused_at(retrace(folder, {command, "binary.toml", "-o", "out"})), "binary.toml:1");
    const Outcome two_lines = retrace(folder, {command, "two\nlines.toml", "-o", "out"});
    EXPECT_EQ(refused_at(two_lines), "");
    EXPECT_TRUE(two_lines.err.starts_with("retrace: two lines.toml: ")) << two_lines.err;
    EXPECT_EQ(refused_at(retrace(folder, {command, "\x1b[31mred.toml", "-o", "out"})), "\\x1b[31mred.toml");
    EXPECT_EQ(refused_at(retrace(folder, {command, "", "-o", "out"})), "DESIGN");
    EXPECT_EQ(folder.names(), before);
  }
}

/// If a design or an option names a file that does not exist, the message begins with the position of the name: file,
/// line and key, or the option.
TEST(BadInput, MissingFilesAreReportedWithWhatNamesThem) {
  const TemporaryFolder folder;
  folder.write("d.toml", design_with(0, "") + "[part]\nfacets = \"none.toml\"\n");
  folder.write("plain.toml", design_with(0, ""));
  const std::string quantity = "[[quantity]]\nkind = \"elements_full\"\n";
  folder.write("study.toml",
               "schema = \"retrace.study/1\"\ndesign = \"none.toml\"\n[[parameter]]\n"
               "key = \"element.base_mm\"\nvalues = [0.5]\n" +
                   quantity);
  folder.write("designs.toml",
               "schema = \"retrace.study/1\"\n[[parameter]]\nkey = \"design\"\n"
               "values = [\"plain.toml\", \"none.toml\"]\n" +
                   quantity);
  ASSERT_EQ(retrace(folder, {"job", "plain.toml", "--tool-width-mm", "0.5", "-o", "job.toml"}).code, 0);
  std::string job = folder.read("job.toml");
  const std::size_t machine = job.find("machine = \"ideal\"");
  job.replace(machine, 17, "machine = \"none.toml\"");
  folder.write("job.toml", job);
  const auto line = std::to_string(1 + std::count(job.begin(), job.begin() + static_cast<long>(machine), '\n'));
  folder.write("m.csv", "job,element,facet,what,value,uncertainty\nnone.toml,0,1,up_arcsec,1,1\n");
  folder.write("t.csv", "program,seconds,uncertainty\nnone.toml,1,1\n");
  const std::vector<Refused> cases = {
      {{"rre", "d.toml"}, "d.toml:14: part.facets"},
      {{"inspect", "d.toml"}, "d.toml:14: part.facets"},
      {{"sweep", "study.toml"}, "study.toml:2: design"},
      {{"tolerance", "study.toml"}, "study.toml:2: design"},
      {{"sweep", "designs.toml"}, "designs.toml:4: parameter[1].values"},
      {{"fabricate", "job.toml"}, "job.toml:" + line + ": machine"},
      {{"job", "plain.toml", "--tool-width-mm", "0.5", "--machine", "none.toml"}, "--machine"},
      {{"job", "plain.toml", "--tool-width-mm", "0.5", "--process", "none.toml"}, "--process"},
      {{"calibrate", "m.csv"}, "m.csv:2: job"},
      {{"calibrate", "--times", "ideal", "t.csv"}, "t.csv:2: program"},
  };
  expect_refused(folder, cases, {}, {});
}

/// If the design of a study names a missing file, retrace refuses the study before it computes any point. The message
/// begins with the position of the key, which is in the design, in a parameter of the study or in an override.
TEST(BadInput, MissingFilesOfTheDesignsOfAStudyAreReportedWithWhatNamesThem) {
  const std::string cells = "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nx_length_mm = 10\n";
  const std::string rest = "y_length_mm = 10\n[body]\nthickness_mm = 2.0\nrefractive_index = 1.49\n";
  const std::string design = cells + rest;
  const std::vector<std::pair<std::string, std::string>> designs = {
      {"[body]\nrefractive_index = 1.49\n[part]\nmesh = \"none\"\n", "d.toml:4: part.mesh"},
      {cells + "mask = \"none\"\n" + rest, "d.toml:7: array.mask"},
      {design + "material = \"K7\"\ncatalogue = \"none\"\n", "d.toml:12: body.catalogue"},
      {design + "[part]\nfacets = \"none\"\n", "d.toml:12: part.facets"},
      {design + "[entrance_surface]\nmesh = \"none\"\n", "d.toml:12: entrance_surface.mesh"},
      {design + "[entrance_surface]\nturned_part = \"none\"\n", "d.toml:12: entrance_surface.turned_part"},
      {design + "[light]\nspectrum = \"none.csv\"\n", "d.toml:12: light.spectrum"},
      {design + "[form]\nmap = \"none\"\n", "d.toml:12: form.map"},
      {design + "[surface]\nmodel = \"height_map\"\nheight_map = \"none\"\n", "d.toml:13: surface.height_map"},
  };
  const auto study = [](const std::string& key, const std::string& values) {
    return "schema = \"retrace.study/1\"\ndesign = \"d.toml\"\n[[parameter]]\nkey = \"" + key + "\"\nvalues = [" +
           values + "]\n[[quantity]]\nkind = \"elements_full\"\n";
  };
  const auto expect_named = [](const TemporaryFolder& folder, const std::string& where, const Arguments& more = {}) {
    for (const std::string command : {"sweep", "tolerance", "optimize", "compose"})
      expect_refused(folder, {{with({command, "study.toml"}, more), where}}, {});
  };
  for (const auto& [text, where] : designs) {
    const TemporaryFolder folder;
    folder.write("d.toml", text);
    folder.write("study.toml", study("body.back_index", "1, 1.1"));
    expect_named(folder, where);
  }
  const TemporaryFolder folder;
  folder.write("d.toml", design + "[surface]\nmodel = \"height_map\"\nheight_map = \"map.txt\"\n");
  folder.write("map.txt", read_text(example("facet_height_map.txt")));
  folder.write("study.toml", study("surface.height_map", "\"map.txt\", \"none\""));
  expect_named(folder, "study.toml:5: parameter[1].values");
  folder.write("study.toml", study("body.back_index", "1"));
  expect_named(folder, "--set surface.height_map=none: surface.height_map", {"--set", "surface.height_map=none"});
  EXPECT_EQ(retrace(folder, {"sweep", "study.toml"}).code, 0) << "all its files exist";
}

/// If a limits file or a dye file cannot be read, the message contains the key or the option that names it.
TEST(BadInput, UnreadableFilesOfPhotometryAreReportedWithWhatNamesThem) {
  const TemporaryFolder folder;
  folder.write("d.toml", design_with(0, ""));
  fs::create_directory(folder.path() / "folder");
  ASSERT_EQ(::mkfifo((folder.path() / "fifo").c_str(), 0600), 0);
  const std::string before =
      "design = \"d.toml\"\n[[parameter]]\nkey = \"element.base_mm\"\nvalues = [0.5]\n[[quantity]]\n"
      "kind = \"photometry\"\narea_cm2 = 1\n";
  const Arguments photometry = {"photometry", "d.toml", "--area-cm2", "1"};
  const Arguments r150 = {"--standard", "r150", "--class", "IA", "--colour", "red", "--dye"};
  for (const std::string name : {"folder", "fifo"}) {
    folder.write("standard.toml", before + "standard = \"" + name + "\"\n");
    folder.write("dye.toml",
                 before + "standard = \"r150\"\nclass = \"IA\"\ncolour = \"red\"\ndye = \"" + name + "\"\n");
    expect_refused(folder,
                   {{{"sweep", "standard.toml"}, "standard.toml:8: quantity[1].standard"},
                    {{"sweep", "dye.toml"}, "dye.toml:11: quantity[1].dye"},
                    {with(photometry, {"--standard", name}), "--standard"},
                    {with(with(photometry, r150), {name}), "--dye"}},
                   {});
  }
}

/// Messages shorten every value that is longer than 80 characters.
TEST(BadInput, LongValuesAreClipped) {
  const std::string value(5000, 'q');
  const TemporaryFolder folder;
  const std::string design = example("rtp_single_0p45mm.toml");
  const std::string name = value.substr(0, 200) + ".toml";
  folder.write(name, design_with(0, ""));
  folder.write("word.toml", design_with(7, "arrangement = \"" + value + "\""));
  folder.write("key.toml", design_with(3, value + " = 1"));
  folder.write("number.toml", design_with(3, "base_mm = \"" + value + "\""));
  const std::vector<Arguments> cases = {
      {"rre", "word.toml"},
      {"rre", "key.toml"},
      {"rre", "number.toml"},
      {"rre", design, "--engine", value},
      {"rre", design, "--sampling", value},
      {"rre", design, "--samples", value},
      {"rre", design, "--cutoff", value},
      {"rre", design, "--incidence", value},
      {"rre", design, "--azimuth", "1:" + value},
      {"rre", design, "--set", "element.kind=" + value},
      {"rre", design, "--set", value},
      {"rre", design, "--set", value + "="},
      {"rre", design, "--" + value},
      {"rre", design, "--threads=" + value},
      {"inspect", design, value},
      {value},
      {"list", value},
      {"init", value},
      {"image", design, "--camera", "--pixels", value},
      {"metrology", design, "--form", value},
      {"metrology", design, "--pixel-um", value},
      {"photometry", design, "--area-cm2", "1", "--standard", value},
      {"job", design, "--tool-width-mm", "0.5", "--machine", value},
      {"export", design, "--what", value},
      {"inspect", name, "--json", name},
  };
  for (const Arguments& arguments : cases) {
    const Outcome outcome = retrace(folder, arguments);
    SCOPED_TRACE(arguments.front().substr(0, 20) + " " + outcome.err.substr(0, 200));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err.find(std::string(81, 'q')), std::string::npos);
    EXPECT_NE(outcome.err.find(std::string(50, 'q')), std::string::npos);
  }
}

/// If the operating system refuses a file name, retrace reports it in its own one-line format. The exit code is 2 for
/// input files and 3 for output files.
TEST(BadInput, NamesThatTheSystemRefusesAreReportedInOneLine) {
  const TemporaryFolder folder;
  folder.write("d.toml", design_with(0, ""));
  fs::create_symlink("loop", folder.path() / "loop");
  for (const std::string& name :
       {std::string(300, 'n'), std::string("loop"), std::string("loop/x"), std::string("d.toml/x")}) {
    SCOPED_TRACE(name);
    const std::vector<std::pair<int, Arguments>> cases = {
        {2, {"rre", name}},
        {2, {"report", name}},
        {2, {"verify", "d.toml", name + "@3"}},
        {2, {"photometry", "d.toml", "--standard", name}},
        {2, {"photometry", "d.toml", "--area-cm2", "1", "--standard", "r150", "--dye", name}},
        {2, {"rays", "d.toml", "--source", name + ".csv"}},
        {3, {"inspect", "d.toml", "-o", name + "/y"}},
        {3, {"inspect", "d.toml", "--json", name + "/y"}},
        {3, {"inspect", "d.toml", "--json", name}},
        {3, {"export", "d.toml", name + ".d/x.stl"}},
    };
    for (const auto& [code, arguments] : cases) {
      const Outcome outcome = retrace(folder, arguments);
      EXPECT_EQ(outcome.code, code) << arguments.front() << ' ' << outcome.err;
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
  }
  EXPECT_EQ(folder.names(), (Arguments{"d.toml", "loop"}));
}

TEST(BadInput, WrongOptionsAreRefused) {
  const std::vector<Refused> cases = {
      {{"--engine", "magic"}, "--engine"},
      {{"--engine", ""}, "--engine"},
      {{"--engine", "cell"}, "--engine"},
      {{"--sampling", "random"}, "--sampling"},
      {{"--sampling", "plain", "--engine", "exact"}, "--sampling"},
      {{"--sampling", "plain", "--engine", "stochastic"}, "--sampling"},
      {{"--footprint", "--engine", "stochastic"}, "--footprint"},
      {{"--sampling", "plain", "--engine", "cell"}, "--sampling"},
      {{"--incidence=5:1:1"}, "--incidence"},
      {{"--incidence=1:1:auto"}, "--incidence"},
      {{"--incidence=40:-40:auto"}, "--incidence"},
      {{"--incidence=-95:0:auto"}, "--incidence"},
      {{"--incidence=0:90:auto"}, "--incidence"},
      {{"--incidence=0:nan:auto"}, "--incidence"},
      {{"--incidence=0:10:aut"}, "--incidence"},
      {{"--incidence=auto"}, "--incidence"},
      {{"--incidence=auto:10:1"}, "--incidence"},
      {{"--azimuth=0:90:auto"}, "--azimuth"},
      {{"--incidence", ""}, "--incidence"},
      {{"--azimuth", ""}, "--azimuth"},
      {{"--incidence", "90"}, "--incidence"},
      {{"--incidence=0,-90"}, "--incidence"},
      {{"--threads", "0"}, "--threads"},
      {{"--threads", "two"}, "--threads"},
      {{"--samples", "0"}, "--samples"},
      {{"--samples", "-1"}, "--samples"},
      {{"--samples", "1e6"}, "--samples"},
      {{"--target-error", "0"}, "--target-error"},
      {{"--target-error", "-1e-4"}, "--target-error"},
      {{"--target-error", "nan"}, "--target-error"},
      {{"--target-error", "small"}, "--target-error"},
      {{"--target-error=1e-3", "--samples=64"}, "--target-error"},
      {{"--cutoff", "-1"}, "--cutoff"},
      {{"--cutoff", "1"}, "--cutoff"},
      {{"--seed", "lucky"}, "--seed"},
      {{"--seed", "-1"}, "--seed"},
      {{"--seed", "1.5"}, "--seed"},
      {{"--seed", "010"}, "--seed"},
      {{"--seed", "4294967296"}, "--seed"},
      {{"--set", "element.base_mm"}, "--set element.base_mm"},
      {{"--set", "element.bas=1"}, "--set element.bas=1: element.bas"},
      {{"--frobnicate"}, ""},
      {{"--samples"}, "--samples"},
      {{"--azimuth=1e300"}, "--azimuth"},
      {{"--set", "body.refractive_index=1e6"}, "--set body.refractive_index=1e6: body.refractive_index"},
      {{"--json", ""}, "--json"},
      {{"--out", ""}, "--out"},
  };
  for (const Refused& bad : cases) {
    Arguments command = {"rre", example("rtp_single_0p45mm.toml")};
    if (bad.arguments.front() != "--out") command.insert(command.begin(), {"-o", "out"});
    expect_refused(TemporaryFolder(), {bad}, command, {});
  }
}

TEST(BadInput, SeedMayBeAnyOfThem) {
  const TemporaryFolder folder;
  for (const char* seed : {"0", "4294967295"})
    EXPECT_EQ(std::to_string(retrace_json(folder, {"rre", example("rtp_single_0p45mm.toml"), "--samples=32", "--seed",
                                                   seed})["seed"]
                                 .get<std::uint64_t>()),
              seed);
}

TEST(BadInput, WordsThatAreNoCommandAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(refused_at(retrace(folder, {})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"trace", "d.toml", "-o", "out"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"--bogus"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "--bogus"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "-o", "out"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"rre", "-", "-", "-o", "out"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"inspect", "a.toml", "b.toml"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"init", "prism", "-o", "out"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"init", "-o", "out"})), "");
  EXPECT_EQ(refused_at(retrace(folder, {"init", "rtp", "--set", "element.base_mm=1", "-o", "out"})), "--set");
  EXPECT_EQ(refused_at(retrace(folder, {"list", "planets", "-o", "out"})), "list");
  EXPECT_EQ(refused_at(retrace(folder, {"list"})), "");
  EXPECT_TRUE(folder.names().empty());
}

TEST(BadOutput, FolderThatCannotBeMadeEndsWith3) {
  const TemporaryFolder folder;
  folder.write("way", "in the way");
  for (const Arguments& run : {Arguments{"rre", example("rtp_single_0p45mm.toml"), "--samples=64"},
                               Arguments{"inspect", example("rtp_single_0p45mm.toml")}, Arguments{"list", "materials"}})
    for (const std::string out : {"way", "way/below"}) {
      Arguments arguments = run;
      arguments.insert(arguments.end(), {"-o", out, "--json", "r.json"});
      EXPECT_EQ(refused_at(retrace(folder, arguments), 3), out);
    }
  EXPECT_EQ(folder.names(), Arguments{"way"});
  EXPECT_EQ(folder.read("way"), "in the way");
}

TEST(BadOutput, JsonThatCannotBeWrittenEndsWith3AndMakesNoFolder) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "folder");
  const Arguments run = {"rre", example("rtp_single_0p45mm.toml"), "--samples=64", "--quiet", "-o", "out", "--json"};
  for (const std::string json : {"missing/r.json", "folder"}) {
    Arguments arguments = run;
    arguments.push_back(json);
    EXPECT_EQ(refused_at(retrace(folder, arguments), 3), json);
    EXPECT_EQ(folder.names(), Arguments{"folder"});
  }
  EXPECT_EQ(refused_at(retrace(folder, {"list", "materials", "--json", "/dev/full"}), 3), "/dev/full");
}

TEST(BadOutput, NoOutputReplacesADesignOrAnotherOutput) {
  const TemporaryFolder folder;
  const std::string design = read_text(example("rtp_single_0p45mm.toml"));
  folder.write("d.toml", design);
  folder.write("rre.csv", design);
  const Arguments run = {"rre", "d.toml", "rre.csv", "--samples=64", "--quiet"};
  const std::vector<Refused> cases = {
      {{"--json", "d.toml"}, "--json"},
      {{"--json", "./d.toml"}, "--json"},
      {{"-o", "."}, "--out"},
      {{"-o", "out", "--json", "out/rre.csv"}, "--json"},
      {{"-o", "out", "--json", "./out/rre.png"}, "--json"},
  };
  for (const Refused& bad : cases) {
    expect_refused(folder, {bad}, run, {});
    EXPECT_EQ(folder.read("d.toml"), design);
    EXPECT_EQ(folder.read("rre.csv"), design);
  }
  EXPECT_EQ(refused_at(retrace(folder, {"inspect", "d.toml", "--json", "d.toml"})), "--json");
}

TEST(BadOutput, ResultFileBehindAFolderEndsWith3AndLeavesNoTemporaryFile) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "out/rre.csv");
  EXPECT_EQ(refused_at(retrace(folder, {"rre", example("rtp_single_0p45mm.toml"), "--samples=64", "-o", "out"}), 3),
            "out/rre.csv");
  for (const std::string& name : folder.names()) EXPECT_EQ(name.find(".tmp"), std::string::npos) << name;
}

TEST(BadOutput, FullStandardOutputEndsWith3) {
  const TemporaryFolder folder;
  for (const Arguments& run : {Arguments{"rre", example("rtp_single_0p45mm.toml"), "--samples=64"},
                               Arguments{"rre", example("rtp_single_0p45mm.toml"), "--samples=64", "--json", "-"},
                               Arguments{"inspect", example("rtp_single_0p45mm.toml")}, Arguments{"init", "rtp"},
                               Arguments{"list", "materials"}, Arguments{"--help"}, Arguments{"--version"}}) {
    const Outcome outcome = retrace(folder, run, "", "/dev/full");
    EXPECT_EQ(refused_at(outcome, 3), "") << run.front();
  }
}

}  // namespace
}  // namespace retrace::test::bad_input_test

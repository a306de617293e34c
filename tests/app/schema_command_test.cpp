#include <gtest/gtest.h>

#include "tests/app/program.h"

// Tests of `retrace schema`. An independent validator must accept our files with the printed JSON Schemas.

namespace retrace::test::schema_command_test {
namespace {

namespace fs = std::filesystem;

TEST(SchemaCommand, ListsTheFormats) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"schema"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "name         schema                 title\n"
            "cubes        retrace.cubes/1        Cubes of an array for ranging\n"
            "design       retrace.design/1       Design of a retroreflector array\n"
            "job          retrace.job/1          Fabrication job\n"
            "machine      retrace.machine/1      Machine with five axes\n"
            "materials    retrace.materials/1    Materials and metals\n"
            "planed_part  retrace.planed_part/1  Flat lens of zones, planed or turned\n"
            "process      retrace.process/1      Process of a fabrication job\n"
            "study        retrace.study/1        Study of a design\n"
            "turned_part  retrace.turned_part/1  Freeform surface, turned\n");
  const Json json = retrace_json(folder, {"schema"});
  EXPECT_EQ(json["schema"], "retrace.formats/1");
  EXPECT_EQ(json["formats"][3],
            (Json{{"name", "machine"}, {"schema", "retrace.machine/1"}, {"title", "Machine with five axes"}}));
}

TEST(SchemaCommand, PrintsJsonSchema) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"schema", "process"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["title"], "Process of a fabrication job");
  EXPECT_EQ(json["properties"]["dwell_s"]["default"], 0.1);
  EXPECT_EQ(retrace(folder, {"schema", "process", "-o", "out", "--quiet"}).out, "");
  EXPECT_EQ(folder.read("out/process.schema.json"), outcome.out);
}

TEST(SchemaCommand, RefusesAnUnknownFormat) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"schema", "procces"});
  EXPECT_EQ(refused_at(outcome), "schema");
}

/// Python script that prints one line for each TOML file: its name, and whether the schema accepts it.
const char* const kValidate = R"(
import json, pathlib, sys, tomllib
import jsonschema
schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
for name in sys.argv[2:]:
    is_valid = validator.is_valid(tomllib.loads(pathlib.Path(name).read_text()))
    print(pathlib.Path(name).name, "accepted" if is_valid else "refused")
)";

/// Returns the output of the validator for files with the schema of a format.
std::vector<std::string> judged(const TemporaryFolder& folder, const std::string& format,
                                const std::vector<std::string>& files) {
  folder.write("validate.py", kValidate);
  folder.write("schema.json", retrace(folder, {"schema", format}).out);
  Arguments arguments = {RETRACE_PYTHON, "-B", "validate.py", "schema.json"};
  arguments.insert(arguments.end(), files.begin(), files.end());
  Child child(folder.path(), arguments);
  const Outcome outcome = child.wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return lines_of(outcome.out);
}

/// Returns the files with the extension .toml in a folder of the repository.
std::vector<std::string> files_in(const std::string& name) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / name))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  return files;
}

TEST(SchemaCommand, AValidatorAcceptsWhatIsShipped) {
  const TemporaryFolder folder;
  std::vector<std::string> jobs;
  for (const auto& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / "tests/fabrication/golden"))
    if (entry.is_directory()) jobs.push_back((entry.path() / "job.toml").string());
  EXPECT_GE(jobs.size(), 10U);
  for (const std::string& line : judged(folder, "job", jobs)) EXPECT_EQ(line, "job.toml accepted");
  for (const auto& [format, name, least] :
       {std::tuple{"machine", "data/machines", 4U}, std::tuple{"process", "data/processes", 4U},
        std::tuple{"materials", "data", 1U}, std::tuple{"design", "examples", 15U},
        std::tuple{"planed_part", "examples/planing", 2U}, std::tuple{"turned_part", "examples/turning", 3U},
        std::tuple{"design", "examples/fronts", 1U}, std::tuple{"design", "examples/luminance_fixture", 1U},
        std::tuple{"study", "examples/studies", 9U}}) {
    std::vector<std::string> files = files_in(name);
    // The folder of studies also contains designs, which are not studies.
    if (format == std::string("study"))
      std::erase_if(files,
                    [](const std::string& file) { return read_text(file).find("[[parameter]]") == std::string::npos; });
    const std::vector<std::string> lines = judged(folder, format, files);
    EXPECT_GE(lines.size(), least) << name;
    for (const std::string& line : lines) EXPECT_TRUE(line.ends_with(" accepted")) << format << ": " << line;
  }
}

/// Each of these lines makes a design of prisms invalid. The validator must refuse it, as our reader does.
TEST(SchemaCommand, AValidatorRefusesWrongDesigns) {
  const TemporaryFolder folder;
  const std::string good = "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nextent = \"infinite\"\n";
  const std::string rest = "[body]\nthickness_mm = 2\n";
  const std::vector<std::string> wrong = {"x_length_mm = 3\n",
                                          "arrangement = \"honeycomb\"\n",
                                          "overlap_percent = 50\n",
                                          "x_gap_mm = -1\n",
                                          "gap_mm = 1\n",
                                          "mask = \"m.png\"\n",
                                          "mask_threshold = 0.5\n",
                                          "arangement = \"offset\"\n",
                                          "[light]\nwavelength_nm = 0\n",
                                          "[light]\nweighting = \"radiant\"\n",
                                          "[light]\nspectrum = \"A\"\nwavelength_nm = 500\n",
                                          "[light]\npolarisation = [1, 0]\n",
                                          "[light]\npolarisation_angle_deg = 1\n",
                                          "[surface]\nabg_a = 1\n",
                                          "[surface]\nmodel = \"abg\"\n",
                                          "[surface]\nslope_distribution = \"ggx\"\n",
                                          "[surface]\nscratches = 3\n",
                                          "[substrate]\nkind = \"plane\"\n",
                                          "[substrate]\nkind = \"sphere\"\nradius_mm = 9\naxis = \"x\"\n",
                                          "[entrance_surface]\nturned_part = \"a\"\nmesh = \"b\"\n",
                                          "[part]\nmesh = \"p.stl\"\n",
                                          "[bodies]\n",
                                          "[detector]\nacceptance_half_angle_deg = [1, 91]\n",
                                          "[idealisation]\nfacets = \"real mirror\"\n"};
  std::vector<std::string> files = {"good.toml"};
  folder.write("good.toml", good + rest);
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    files.push_back("wrong" + std::to_string(i) + ".toml");
    folder.write(files.back(), good + wrong[i] + rest);
    EXPECT_EQ(retrace(folder, {"inspect", files.back()}).code, 2) << wrong[i];
  }
  const std::vector<std::string> lines = judged(folder, "design", files);
  ASSERT_EQ(lines.size(), files.size());
  EXPECT_EQ(lines[0], "good.toml accepted");
  for (std::size_t i = 0; i < wrong.size(); ++i) EXPECT_TRUE(lines[i + 1].ends_with(" refused")) << wrong[i];
}

/// Replacement of a text in a shipped file, which makes the file invalid.
struct Wrong {
  std::string from;
  std::string to;
};

/// Expects that both retrace and the validator refuse each case.
void expect_refused(const std::string& format, const std::string& file, const std::vector<Wrong>& cases) {
  const TemporaryFolder folder;
  const std::string good = read_text(fs::path(RETRACE_SOURCE_DIR) / file);
  std::vector<std::string> names;
  for (const Wrong& wrong : cases) {
    std::string text = good;
    const std::size_t at = text.find(wrong.from);
    ASSERT_NE(at, std::string::npos) << wrong.from;
    names.push_back(std::to_string(names.size()) + ".toml");
    folder.write(names.back(), text.replace(at, wrong.from.size(), wrong.to));
  }
  const std::vector<std::string> lines = judged(folder, format, names);
  ASSERT_EQ(lines.size(), cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_TRUE(lines[i].ends_with(" refused")) << cases[i].to;
}

TEST(SchemaCommand, AValidatorRefusesWrongMachines) {
  expect_refused("machine", "data/machines/paper.toml",
                 {{"[0.999995, -0.0014502, 0.00268292]", "[0, 1]"},
                  {"value = 10,", "value = 0,"},
                  {", assumed = \"square guideways\"", ""},
                  {"assumed = \"square guideways\"", "assumed = \"a\", measured = \"b\""},
                  {"[z]", "[w]"},
                  {"[a]", "[b]\n[a]"},
                  {"moves_with = \"tool\"", "moves_with = \"spindle\""},
                  {"box_mm = { value = [-60, -60, -40, 60, 60, -15]", "points_mm = { value = [[0, 0, 0]]"},
                  {"retrace.machine/1", "retrace.machine/2"},
                  {"title", "titel"}});
}

TEST(SchemaCommand, AValidatorRefusesWrongProcesses) {
  expect_refused("process", "data/processes/paper-pmma.toml",
                 {{"clearance_mm = 0.2\n", ""},
                  {"clearance_mm = 0.2", "clearance_mm = 0"},
                  {"clearance_mm = 0.2", "clearance_mm = \"0.2\""},
                  {"finishing_cuts = 2", "finishing_cuts = 1.5"},
                  {"finishing_cuts = 2", "finishing_cut = 2"},
                  {"dwell_s = 0.1", "dwell_s = 61"},
                  {"dwell_s = 0.1", "shortest_plough = 1"}});
}

TEST(SchemaCommand, AValidatorRefusesWrongJobs) {
  expect_refused("job", "tests/fabrication/golden/offset_two_step_thesis/job.toml",
                 {{"strategy = \"two-step\"", "strategy = \"dmc\""},
                  {"arrangement = \"offset\"", "arrangement = \"honeycomb\""},
                  {"arrangement = \"offset\"", "arrangement = \"single\""},
                  {"x_length_mm", "x_length"},
                  {"[array]", "apex_angle_deg = 121\n[array]"},
                  {"[process]", "nose_angle_deg = 50\n[process]"},
                  {"[tool]", "[substrate]\nkind = \"sphere\"\n[tool]"},
                  {"[process]", "[[tool.edge_chips]]\nwidth_um = 1\n[process]"},
                  {"dwell_s", "dwel_s"},
                  {"[tool]", "[workpiece]\nkind = \"optic\"\n[tool]"}});
}

TEST(SchemaCommand, AValidatorRefusesWrongPlanedParts) {
  expect_refused("planed_part", "examples/planing/zone_lens_60ghz.toml",
                 {{"kind = \"zone_lens\"", "kind = \"round_zone_lens\""},
                  {"refractive_index = 1.52", "refractive_index = 1"},
                  {"\nlength_mm", "\nlength"},
                  {"[mill]", "[lathe]"},
                  {"[13, 13, 6]", "[13, 13]"}});
}

TEST(SchemaCommand, AValidatorRefusesWrongTurnedParts) {
  expect_refused("turned_part", "examples/turning/rectangle_quartic.toml",
                 {{"corner_mm = 0.15\n", ""},
                  {"kind = \"rectangle\"", "kind = \"circle\""},
                  {"[boundary]", "[lenslets]"},
                  {"order = 4", "order = 10"},
                  {"terms", "even"},
                  {"feed_um = 20", "feed_um = 20\nscallop_nm = 3"},
                  {"points_per_turn = 1440", "sampling = \"arc\""},
                  {"points_per_turn = 1440", "sampling = \"arc\"\narc_um = 5\nservo = \"fast\""},
                  {"[inspect]", "[machine.w]\n[inspect]"}});
}

TEST(SchemaCommand, AValidatorRefusesWrongStudies) {
  expect_refused("study", "examples/studies/element_size.toml",
                 {{"from = 0.1\n", "from = 0.1\nvalues = [1]\n"},
                  {"scale = \"log\"", "scale = \"decades\""},
                  {"scale = \"log\"", "scal = \"log\""},
                  {"name = \"size_mm\"", "name = 3"},
                  {"kind = \"rre\"", "kind = \"rree\""},
                  {"kind = \"rre\"", "kind = \"rre\"\narea_cm2 = 3"},
                  {"kind = \"rre\"", "kind = \"rre\"\nincidence_deg = [0, 90]"},
                  {"kind = \"rre\"", "kind = \"ledger\""},
                  {"[[quantity]]", "[sweep]\nsamples = 5\n[[quantity]]"},
                  {"[[quantity]]", "[tolerance]\nsamples = 1\n[[quantity]]"},
                  {"maximize", "minimize = \"rre\"\nmaximize"}});
}

/// The schema to which a file of `init --editor` refers must be equal to the schema that `retrace schema` prints.
TEST(SchemaCommand, EditorsFindTheSchema) {
  const TemporaryFolder folder;
  for (const auto& [kind, format] : {std::pair{"rtp", "design"}, std::pair{"round_zone_lens", "planed_part"}}) {
    const std::string plain = retrace(folder, {"init", kind}).out;
    const std::string text = retrace(folder, {"init", kind, "--editor"}).out;
    const std::string start = "#:schema file:///";
    ASSERT_TRUE(text.starts_with(start)) << text.substr(0, 100);
    const std::size_t end = text.find('\n');
    EXPECT_EQ(text.substr(end + 1), plain);
    EXPECT_EQ(read_text(text.substr(start.size() - 1, end - start.size() + 1)),
              retrace(folder, {"schema", format}).out);
  }
}

/// The schema file of every format is installed with the program.
TEST(SchemaCommand, AllSchemasAreInstalled) {
  const TemporaryFolder folder;
  const auto formats = nlohmann::json::parse(retrace(folder, {"schema", "--json", "-"}).out)["formats"];
  const fs::path program = fs::path(RETRACE_PROGRAM);
  for (const auto& format : formats)
    EXPECT_TRUE(fs::is_regular_file(program.parent_path().parent_path() / "share/retrace_schemas" /
                                    (format["name"].get<std::string>() + ".schema.json")))
        << format["name"];
}

}  // namespace
}  // namespace retrace::test::schema_command_test

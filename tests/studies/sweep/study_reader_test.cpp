#include "studies/quantity/io/study_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "studies/sweep/io/sweep_reader.h"
#include "tests/support/refusals.h"

namespace retrace::studies::study_reader_test {
namespace {

const std::string kFolder = std::string(RETRACE_SOURCE_DIR) + "/examples/";

const std::string kDesign = "design = \"rtp_brick_1mm.toml\"\n";
const std::string kParameter = "[[parameter]]\nkey = \"element.base_mm\"\nvalues = [1, 2]\n";
const std::string kQuantity = "[[quantity]]\nkind = \"rre\"\n";

Sweep sweep_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_sweep(parse_study(text, kFolder + "study.toml", overrides));
}

const std::string kExamples = "examples/";

/// Returns the place at which a study is refused, without the folder.
std::string message(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    sweep_of(text, overrides);
  } catch (const InputError& error) {
    const std::string place = recorded_place_of(error);
    return place.starts_with(kExamples) ? place.substr(kExamples.size()) : place;
  }
  return "";
}

std::string with_parameter(const std::string& keys) {
  return kDesign + "[[parameter]]\n" + keys + kQuantity;
}
std::string with_quantity(const std::string& keys) {
  return kDesign + kParameter + "[[quantity]]\n" + keys;
}

std::vector<double> numbers(const Parameter& parameter) {
  std::vector<double> values;
  for (const ParameterValue& value : parameter.values) values.push_back(std::get<double>(value.shown));
  return values;
}

TEST(StudyReader, AQuantityWithoutAnAzimuthHasThatOfTheAnalysis) {
  const auto rre = [](const std::string& of_quantity, const std::string& of_analysis) {
    const Study study = parse_study(kDesign + kParameter + kQuantity + "incidence_deg = 20\n" + of_quantity +
                                        "[analysis]\nengine = \"montecarlo\"\nsamples = 4096\n" + of_analysis,
                                    kFolder + "study.toml");
    const PointValues values = {Parameter::value_of(1.0)};
    const Candidate candidate = make_candidate(study, values);
    return study.quantities[0]->measure(candidate, nullptr)->value.value();
  };
  const std::string azimuth = "azimuth_deg = 30\n";
  EXPECT_EQ(rre("", azimuth), rre(azimuth, ""));
  EXPECT_GT(std::abs(rre("", azimuth) - rre("", "")), 1e-3);
}

TEST(StudyReader, RangesAreThoseOfLists) {
  const auto values = [](const std::string& keys) {
    return numbers(sweep_of(with_parameter("key = \"element.base_mm\"\n" + keys)).study().parameters[0]);
  };
  EXPECT_EQ(values("from = 1\nto = 2\nstep = 0.25\n"), (std::vector{1.0, 1.25, 1.5, 1.75, 2.0}));
  EXPECT_EQ(values("from = 0\nto = 1\nstep = 0.3\n").size(), 4U);
  EXPECT_EQ(values("from = 0\nto = 0.3\nstep = 0.1\n").size(), 4U) << "the stop belongs to it, whatever the rounding";
  EXPECT_EQ(values("from = 1\nto = 3\ncount = 5\n"), (std::vector{1.0, 1.5, 2.0, 2.5, 3.0}));
  const std::vector<double> decades = values("from = 0.01\nto = 10\ncount = 4\nscale = \"log\"\n");
  ASSERT_EQ(decades.size(), 4U);
  EXPECT_NEAR(decades[1], 0.1, 1e-12);
  EXPECT_NEAR(decades[2], 1.0, 1e-12);
  EXPECT_EQ(decades[3], 10.0);
}

TEST(StudyReader, GridAndZip) {
  const std::string parameters = kDesign + kParameter + "[[parameter]]\nkey = \"element.width_mm\"\nvalues = [3, 4]\n";
  const Sweep grid = sweep_of(parameters + kQuantity);
  ASSERT_EQ(grid.size(), 4U);
  const auto shown = [](const Sweep& sweep, std::uint64_t point) {
    std::vector<double> values;
    for (const ParameterValue& value : sweep.values(point)) values.push_back(std::get<double>(value.shown));
    return values;
  };
  EXPECT_EQ(shown(grid, 0), (std::vector{1.0, 3.0}));
  EXPECT_EQ(shown(grid, 1), (std::vector{1.0, 4.0}));
  EXPECT_EQ(shown(grid, 3), (std::vector{2.0, 4.0}));
  const Sweep zipped = sweep_of(parameters + kQuantity + "[sweep]\ncombine = \"zipped\"\n");
  ASSERT_EQ(zipped.size(), 2U);
  EXPECT_EQ(shown(zipped, 1), (std::vector{2.0, 4.0}));
}

TEST(StudyReader, AParameterSetsItsKeys) {
  const Sweep sweep = sweep_of(with_parameter("key = [\"element.base_mm\", \"element.width_mm\"]\nvalues = [0.25]\n"));
  const Candidate candidate = make_candidate(sweep.study(), sweep.values(0));
  const auto& prism = std::get<geometry::RtpElement>(candidate.design().part().element);
  EXPECT_EQ(prism.base_mm, 0.25);
  EXPECT_EQ(prism.width_mm, 0.25);
}

TEST(StudyReader, AnalysisMachiningAndWordsCanBeVaried) {
  const Sweep sweep = sweep_of(kDesign +
                                   "[[parameter]]\nkey = \"analysis.incidence_deg\"\nvalues = [7]\n"
                                   "[[parameter]]\nkey = \"machining.tool_width_mm\"\nvalues = [0.3]\n"
                                   "[[parameter]]\nkey = \"array.arrangement\"\nvalues = [\"aligned\"]\n" +
                                   kQuantity,
                               {"analysis.engine=exact", "array.shifted_rows=odd", "body.thickness_mm=3"});
  std::vector<std::string> overrides = sweep.study().overrides;
  Study study = sweep.study();
  std::erase(study.overrides, "array.shifted_rows=odd");
  // The design shifts rows, which is not allowed for an aligned array.
  EXPECT_THROW(make_candidate(study, sweep.values(0)), InputError);
  PointValues values = sweep.values(0);
  values[2].toml = "\"offset\"";
  const Candidate candidate = make_candidate(study, values);
  EXPECT_EQ(candidate.analysis().incidence_deg, 7.0);
  EXPECT_EQ(candidate.analysis().engine, raytrace::Engine::exact);
  EXPECT_EQ(candidate.machining().tool_width_mm, 0.3);
  EXPECT_EQ(candidate.design().part().thickness_mm, 3.0);
}

TEST(StudyReader, DesignsCanBeVaried) {
  const Sweep sweep = sweep_of(
      "[[parameter]]\nkey = \"design\"\nvalues = [\"rtp_brick_1mm.toml\", \"rtp_brick_2mm.toml\"]\n" + kQuantity);
  ASSERT_EQ(sweep.size(), 2U);
  const Candidate candidate = make_candidate(sweep.study(), sweep.values(1));
  EXPECT_EQ(std::get<geometry::RtpElement>(candidate.design().part().element).base_mm, 2.0);
}

TEST(StudyReader, CommentsAreNoChangeButValuesAre) {
  const auto parts = [](const std::string& text) { return sweep_of(text).layout().parts; };
  const std::string text = kDesign + kParameter + kQuantity;
  EXPECT_EQ(parts(text), parts("# why\ntitle = \"a title\"\n" + text + "\n# end\n"));
  EXPECT_NE(parts(text), parts(kDesign + "[[parameter]]\nkey = \"element.base_mm\"\nvalues = [1, 3]\n" + kQuantity));
  EXPECT_NE(parts(text), parts(text + "incidence_deg = 5\n"));
  EXPECT_NE(parts(text), parts(text + "[analysis]\ntarget_error = 0.001\n"));
  EXPECT_NE(parts(text), parts("design = \"rtp_brick_2mm.toml\"\n" + kParameter + kQuantity));
}

TEST(StudyReader, WhatIsWrongIsSaidWithItsLine) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {kParameter + kQuantity, "study.toml: design"},
      {kDesign + kQuantity, "study.toml: parameter"},
      {kDesign + kParameter, "study.toml: quantity"},
      {kDesign + "parameter = 3\n", "study.toml:2: parameter"},
      {"schema = \"retrace.design/1\"\n" + kDesign, "study.toml:1: schema"},
      {kDesign + "[swep]\n", "study.toml:2: swep"},
      {with_parameter("key = \"element.bas_mm\"\nvalues = [1]\n"), "study.toml:3: parameter[1].key"},
      {with_parameter("key = \"analysis.engin\"\nvalues = [1]\n"), "study.toml:3: parameter[1].key"},
      {with_parameter("key = [\"element.base_mm\", 3]\nvalues = [1]\n"), "study.toml:3: parameter[1].key"},
      {with_parameter("values = [1]\n"), "study.toml:2: parameter[1].key"},
      {with_parameter("key = \"element.base_mm\"\n"), "study.toml:2: parameter[1].values"},
      {with_parameter("key = \"element.base_mm\"\nvalues = []\n"), "study.toml:4: parameter[1].values"},
      {with_parameter("key = \"element.base_mm\"\nvalues = [1, true]\n"), "study.toml:4: parameter[1].values"},
      {with_parameter("key = \"element.base_mm\"\nfrom = 2\nto = 1\nstep = 1\n"), "study.toml:5: parameter[1].to"},
      {with_parameter("key = \"element.base_mm\"\nfrom = 0\nto = 1\ncount = 3\nscale = \"log\"\n"),
       "study.toml:4: parameter[1].from"},
      {with_parameter("key = \"element.base_mm\"\nfrom = 0\nto = 1\nstep = 1e-9\n"), "study.toml:6: parameter[1].step"},
      {with_parameter("key = \"element.base_mm\"\nfrom = 0\nto = 1\ncount = 2.5\n"),
       "study.toml:6: parameter[1].count"},
      {with_parameter("key = \"element.base_mm\"\nfrom = 0\nto = 1\n"), "study.toml:2: parameter[1]"},
      {with_parameter("key = \"element.base_mm\"\nvalues = [1]\nfrom = 2\n"), "study.toml:5: parameter[1].from"},
      {with_parameter("key = \"element.base_mm\"\nvalues = [1]\ntypo = 2\n"), "study.toml:5: parameter[1].typo"},
      {with_parameter("key = \"element.base_mm\"\ndistribution = \"normal\"\nmean = 1\n"),
       "study.toml:2: parameter[1].sigma"},
      {with_parameter("key = \"element.base_mm\"\ndistribution = \"normal\"\nmean = 1\nsigma = -1\n"),
       "study.toml:6: parameter[1].sigma"},
      {kDesign + kParameter + kParameter + kQuantity, "study.toml:5: parameter[2]"},
      {kDesign + kParameter + kQuantity + kQuantity, "study.toml:7: quantity[2].name"},
      {with_quantity("kind = \"rree\"\n"), "study.toml:6: quantity[1].kind"},
      {with_quantity("kind = \"rre\"\nincidence_deg = 90\n"), "study.toml:7: quantity[1].incidence_deg"},
      {with_quantity("kind = \"rre\"\nincidence_deg = {from = 20, to = 10, count = 4}\n"),
       "study.toml:7: quantity[1].incidence_deg.to"},
      {with_quantity("kind = \"rre\"\nincidence_deg = {from = 10, to = 20}\n"),
       "study.toml:7: quantity[1].incidence_deg.count"},
      {with_quantity("kind = \"ledger\"\n"), "study.toml:5: quantity[1].account"},
      {with_quantity("kind = \"far_field\"\nfrom_deg = 2\nto_deg = 1\n"), "study.toml:8: quantity[1].to_deg"},
      {with_quantity("kind = \"rre\"\nname = \"1 2\"\n"), "study.toml:7: quantity[1].name"},
      {with_quantity("kind = \"elements_full\"\nincidence_deg = 3\n"), "study.toml:7: quantity[1].incidence_deg"},
      {kDesign + kParameter + kQuantity + "[analysis]\nengine = \"fast\"\n", "study.toml:8: analysis.engine"},
      {kDesign + kParameter + kQuantity + "[analysis]\nazimuth_deg = 1e300\n", "study.toml:8: analysis.azimuth_deg"},
      {kDesign + kParameter + kQuantity + "[analysis]\ntarget_error = 1e-3\nsamples = 5\n",
       "study.toml:8: analysis.target_error"},
      {kDesign + kParameter + kQuantity + "[machining]\ntool_width_mm = 0\n", "study.toml:8: machining.tool_width_mm"},
      {kDesign + kParameter + kQuantity + "[sweep]\ncombine = \"sobol\"\n", "study.toml:7: sweep.samples"},
      {kDesign + kParameter + kQuantity + "[sweep]\nsamples = 5\n", "study.toml:8: sweep.samples"},
      {kDesign + kParameter + "[[parameter]]\nkey = \"element.width_mm\"\nvalues = [1]\n" + kQuantity +
           "[sweep]\ncombine = \"zipped\"\n",
       "study.toml:5: parameter[2]"},
      {"design = \"absent.toml\"\n" + kParameter + kQuantity, "study.toml:1: design"},
      {"[[parameter]]\nkey = \"design\"\nvalues = [1]\n" + kQuantity, "study.toml:3: parameter[1].values"},
      {kDesign + "[[parameter]]\nkey = \"design\"\nvalues = [\"rtp_brick_1mm.toml\"]\n" + kQuantity,
       "study.toml:1: design"},
      {"a = \n", "study.toml:1"}};
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(message(text), expected) << text;
  }
}

/// Photometry by rays uses no cut-off. A cut-off is therefore refused unless another quantity or another engine of
/// the study uses it.
TEST(StudyReader, ACutoffThatNothingUsesIsRefused) {
  const std::string photometry =
      "[[quantity]]\nkind = \"photometry\"\nstandard = \"r150\"\nclass = \"IA\"\ncolour = \"red\"\narea_cm2 = 1\n";
  const std::string text = kDesign + kParameter + photometry;  // 10 lines
  const auto analysis = [](const std::string& engine) {
    return "[analysis]\ncutoff = 1e-4\nengine = \"" + engine + "\"\n";
  };
  for (const std::string engine : {"montecarlo", "embree"}) {
    EXPECT_EQ(message(text + analysis(engine)), "study.toml:12: analysis.cutoff");
    EXPECT_EQ(message(text + analysis(engine) + kQuantity), "") << "RRE by rays has a cut-off";
    EXPECT_EQ(message(text + "[[parameter]]\nkey = \"analysis.engine\"\nvalues = [\"exact\", \"montecarlo\"]\n" +
                      "[analysis]\ncutoff = 1e-4\n"),
              "");
    EXPECT_EQ(
        message(text + "[[parameter]]\nkey = \"analysis.cutoff\"\nvalues = [1e-4, 1e-5]\n[analysis]\nengine = \"" +
                engine + "\"\n"),
        "study.toml:11: parameter[2]");
  }
  for (const std::string engine : {"auto", "exact"}) EXPECT_EQ(message(text + analysis(engine)), "");
  EXPECT_EQ(message(text + "[analysis]\nengine = \"montecarlo\"\n"), "");
  EXPECT_EQ(message(text + "[analysis]\nengine = \"montecarlo\"\n", {"analysis.cutoff=1e-4"}),
            "--set analysis.cutoff=1e-4: analysis.cutoff");
}

TEST(StudyReader, ATargetErrorThatNothingUsesIsRefused) {
  const std::string photometry =
      "[[quantity]]\nkind = \"photometry\"\nstandard = \"r150\"\nclass = \"IA\"\ncolour = \"red\"\narea_cm2 = 1\n";
  const std::string text = kDesign + kParameter + photometry;  // 10 lines
  const std::string analysis = "[analysis]\ntarget_error = 1e-3\n";
  EXPECT_EQ(message(text + analysis), "study.toml:12: analysis.target_error");
  EXPECT_EQ(message(text, {"analysis.target_error=1e-3"}), "--set analysis.target_error=1e-3: analysis.target_error");
  EXPECT_EQ(message(text + analysis + kQuantity), "");
}

TEST(StudyReader, AnOverrideOfAVariedKeyIsRefused) {
  EXPECT_EQ(message(kDesign + kParameter + kQuantity, {"element.base_mm=3"}), "--set element.base_mm=3");
}

/// If a file that the design names has changed, a store does not match the study.
TEST(StudyReader, PlanesOfFacetsArePartOfTheStudy) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("retrace_study_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "d.toml") << "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\nx_length_mm = 2\n"
                                      "y_length_mm = 2\n[body]\nthickness_mm = 1\n[part]\nfacets = \"p.csv\"\n";
  const auto parts = [&](const std::string& planes) {
    std::ofstream(folder / "p.csv") << planes;
    return parse_study("design = \"d.toml\"\n" + kParameter + kQuantity, (folder / "study.toml").string()).parts;
  };
  const auto first = parts("one");
  EXPECT_EQ(parts("one"), first);
  EXPECT_NE(parts("another"), first);
  fs::remove_all(folder);
}

TEST(StudyReader, ReadsEveryExample) {
  int read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder + "studies")) {
    if (entry.path().extension() != ".toml") continue;
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    // Optimizations, tolerances and compositions have their own readers and tests.
    if (text.find("retrace.study/1") == std::string::npos || text.find("[optimize]") != std::string::npos ||
        text.find("[tolerance]") != std::string::npos || text.find("[compose]") != std::string::npos)
      continue;
    EXPECT_NO_THROW(read_sweep(read_study(entry.path().string(), {}))) << entry.path();
    ++read;
  }
  EXPECT_GE(read, 6);
}

}  // namespace
}  // namespace retrace::studies::study_reader_test

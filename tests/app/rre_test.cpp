#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "tests/support/refusals.h"

#include "tests/app/program.h"

namespace retrace::test::rre_test {
namespace {

namespace fs = std::filesystem;

const std::string kDesign = example("rtp_brick_2mm.toml");
const std::string kOther = example("rtp_single_0p45mm.toml");

/// Returns the arguments for oblique directions at which the result depends on the samples.
Arguments oblique(const Arguments& more) {
  Arguments arguments = {"rre", kDesign, "--incidence=-25,25", "--azimuth=30", "--samples=65536"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

TEST(Rre, WritesItsFourFilesAndTouchesNothingElse) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "result");
  folder.write("result/mine.txt", "kept");
  folder.write("result/rre.json", "old");
  folder.write("result/rre.json.bak", "kept too");
  const auto age = fs::last_write_time(folder.path() / "result/mine.txt") - std::chrono::hours(1);
  fs::last_write_time(folder.path() / "result/mine.txt", age);

  const Outcome outcome = retrace(folder, {"rre", kDesign, "--samples", "64", "--out", "result"});

  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder.names(), (Arguments{"result", "result/mine.txt", "result/rre.csv", "result/rre.json",
                                       "result/rre.json.bak", "result/rre.png", "result/rre.svg"}));
  EXPECT_EQ(folder.read("result/mine.txt"), "kept");
  EXPECT_EQ(folder.read("result/rre.json.bak"), "kept too");
  EXPECT_EQ(fs::last_write_time(folder.path() / "result/mine.txt"), age);
  EXPECT_EQ(folder.json("result/rre.json")["schema"], "retrace.rre/1");
  EXPECT_TRUE(folder.read("result/rre.png").starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_TRUE(folder.read("result/rre.svg").starts_with("<?xml"));
  EXPECT_NE(folder.read("result/rre.svg").find("</svg>"), std::string::npos);
}

TEST(Rre, MakesAnOutputFolderWithItsParents) {
  const TemporaryFolder folder;
  ASSERT_EQ(retrace(folder, {"rre", kDesign, "--samples", "64", "-o", "a/b", "--quiet"}).code, 0);
  EXPECT_EQ(folder.names(), (Arguments{"a", "a/b", "a/b/rre.csv", "a/b/rre.json", "a/b/rre.png", "a/b/rre.svg"}));
}

TEST(Rre, JsonMayGoIntoTheOutputFolderThatIsMadeForIt) {
  for (const std::string out : {"result", "result/", "./result"}) {
    const TemporaryFolder folder;
    const Outcome outcome = retrace(folder, {"rre", kDesign, "--samples=64", "-o", out, "--json", "result/copy.json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(folder.read("result/copy.json"), folder.read("result/rre.json"));
  }
}

TEST(Rre, JsonHasEveryKeyOfTheContract) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"rre", kDesign, "--samples", "4096", "--seed", "7"});
  for (const char* key : {"schema", "engine", "engine_requested", "designs", "seed", "points", "elapsed_s", "rays",
                          "version", "warnings", "complete"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["schema"], "retrace.rre/1");
  EXPECT_EQ(json["engine"], "cell");
  EXPECT_EQ(json["engine_requested"], "auto");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["rays"], 4096);
  EXPECT_EQ(json["complete"], true);
  EXPECT_TRUE(json["warnings"].is_array());
  EXPECT_GT(json["elapsed_s"].get<double>(), 0.0);
  ASSERT_EQ(json["designs"].size(), 1U);
  EXPECT_EQ(json["designs"][0]["element"]["base_mm"], 2);
  EXPECT_EQ("retrace " + json["version"].get<std::string>() + "\n", retrace(folder, {"--version"}).out);

  ASSERT_EQ(json["points"].size(), 1U);
  const Json& point = json["points"][0];
  for (const char* key : {"design", "incidence_deg", "azimuth_deg", "wavelength_nm", "rre", "std_error", "ledger"})
    EXPECT_TRUE(point.contains(key)) << key;
  EXPECT_EQ(point["wavelength_nm"], 587.56);
  Arguments accounts = keys(point["ledger"]);
  std::sort(accounts.begin(), accounts.end());
  EXPECT_EQ(accounts, (Arguments{"absorbed", "front_specular", "lost", "retroreflected", "returned_elsewhere",
                                 "scattered_out", "side_exit", "transmitted", "truncated"}));
}

TEST(Rre, LedgerAddsToOneAndHoldsRre) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, oblique({}));
  ASSERT_EQ(json["points"].size(), 2U);
  for (const Json& point : json["points"]) {
    double sum = 0.0;
    for (const Json& power : point["ledger"]) sum += power.get<double>();
    EXPECT_NEAR(sum, 1.0, 1e-6);
    EXPECT_EQ(point["ledger"]["retroreflected"], point["rre"]);
    EXPECT_GT(point["std_error"].get<double>(), 0.0);
  }
}

TEST(Rre, EngineThatWasAskedForIsNamed) {
  const TemporaryFolder folder;
  for (const char* engine : {"auto", "montecarlo", "embree"}) {
    const Json json = retrace_json(folder, {"rre", kDesign, "--samples=64", "--engine", engine});
    EXPECT_EQ(json["engine_requested"], engine);
    EXPECT_EQ(json["engine"], std::string(engine) == "embree" ? "embree" : "cell");
  }
}

// For arrays of equal elements, rays are traced without a search structure.
TEST(Rre, MonteCarloChoosesItsEngine) {
  const TemporaryFolder folder;
  const std::string endless = RETRACE_SOURCE_DIR "/examples/honeycomb_infinite.toml";
  const auto engine = [&](Arguments more) {
    more.insert(more.begin(), {"rre", "--samples=64"});
    return retrace_json(folder, more)["engine"].get<std::string>();
  };
  EXPECT_EQ(engine({endless, "--engine=montecarlo"}), "cell");
  EXPECT_EQ(engine({endless, "--engine=cell"}), "cell");
  EXPECT_EQ(engine({endless, "--engine=embree"}), "embree");
  EXPECT_EQ(engine({endless, "--engine=montecarlo", "--sampling=plain"}), "embree");
  EXPECT_EQ(engine({endless, "--engine=montecarlo", "--set=surface.roughness_sq_nm=5",
                    "--set=surface.correlation_length_um=2"}),
            "cell");
  EXPECT_EQ(engine({kDesign, "--engine=montecarlo"}), "cell");
  EXPECT_EQ(engine({kDesign, "--engine=montecarlo", "--set=surface.angle_error_sigma_arcmin=1"}), "embree");
  EXPECT_EQ(engine({endless, kOther, "--engine=montecarlo"}), "montecarlo");
}

TEST(Rre, PlainSamplingAgreesAtAHigherPrice) {
  const TemporaryFolder folder;
  const auto point = [&](const std::string& sampling) {
    return retrace_json(folder, {"rre", RETRACE_SOURCE_DIR "/examples/honeycomb_infinite.toml", "--incidence=10",
                                 "--engine=embree", "--samples=65536", "--sampling=" + sampling})["points"][0];
  };
  const Json plain = point("plain");
  const Json stratified = point("stratified");
  const double error = std::hypot(plain["std_error"].get<double>(), stratified["std_error"].get<double>());
  EXPECT_NEAR(plain["rre"].get<double>(), stratified["rre"].get<double>(), 4.0 * error);
  EXPECT_GT(plain["std_error"].get<double>(), 3.0 * stratified["std_error"].get<double>());
}

TEST(Rre, AutoIsExactWhereThatIsCheap) {
  const TemporaryFolder folder;
  const Json cheap = retrace_json(folder, {"rre", kDesign, "--incidence=0,3"});
  EXPECT_EQ(cheap["engine_requested"], "auto");
  EXPECT_EQ(cheap["engine"], "exact");
  for (const Json& point : cheap["points"]) EXPECT_LE(point["ledger"]["truncated"].get<double>(), 1e-4);
  // Beams are expensive for cube corners at oblique incidence, but not at normal incidence. `auto` selects the engine
  // for each direction separately.
  const Json dear = retrace_json(folder, {"rre", RETRACE_SOURCE_DIR "/examples/honeycomb_infinite.toml",
                                          "--incidence=0,20", "--azimuth=4", "--target-error=0.01"});
  EXPECT_EQ(dear["engine"], "mixed");
  EXPECT_EQ(dear["points"][0]["engine"], "exact");
  EXPECT_EQ(dear["points"][1]["engine"], "stochastic");
  for (const Json& point : dear["points"]) EXPECT_TRUE(point.contains("beams"));
  EXPECT_TRUE(dear["points"][0].contains("depth"));
  EXPECT_FALSE(dear["points"][1].contains("depth"));
  EXPECT_EQ(dear["complete"], true);
}

TEST(Rre, RoughFacetsAreForRaysAndBeamsThatScatterThem) {
  const TemporaryFolder folder;
  const Arguments rough = {
      "rre", kDesign, "--set", "surface.roughness_sq_nm=5", "--set", "surface.correlation_length_um=2"};
  const Json json = retrace_json(folder, rough);
  EXPECT_EQ(json["engine"], "stochastic");
  EXPECT_GT(json["points"][0]["ledger"]["scattered_out"].get<double>(), 0.0);
  Arguments exact = rough;
  exact.insert(exact.end(), {"--engine", "exact"});
  const Outcome outcome = retrace(folder, exact);
  EXPECT_EQ(refused_at(outcome), "--set surface.roughness_sq_nm=5: surface.roughness_sq_nm");
}

TEST(Rre, ExactEngineHasNoNoise) {
  const TemporaryFolder folder;
  const Arguments run = {"rre", kDesign, "--engine", "exact", "--incidence=0,3", "--json", "-"};
  const Outcome outcome = retrace(folder, run);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["engine"], "exact");
  EXPECT_EQ(json["engine_requested"], "exact");
  for (const Json& point : json["points"]) {
    EXPECT_EQ(point["std_error"], 0.0);
    EXPECT_GT(point["beams"], 0);
    EXPECT_GT(point["depth"], 0);
    EXPECT_LT(point["ledger"]["truncated"], 1e-10);
  }
  // 22 of 25 elements are complete. A partial element returns the fraction 2R/(1+R) (docs/theory/closed_forms.md, 1).
  const double r = std::pow(0.4917 / 2.4917, 2.0);
  EXPECT_NEAR(json["points"][0]["rre"].get<double>(), 0.88 + 0.12 * 2.0 * r / (1.0 + r), 1e-9);
  Arguments threads = run;
  threads.insert(threads.end(), {"--threads", "1"});
  Json other = Json::parse(retrace(folder, threads).out);
  other["elapsed_s"] = json["elapsed_s"];
  EXPECT_EQ(other, json);
}

TEST(Rre, CutoffOfTheExactEngineIsBooked) {
  const TemporaryFolder folder;
  const Outcome coarse = retrace(folder, {"rre", example("triangular_infinite.toml"), "--engine=exact",
                                          "--incidence=20", "--azimuth=3.75", "--cutoff=1e-6", "--json", "-"});
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  const Json json = Json::parse(coarse.out);
  ASSERT_EQ(json["warnings"].size(), 1U);
  record_message(json["warnings"][0].get<std::string>());
  const Json& ledger = json["points"][0]["ledger"];
  EXPECT_GT(ledger["truncated"], 1e-6);
  double sum = 0.0;
  for (const auto& [name, power] : ledger.items()) sum += power.get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST(Rre, PointsComeByDesignThenAzimuthThenIncidence) {
  const TemporaryFolder folder;
  const Json json =
      retrace_json(folder, {"rre", kDesign, kOther, "--samples=64", "--incidence=10,-10,0", "--azimuth=90,0"});
  ASSERT_EQ(json["designs"].size(), 2U);
  EXPECT_EQ(json["designs"][0]["source"], kDesign);
  EXPECT_EQ(json["designs"][1]["source"], kOther);
  ASSERT_EQ(json["points"].size(), 12U);
  std::size_t k = 0;
  for (const int design : {0, 1})
    for (const int azimuth : {90, 0})
      for (const int incidence : {10, -10, 0}) {
        const Json& point = json["points"][k++];
        EXPECT_EQ(point["design"], design);
        EXPECT_EQ(point["azimuth_deg"], azimuth);
        EXPECT_EQ(point["incidence_deg"], incidence);
      }
}

TEST(Rre, CsvHasTheKeysAndTheNumbersOfTheJson) {
  const TemporaryFolder folder;
  ASSERT_EQ(retrace(folder, oblique({"-o", "."})).code, 0);
  const Json json = folder.json("rre.json");
  const std::vector<std::string> csv = lines_of(folder.read("rre.csv"));
  ASSERT_EQ(csv.size(), json["points"].size() + 1);

  Arguments header;
  for (const std::string& key : keys(json["points"][0]))
    if (key != "ledger" && key != "stokes" && key != "engine") header.push_back(key);  // lists are not columns
  for (const std::string& key : keys(json["points"][0]["ledger"])) header.push_back(key);
  header.push_back("engine");  // the only text is the last column
  EXPECT_EQ(split(csv[0]), header);

  for (std::size_t row = 1; row < csv.size(); ++row) {
    const Json& point = json["points"][row - 1];
    const std::vector<std::string> fields = split(csv[row]);
    ASSERT_EQ(fields.size(), header.size());
    EXPECT_EQ(fields.back(), point["engine"]);
    for (std::size_t k = 0; k + 1 < fields.size(); ++k) {
      const Json& value = point.contains(header[k]) ? point[header[k]] : point["ledger"][header[k]];
      char* end = nullptr;
      EXPECT_EQ(std::strtod(fields[k].c_str(), &end), value.get<double>()) << header[k];
      EXPECT_EQ(*end, '\0') << fields[k];
    }
  }
}

TEST(Rre, JsonDashLeavesStandardOutputToTheDocument) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"rre", kDesign, "--samples=64", "--json", "-", "--out", "result"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, folder.read("result/rre.json"));
  EXPECT_EQ(outcome.err, "");
}

TEST(Rre, WithoutOutATableIsPrintedAndNothingWritten) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"rre", kDesign, "--samples=64", "--incidence=0,5"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ASSERT_EQ(lines_of(outcome.out).size(), 3U);
  EXPECT_NE(outcome.out.find("RRE_%"), std::string::npos);
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(folder.names().empty());
}

TEST(Rre, LongTablesAreSummariesIfTheyGoToAFolder) {
  const TemporaryFolder folder;
  const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n'); };
  const Arguments many = {"rre",          kDesign, "--incidence=0:20:0.5", "--azimuth=0:30:10", "--engine=montecarlo",
                          "--samples=256"};
  const Outcome printed = retrace(folder, many);
  EXPECT_EQ(printed.code, 0);
  EXPECT_GT(lines(printed.out), 4 * 41);
  Arguments written = many;
  written.insert(written.end(), {"--out", "out"});
  const Outcome summary = retrace(folder, written);
  EXPECT_EQ(summary.code, 0);
  EXPECT_LE(lines(summary.out), 30);
  EXPECT_NE(summary.out.find("out/rre.json"), std::string::npos);
  EXPECT_EQ(lines(folder.read("out/rre.csv")), 1 + 4 * 41);
}

TEST(Rre, LightOfASpectrumIsTraced) {
  const TemporaryFolder folder;
  folder.write("lamp.csv", "wavelength_nm,power\n400,0.5\n700,1\n");
  folder.write("d.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"single\"\n"
               "[body]\nthickness_mm = 1\n[light]\nspectrum = \"lamp.csv\"\n");
  for (const std::string engine : {"exact", "montecarlo"}) {
    const Outcome outcome =
        retrace(folder, {"rre", "d.toml", "--engine", engine, "--incidence=0,12", "--target-error=1e-3", "-o", "r"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = folder.json("r/rre.json");
    ASSERT_EQ(json["points"].size(), 2U);
    const Json& point = json["points"][1];
    EXPECT_EQ(point["by_wavelength"].size(), 10U);
    EXPECT_EQ(point["wavelength_nm"], json["designs"][0]["spectrum"]["centroid_nm"]);
    EXPECT_EQ(json["designs"][0]["light"]["spectrum"], "lamp.csv");
    EXPECT_EQ(lines_of(folder.read("r/rre.csv")).size(), 3U);
  }
  const Json inspected = retrace_json(folder, {"inspect", "d.toml"});
  EXPECT_EQ(inspected["spectrum"]["wavelengths_nm"].size(), 10U);
  const Outcome text = retrace(folder, {"inspect", "d.toml"});
  EXPECT_NE(text.out.find("spectrum            10 wavelengths, "), std::string::npos) << text.out;
}

TEST(Rre, SpectraGiveTheSameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const Arguments run = {"rre",    kDesign, "--set", "light.spectrum=D65", "--samples=4096", "--incidence=0,20",
                         "--json", "-"};
  Arguments one = run;
  one.insert(one.end(), {"--threads", "1"});
  Arguments two = run;
  two.insert(two.end(), {"--threads", "2"});
  const Outcome first = retrace(folder, one);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(without_elapsed(first.out), without_elapsed(retrace(folder, two).out));
}

TEST(Rre, QuietSaysNothing) {
  const TemporaryFolder folder;
  // This design causes a warning, because the wavelength is outside of the data of the material.
  folder.write("d.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"single\"\n"
               "[body]\nthickness_mm = 1\nmaterial = \"PC\"\n[light]\nwavelength_nm = 350\n");
  const Outcome loud = retrace(folder, {"rre", "d.toml", "--samples=64"});
  EXPECT_EQ(loud.code, 0);
  EXPECT_EQ(warnings_of(loud).size(), 1U) << loud.err;
  EXPECT_FALSE(loud.out.empty());
  const Outcome quiet = retrace(folder, {"rre", "d.toml", "--samples=64", "--quiet", "-o", "result"});
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "");
  EXPECT_FALSE(folder.json("result/rre.json")["warnings"].empty());
}

TEST(Rre, CommonOptionsStandBeforeOrAfterTheCommand) {
  const TemporaryFolder folder;
  const Arguments common = {"--seed", "3", "--threads", "2", "--set", "element.apex_angle_deg=91",
                            "--json", "-", "-o",        "r"};
  Arguments before = common;
  before.insert(before.end(), {"rre", kDesign, "--incidence=20", "--samples=4096"});
  Arguments after = {"rre", kDesign, "--incidence=20", "--samples=4096"};
  after.insert(after.end(), common.begin(), common.end());
  const Outcome first = retrace(folder, before);
  const Outcome second = retrace(folder, after);
  ASSERT_EQ(first.code, 0) << first.err;
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(without_elapsed(first.out), without_elapsed(second.out));
  EXPECT_EQ(Json::parse(first.out)["seed"], 3);
  EXPECT_EQ(Json::parse(first.out)["designs"][0]["element"]["apex_angle_deg"], 91);
}

TEST(Rre, SameSeedGivesTheSameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  for (const char* threads : {"1", "2", "7"})
    ASSERT_EQ(retrace(folder, oblique({"--quiet", "--threads", threads, "-o", threads})).code, 0);
  for (const std::string threads : {"2", "7"}) {
    EXPECT_EQ(without_elapsed(folder.read("1/rre.json")), without_elapsed(folder.read(threads + "/rre.json")));
    for (const std::string file : {"/rre.csv", "/rre.svg", "/rre.png"})
      EXPECT_EQ(folder.read("1" + file), folder.read(threads + file)) << file << threads;
  }
}

TEST(Rre, AnotherSeedGivesOtherNumbers) {
  const TemporaryFolder folder;
  const Json one = retrace_json(folder, oblique({"--seed=1"}));
  const Json other = retrace_json(folder, oblique({"--seed=2"}));
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NE(one["points"][k]["rre"], other["points"][k]["rre"]);
  EXPECT_EQ(one["points"], retrace_json(folder, oblique({}))["points"]) << "the default seed is 1";
}

TEST(Rre, TargetErrorIsReached) {
  const TemporaryFolder folder;
  const Json coarse =
      retrace_json(folder, {"rre", kDesign, "--engine=montecarlo", "--incidence=25", "--target-error=1e-3"});
  const Json fine =
      retrace_json(folder, {"rre", kDesign, "--engine=montecarlo", "--incidence=25", "--target-error=2e-5"});
  const Json standard = retrace_json(folder, {"rre", kDesign, "--engine=montecarlo", "--incidence=25"});
  EXPECT_LE(coarse["points"][0]["std_error"].get<double>(), 1e-3);
  EXPECT_LE(standard["points"][0]["std_error"].get<double>(), 1e-4);
  EXPECT_LE(fine["points"][0]["std_error"].get<double>(), 2e-5);
  EXPECT_GT(fine["rays"].get<double>(), coarse["rays"].get<double>());
}

TEST(Rre, SetOverridesTheFile) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"rre", kDesign, "--samples=64", "--set", "element.base_mm=1", "--set",
                                          "body.refractive_index=1.6", "--set=body.refractive_index=1.7"});
  EXPECT_EQ(json["designs"][0]["element"]["base_mm"], 1);
  EXPECT_EQ(json["designs"][0]["body"]["refractive_index"], 1.7) << "the last one wins";
}

TEST(Rre, DesignMayComeFromStandardInput) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"rre", "-", kOther, "--samples=64"}, read_text(kDesign));
  EXPECT_EQ(json["designs"][0]["source"], "-");
  Json piped = json["designs"][0];
  Json read = retrace_json(folder, {"rre", kDesign, "--samples=64"})["designs"][0];
  piped.erase("source");
  read.erase("source");
  EXPECT_EQ(piped, read);
}

TEST(Rre, SeveralAcceptanceAnglesGiveAPointEach) {
  const TemporaryFolder folder;
  const Json json =
      retrace_json(folder, {"rre", kOther, "--samples=4096", "--set", "detector.acceptance_half_angle_deg=[2, 0.5]"});
  ASSERT_EQ(json["points"].size(), 2U);
  EXPECT_EQ(json["points"][0]["acceptance_half_angle_deg"], 0.5);
  EXPECT_EQ(json["points"][1]["acceptance_half_angle_deg"], 2);
}

TEST(Rre, UnicodeTitleStaysAsItIsInTheJsonAndHarmlessOnTheTerminal) {
  const TemporaryFolder folder;
  const std::string title = "R\u00e9flecteur \u53cd\u5c04 <&> \n\x1b[31m";
  folder.write("d.toml", "title = \"R\u00e9flecteur \u53cd\u5c04 <&> \\n\\u001b[31m\"\n" +
                             read_text(kOther).substr(read_text(kOther).find("[element]")));
  const Outcome outcome = retrace(folder, {"rre", "d.toml", "d.toml", "--samples=64", "-o", "."});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
  EXPECT_EQ(folder.json("rre.json")["designs"][0]["title"], title);
  EXPECT_EQ(folder.read("rre.svg").find('\x1b'), std::string::npos);
}

TEST(Rre, EveryExampleIsTracedAndInspected) {
  const TemporaryFolder folder;
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / "examples")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const Json json = retrace_json(folder, {"rre", entry.path().string(), "--samples=64", "--incidence=0,10"});
    EXPECT_EQ(json["points"].size(), 2U) << entry.path();
    EXPECT_GT(json["points"][0]["rre"].get<double>(), 0.0) << entry.path();
    EXPECT_GT(retrace_json(folder, {"inspect", entry.path().string()})["elements_full"].get<int>(), 0) << entry.path();
  }
  EXPECT_GE(count, 9);
}

}  // namespace
}  // namespace retrace::test::rre_test

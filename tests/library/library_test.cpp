#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "retrace/design.h"
#include "retrace/drawing.h"
#include "retrace/image.h"
#include "retrace/inspect.h"
#include "retrace/job.h"
#include "retrace/metrology.h"
#include "retrace/part.h"
#include "retrace/photometry.h"
#include "retrace/ranging.h"
#include "retrace/rays.h"
#include "retrace/report.h"
#include "retrace/rre.h"
#include "retrace/running.h"
#include "retrace/study.h"
#include "retrace/verify.h"
#include "tests/app/program.h"
#include "tests/support/refusals.h"
#include "tests/support/sample_size.h"

// Tests of the library as external programs use it. They check its exported symbols, compare its results with those of
// the program, and build a small project against an installation.

namespace retrace::test::library_test {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = RETRACE_SOURCE_DIR;

/// Runs a program and returns its output.
/// \pre the exit code of the program is 0
std::string output_of(const Arguments& arguments, const fs::path& folder = fs::temp_directory_path()) {
  const Outcome outcome = Child(folder, arguments).wait();
  EXPECT_EQ(outcome.code, 0) << arguments[0] << ": " << outcome.err << outcome.out;
  return outcome.out;
}

/// Returns the document that the program prints.
std::string document(const TemporaryFolder& folder, const Arguments& arguments, int code = 0) {
  const Outcome outcome = retrace(folder, with(arguments, {"--json", "-", "--quiet"}));
  EXPECT_EQ(outcome.code, code) << outcome.err;
  return without_elapsed(outcome.out);
}

TEST(Library, ShowsItsHeadersAndNothingElse) {
  const std::string symbols = output_of({RETRACE_NM, "--dynamic", "--defined-only", "--demangle", RETRACE_LIBRARY});
  const std::regex shown(R"([0-9a-f]+ \w (?:typeinfo for |typeinfo name for |vtable for )?retrace::[A-Z]?\w+.*)");
  const std::regex of_parts(
      R"(.*retrace::(studies|raytrace|fabrication|geometry|materials|surface_models|report)::.*)");
  ASSERT_GT(lines_of(symbols).size(), 20U);
  for (const std::string& line : lines_of(symbols)) {
    EXPECT_TRUE(std::regex_match(line, shown)) << line;
    EXPECT_FALSE(std::regex_match(line, of_parts)) << line;
  }
}

TEST(Library, HeadersNeedTheStandardLibraryAlone) {
  std::vector<fs::path> headers;
  for (const char* name : {"api", "error", "field", "progress", "warning"})
    headers.push_back(kSource / "core" / (std::string(name) + ".h"));
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "library/retrace"))
    headers.push_back(entry.path());
  for (const std::string& line : lines_of(read_text(kSource / "library/CMakeLists.txt")))
    if (std::smatch found; std::regex_search(line, found, std::regex("/(requests/\\w+\\.h)\"")))
      headers.push_back(kSource / found[1].str());
  ASSERT_GE(headers.size(), 10U);
  const std::regex include(R"(\s*#\s*include\s*(.*))");
  const std::regex allowed(
      R"((<[a-z_]+>|"(retrace|requests)/\w+\.h"|"core/(api|error|field|progress|warning)\.h"|"(api|field)\.h").*)");
  for (const fs::path& header : headers) {
    std::smatch found;
    for (const std::string& line : lines_of(read_text(header)))
      if (std::regex_match(line, found, include)) {
        EXPECT_TRUE(std::regex_match(found[1].str(), allowed)) << header << ": " << line;
      }
  }
}

TEST(Library, ItsPageShowsTheExampleAsItIs) {
  const std::string page = read_text(kSource / "docs/library.md");
  for (const char* file : {"CMakeLists.txt", "curve.cpp"})
    EXPECT_NE(page.find("\n" + read_text(kSource / "examples/library" / file) + "```"), std::string::npos) << file;
}

TEST(Library, RreIsThatOfTheProgram) {
  const TemporaryFolder folder;
  const std::string file = example("honeycomb_daylight.toml");
  RreRequest request;
  request.incidence_deg = {-20, 0, 35};
  request.azimuth_deg = {0, 30};
  request.engine = "montecarlo";
  request.samples = 2048;
  request.seed = 7;
  Running running;
  running.threads = 1;
  const RreResult result = rre(Design::load(file), request, running);
  EXPECT_EQ(without_elapsed(result.json), document(folder, {"rre", file, "--incidence=-20,0,35", "--azimuth=0,30",
                                                            "--engine=montecarlo", "--samples=2048", "--seed=7"}));
  const Json points = Json::parse(result.json)["points"];
  ASSERT_EQ(result.points.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const RrePoint& point = result.points[k];
    EXPECT_EQ(point.rre, points[k]["rre"].get<double>());
    EXPECT_EQ(point.std_error, points[k]["std_error"].get<double>());
    double sum = 0.0;
    for (const auto& [account, power] : point.ledger) {
      EXPECT_EQ(power, points[k]["ledger"][account].get<double>()) << account;
      sum += power;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(Library, DesignsAreReadVariedAndQuoted) {
  const TemporaryFolder folder;
  const fs::path file = example("honeycomb_infinite.toml");
  const Design design = Design::load(file, {"body.thickness_mm=3"});
  EXPECT_EQ(Json::parse(design.json())["body"]["thickness_mm"], 3.0);
  const Design other = design.with({"body.thickness_mm=4"});
  EXPECT_EQ(Json::parse(other.json())["body"]["thickness_mm"], 4.0);
  EXPECT_EQ(Json::parse(design.json())["body"]["thickness_mm"], 3.0);
  EXPECT_EQ(Design::parse(read_text(file), file.string(), {"body.thickness_mm=3"}).json(), design.json());
}

/// Returns a request for a red part of 30 cm2 and class IA of R150.
PhotometryRequest red_r150() {
  PhotometryRequest request;
  request.standard = "r150";
  request.part_class = "IA";
  request.colour = "red";
  request.area_cm2 = 30;
  return request;
}

TEST(Library, WrongInputIsAnErrorWithItsPlace) {
  try {
    Design::parse("schema = \"retrace.design/1\"\n[element]\nkind = \"prism\"\n", "my.toml");
    FAIL() << "is no element";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file, "my.toml");
    EXPECT_EQ(error.where().line, 3);
    EXPECT_EQ(error.where().key, "element.kind");
    EXPECT_EQ(std::string(error.what()), "my.toml:3: element.kind: " + error.text());
    EXPECT_EQ(recorded_place_of(error), "my.toml:3: element.kind");
  }
  const Design design = Design::load(example("rtp_single_0p45mm.toml"));
  RreRequest wrong;
  wrong.engine = "fast";
  EXPECT_THROW(rre(design, wrong), InputError);
  wrong = {};
  wrong.incidence_deg = {90};
  EXPECT_THROW(rre(design, wrong), InputError);
  // The command line never passes these numbers to the library.
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, -1.0, 0.0, 1.0, 2.0}) {
    EXPECT_THROW(rre(design, {.target_error = bad}), InputError) << bad;
    if (bad != 0.0) {
      EXPECT_THROW(rre(design, {.engine = "exact", .cutoff = bad}), InputError) << bad;
    }
    PhotometryRequest table = red_r150();
    table.cutoff = bad;
    EXPECT_THROW(photometry(design, table), InputError) << bad;
  }
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_THROW(rre(design, {.incidence_deg = {bad}}), InputError);
    EXPECT_THROW(rre(design, {.azimuth_deg = {bad}}), InputError);
  }
  EXPECT_THROW(rre(design, {.samples = 0}), InputError);
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  EXPECT_THROW(rre(design, {.engine = "montecarlo", .samples = most}), InputError);
  EXPECT_THROW(rays(design, {.emitter = "collimated", .rays = most}), InputError);
  PhotometryRequest table = red_r150();
  table.samples = most;
  EXPECT_THROW(photometry(design, table), InputError);
  EXPECT_THROW(rre(design, {.azimuth_deg = {1e300}}), InputError);
  for (const std::array<double, 2>& span :
       std::vector<std::array<double, 2>>{{40.0, 20.0}, {20.0, 20.0}, {nan, 20.0}, {0.0, nan}})
    EXPECT_THROW(rre(design, {.incidence_spans_deg = {span}}), InputError) << span[0] << ' ' << span[1];
  EXPECT_THROW(Design(nullptr), InputError);
  EXPECT_THROW(mesh(design, {"corner", {}}), InputError);
  EXPECT_THROW(make_job(design, {}), InputError);
  EXPECT_THROW(fabricate("no_such_job.toml"), InputError);
  EXPECT_THROW(photometry(design, {}), InputError);
  EXPECT_THROW(export_solid(design, "no/such/folder/part.stl"), OutputError);
}

TEST(Library, ThreadsOfTheCallerDoNotMeet) {
  const std::vector<std::string> files = {"honeycomb_infinite.toml", "rtp_single_0p45mm.toml",
                                          "triangular_infinite.toml"};
  const auto answer = [](const std::string& file) {
    return without_elapsed(rre(Design::load(example(file)), {.incidence_deg = {0, 7, 25}, .target_error = 1e-3}).json);
  };
  std::vector<std::string> alone;
  for (const std::string& file : files) alone.push_back(answer(file));
  for (int round = 0; round < 3; ++round) {
    std::vector<std::string> together(files.size());
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < files.size(); ++k) threads.emplace_back([&, k] { together[k] = answer(files[k]); });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(together, alone);
  }
}

TEST(Library, WorkIsWatchedAndStopped) {
  class Last : public Progress {
   public:
    void at(double share) override { share_ = share; }
    double share_ = -1.0;
  };
  const Design design = Design::load(example("rtp_single_0p45mm.toml"));
  Last seen;
  EXPECT_TRUE(rre(design, {}, {&seen, nullptr, 0}).complete);
  EXPECT_EQ(seen.share_, 1.0);
  Cancellation cancellation;
  cancellation.request();
  const RreResult none = rre(design, {}, {nullptr, &cancellation, 0});
  EXPECT_FALSE(none.complete);
  EXPECT_TRUE(none.points.empty());
}

TEST(Library, PhotometryIsThatOfTheProgram) {
  const TemporaryFolder folder;
  const std::string file = example("rtp_brick_2mm.toml");
  PhotometryRequest request = red_r150();
  request.engine = "montecarlo";
  request.samples = 512;
  request.advice = false;
  const PhotometryResult result = photometry(Design::load(file), request);
  EXPECT_EQ(without_elapsed(result.json),
            document(folder,
                     {"photometry", file, "--standard=r150", "--class=IA", "--colour=red", "--area-cm2=30",
                      "--engine=montecarlo", "--samples=512", "--no-advice"},
                     result.passes ? 0 : 1));
  ASSERT_FALSE(result.points.empty());
  EXPECT_EQ(result.verdict, Json::parse(result.json)["verdict"].get<std::string>());
}

TEST(Library, MeshIsClosedAndTheSameAsTheExportedOne) {
  const TemporaryFolder folder;
  const Design design = Design::load(example("rtp_brick_5mm.toml"));
  const Mesh part = mesh(design);
  ASSERT_EQ(part.triangles.size(), part.kinds.size());
  double six_volumes_mm3 = 0.0;
  for (const auto& [a, b, c] : part.triangles) {
    const auto& p = part.vertices_mm[a];
    const auto& q = part.vertices_mm[b];
    const auto& r = part.vertices_mm[c];
    six_volumes_mm3 +=
        p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
  }
  EXPECT_NEAR(six_volumes_mm3 / 6.0, part.volume_mm3, 1e-9 * part.volume_mm3);
  export_solid(design, folder.path() / "library.stl");
  retrace(folder, {"export", example("rtp_brick_5mm.toml"), "program.stl", "--quiet"});
  EXPECT_EQ(folder.read("library.stl"), folder.read("program.stl"));
}

TEST(Library, MaterialIsThatOfTheProgram) {
  const TemporaryFolder folder;
  const std::string file = example("rtp_single_0p45mm.toml");
  MaterialRequest request;
  request.entrance_deg = 1.0;
  request.window_deg = 0.1;
  request.max_directions = 64;
  request.error = 0.2;
  fs::create_directory(folder.path() / "told");
  // Each file takes a second. Therefore, only a long run compares every format.
  std::vector<std::string> endings = {"json", "glsl"};
  if (is_long_run()) endings.emplace_back("xml");
  for (const std::string& ending : endings) {
    const std::string name = "material." + ending;
    retrace(folder, {"export", file, "told/" + name, "--entrance-deg=1", "--window-deg=0.1", "--max-directions=64",
                     "--error=0.2", "--quiet"});
    const MaterialResult result = export_material(Design::load(file), folder.path() / name, request);
    EXPECT_TRUE(result.complete);
    EXPECT_EQ(folder.read(name), folder.read("told/" + name));
  }
  EXPECT_EQ(folder.read("material.csv"), folder.read("told/material.csv"));
  EXPECT_THROW(export_material(Design::load(file), folder.path() / "material.osl", request), InputError);
  request.error = 0.0;
  EXPECT_THROW(export_material(Design::load(file), folder.path() / "other.json", request), InputError);
  Cancellation cancellation;
  cancellation.request();
  EXPECT_FALSE(
      export_material(Design::load(file), folder.path() / "other.json", {}, {nullptr, &cancellation, 0}).complete);
  EXPECT_FALSE(fs::exists(folder.path() / "other.json"));
}

TEST(Library, ADesignIsCutAndReadBack) {
  const TemporaryFolder folder;
  const std::string file = example("rtp_brick_5mm.toml");
  JobRequest request;
  request.tool_width_mm = 1;
  const Job job = make_job(Design::load(file), request);
  EXPECT_GT(job.elements, 0);
  folder.write("job.toml", job.text);
  EXPECT_EQ(job.text, output_of({RETRACE_PROGRAM, "job", file, "--tool-width-mm=1"}, folder.path()));
  const Fabrication made = fabricate(folder.path() / "job.toml");
  ASSERT_EQ(made.programs.size(), 1U);
  const NcText& program = made.programs[0];
  output_of({RETRACE_PROGRAM, "fabricate", "job.toml", "-o", "nc", "--quiet"}, folder.path());
  EXPECT_EQ(program.text, folder.read("nc/" + program.file));

  VerificationRequest asked;
  asked.job = folder.path() / "job.toml";
  asked.programs = {(folder.path() / "nc" / program.file).string()};
  asked.as_machined = folder.path() / "left.toml";
  const Verification verified = verify(asked);
  EXPECT_TRUE(verified.passes) << verified.table;
  EXPECT_EQ(verified.verdict, "pass");
  EXPECT_NO_THROW(Design::load(folder.path() / "left.toml"));

  // The verifier must find a block that cuts deeper, and must report its line.
  std::string wrong = program.text;
  const std::size_t deep = wrong.find("Z-");
  ASSERT_NE(deep, std::string::npos);
  folder.write("nc/" + program.file, wrong.insert(deep + 2, "1"));
  asked.as_machined.clear();
  const Verification found = verify(asked);
  EXPECT_FALSE(found.passes);
  ASSERT_FALSE(found.findings.empty());
  EXPECT_GT(found.findings[0].line, 0);
}

TEST(Library, WhatADesignIsIsToldAndDrawn) {
  const TemporaryFolder folder;
  const std::string file = example("rtp_brick_5mm.toml");
  const Inspection inspection = inspect(Design::load(file));
  EXPECT_EQ(inspection.json, output_of({RETRACE_PROGRAM, "inspect", file, "--json=-", "--quiet"}, folder.path()));
  EXPECT_NE(inspection.plan.svg().find("<svg"), std::string::npos);
  EXPECT_EQ(inspection.view.png().substr(1, 3), "PNG");
  EXPECT_TRUE(inspection.plan.png().empty());
  EXPECT_FALSE(Drawing());
}

TEST(Library, AStudyOfADesignInMemoryIsCarriedOut) {
  const std::string text =
      "schema = \"retrace.study/1\"\ndesign = \"mine\"\n[[parameter]]\nkey = \"element.base_mm\"\nvalues = [0.4, 0.5]\n"
      "[[quantity]]\nkind = \"entrance_area_mm2\"\n";
  const Study study{text, "study", {{"mine", read_text(example("rtp_single_0p45mm.toml"))}}};
  const StudyResult result = sweep(study);
  EXPECT_TRUE(result.complete);
  const Json points = Json::parse(result.json)["points"];
  ASSERT_EQ(points.size(), 2U);
  EXPECT_NEAR(points[1]["entrance_area_mm2"].get<double>(), 0.5 * 0.45, 1e-12);
  EXPECT_THROW(sweep({text, "study", {}}), InputError);
  EXPECT_THROW(sweep(study, {.if_exists = "ask"}), InputError);
  EXPECT_THROW(tolerance(study), InputError);
  EXPECT_THROW(optimize(study), InputError);
}

TEST(Library, SurfacesAreMeasuredFromFilesAndMemory) {
  const TemporaryFolder folder;
  const std::string file = example("facet_height_map.txt");
  const Metrology of_file = metrology(file);
  EXPECT_EQ(of_file.json, output_of({RETRACE_PROGRAM, "metrology", file, "--json=-", "--quiet"}, folder.path()));
  MetrologyRequest request;
  request.form = "none";
  EXPECT_THROW(metrology(of_file.surface, request), InputError);
  request.x_pixel_um = of_file.x_pixel_um;
  const Json again = Json::parse(metrology(of_file.surface, request).json);
  EXPECT_NEAR(again["sa_nm"].get<double>(), Json::parse(of_file.json)["sa_nm"].get<double>(), 1e-9);
}

TEST(Library, CubeCornersAreRanged) {
  const Design cube = Design::load(example("round_cube.toml"));
  RangingRequest request;
  request.cubes = example("ranging/sphere.toml");
  request.incidence_deg = {30.0};
  request.orbit_km = 5860.0;
  request.map_points = 5;
  const RangingResult array = ranging(cube, request);
  const Json point = Json::parse(array.json)["points"][0];
  ASSERT_EQ(array.points.size(), 1U);
  EXPECT_EQ(*array.points[0].mean_m2, point["annulus"]["total"]["mean_m2"].get<double>());
  EXPECT_EQ(*array.points[0].centroid_mm, point["ranges"]["centroid_mm"].get<double>());
  EXPECT_FALSE(array.points[0].range_correction_mm);
  EXPECT_TRUE(static_cast<bool>(array.map));
  request.cubes = "missing.toml";
  EXPECT_THROW(ranging(cube, request), InputError);
}

TEST(Library, PicturesAreNumbers) {
  const TemporaryFolder folder;
  const std::string file = example("rtp_brick_5mm.toml");
  DetectorRequest request;
  request.engine = "montecarlo";
  request.samples = 512;
  request.pixels = 20;
  const ImageResult result = detector(Design::load(file), request);
  EXPECT_EQ(without_elapsed(result.json),
            document(folder, {"image", file, "--detector", "--engine=montecarlo", "--samples=512", "--pixels=20"}));
  ASSERT_EQ(result.pictures.size(), 2U);
  EXPECT_EQ(result.pictures[0].name, "irradiance");
  for (const auto& [channel, values] : result.pictures[0].channels) EXPECT_EQ(values.size(), 400U) << channel;
}

/// The pictures of a series are equal to those of single requests, and its document is equal to that of the command.
TEST(Library, SeriesOfPicturesHasOneExposure) {
  const TemporaryFolder folder;
  const std::string file = example("rtp_brick_5mm.toml");
  CameraRequest request;
  request.columns = 16;
  request.rows = 12;
  request.passes = 2;
  std::vector<CameraRequest> requests(2, request);
  requests[0].observation_deg = 0.2;
  requests[1].observation_deg = 0.5;
  const Design design = Design::load(file);
  const ImageResult series = camera_series({design}, requests);
  EXPECT_EQ(without_elapsed(series.json),
            document(folder, {"image", file, "--camera", "--pixels=16x12", "--passes=2", "--observation-deg=0.2,0.5"}));
  ASSERT_EQ(series.pictures.size(), 2U);
  EXPECT_EQ(series.pictures[1].name, "camera_02");
  EXPECT_EQ(series.pictures[1].channels, camera(design, requests[1]).pictures[0].channels);
  EXPECT_TRUE(series.sheet.png().starts_with("\x89PNG"));
  EXPECT_EQ(camera_series({design, design}, {request}).pictures.size(), 2U);
  EXPECT_THROW(camera_series({design, design}, requests), InputError);
  EXPECT_THROW(camera_series({}, requests), InputError);
}

TEST(Library, OnePageHasSeveralResults) {
  const Design design = Design::load(example("rtp_single_0p45mm.toml"));
  const RreResult curve = rre(design, {.incidence_deg = {0, 10}});
  const ReportPage page = report_page({{"rre.json", curve.json}, {"rre.svg", curve.curve.svg()}}, "Mine");
  EXPECT_NE(page.html.find("<title>Mine"), std::string::npos);
  EXPECT_THROW(report_page({}), InputError);
  EXPECT_THROW(report_page({{"rre.json", "{\"schema\": \"retrace.rre/1\""}}), InputError);
}

/// A report page reads only files that the caller permits by name, or that are in a folder that the caller permits.
TEST(Library, APageReadsNamedFilesOnly) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "part.stl").string();
  export_solid(Design::load(example("rtp_single_0p45mm.toml")), file);
  const std::string document = R"({"schema": "retrace.rre/1", "points": [], "designs": [{"source": "d.toml", "part": )"
                               R"({"mesh": ")" +
                               file + R"("}, "body": {"refractive_index": 1.5}}]})";
  const ReportPage without = report_page({{"rre.json", document}});
  ASSERT_EQ(without.warnings.size(), 1U);
  EXPECT_EQ(without.warnings[0].id, "no_scene");
  for (const std::string& readable : {file, folder.path().string()})
    EXPECT_TRUE(report_page({{"rre.json", document}}, {}, {readable}).warnings.empty()) << readable;
  EXPECT_THROW(report_page({{"rre.json", document}}, {}, {file + "x"}), InputError);
}

class InstalledLibrary : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kIsSanitized) GTEST_SKIP() << "programs outside do not link the sanitizers";
    output_of({RETRACE_CMAKE, "--install", RETRACE_BUILD_DIR, "--prefix", prefix().string()});
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(prefix()))
      if (entry.path().filename() == "retrace.pc") libraries_ = entry.path().parent_path().parent_path();
    ASSERT_FALSE(libraries_.empty()) << "no retrace.pc below " << prefix();
  }
  fs::path prefix() const { return folder_.path() / "installed"; }

  TemporaryFolder folder_;
  fs::path libraries_;
};

TEST_F(InstalledLibrary, TheExampleBuildsAgainstItAndRuns) {
  const fs::path build = folder_.path() / "build";
  output_of({RETRACE_CMAKE, "-G", RETRACE_GENERATOR, "-S", (kSource / "examples/library").string(), "-B",
             build.string(), "-DCMAKE_PREFIX_PATH=" + prefix().string()});
  output_of({RETRACE_CMAKE, "--build", build.string()});
  const std::string design = (prefix() / "share/doc/retrace/examples/rtp_single_0p45mm.toml").string();
  const std::string printed = output_of({(build / "curve").string(), design});
  const RreResult expected = rre(Design::load(design), {.incidence_deg = {0, 10, 20, 30}});
  ASSERT_EQ(lines_of(printed).size(), expected.points.size());
  for (std::size_t k = 0; k < expected.points.size(); ++k)
    EXPECT_NEAR(std::stod(lines_of(printed)[k].substr(lines_of(printed)[k].find(": ") + 2)), expected.points[k].rre,
                1e-6);
  const Outcome refused = Child(folder_.path(), {(build / "curve").string(), "none.toml"}).wait();
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(lines_of(refused.err).size(), 1U) << refused.err;
}

TEST_F(InstalledLibrary, PkgConfigKnowsIt) {
  folder_.write("v.cpp",
                "#include <retrace/running.h>\n#include <iostream>\nint main() { std::cout << retrace::version(); }\n");
  const std::string build = "PKG_CONFIG_PATH='" + (libraries_ / "pkgconfig").string() +
                            "' && export PKG_CONFIG_PATH && c++ v.cpp -o v $(pkg-config --cflags --libs retrace) && "
                            "pkg-config --modversion retrace && LD_LIBRARY_PATH='" +
                            libraries_.string() + "' ./v";
  const std::string said = output_of({"/bin/sh", "-c", build}, folder_.path());
  EXPECT_EQ(said, std::string(version()) + "\n" + version());
}

}  // namespace
}  // namespace retrace::test::library_test

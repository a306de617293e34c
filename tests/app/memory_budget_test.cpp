// Tests of the memory and the time that retrace needs for many elements, and of runs that exceed the memory budget.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>

#include "tests/app/program.h"

namespace retrace::test::memory_budget_test {
namespace {

struct Measured {
  int code = 0;
  double peak_mib = 0.0;     ///< peak resident memory
  double processor_s = 0.0;  ///< CPU time of all threads
  std::string out, err;
};

/// Runs retrace and measures its memory and time. retrace is the only child process of a Python interpreter, which
/// reads the resource usage of its children.
Measured measured(const TemporaryFolder& folder, const Arguments& arguments) {
  const std::string script =
      "import resource, subprocess, sys\n"
      "run = subprocess.run(sys.argv[1:], capture_output=True, text=True)\n"
      "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
      "print(run.returncode, used.ru_maxrss / 1024, used.ru_utime + used.ru_stime)\n"
      "print(run.stdout, end='')\n"
      "print(run.stderr, end='', file=sys.stderr)\n";
  const Outcome outcome =
      Child(folder.path(), with({RETRACE_PYTHON, "-c", script, RETRACE_PROGRAM}, arguments)).wait(patient(120));
  Measured result;
  std::istringstream lines(outcome.out);
  lines >> result.code >> result.peak_mib >> result.processor_s;
  lines.ignore();
  result.out.assign(std::istreambuf_iterator<char>(lines), {});
  result.err = outcome.err;
  return result;
}

std::string array(const std::string& element, double length_mm) {
  return "[element]\n" + element + "\n[array]\nx_length_mm = " + std::to_string(length_mm) +
         "\ny_length_mm = " + std::to_string(length_mm) + "\n[body]\nthickness_mm = 2\nrefractive_index = 1.49\n";
}

/// Returns a design with hexagonal cube corners of 0.01 mm.
/// \param length_mm length of both sides of the array; 9.87 mm gives 1.5 million elements
std::string small_cubes(double length_mm) {
  return array("kind = \"hexagonal_icc\"\naperture_mm = 0.01", length_mm);
}

const std::string kInfiniteCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 2.5\n[array]\nextent = \"infinite\"\n[body]\nthickness_mm = "
    "2\nrefractive_index = 1.49\n";

// Tracing beams requires a list of all elements, but tracing rays does not. With very many elements, making this list
// takes longer than tracing the rays. The engine `auto` may need at most 1.5 times the processor time of an engine that
// traces rays.
TEST(MemoryBudget, AutoCostsNoMoreThanHalfAgainOfTheEngineThatItTakes) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", small_cubes(9.87));
  const Arguments arguments = {"rre", "cubes.toml", "--incidence=0", "--target-error=1e-3", "--json", "-", "--engine"};
  const Measured by_rays = measured(folder, with(arguments, {"montecarlo"}));
  const Measured automatic = measured(folder, with(arguments, {"auto"}));
  ASSERT_EQ(by_rays.code, 0) << by_rays.err;
  ASSERT_EQ(automatic.code, 0) << automatic.err;
  EXPECT_EQ(Json::parse(automatic.out)["engine"], Json::parse(by_rays.out)["engine"]);
  EXPECT_LE(automatic.processor_s, 1.5 * by_rays.processor_s + 0.3);
  EXPECT_LE(automatic.peak_mib, by_rays.peak_mib + 50.0);
}

TEST(MemoryBudget, MoreElementsThanItHoldsAreRefusedBeforeTheyAreListed) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", small_cubes(31.2));
  const Measured exact = measured(folder, {"rre", "cubes.toml", "--engine", "exact", "--cutoff=1e-3"});
  EXPECT_EQ(exact.code, 3);
  EXPECT_NE(exact.err.find("--memory-gib"), std::string::npos) << exact.err;
  EXPECT_LE(exact.peak_mib, 200.0);
  EXPECT_LE(exact.processor_s, 5.0);
}

// Without a cut-off, the number of beams grows without limit. Only the memory budget ends the run.
TEST(MemoryBudget, BeamsWithoutACutoffEndWithIt) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", kInfiniteCubes);
  for (const char* threads : {"1", "4"}) {
    const Measured exact = measured(folder, {"rre", "cubes.toml", "--engine", "exact", "--cutoff", "0", "--incidence",
                                             "10,20,30,40", "--memory-gib", "0.1", "--threads", threads});
    EXPECT_EQ(exact.code, 3) << threads;
    EXPECT_NE(exact.err.find("--memory-gib"), std::string::npos) << exact.err;
    EXPECT_LE(exact.peak_mib, 102.4 + 100.0) << threads;
    EXPECT_EQ(exact.out, "");
  }
}

// If beams exceed the memory budget, `auto` gives exactly the same result as `montecarlo`.
TEST(MemoryBudget, AutoGoesOnWithRaysWhereBeamsExceedIt) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", kInfiniteCubes);
  const Arguments arguments = {"rre",  "cubes.toml",   "--cutoff", "0",      "--incidence", "20",      "--target-error",
                               "2e-4", "--memory-gib", "0.02",     "--json", "-",           "--engine"};
  const Measured automatic = measured(folder, with(arguments, {"auto"}));
  const Measured by_rays = measured(folder, with(arguments, {"montecarlo"}));
  ASSERT_EQ(automatic.code, 0) << automatic.err;
  EXPECT_EQ(Json::parse(automatic.out)["points"], Json::parse(by_rays.out)["points"]);
  EXPECT_LE(automatic.peak_mib, by_rays.peak_mib + 60.0);
}

std::string study(const std::string& engine) {
  return "schema = \"retrace.study/1\"\ndesign = \"cubes.toml\"\n[[parameter]]\nkey = \"element.aperture_mm\"\nvalues "
         "= [1, 2, 3]\n[[quantity]]\nkind = \"rre\"\n[optimize]\nmaximize = \"rre\"\n[analysis]\nincidence_deg = "
         "20\ncutoff = 0\nengine = \"" +
         engine + "\"\n" + (engine == "exact" ? "" : "target_error = 1e-3\n");
}

TEST(MemoryBudget, ASearchWithoutAnAnswerBecauseOfItEndsWith3) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", kInfiniteCubes);
  folder.write("exact.toml", study("exact"));
  const Measured ended = measured(folder, {"optimize", "exact.toml", "--memory-gib", "0.02", "-o", "out"});
  EXPECT_EQ(ended.code, 3) << ended.out << ended.err;
  // An optimization that uses rays finds an optimum with the same memory budget.
  folder.write("auto.toml", study("auto"));
  const Measured found = measured(folder, {"optimize", "auto.toml", "--memory-gib", "0.02", "-o", "other"});
  EXPECT_EQ(found.code, 0) << found.err;
}

// The far field of beams with diffraction requires memory for each element. Rays require no memory for elements.
TEST(MemoryBudget, PhotometryOfAMillionElementsGoesOnWithRays) {
  const TemporaryFolder folder;
  folder.write("prisms.toml", array("kind = \"rtp\"\nbase_mm = 0.01\nwidth_mm = 0.01", 10.0));
  const Arguments arguments = {"photometry",  "prisms.toml", "--standard", "r150",    "--class", "IA",
                               "--colour",    "white",       "--area-cm2", "30",      "--light", "design",
                               "--no-advice", "--json",      "-",          "--engine"};
  const Measured automatic = measured(folder, with(arguments, {"auto", "--samples", "1024"}));
  const Measured by_rays = measured(folder, with(arguments, {"montecarlo", "--samples", "1024"}));
  EXPECT_EQ(automatic.code, 1) << automatic.err;  // without diffraction the verdict is undetermined
  EXPECT_EQ(Json::parse(automatic.out)["engine"], "embree");
  EXPECT_EQ(Json::parse(automatic.out)["points"].size(), Json::parse(by_rays.out)["points"].size());
  EXPECT_LE(automatic.peak_mib, by_rays.peak_mib + 50.0);
  EXPECT_LE(automatic.processor_s, 1.5 * by_rays.processor_s + 0.5);
  const Measured exact = measured(folder, with(arguments, {"exact"}));
  EXPECT_EQ(exact.code, 3);
  EXPECT_NE(exact.err.find("--memory-gib"), std::string::npos) << exact.err;
}

// The header of a binary STL file contains the number of its triangles. The length of the first file matches this
// number. The second file is shorter.
TEST(MemoryBudget, MeshesOfTooManyTrianglesAreRefusedBeforeTheyAreRead) {
  const TemporaryFolder folder;
  folder.write("mesh.toml", "[body]\nrefractive_index = 1.49\n[part]\nmesh = \"part.stl\"\n");
  const std::string header = std::string(80, '\0') + std::string("\x00\x2d\x31\x01", 4);  // 20 million triangles
  for (const auto bytes : {1'000'000'084U, 1'000'000'000U}) {
    folder.write("part.stl", header);
    std::filesystem::resize_file(folder.path() / "part.stl", bytes);  // a sparse file, which takes no disk space
    const Measured refused = measured(folder, {"inspect", "mesh.toml"});
    EXPECT_EQ(refused_at({refused.code, refused.out, refused.err, refused.processor_s}), "mesh.toml:4: part.mesh");
    EXPECT_LE(refused.peak_mib, 200.0);
  }
}

// If the exiting rays exceed the memory budget, retrace traces fewer rays at a time. The result of each ray stays the
// same.
TEST(MemoryBudget, RaysThatLeaveStayWithinIt) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", kInfiniteCubes);
  const auto rays = [&](const std::string& budget, const std::string& out) {
    const Measured traced = measured(folder, {"rays", "cubes.toml", "--emitter=lambertian", "--rays=20000", "--split=0",
                                              "--cutoff=1e-4", "--memory-gib", budget, "-o", out});
    EXPECT_EQ(traced.code, 0) << traced.err;
    return folder.read(out);
  };
  EXPECT_TRUE(rays("1", "one.csv") == rays("0.01", "small.csv")) << "the files differ";
}

// Without a cut-off, and with both branches of every interface followed, the paths of a ray split without end.
TEST(MemoryBudget, RaysThatSplitWithoutEndEndWith3) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", kInfiniteCubes);
  const Measured ended =
      measured(folder, {"rays", "cubes.toml", "--emitter=lambertian", "--rays=200", "--split=0", "--cutoff=0"});
  EXPECT_EQ(ended.code, 3) << ended.out;
  EXPECT_LT(ended.peak_mib, 500.0);
}

TEST(MemoryBudget, SizesOutOfRangeAreRefused) {
  const TemporaryFolder folder;
  folder.write("cubes.toml", kInfiniteCubes);
  expect_refused(folder,
                 {{{"--memory-gib", "0"}, "--memory-gib"},
                  {{"--memory-gib=-1"}, "--memory-gib"},
                  {{"--memory-gib", "1e300"}, "--memory-gib"}},
                 {"rre", "cubes.toml"});
}

}  // namespace
}  // namespace retrace::test::memory_budget_test

// Tests of `mpirun -np N retrace` with commands other than `sweep` whose work is shared by ranks. The files are the
// same as those of a single process.

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "tests/studies/sweep/mpi_run.h"
#include "tests/studies/sweep/stored_points.h"
#include "tests/support/refusals.h"

namespace retrace::test::mpi_shared_test {
namespace {

namespace fs = std::filesystem;

const std::string kBrick =
    "[element]\nkind = \"rtp\"\nbase_mm = 0.45\nwidth_mm = 0.45\n[array]\narrangement = \"offset\"\n"
    "extent = \"infinite\"\n[body]\nthickness_mm = 2\n";

/// Command that takes some seconds.
const std::string kLongRoughness =
    "roughness d.toml --sa 5,10,15,20,25,30,35,40,50,60 --correlation-length-um 5 --facets facets.csv --samples 60000";

class CommandsByMpi : public ByMpi {
 protected:
  CommandsByMpi() {
    folder_.write("d.toml", kBrick);
    folder_.write("facets.csv", "process,roughness_sa_nm,waviness_sa_nm\nmine,8,30\n");
  }

  void run(const Arguments& program, int code = 0) {
    const Outcome outcome = Child(folder_.path(), program).wait(kMpiLimit);
    EXPECT_EQ(outcome.code, code) << outcome.err;
  }
  void run_alone(const std::string& arguments) {
    run({"/bin/sh", "-c", "exec '" + std::string(RETRACE_PROGRAM) + "' " + arguments});
  }
  void expect_same_files(const std::string& a, const std::string& b, std::size_t count) {
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path() / a)) {
      const std::string name = entry.path().filename().string();
      if (name.find(".sqlite") != std::string::npos) continue;
      ++files;
      const bool is_json = name.ends_with(".json");
      const auto text = [&](const std::string& folder) {
        const std::string read = folder_.read(folder + "/" + name);
        return is_json ? without_elapsed(read) : read;
      };
      EXPECT_TRUE(text(a) == text(b)) << name;
    }
    EXPECT_EQ(files, count);
  }
  /// Expects the same files from one rank, from three ranks, and from a process without MPI.
  /// \param files number of files that the command writes, without stores
  void expect_same_by_ranks(const std::string& arguments, std::size_t files) {
    run_alone(arguments + " --quiet -o alone");
    run(on_ranks(1, arguments + " --quiet -o one"));
    run(on_ranks(3, arguments + " --quiet -o three"));
    expect_same_files("alone", "one", files);
    expect_same_files("alone", "three", files);
  }
  /// Returns the table of kLongRoughness, computed by a single process. It is computed only in the first call.
  std::string long_roughness_alone() {
    static const std::string table = [this] {
      run_alone(kLongRoughness + " --quiet -o alone");
      return folder_.read("alone/roughness.csv");
    }();
    return table;
  }
  /// Sends a signal to a rank during the computation.
  /// \return text that the job has written to standard error
  std::string outcome_without_rank(int rank, int signal, const std::string& arguments, const std::string& options) {
    Child child(folder_.path(), on_ranks(3, arguments + " --threads 1 -o out", options));
    EXPECT_TRUE(comes_about(child, [this] { return fs::exists(folder_.path() / "out"); })) << "nothing was begun";
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_TRUE(is_running(rank)) << "it was over too soon";
    EXPECT_EQ(::kill(process_of(rank), signal), 0);
    EXPECT_TRUE(ends(0)) << "rank 0 hangs";
    return child.wait(kMpiLimit).err;
  }
};

/// Returns all numbers in the warnings about lost MPI ranks: the number of the rank and, if the rank stopped
/// responding, the time in s for which it was silent. Also records the warnings for tests/messages.txt.
/// \param said text of standard error
std::vector<int> numbers_of_lost_ranks(const std::string& said) {
  Outcome outcome;
  outcome.err = said;
  std::vector<int> numbers;
  static const std::regex number("[0-9]+");
  for (const std::string& warning : warnings_of(outcome))
    for (std::sregex_iterator match(warning.begin(), warning.end(), number), last; match != last; ++match)
      numbers.push_back(std::stoi(match->str()));
  return numbers;
}

TEST_F(CommandsByMpi, RoughnessIsTheSame) {
  expect_same_by_ranks("roughness d.toml --sa 0,10,40 --correlation-length-um 5,50 --facets facets.csv --samples 4096",
                       4);
}

TEST_F(CommandsByMpi, RoughnessWarnsOfTheSame) {
  // For the larger values of Sa, the scatter model is outside of its range.
  expect_same_by_ranks(
      "roughness d.toml --sa 0,200,250 --correlation-length-um 5 --facets facets.csv --target-error 3e-2", 4);
  EXPECT_FALSE(folder_.json("three/roughness.json")["warnings"].empty());
}

TEST_F(CommandsByMpi, RoughnessGoesOnWithoutARankThatIsInterrupted) {
  const std::string said = outcome_without_rank(1, SIGTERM, kLongRoughness, "");
  EXPECT_EQ(numbers_of_lost_ranks(said), (std::vector<int>{1})) << said;
  EXPECT_EQ(folder_.read("out/roughness.csv"), long_roughness_alone());
}

TEST_F(CommandsByMpi, RoughnessGoesOnWithoutARankThatIsKilled) {
  const std::string said = outcome_without_rank(2, SIGKILL, kLongRoughness, "--enable-recovery");
  EXPECT_EQ(numbers_of_lost_ranks(said), (std::vector<int>{2, kMpiSilenceS})) << said;
  EXPECT_EQ(folder_.read("out/roughness.csv"), long_roughness_alone());
}

TEST_F(CommandsByMpi, InterruptedRoughnessKeepsWhatIsFinished) {
  const std::string said = outcome_without_rank(0, SIGTERM, kLongRoughness, "");
  EXPECT_TRUE(numbers_of_lost_ranks(said).empty()) << said;
  EXPECT_EQ(folder_.json("out/roughness.json")["complete"], false);
}

/// Study with a discrete and a continuous parameter. The limit of feasibility is inside the interval of the continuous
/// parameter.
const std::string kOptimum =
    "design = \"d.toml\"\n[[parameter]]\nkey = \"array.arrangement\"\nvalues = [\"offset\", \"aligned\"]\n"
    "[[parameter]]\nkey = \"body.thickness_mm\"\nfrom = 1\nto = 3\n[[quantity]]\nkind = \"rre\"\n"
    "[[quantity]]\nkind = \"lens_thickness_mm\"\n[[constraint]]\nquantity = \"lens_thickness_mm\"\nmax = 2.5\n"
    "[optimize]\nmaximize = \"rre\"\nscan = 9\n[analysis]\nengine = \"cell\"\nsamples = 2000\nincidence_deg = 10\n";

TEST_F(CommandsByMpi, OptimizeIsTheSame) {
  folder_.write("study.toml", kOptimum);
  expect_same_by_ranks("optimize study.toml", 8);
  // A single process can resume from a store that ranks have written, and ranks can resume from the store of a single
  // process.
  run_alone("optimize study.toml --quiet --resume -o three");
  expect_same_files("alone", "three", 8);
  const auto points = stored_points(folder_.path() / "alone/optimum.sqlite").size();
  run(on_ranks(3, "optimize study.toml --quiet --resume -o alone"));
  expect_same_files("alone", "three", 8);
  EXPECT_EQ(stored_points(folder_.path() / "alone/optimum.sqlite").size(), points);
}

TEST_F(CommandsByMpi, NoIsTheAnswerIfNoDesignIsFeasible) {
  std::string study = kOptimum;
  folder_.write("study.toml", study.replace(study.find("max = 2.5"), 9, "max = 0.5"));
  const Outcome outcome = Child(folder_.path(), on_ranks(3, "optimize study.toml -o out --quiet")).wait(kMpiLimit);
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  const std::string reason = folder_.json("out/optimum.json").at("infeasible");
  EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
  record_message(reason);
}

TEST_F(CommandsByMpi, CameraIsTheSame) {
  expect_same_by_ranks("image d.toml --camera --pixels 24x18 --passes 7 --ambient-lx 1 --false-colour", 4);
}

TEST_F(CommandsByMpi, SeriesOfPicturesIsTheSame) {
  expect_same_by_ranks("image d.toml --camera --pixels 16x12 --passes 2 --v-deg 0,5", 6);
}

TEST_F(CommandsByMpi, CameraThatLooksAtItsNoiseIsTheSame) {
  // The ranks may compute more passes than the requested noise requires. The additional passes must not change the
  // picture.
  expect_same_by_ranks("image d.toml --camera --pixels 24x18 --film-mm 5x5 --noise 0.2", 3);
}

TEST_F(CommandsByMpi, CameraGoesOnWithoutARankThatIsInterrupted) {
  const std::string camera = "image d.toml --camera --pixels 40x30 --passes 400";
  const std::string said = outcome_without_rank(1, SIGTERM, camera, "");
  EXPECT_EQ(numbers_of_lost_ranks(said), (std::vector<int>{1})) << said;
  run_alone(camera + " --quiet -o alone");
  EXPECT_TRUE(folder_.read("out/camera.exr") == folder_.read("alone/camera.exr"));
}

TEST_F(CommandsByMpi, WhatIsWrongIsSaidOnce) {
  folder_.write("study.toml", "design = 3\n");
  for (const std::string arguments :
       {"roughness d.toml --sa=-1", "optimize study.toml", "image d.toml --camera --noise=-1"}) {
    const Outcome outcome = Child(folder_.path(), on_ranks(3, arguments + " -o out")).wait(kMpiLimit);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(refusals_in(outcome), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "out")) << arguments;
  }
}

}  // namespace
}  // namespace retrace::test::mpi_shared_test

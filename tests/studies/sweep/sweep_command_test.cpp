// Tests of the command `retrace sweep`: killed and interrupted runs, several processes, and a full disk.

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <random>
#include <thread>

#include "tests/app/program.h"
#include "tests/studies/sweep/stored_points.h"
#include "tests/support/refusals.h"

namespace retrace::test::sweep_command_test {
namespace {

namespace fs = std::filesystem;

Arguments sweep_arguments(const std::string& folder, bool resume) {
  Arguments arguments = {RETRACE_PROGRAM, "sweep", "study.toml", "-o", folder, "--quiet"};
  if (resume) arguments.push_back("--resume");
  return arguments;
}

std::string whole_run(const TemporaryFolder& folder) {
  const Outcome outcome = Child(folder.path(), sweep_arguments("whole", false)).wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return folder.read("whole/sweep.csv");
}

TEST(SweepCommand, TwentyKillsLoseNoPointAndRepeatNone) {
  constexpr int points = 240;
  constexpr int kills = 20;
  const TemporaryFolder folder;
  folder.write("study.toml", sweep_study(points));
  const std::string expected = whole_run(folder);
  std::mt19937 random(20);
  std::map<int, double> before;
  int kills_at_work = 0;
  for (int kill = 0; kill < kills; ++kill) {
    {
      const Child child(folder.path(), sweep_arguments("killed", true));
      // The run is killed at a random time after some points are stored. The test does not depend on the speed of the
      // computer.
      const std::size_t goal = before.size() + random() % 8;
      const auto deadline = std::chrono::steady_clock::now() + patient(60);
      while (stored_points(folder.path() / "killed/sweep.sqlite").size() < goal &&
             std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
    }  // the destructor kills the child with SIGKILL
    const std::map<int, double> after = stored_points(folder.path() / "killed/sweep.sqlite");
    for (const auto& [point, elapsed_s] : before) {
      ASSERT_TRUE(after.contains(point)) << "lost by kill " << kill;
      ASSERT_EQ(after.at(point), elapsed_s) << "computed again by run " << kill;
    }
    kills_at_work += after.size() < points ? 1 : 0;
    before = after;
  }
  EXPECT_GE(kills_at_work, 10) << "kills must hit runs that work";
  const Outcome outcome = Child(folder.path(), sweep_arguments("killed", true)).wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(folder.read("killed/sweep.csv"), expected);
  for (const auto& [point, elapsed_s] : stored_points(folder.path() / "killed/sweep.sqlite"))
    EXPECT_TRUE(!before.contains(point) || elapsed_s == before.at(point)) << point;
}

TEST(SweepCommand, TwoProcessesShareOneStore) {
  constexpr int points = 120;
  const TemporaryFolder folder;
  folder.write("study.toml", sweep_study(points));
  const std::string expected = whole_run(folder);
  Child first(folder.path(), sweep_arguments("shared", true));
  Child second(folder.path(), sweep_arguments("shared", true));
  for (Child* child : {&first, &second}) {
    const Outcome outcome = child->wait(patient(120));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(folder.read("shared/sweep.csv"), expected);
  EXPECT_EQ(stored_points(folder.path() / "shared/sweep.sqlite").size(), static_cast<std::size_t>(points));
  SQLite::Database database((folder.path() / "shared/sweep.sqlite").string(), SQLite::OPEN_READWRITE);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(database.execAndGet("SELECT count(*) FROM claims").getInt(), 0);
}

class Interrupted : public ::testing::TestWithParam<int> {};

TEST_P(Interrupted, RunIsValidAndGoesOn) {
  const TemporaryFolder folder;
  folder.write("study.toml", sweep_study(400));
  Child child(folder.path(), sweep_arguments("out", false));
  const auto deadline = std::chrono::steady_clock::now() + patient(60);
  while (stored_points(folder.path() / "out/sweep.sqlite").size() < 5) {
    ASSERT_FALSE(child.has_ended()) << "it was over too soon";
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "no points were stored";
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  child.interrupt(GetParam());
  const Outcome outcome = child.wait(patient(60));
  EXPECT_EQ(outcome.code, 130);
  const Json json = folder.json("out/sweep.json");
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["points_in_all"], 400);
  EXPECT_GE(json["points"].size(), 5U);
  EXPECT_LT(json["points"].size(), 400U);
}

INSTANTIATE_TEST_SUITE_P(SweepCommand, Interrupted, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(SweepCommand, AHangUpThatIsIgnoredStaysIgnored) {
  const TemporaryFolder folder;
  folder.write("study.toml", sweep_study(40));
  Child child(
      folder.path(),
      {"/bin/sh", "-c", std::string("trap '' HUP; exec '") + RETRACE_PROGRAM + "' sweep study.toml -o out --quiet"});
  const auto deadline = std::chrono::steady_clock::now() + patient(60);
  while (!child.has_ended() && stored_points(folder.path() / "out/sweep.sqlite").empty() &&
         std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  child.interrupt(SIGHUP);
  EXPECT_EQ(child.wait(patient(60)).code, 0);
  EXPECT_EQ(folder.json("out/sweep.json")["complete"], true);
}

/// A command, a study for it, the name of its store, and SQL statements each of which damages the store.
struct Damage {
  std::string command;
  std::string study;
  std::string store;
  std::vector<std::string> changes;
};

TEST(StudyCommands, RefuseDamagedStoresAndWriteNothing) {
  const std::string design = "design = \"" + example("rtp_brick_1mm.toml") + "\"\n";
  const std::string sizes = design +
                            "[[parameter]]\nkey = \"element.base_mm\"\nname = \"b\"\nvalues = [0.5, 1, 2]\n"
                            "[[quantity]]\nkind = \"lens_thickness_mm\"\n";
  const std::string negative = "UPDATE points SET point = -1 WHERE point = 1";
  const std::string beyond = "UPDATE points SET point = 99 WHERE point = 1";
  const std::string value = "UPDATE points SET b = 0.75 WHERE point = 1";
  for (const Damage& damage :
       {Damage{"sweep", sizes, "sweep.sqlite", {negative, beyond, value}},
        Damage{"tolerance",
               design +
                   "[[parameter]]\nkey = \"body.thickness_mm\"\nname = \"b\"\ndistribution = \"uniform\"\nfrom = 1\n"
                   "to = 3\n[[quantity]]\nkind = \"lens_thickness_mm\"\n[tolerance]\nsamples = 8\nindices = \"none\"\n",
               "tolerance.sqlite",
               {negative, beyond, value}},
        Damage{
            "optimize", sizes + "[optimize]\nmaximize = \"lens_thickness_mm\"\n", "optimum.sqlite", {negative, value}},
        Damage{"compose",
               "design = \"" + example("honeycomb_infinite.toml") +
                   "\"\n[[parameter]]\nkey = \"element.cant_deg\"\nname = \"b\"\nvalues = [0, 5, 10]\n[[quantity]]\n"
                   "kind = \"rre\"\nname = \"g\"\n[analysis]\nengine = \"exact\"\ncutoff = 1e-2\n[compose]\n"
                   "maximize = \"g\"\n",
               "composition.sqlite",
               {negative, value}}}) {
    SCOPED_TRACE(damage.command);
    const TemporaryFolder folder;
    folder.write("study.toml", damage.study);
    const Arguments run = {damage.command, "study.toml", "-o", "out", "--quiet"};
    ASSERT_EQ(retrace(folder, run).code, 0);
    const std::string store = "out/" + damage.store;
    const std::string whole = folder.read(store);
    fs::remove(folder.path() / (store + "-lock"));
    const std::vector<std::string> names = folder.names();
    const auto expect_store_refused = [&] {
      const std::string damaged = folder.read(store);
      const Arguments resume = with(with({RETRACE_PROGRAM}, run), {"--resume"});
      EXPECT_EQ(refused_at(Child(folder.path(), resume).wait(patient(30))), store);
      EXPECT_EQ(folder.names(), names);
      EXPECT_EQ(folder.read(store), damaged);
    };
    for (const std::string& change : damage.changes) {
      SCOPED_TRACE(change);
      folder.write(store, whole);
      SQLite::Database((folder.path() / store).string(), SQLite::OPEN_READWRITE).exec(change);
      expect_store_refused();
    }
    for (const int percent : {50, 80, 85, 90, 95}) {
      SCOPED_TRACE(percent);
      folder.write(store, whole.substr(0, whole.size() * static_cast<std::size_t>(percent) / 100));
      expect_store_refused();
    }
  }
}

// A lack of memory is temporary. It must not be stored as the result of a point, and it must not abort the program.
TEST(SweepCommand, ALackOfMemoryEndsTheRunAndStoresNothing) {
  if (kIsSanitized) GTEST_SKIP() << "sanitizers reserve far more address space than a limit would allow";
  const TemporaryFolder folder;
  folder.write("study.toml", "design = \"" + example("honeycomb_infinite.toml") +
                                 "\"\n[[parameter]]\nkey = \"analysis.incidence_deg\"\nvalues = [0, 10, 20]\n"
                                 "[[quantity]]\nkind = \"rre\"\n[analysis]\nengine = \"embree\"\nsamples = 1000\n");
  const std::string expected = whole_run(folder);
  const auto limited = [&](const std::string& kilobytes, const std::string& arguments) {
    return Child(folder.path(),
                 {"/bin/sh", "-c",
                  "ulimit -c 0; ulimit -v " + kilobytes + "; exec '" + RETRACE_PROGRAM + "' " + arguments})
        .wait(patient(60));
  };
  int starts = 0;
  int lacks = 0;
  for (int kilobytes = 60'000; kilobytes < 2'000'000; kilobytes += kilobytes / 32) {
    SCOPED_TRACE(kilobytes);
    // If the memory limit is too low, the system cannot even load the program.
    if (limited(std::to_string(kilobytes), "--version").code != 0) continue;
    ++starts;
    const Outcome outcome = limited(std::to_string(kilobytes), "sweep study.toml -o out --resume --quiet");
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 3) << outcome.code << ' ' << outcome.err;
    lacks += outcome.code == 3 ? 1 : 0;
    const fs::path store = folder.path() / "out/sweep.sqlite";
    if (!stored_points(store).empty()) {
      SQLite::Database database(store.string(), SQLite::OPEN_READWRITE);
      EXPECT_EQ(database.execAndGet("SELECT count(*) FROM points WHERE failed").getInt(), 0) << outcome.err;
    }
    if (outcome.code == 0) break;
  }
  EXPECT_GT(starts, 0);
  EXPECT_GT(lacks, 0) << "no limit was tight enough";
  const Outcome resumed = Child(folder.path(), sweep_arguments("out", true)).wait(patient(60));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(folder.read("out/sweep.csv"), expected);
}

TEST(SweepCommand, AnExistingStoreNeedsAWord) {
  const TemporaryFolder folder;
  folder.write("study.toml", sweep_study(4, 1000));
  const auto run = [&](const Arguments& more) {
    Arguments arguments = {"sweep", "study.toml", "-o", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return retrace(folder, arguments);
  };
  EXPECT_EQ(run({}).code, 0);
  const Outcome again = run({});
  EXPECT_EQ(refused_at(again), "out/sweep.sqlite");
  EXPECT_EQ(run({"--resume"}).code, 0);
  EXPECT_EQ(run({"--resume", "--overwrite"}).code, 2);
  folder.write("study.toml", sweep_study(5, 1000));
  const Outcome changed = run({"--resume"});
  EXPECT_EQ(refused_at(changed), "study.toml");
  EXPECT_EQ(folder.json("out/sweep.json")["points"].size(), 4U) << "nothing written";
  EXPECT_EQ(run({"--overwrite"}).code, 0);
  EXPECT_EQ(folder.json("out/sweep.json")["points"].size(), 5U);
  EXPECT_EQ(run({"--resume", "--seed", "2"}).code, 2);
  const Outcome without = retrace(folder, {"sweep", "study.toml", "--resume"});
  EXPECT_EQ(refused_at(without), "--resume");
}

TEST(SweepCommand, AFullDiskLosesNothing) {
  const TemporaryFolder folder;
  folder.write("study.toml", sweep_study(300, 1000));
  const std::string expected = whole_run(folder);
  // A limit on the size of files simulates a full disk. It is 256 blocks of 512 or 1024 bytes, a few times the size of
  // an empty store.
  const Outcome outcome = Child(folder.path(), {"/bin/sh", "-c",
                                                std::string("trap '' XFSZ; ulimit -f 256; exec '") + RETRACE_PROGRAM +
                                                    "' sweep study.toml -o full --quiet"})
                              .wait();
  EXPECT_EQ(refused_at(outcome, 3), "full/sweep.sqlite");
  const std::size_t kept = stored_points(folder.path() / "full/sweep.sqlite").size();
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, 300U);
  const Outcome resumed = Child(folder.path(), sweep_arguments("full", true)).wait();
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(folder.read("full/sweep.csv"), expected);
}

TEST(SweepCommand, WithoutAFolderATableIsPrintedAndNothingWritten) {
  const TemporaryFolder folder;
  const Outcome outcome = retrace(folder, {"sweep", example("studies/table1.toml")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(lines_of(outcome.out).size(), 6U) << outcome.out;
  EXPECT_TRUE(folder.names().empty());
}

TEST(SweepCommand, ItsDocumentHasWhatScriptsCountOn) {
  const TemporaryFolder folder;
  const Json json = retrace_json(folder, {"sweep", example("studies/table1.toml"), "--quiet"});
  EXPECT_EQ(json["schema"], "retrace.sweep/1");
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["failed"], 0);
  ASSERT_EQ(json["points"].size(), 5U);
  EXPECT_EQ(json["points"][3]["size_mm"], 1.0);
  EXPECT_NEAR(json["points"][3]["rre"].get<double>(), 0.953748, 1e-6);
  for (const char* key : {"version", "warnings", "elapsed_s", "seed"}) EXPECT_TRUE(json.contains(key)) << key;
}

TEST(OptimizeCommand, ChoosesResumesAndSaysNo) {
  const TemporaryFolder folder;
  const auto study = [](const std::string& most_mm) {
    return "design = \"" + example("rtp_brick_1mm.toml") +
           "\"\n[[parameter]]\nkey = \"element.base_mm\"\nvalues = [0.5, 1, 2]\n[[quantity]]\nkind = \"rre\"\n"
           "[[quantity]]\nkind = \"lens_thickness_mm\"\n[[constraint]]\nquantity = \"lens_thickness_mm\"\nmax = " +
           most_mm + "\n[optimize]\nmaximize = \"rre\"\n";
  };
  folder.write("study.toml", study("2.6"));
  const Json json = retrace_json(folder, {"optimize", "study.toml", "-o", "out", "--quiet"});
  EXPECT_EQ(json["schema"], "retrace.optimum/1");
  EXPECT_EQ(json["best"]["element.base_mm"], 0.5);
  for (const char* key : {"pareto", "rejected", "bands", "version", "warnings", "complete"})
    EXPECT_TRUE(json.contains(key)) << key;
  const Outcome again = retrace(folder, {"optimize", "study.toml", "-o", "out"});
  EXPECT_EQ(refused_at(again), "out/optimum.sqlite");
  EXPECT_EQ(without_elapsed(retrace(folder, {"optimize", "study.toml", "-o", "out", "--resume", "--json", "-"}).out),
            without_elapsed(folder.read("out/optimum.json")));
  folder.write("none.toml", study("2"));
  const Outcome none = retrace(folder, {"optimize", "none.toml"});
  EXPECT_EQ(none.code, 1) << none.err;
  record_message(none.out.substr(0, none.out.find('\n')));
}

TEST(SweepCommand, NoIsTheAnswerIfEveryPointFailed) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& values, const Arguments& more = {}) {
    folder.write("study.toml", "design = \"" + example("honeycomb_infinite.toml") +
                                   "\"\n[[parameter]]\nkey = \"body.thickness_mm\"\nvalues = " + values +
                                   "\n[[quantity]]\nkind = \"rre\"\n[analysis]\nengine = \"cell\"\nsamples = 1000\n");
    Arguments arguments = {"sweep", "study.toml", "-o", "out", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return retrace(folder, arguments);
  };
  const Outcome all = run("[-1, -2]");
  EXPECT_EQ(refused_at(all, 1), "");
  EXPECT_EQ(folder.json("out/sweep.json")["failed"], 2) << "and the files say why";
  const Outcome again = run("[-1, -2]", {"--resume"});
  EXPECT_EQ(again.code, 1) << "they are not tried again";
  EXPECT_EQ(again.err, all.err);
  const Outcome one = run("[-1, 2]", {"--overwrite"});
  EXPECT_EQ(one.code, 0);
  EXPECT_EQ(one.err, "");
}

// Files that a study names are part of the study. If such a file has changed, it is a different study, even if a
// parameter names the file.
TEST(SweepCommand, FilesThatParametersNameBelongToTheStudy) {
  const TemporaryFolder folder;
  const std::string map = read_text(example("facet_height_map.txt"));
  folder.write("a.txt", map);
  folder.write("b.txt", map);
  folder.write("design.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nx_length_mm = 1\ny_length_mm = 1\n"
               "[body]\nthickness_mm = 1\nrefractive_index = 1.49\n[surface]\nmodel = \"height_map\"\n");
  folder.write(
      "study.toml",
      "design = \"design.toml\"\n[[parameter]]\nkey = \"surface.height_map\"\nvalues = [\"a.txt\", \"b.txt\"]\n"
      "[[quantity]]\nkind = \"rre\"\n[analysis]\nsamples = 64\n");
  const auto run = [&](const std::string& how) {
    return retrace(folder, {"sweep", "study.toml", "-o", "out", "--quiet", how});
  };
  EXPECT_EQ(run("--resume").code, 0);
  EXPECT_EQ(run("--resume").code, 0);
  folder.write("b.txt", map + "\n");
  const Outcome changed = run("--resume");
  EXPECT_EQ(changed.code, 2);
  EXPECT_EQ(refused_at(changed), "study.toml");
}

TEST(SweepCommand, TheSameBytesAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  folder.write("study.toml", sweep_study(12, 5000));
  const auto document = [&](const std::string& threads) {
    return without_elapsed(retrace(folder, {"sweep", "study.toml", "--json", "-", "--threads", threads}).out);
  };
  EXPECT_EQ(document("1"), document("3"));
}

}  // namespace
}  // namespace retrace::test::sweep_command_test

#include "compute/store/store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "core/error.h"
#include "tests/support/refusals.h"

namespace retrace::compute::store_test {
namespace {

namespace fs = std::filesystem;

class Store : public ::testing::Test {
 protected:
  Store() {
    std::string name = (fs::temp_directory_path() / "retrace_store_XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~Store() override { fs::remove_all(folder_); }

  fs::path file() const { return folder_ / "s.sqlite"; }
  static StoreLayout layout() {
    return {"retrace.sweep/1", "study.toml", {{"parameter", "a"}}, {"x", "word"}, {"rre"}};
  }
  static StoredPoint point(std::uint64_t number) {
    StoredPoint p;
    p.point = number;
    p.inputs = {0.1 * static_cast<double>(number), "it's, \"odd\""};
    p.outputs = {{1.0 / 3.0, 1e-9}};
    p.elapsed_s = 0.25;
    p.version = "0.1.0";
    return p;
  }
  std::string message(const StoreLayout& layout, IfExists if_exists) const {
    return refusal_of([&] { const ResultStore store(file(), layout, if_exists); });
  }
  /// Returns the position that the error contains if the store is refused. The tests use this function for stores with
  /// random damage, because their messages come from SQLite and are not recorded.
  std::string unrecorded_message(const StoreLayout& layout, IfExists if_exists) const {
    return unrecorded_refusal_of([&] { const ResultStore store(file(), layout, if_exists); });
  }

  fs::path folder_;
};

TEST_F(Store, PointsComeBackAsTheyWere) {
  {
    ResultStore store(file(), layout(), IfExists::refuse);
    store.record(point(7));
    StoredPoint failed = point(3);
    failed.failed = true;
    failed.reason = "design.toml: no";
    failed.outputs.clear();
    store.record(failed);
    StoredPoint without = point(9);
    without.outputs = {{std::nullopt, 0.0}};
    store.record(without);
  }
  const ResultStore store(file(), layout(), IfExists::resume);
  EXPECT_EQ(store.finished(), (std::vector<std::uint64_t>{3, 7, 9}));
  const std::vector<StoredPoint> points = store.points();
  ASSERT_EQ(points.size(), 3U);
  EXPECT_TRUE(points[0].failed);
  EXPECT_EQ(points[0].reason, "design.toml: no");
  EXPECT_EQ(points[1].inputs, point(7).inputs);
  EXPECT_EQ(points[1].outputs[0].value, 1.0 / 3.0);
  EXPECT_EQ(points[1].outputs[0].std_error, 1e-9);
  EXPECT_EQ(points[1].elapsed_s, 0.25);
  EXPECT_EQ(points[1].version, "0.1.0");
  EXPECT_FALSE(points[2].outputs[0].value.has_value());
}

TEST_F(Store, TheFirstResultOfAPointStays) {
  ResultStore store(file(), layout(), IfExists::refuse);
  store.record(point(1));
  StoredPoint other = point(1);
  other.outputs[0].value = 2.0;
  store.record(other);
  EXPECT_EQ(store.points().at(0).outputs[0].value, 1.0 / 3.0);
}

TEST_F(Store, TwoProcessesNeverTakeOnePoint) {
  // A lock belongs to an open file. Two stores in one process therefore act like two processes.
  ResultStore first(file(), layout(), IfExists::refuse);
  {
    ResultStore second(file(), layout(), IfExists::resume);
    EXPECT_TRUE(first.claim(1));
    EXPECT_FALSE(second.claim(1));
    EXPECT_TRUE(second.claim(2));
    EXPECT_FALSE(first.claim(2));
    EXPECT_EQ(first.claimed_by_others(), 1U);
    EXPECT_EQ(second.claimed_by_others(), 1U);
    first.record(point(1));
    EXPECT_FALSE(second.claim(1)) << "finished";
    second.give_up(2);
    EXPECT_TRUE(first.claim(2));
    EXPECT_TRUE(second.claim(3));
  }
  EXPECT_FALSE(first.claim(3)) << "claimed by who died";
  EXPECT_EQ(first.claimed_by_others(), 0U);
  EXPECT_TRUE(first.claim(3));
}

TEST_F(Store, ClaimsOfADeadProcessAreVoidForItsSuccessor) {
  {
    ResultStore died(file(), layout(), IfExists::refuse);
    EXPECT_TRUE(died.claim(5));
  }
  ResultStore next(file(), layout(), IfExists::resume);
  EXPECT_TRUE(next.claim(5));
}

TEST_F(Store, ManyThreadsOfTwoProcessesShareThePoints) {
  constexpr std::uint64_t count = 200;
  ResultStore first(file(), layout(), IfExists::refuse);
  ResultStore second(file(), layout(), IfExists::resume);
  std::atomic<int> taken{0};
  const auto work = [&](ResultStore& store) {
    for (std::uint64_t k = 0; k < count; ++k)
      if (store.claim(k)) {
        ++taken;
        store.record(point(k));
      }
  };
  std::vector<std::thread> threads;
  for (ResultStore* store : {&first, &second, &first, &second}) threads.emplace_back([&work, store] { work(*store); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(taken, static_cast<int>(count));
  EXPECT_EQ(first.finished().size(), count);
  SQLite::Database database(file().string(), SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
}

TEST_F(Store, WhatIsNoStoreOfThisStudyIsRefused) {
  {
    ResultStore store(file(), layout(), IfExists::refuse);
    store.record(point(0));
  }
  EXPECT_EQ(message(layout(), IfExists::refuse), "TMP/s.sqlite");
  EXPECT_EQ(message(layout(), IfExists::resume), "");
  StoreLayout changed = layout();
  changed.parts[0].second = "b";
  EXPECT_EQ(message(changed, IfExists::resume), "study.toml");
  StoreLayout other = layout();
  other.kind = "retrace.optimum/1";
  EXPECT_EQ(message(other, IfExists::resume), "TMP/s.sqlite");
  EXPECT_EQ(message(changed, IfExists::overwrite), "");
  EXPECT_EQ(message(changed, IfExists::resume), "");
}

/// A store in which no point has succeeded is replaced by the next run, unless another process uses the store.
TEST_F(Store, AStoreWithoutResultsIsReplaced) {
  StoredPoint failed = point(3);
  failed.failed = true;
  failed.reason = "a wrong key";
  failed.outputs.clear();
  { ResultStore(file(), layout(), IfExists::refuse).record(failed); }
  StoreLayout changed = layout();
  changed.parts[0].second = "b";
  {
    ResultStore store(file(), changed, IfExists::refuse);
    EXPECT_TRUE(store.finished().empty());
    store.record(failed);
    store.record(point(1));
  }
  EXPECT_EQ(message(changed, IfExists::refuse), "TMP/s.sqlite");
  EXPECT_EQ(ResultStore(file(), changed, IfExists::resume).finished().size(), 2U);
}

TEST_F(Store, ANewerFormatIsSaidToBeOne) {
  { const ResultStore store(file(), layout(), IfExists::refuse); }
  {
    SQLite::Database database(file().string(), SQLite::OPEN_READWRITE);
    database.exec("PRAGMA user_version = 99");
  }
  EXPECT_EQ(message(layout(), IfExists::resume), "TMP/s.sqlite");
}

TEST_F(Store, OtherFilesAreNoStores) {
  std::ofstream(file()) << "a text that is long enough to be looked at as a database, and is none";
  EXPECT_EQ(message(layout(), IfExists::resume), "TMP/s.sqlite");
  fs::remove(file());
  {
    SQLite::Database database(file().string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec("CREATE TABLE t (a)");
  }
  EXPECT_EQ(message(layout(), IfExists::resume), "TMP/s.sqlite");
}

/// Fixture with a store that the tests damage in several ways.
class DamagedStore : public Store {
 protected:
  static constexpr std::uint64_t kPoints = 400;

  DamagedStore() {
    ResultStore store(file(), layout(), IfExists::refuse);
    for (std::uint64_t k = 0; k < kPoints; ++k) store.record(k == 5 ? failed(k) : point(k));
  }

  static StoreLayout layout() {
    StoreLayout layout = Store::layout();
    layout.fault_of = [](const StoredPoint& p) -> std::string {
      return p.point < kPoints && p.inputs == point(p.point).inputs ? "" : "not of this study";
    };
    return layout;
  }
  static StoredPoint failed(std::uint64_t number) {
    StoredPoint p = point(number);
    p.failed = true;
    p.reason = "no";
    p.outputs.clear();
    return p;
  }

  std::string bytes() const {
    std::ostringstream text;
    text << std::ifstream(file(), std::ios::binary).rdbuf();
    return text.str();
  }
  void write(const std::string& content) const { std::ofstream(file(), std::ios::binary) << content; }

  /// Returns the contents of all files of the folder, by file name.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      std::ostringstream text;
      text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      files[entry.path().filename()] = text.str();
    }
    return files;
  }

  /// Expects that the store is refused, that the message names the store and the remedy, and that nothing is
  /// written.
  void expect_refused(const std::string& what) const {
    fs::remove(file().string() + "-lock");
    const auto before = files();
    EXPECT_EQ(unrecorded_message(layout(), IfExists::resume), "TMP/s.sqlite") << what;
    EXPECT_TRUE(files() == before) << what << ": something was written";
  }
};

TEST_F(DamagedStore, IsRefusedWhateverWasChangedInItsTables) {
  const std::string whole = bytes();
  ASSERT_EQ(message(layout(), IfExists::resume), "");
  for (const std::string change : {"UPDATE points SET point = -1 WHERE point = 1",
                                   "UPDATE points SET point = 9999 WHERE point = 1",
                                   "UPDATE points SET x = x + 0.1 WHERE point = 7",
                                   "UPDATE points SET x = NULL WHERE point = 7",
                                   "UPDATE points SET x = 'text' WHERE point = 7",
                                   "UPDATE points SET word = 3 WHERE point = 7",
                                   "UPDATE points SET word = x'00ff' WHERE point = 7",
                                   "UPDATE points SET x = 9e999 WHERE point = 7",
                                   "UPDATE points SET failed = 2 WHERE point = 7",
                                   "UPDATE points SET failed = 1 WHERE point = 7",
                                   "UPDATE points SET failed = 0 WHERE point = 5",
                                   "UPDATE points SET failed = 'no' WHERE point = 7",
                                   "UPDATE points SET reason = NULL WHERE point = 5",
                                   "UPDATE points SET rre = 'much' WHERE point = 7",
                                   "UPDATE points SET rre = 9e999 WHERE point = 7",
                                   "UPDATE points SET rre = NULL WHERE point = 7",
                                   "UPDATE points SET rre_std_error = -1 WHERE point = 7",
                                   "UPDATE points SET elapsed_s = -1 WHERE point = 7",
                                   "UPDATE points SET version = x'00' WHERE point = 7",
                                   "ALTER TABLE points ADD COLUMN more",
                                   "ALTER TABLE points DROP COLUMN rre",
                                   "ALTER TABLE points RENAME COLUMN rre TO other",
                                   "DROP TABLE points",
                                   "DROP TABLE claims",
                                   "DROP TABLE study",
                                   "DELETE FROM study",
                                   "PRAGMA application_id = 7"}) {
    write(whole);
    SQLite::Database(file().string(), SQLite::OPEN_READWRITE).exec(change);
    expect_refused(change);
  }
  write(whole);
  EXPECT_EQ(message(layout(), IfExists::resume), "");
}

TEST_F(DamagedStore, IsRefusedWhereverItIsCut) {
  const std::string whole = bytes();
  ASSERT_GT(whole.size(), std::size_t{5 * 4096});
  for (int percent = 1; percent < 100; percent += 2) {
    write(whole.substr(0, whole.size() * static_cast<std::size_t>(percent) / 100));
    expect_refused(std::to_string(percent) + " %");
  }
}

TEST_F(DamagedStore, IsRefusedWithTheLogOfAKilledProcess) {
  {
    ResultStore killed(file(), layout(), IfExists::resume);
    killed.give_up(0);
    EXPECT_TRUE(killed.claim(kPoints));
    for (const char* suffix : {"", "-wal"})
      fs::copy(file().string() + suffix, folder_ / (std::string("kept") + suffix));
  }
  for (const char* suffix : {"", "-wal"})
    fs::rename(folder_ / (std::string("kept") + suffix), file().string() + suffix);
  ASSERT_GT(fs::file_size(file().string() + "-wal"), 0U);
  const std::string whole = bytes();
  write(whole.substr(0, whole.size() - 4096) + std::string(4096, 'x'));
  const std::string log = files().at("s.sqlite-wal");
  EXPECT_EQ(message(layout(), IfExists::resume), "TMP/s.sqlite");
  EXPECT_EQ(files().at("s.sqlite-wal"), log);
  EXPECT_EQ(bytes().substr(0, 4096), whole.substr(0, 4096));
}

TEST_F(DamagedStore, IsRefusedOrRightWhateverBytesWereOverwritten) {
  const std::string whole = bytes();
  std::mt19937 random(21);
  for (int k = 0; k < 150; ++k) {
    std::string damaged = whole;
    const std::size_t at = random() % whole.size();
    for (std::size_t byte = at; byte < std::min(at + 1 + random() % 300, whole.size()); ++byte)
      damaged[byte] = static_cast<char>(random());
    write(damaged);
    const std::string refusal = unrecorded_message(layout(), IfExists::resume);
    if (!refusal.empty()) {
      EXPECT_TRUE(refusal == "TMP/s.sqlite" || refusal == "study.toml") << refusal;
      continue;
    }
    for (const StoredPoint& p : ResultStore(file(), layout(), IfExists::resume).points())
      EXPECT_EQ(p.inputs, point(p.point).inputs);
  }
}

TEST_F(Store, ClaimsOfNoProcessAreVoid) {
  { const ResultStore store(file(), layout(), IfExists::refuse); }
  SQLite::Database(file().string(), SQLite::OPEN_READWRITE)
      .exec("INSERT INTO claims VALUES (1, -7), (2, 99999999), (-3, 4), (4, 9223372036854775807)");
  ResultStore store(file(), layout(), IfExists::resume);
  store.claimed_by_others();
  EXPECT_EQ(store.claimed_by_others(), 0U);
  for (const std::uint64_t number : {1U, 2U, 4U}) EXPECT_TRUE(store.claim(number)) << number;
}

TEST_F(Store, AStoreInUseIsNotOverwritten) {
  const ResultStore store(file(), layout(), IfExists::refuse);
  EXPECT_EQ(message(layout(), IfExists::overwrite), "TMP/s.sqlite");
}

TEST_F(Store, InMemoryNothingIsWritten) {
  ResultStore store("", layout(), IfExists::refuse);
  EXPECT_TRUE(store.claim(0));
  EXPECT_FALSE(store.claim(0));
  store.record(point(0));
  EXPECT_EQ(store.finished().size(), 1U);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace retrace::compute::store_test

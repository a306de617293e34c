// Tests of the progress of work that consists of tasks, and of the estimate of the remaining time.
#include <gtest/gtest.h>

#include <vector>

#include "core/long_run.h"
#include "core/task_progress.h"
#include "core/threads.h"

namespace retrace::testing::progress_test {
namespace {

class Reports : public Progress {
 public:
  void at(double share) override { shares.push_back(share); }
  std::vector<double> shares;
};

/// Returns the time, in s, at which work with constant speed is first reported to be long, or -1 if it is never
/// reported.
/// \param total_s duration of the work
/// \param step_s time between two reports of progress
double notice_time_s(double total_s, double step_s) {
  LongRun run;
  for (int k = 0; k * step_s <= total_s; ++k) {
    const double elapsed_s = k * step_s;
    const auto remaining_s = run.notice_s(elapsed_s / total_s, elapsed_s);
    if (!remaining_s) continue;
    EXPECT_NEAR(*remaining_s, total_s - elapsed_s, 1e-9 * total_s);
    return elapsed_s;
  }
  return -1.0;
}

TEST(LongRun, IsReportedAfterTheFirstSecondWithTheRemainingTime) {
  EXPECT_DOUBLE_EQ(notice_time_s(1e4, 0.25), 1.0);
  EXPECT_DOUBLE_EQ(notice_time_s(1e4, 3.0), 3.0) << "the first report of progress comes later";
}

TEST(LongRun, IsNotReportedIfAtMostAMinuteRemainsAfterTheFirstSecond) {
  EXPECT_DOUBLE_EQ(notice_time_s(LongRun::kFirstEstimateS + LongRun::kLongS - 0.1, 0.25), -1.0);
  EXPECT_DOUBLE_EQ(notice_time_s(LongRun::kFirstEstimateS + LongRun::kLongS + 0.1, 0.25), 1.0);
}

TEST(LongRun, IsReportedOnlyOneTime) {
  LongRun run;
  int notices = 0;
  for (int k = 0; k <= 1000; ++k) notices += run.notice_s(k / 1000.0, k).has_value() ? 1 : 0;
  EXPECT_EQ(notices, 1);
}

TEST(LongRun, WorkOfAnEarlierRunDoesNotCountAsProgress) {
  LongRun run;
  EXPECT_FALSE(run.notice_s(0.9, 0.0).has_value());
  EXPECT_FALSE(run.notice_s(0.9, 100.0).has_value()) << "without progress, nothing is known";
  const auto remaining_s = run.notice_s(0.91, 100.0);
  ASSERT_TRUE(remaining_s.has_value());
  EXPECT_NEAR(*remaining_s, 900.0, 1e-6) << "1 % takes 100 s, and 9 % remain";
}

TEST(LongRun, APartIsEstimatedByItsOwnProgressAndTime) {
  LongRun run;
  EXPECT_FALSE(run.notice_s(0.0, 0.0).has_value());
  run.begin_part(0.0, 1000.0);
  EXPECT_FALSE(run.notice_s(0.5, 1000.5).has_value());
  const auto remaining_s = run.notice_s(0.1, 1010.0);
  ASSERT_TRUE(remaining_s.has_value());
  EXPECT_NEAR(*remaining_s, 90.0, 1e-9);
}

TEST(LongRun, DurationsAreRoundedToAFewDigits) {
  EXPECT_EQ(duration_text(61.4), "61 s");
  EXPECT_EQ(duration_text(1800.0), "30 min");
  EXPECT_EQ(duration_text(3600.0 * 2.76), "2.8 h");
  EXPECT_EQ(duration_text(86400.0 * 11.58), "11.6 days");
}

TEST(TaskProgress, ReportsTheMeanOfAllTasks) {
  Reports reports;
  TaskProgress all(&reports, 4);
  TaskProgress::Task first(all);
  TaskProgress::Task second(all);
  first.at(0.5);
  second.at(0.25);
  first.finish();
  second.finish();
  EXPECT_EQ(reports.shares, (std::vector<double>{0.125, 0.1875, 0.3125, 0.5}));
}

TEST(TaskProgress, ATaskThatIsRepeatedNeitherFallsNorCountsTwice) {
  Reports reports;
  TaskProgress all(&reports, 2);
  {
    TaskProgress::Task abandoned(all);
    abandoned.at(0.8);
  }
  TaskProgress::Task repeated(all);
  repeated.at(0.5);
  repeated.finish();
  TaskProgress::Task(all).finish();
  EXPECT_EQ(reports.shares, (std::vector<double>{0.4, 0.5, 1.0}));
}

TEST(TaskProgress, RisesToExactlyOneWhateverTheOrderOfTheThreads) {
  constexpr std::size_t kTasks = 300;
  Reports reports;
  TaskProgress all(&reports, kTasks);
  for_each_in_parallel(kTasks, [&](std::size_t k) {
    TaskProgress::Task task(all);
    for (int step = 1; step < 7; ++step) task.at(static_cast<double>(step) / static_cast<double>(7 + k));
    task.finish();
  });
  ASSERT_FALSE(reports.shares.empty());
  EXPECT_EQ(reports.shares.back(), 1.0);
  for (std::size_t k = 1; k < reports.shares.size(); ++k) EXPECT_GT(reports.shares[k], reports.shares[k - 1]);
}

TEST(AttemptProgress, ASecondAttemptIsReportedAsTheRest) {
  Reports reports;
  AttemptProgress attempt(&reports);
  attempt.at(0.2);
  attempt.begin_again();
  attempt.at(0.5);
  attempt.at(1.0);
  ASSERT_EQ(reports.shares.size(), 3U);
  EXPECT_DOUBLE_EQ(reports.shares[1], 0.6);
  EXPECT_EQ(reports.shares[2], 1.0);
}

}  // namespace
}  // namespace retrace::testing::progress_test

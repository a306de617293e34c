#include "app/points_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "app/first_answer.h"
#include "app/interrupt.h"
#include "app/progress_bar.h"
#include "app/ranks.h"
#include "app/study_bar.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/sweep/shared_sweep.h"

namespace retrace::app {
namespace {

/// Progress bar that also shows the number of points per second and the number of failed points.
class PointsBar : public studies::SweepObserver {
 public:
  /// \param so_far returns a line about the finished points for long runs; may be empty
  PointsBar(RunText text, const CommonOptions& common, std::function<std::string()> so_far)
      : bar_(std::move(text), common), so_far_(std::move(so_far)) {}

  void at(std::uint64_t done, std::uint64_t total, std::uint64_t failed) override {
    if (!began_) begun_with_ = done;
    began_ = true;
    const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double rate = elapsed_s > 0.0 ? static_cast<double>(done - begun_with_) / elapsed_s : 0.0;
    remark_ = fmt::format("  {}/{} points, {:.3g}/s, {} failed", done, total, rate, failed);
    at_fraction(total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0);
    const auto now = std::chrono::steady_clock::now();
    if (!so_far_ || now - last_line_ < kTimeBetweenLines || done == total) return;
    bar_.write_lines(so_far_() + '\n');
    // Reading all finished points takes time. Long runs have many points, so the interval between two lines increases
    // with this time.
    last_line_ = std::chrono::steady_clock::now();
    last_line_ += kPauseFactor * (last_line_ - now);
  }
  ProgressBar& bar() { return bar_; }
  void at_fraction(double share) override {
    share_ = std::max(share_, share);
    bar_.at(share_, remark_);
  }

 private:
  static constexpr int kPauseFactor = 20;

  ProgressBar bar_;
  std::function<std::string()> so_far_;
  std::chrono::steady_clock::time_point last_line_ = std::chrono::steady_clock::now();
  bool began_ = false;
  double share_ = 0.0;
  std::string remark_;
  std::uint64_t begun_with_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Computes the first point with a larger error, if no point is finished yet. Returns a line about the result, or an
/// empty text if there is none.
std::string first_point_text(const studies::Sweep& sweep, const compute::ResultStore& store, const Cancellation* stop) {
  // Errors of the preliminary values, as a multiple of the errors of the study.
  constexpr double coarse = 16.0;
  if (sweep.size() == 0 || !store.finished().empty()) return {};
  studies::Study study = sweep.study();
  study.level = studies::ErrorLevel{coarse, 0};
  const std::optional<compute::StoredPoint> point = studies::compute_point(study, 0, sweep.values(0), stop);
  if (!point || point->failed || !store.finished().empty()) return {};
  return "preliminary values of the first point, with larger errors: " + studies::point_text(sweep, *point) + '\n';
}

/// Returns `code` if at least one point succeeded or there are no points. If every point failed, writes a message and
/// returns ExitCode::answer_is_no.
ExitCode exit_code_of(const std::vector<compute::StoredPoint>& points, ExitCode code) {
  const auto failed = [](const compute::StoredPoint& point) { return point.failed; };
  if (points.empty() || !std::all_of(points.begin(), points.end(), failed)) return code;
  print_to_stderr(
      fmt::format("retrace: all points of the study failed (number of points: {}). The first message is: {}",
                  points.size(), points.front().reason));
  return ExitCode::answer_is_no;
}

/// Computes the missing points and writes the results.
/// \param session MPI session; null if the program does not run under MPI
ExitCode compute(const StudyOptions& options, const CommonOptions& common, const PointsCommand& command,
                 compute::MpiSession* session) {
  const auto start = std::chrono::steady_clock::now();
  const studies::Sweep sweep = command.read();
  const OrderlyInterrupt interrupt;
  ResultFiles files(common, sweep.study().files, command.document);
  std::optional<studies::SweepResult> result;
  command.add_files(files, result);
  const std::filesystem::path file = files.reserve(command.store);
  files.prepare();
  compute::ResultStore store(file, sweep.layout(), if_exists_of(options));
  bool complete = false;
  {
    std::function<std::string()> so_far;
    if (command.so_far) so_far = [&] { return command.so_far(store.points()); };
    PointsBar bar({command.doing, to_shorten_study(sweep.study(), command.fewer_points)}, common, std::move(so_far));
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      const FirstAnswer first(bar.bar(), cancel, [&](std::optional<double>, const Cancellation* stop) {
        return first_point_text(sweep, store, stop);
      });
      const DistributeTasks share = distribute_among(session, slots(common), cancel);
      complete =
          share ? studies::distribute_sweep(sweep, store, &bar, share) : studies::run_sweep(sweep, store, &bar, cancel);
    });
  }
  result.emplace(studies::collect(sweep, store, complete));
  for (const Warning& remark : remarks_of(session)) result->warnings.push_back(remark);
  result->elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const ExitCode code = command.write(*result, files);
  print_warnings(common, result->warnings);
  if (complete) return exit_code_of(result->points, code);
  print_to_stderr(fmt::format("retrace: interrupted; finished points: {} of {}", result->points.size(), sweep.size()));
  return ExitCode::interrupted;
}

}  // namespace

ExitCode run_points(const StudyOptions& options, const CommonOptions& common, const PointsCommand& command) {
  return run_on_ranks(
      common, slots(common), [&](compute::MpiSession* session) { return compute(options, common, command, session); },
      [&] { return studies::compute_task(command.read()); });
}

}  // namespace retrace::app

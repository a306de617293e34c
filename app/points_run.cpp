#include "app/points_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "app/interrupt.h"
#include "app/progress_bar.h"
#include "studies/sweep/mpi_session.h"

namespace retrace::app {
namespace {

/// The bar with points a second and failures behind it.
class PointsBar : public studies::SweepObserver {
 public:
  PointsBar(const std::string& doing, bool enabled) : bar_(doing, enabled) {}

  void at(std::uint64_t done, std::uint64_t total, std::uint64_t failed) override {
    if (!began_) begun_with_ = done;
    began_ = true;
    const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double rate = elapsed_s > 0.0 ? static_cast<double>(done - begun_with_) / elapsed_s : 0.0;
    bar_.at(total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0,
            fmt::format("  {}/{} points, {:.3g}/s, {} failed", done, total, rate, failed));
  }

 private:
  ProgressBar bar_;
  bool began_ = false;
  std::uint64_t begun_with_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Points that a process has in work at a time.
std::size_t slots(const CommonOptions& common) {
  return common.threads.value_or(std::max(1U, std::thread::hardware_concurrency()));
}

/// Another rank than 0: computes what it is dealt and says nothing. What is wrong is told by rank 0, which goes on
/// without this one; another exit code than 0 would have mpirun end the job.
ExitCode serve(const CommonOptions& common, const PointsCommand& command, studies::MpiSession& session) {
  try {
    const studies::Sweep sweep = command.read();
    const OrderlyInterrupt interrupt;
    interrupt.run(common.threads, [&](const Cancellation* cancel) { session.serve(sweep, slots(common), cancel); });
  } catch (const Error& error) {
    session.leave(error.what());
  }
  return ExitCode::done;
}

/// Points none of which could be computed answer nothing.
ExitCode exit_code_of(const std::vector<studies::StoredPoint>& points, ExitCode code) {
  const auto failed = [](const studies::StoredPoint& point) { return point.failed; };
  if (points.empty() || !std::all_of(points.begin(), points.end(), failed)) return code;
  say(fmt::format("retrace: every point failed, the first of {}: {}", points.size(), points.front().reason));
  return ExitCode::answer_is_no;
}

/// \param session null without MPI
ExitCode compute(const StudyOptions& options, const CommonOptions& common, const PointsCommand& command,
                 studies::MpiSession* session) {
  const auto start = std::chrono::steady_clock::now();
  const studies::Sweep sweep = command.read();
  const OrderlyInterrupt interrupt;
  ResultFiles files(common, sweep.study().files, command.document);
  std::optional<studies::SweepResult> result;
  command.add_files(files, result);
  const std::filesystem::path file = files.reserve(command.store);
  files.prepare();
  studies::ResultStore store(file, sweep.layout(), if_exists_of(options));
  bool complete = false;
  {
    PointsBar bar(command.doing, !common.quiet);
    interrupt.run(common.threads, [&](const Cancellation* cancel) {
      complete = session != nullptr ? session->deal(sweep, store, slots(common), &bar, cancel)
                                    : studies::run_sweep(sweep, store, &bar, cancel);
    });
  }
  result.emplace(studies::collect(sweep, store, complete));
  if (session != nullptr)
    for (const std::string& remark : session->remarks()) result->warnings.push_back(remark);
  result->elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const ExitCode code = command.write(*result, files);
  print_warnings(common, result->warnings);
  if (complete) return exit_code_of(result->points, code);
  say(fmt::format("retrace: interrupted; finished points: {} of {}", result->points.size(), sweep.size()));
  return ExitCode::interrupted;
}

}  // namespace

ExitCode run_points(const StudyOptions& options, const CommonOptions& common, const PointsCommand& command) {
  check_study_options(options, common);
  if (!studies::MpiSession::is_launched()) return compute(options, common, command, nullptr);
  studies::MpiSession session;
  const ExitCode code =
      session.rank() == 0 ? compute(options, common, command, &session) : serve(common, command, session);
  if (session.end()) return code;
  // Ranks are gone, and MPI may wait for them for ever: what is left of it is not tidied up.
  std::fflush(nullptr);
  ::_exit(static_cast<int>(code));
}

}  // namespace retrace::app

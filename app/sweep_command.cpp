#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/progress_bar.h"
#include "app/study_options.h"
#include "raytrace/threads.h"
#include "studies/quantity/io/study_reader.h"
#include "studies/sweep/io/sweep_files.h"
#include "studies/sweep/io/sweep_reader.h"
#include "studies/sweep/mpi_session.h"

namespace retrace::app {
namespace {

constexpr const char* kStore = "sweep.sqlite";

/// The bar with points a second and failures behind it.
class SweepBar : public studies::SweepObserver {
 public:
  explicit SweepBar(bool enabled) : bar_("sweeping", enabled) {}

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

studies::Sweep sweep_of(const CommandLine& line) {
  return studies::read_sweep(studies::read_study(line.study.study, line.common.overrides, line.common.seed));
}

}  // namespace

namespace {

/// Points that a process has in work at a time.
std::size_t slots(const CommandLine& line) {
  return line.common.threads.value_or(std::max(1U, std::thread::hardware_concurrency()));
}

/// Another rank than 0: computes what it is dealt and says nothing. What is wrong is told by rank 0, which goes on
/// without this one; another exit code than 0 would have mpirun end the job.
ExitCode serve(const CommandLine& line, studies::MpiSession& session) {
  try {
    const studies::Sweep sweep = sweep_of(line);
    const OrderlyInterrupt interrupt;
    raytrace::run_with_threads(line.common.threads.value_or(0),
                               [&] { session.serve(sweep, slots(line), &interrupt.cancellation()); });
  } catch (const Error& error) {
    session.leave(error.what());
  }
  return ExitCode::done;
}

/// \param session null without MPI
ExitCode sweep_with(const CommandLine& line, studies::MpiSession* session) {
  const auto start = std::chrono::steady_clock::now();
  const studies::Sweep sweep = sweep_of(line);
  const OrderlyInterrupt interrupt;
  prepare_outputs(line.common, {files_of_study(sweep.study()), "sweep.json", {"sweep.csv", kStore}});
  const std::filesystem::path file =
      line.common.out.empty() ? std::filesystem::path() : std::filesystem::path(line.common.out) / kStore;
  studies::ResultStore store(file, sweep.layout(), if_exists_of(line.study));
  bool complete = false;
  {
    SweepBar bar(!line.common.quiet);
    const Cancellation* const cancel = &interrupt.cancellation();
    raytrace::run_with_threads(line.common.threads.value_or(0), [&] {
      complete = session != nullptr ? session->deal(sweep, store, slots(line), &bar, cancel)
                                    : studies::run_sweep(sweep, store, &bar, cancel);
    });
  }
  studies::SweepResult result = studies::collect(sweep, store, complete);
  if (session != nullptr)
    for (const std::string& remark : session->remarks()) result.warnings.push_back(remark);
  result.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string json = studies::sweep_json(result);
  write_outputs(line.common, json, {{"sweep.json", json}, {"sweep.csv", studies::sweep_csv(result)}},
                studies::sweep_table(result));
  print_warnings(line.common, result.warnings);
  if (complete) return ExitCode::done;
  say(fmt::format("retrace: interrupted; finished points: {} of {}", result.points.size(), sweep.size()));
  return ExitCode::interrupted;
}

}  // namespace

ExitCode run_sweep_command(const CommandLine& line) {
  check_study_options(line);
  if (!studies::MpiSession::is_launched()) return sweep_with(line, nullptr);
  studies::MpiSession session;
  const ExitCode code = session.rank() == 0 ? sweep_with(line, &session) : serve(line, session);
  if (session.end()) return code;
  // Ranks are gone, and MPI may wait for them for ever: what is left is not its to tidy up.
  std::fflush(nullptr);
  ::_exit(static_cast<int>(code));
}

}  // namespace retrace::app

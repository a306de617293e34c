#include "app/ranks.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "app/interrupt.h"

namespace retrace::app {
namespace {

/// Runs a rank other than 0: computes the tasks assigned by rank 0 and prints nothing. If this rank fails, rank 0
/// reports the failure and continues without this rank. The exit code is always 0, because mpirun would otherwise end
/// the whole job.
ExitCode serve(const CommonOptions& common, std::size_t at_a_time, const std::function<ComputeTask()>& help,
               compute::MpiSession& session) {
  try {
    const ComputeTask compute = help();
    const OrderlyInterrupt interrupt;
    interrupt.run(common.threads,
                  [&](const Cancellation* cancel) { session.compute_tasks(compute, at_a_time, cancel); });
  } catch (const Error& error) {
    session.leave(error.what());
  }
  return ExitCode::done;
}

}  // namespace

std::size_t slots(const CommonOptions& common) {
  return common.threads.value_or(std::max(1U, std::thread::hardware_concurrency()));
}

ExitCode run_on_ranks(const CommonOptions& common, std::size_t at_a_time,
                      const std::function<ExitCode(compute::MpiSession* session)>& lead,
                      const std::function<ComputeTask()>& help) {
  if (!compute::MpiSession::is_launched()) return lead(nullptr);
  compute::MpiSession session;
  if (session.rank() != 0) print_nothing_on_interrupt();
  const ExitCode code = session.rank() == 0 ? lead(&session) : serve(common, at_a_time, help, session);
  print_nothing_on_interrupt();
  if (session.end()) return code;
  // Some ranks may have been lost, and MPI_Finalize could wait for them forever. The process therefore ends without it.
  std::fflush(nullptr);
  ::_exit(static_cast<int>(code));
}

DistributeTasks distribute_among(compute::MpiSession* session, std::size_t at_a_time, const Cancellation* cancel) {
  if (session == nullptr) return {};
  return [session, at_a_time, cancel](const ComputeTask& compute, TaskLedger& ledger) {
    return session->distribute_tasks(compute, ledger, at_a_time, cancel);
  };
}

Warnings remarks_of(const compute::MpiSession* session) {
  return session != nullptr ? session->remarks() : Warnings();
}

}  // namespace retrace::app

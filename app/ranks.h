#pragma once

// Commands whose work several machines share: `mpirun retrace sweep` and the others that docs/commands.md names.

#include <functional>

#include "app/command.h"
#include "core/error.h"
#include "core/shared_tasks.h"
#include "studies/sweep/mpi_session.h"

namespace retrace::app {

/// Tasks that a process has in work at a time where each is for one thread.
std::size_t slots(const CommonOptions& common);

/// Runs a command by itself or, where mpirun launched this process, as one rank of its job. \param lead reads, computes
/// and writes; session null: alone, else as rank 0 \param help reads the same on another rank, and makes what computes
/// the tasks that rank 0 deals out \param at_a_time tasks of a rank \throw Error of lead
ExitCode run_on_ranks(const CommonOptions& common, std::size_t at_a_time,
                      const std::function<ExitCode(studies::MpiSession* session)>& lead,
                      const std::function<ComputeTask()>& help);

/// Has tasks done by all ranks; none without a session.
ShareTasks share_among(studies::MpiSession* session, std::size_t at_a_time, const Cancellation* cancel);

/// What rank 0 learnt about the others; nothing without a session.
std::vector<std::string> remarks_of(const studies::MpiSession* session);

}  // namespace retrace::app

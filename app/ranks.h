#pragma once

// Runs commands such as `mpirun retrace sweep` on several machines with MPI. docs/commands/sweep.md lists these
// commands.

#include <functional>

#include "app/command.h"
#include "compute/ranks/mpi_session.h"
#include "core/error.h"
#include "core/shared_tasks.h"
#include "core/warning.h"

namespace retrace::app {

/// Returns the number of single-threaded tasks that a process computes at the same time.
std::size_t slots(const CommonOptions& common);

/// Runs a command as a single process, or as one rank of an MPI job if the process was started by mpirun.
/// \param at_a_time number of tasks that a rank computes at the same time
/// \param lead function that reads the input, computes and writes the results. It runs on rank 0. Without MPI, it runs
/// in the only process, and `session` is null.
/// \param help function that runs on all other ranks. It reads the same input and returns the function that computes
/// the tasks assigned by rank 0.
/// \throw Error thrown by `lead`
ExitCode run_on_ranks(const CommonOptions& common, std::size_t at_a_time,
                      const std::function<ExitCode(compute::MpiSession* session)>& lead,
                      const std::function<ComputeTask()>& help);

/// Returns the function that distributes tasks over all ranks. The function is empty if `session` is null.
DistributeTasks distribute_among(compute::MpiSession* session, std::size_t at_a_time, const Cancellation* cancel);

/// Returns the warnings of rank 0 about other ranks, for example about lost ranks. The list is empty if `session` is
/// null.
Warnings remarks_of(const compute::MpiSession* session);

}  // namespace retrace::app

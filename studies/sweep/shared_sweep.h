#pragma once

// Points of a sweep as tasks that several processes share.

#include "core/shared_tasks.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// Computes one point of a sweep as a task of a computation that several processes share. The number of the task is
/// that of the point.
std::optional<std::string> compute_shared(const Sweep& sweep, std::uint64_t number, const Cancellation* cancel);

/// Returns the function that computes the points of a sweep as tasks.
ComputeTask compute_task(Sweep sweep);

/// Computes the points that are not in the store, like run_sweep().
/// \param distribute function that distributes the points as tasks among processes
/// \throw OutputError in the same cases as run_sweep()
/// \throw Error if `distribute` throws it
bool distribute_sweep(const Sweep& sweep, compute::ResultStore& store, SweepObserver* observer,
                      const DistributeTasks& distribute);

}  // namespace retrace::studies

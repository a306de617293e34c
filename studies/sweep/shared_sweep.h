#pragma once

// Points of a sweep as tasks that several processes share.

#include "core/shared_tasks.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// Computes the point of a sweep with this number as a task.
std::optional<std::string> compute_shared(const Sweep& sweep, std::uint64_t number, const Cancellation* cancel);

/// Computes the points that the store lacks, like run_sweep(), but `share` distributes them as tasks.
/// \throw OutputError as run_sweep()
/// \throw Error of `share`
bool share_sweep(const Sweep& sweep, ResultStore& store, SweepObserver* observer, const ShareTasks& share);

}  // namespace retrace::studies

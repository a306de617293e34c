#pragma once

// The points of a sweep as tasks that several processes share.

#include "core/shared_tasks.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// A point of a sweep as a task of that number.
std::optional<std::string> compute_shared(const Sweep& sweep, std::uint64_t number, const Cancellation* cancel);

/// As run_sweep(), by who has tasks done. \throw OutputError likewise; Error of `share`
bool share_sweep(const Sweep& sweep, ResultStore& store, SweepObserver* observer, const ShareTasks& share);

}  // namespace retrace::studies

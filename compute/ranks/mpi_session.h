#pragma once

// Distributes one computation over several machines with MPI. Rank 0 deals out tasks, such as the points of a sweep,
// and the other ranks compute them.

#include <memory>
#include <string>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "core/warning.h"

namespace retrace::compute {

/// Computation that is distributed over several machines. Rank 0 keeps the ledger of tasks and deals out the tasks. The
/// other ranks request tasks when they have none. MPI is used only if mpirun or srun launched the process. Ranks that
/// are silent for too long are given up, and their tasks are dealt to other ranks. A rank ends if it receives nothing
/// from rank 0 for too long. All waiting times are limited.
class MpiSession {
 public:
  /// Returns true if mpirun or srun launched this process with MPI.
  static bool is_launched();
  /// Initializes MPI.
  /// \pre is_launched(); no other session has been created in this process
  /// \throw OutputError if the module with MPI cannot be loaded
  /// \throw InputError if the time limit in the environment variable RETRACE_MPI_SILENCE_S is not a number of seconds
  /// in 1..86400
  /// \throw BudgetError if MPI does not start
  MpiSession();
  /// Calls end().
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  int rank() const;

  /// Deals out tasks to the other ranks, and computes tasks in this process, `slots` at a time. Only for rank 0.
  /// \pre distribute_tasks() has not been called before
  /// \return true if all tasks are finished
  /// \throw Error of the ledger, or of a task that rank 0 computed
  bool distribute_tasks(const ComputeTask& compute, TaskLedger& ledger, std::size_t slots, const Cancellation* cancel);
  /// Returns warnings for the user about ranks that were lost or that left early. Only for rank 0.
  Warnings remarks() const;

  /// Computes tasks that rank 0 deals out, `slots` at a time, until there are no more tasks. Only for ranks other than
  /// 0.
  /// \throw Error of a task; leave() must then be called
  void compute_tasks(const ComputeTask& compute, std::size_t slots, const Cancellation* cancel);
  /// Reports to rank 0 that this rank cannot continue, and why. Only for ranks other than 0.
  void leave(const std::string& why);

  /// Ends the session. Rank 0 must call this function after its results are written. The call allows the other ranks to
  /// end. The other ranks wait for this permission, because the launcher may kill all ranks as soon as one ends with an
  /// error.
  /// \return true if MPI was finalized; otherwise, for example if ranks were lost, the process must end with _exit()
  bool end();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace retrace::compute

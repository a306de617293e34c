#pragma once

// Distributes one computation over several machines with MPI. Rank 0 deals out tasks, such as the points of a sweep,
// and the other ranks compute them.

#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "core/warning.h"

namespace retrace::studies {

/// Computation on several machines. Rank 0 has the ledger and deals out tasks; the other ranks request tasks when they
/// have none. MPI is used only if mpirun or srun launched the process. Silent ranks are given up, and their tasks are
/// dealt to others. A rank that receives nothing from rank 0 ends. All waiting times are limited.
class MpiSession {
 public:
  /// Returns true if mpirun or srun launched this process with MPI.
  static bool is_launched();
  /// Initializes MPI.
  /// \pre is_launched(); called at most one time in a process
  /// \throw OutputError if the module with MPI cannot be loaded
  /// \throw InputError if the limit of silence (RETRACE_MPI_SILENCE_S) is out of range
  /// \throw BudgetError if MPI does not start
  MpiSession();
  /// Calls end().
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  int rank() const;

  /// Rank 0: deals out tasks and computes some itself, `slots` at a time.
  /// \pre called at most one time
  /// \return true if all tasks are finished
  /// \throw Error of the ledger, or of a task that rank 0 computed
  bool deal(const ComputeTask& compute, TaskLedger& ledger, std::size_t slots, const Cancellation* cancel);
  /// Returns remarks of rank 0 on the other ranks, for the user.
  Warnings remarks() const;

  /// Other ranks: compute the tasks that rank 0 deals out, `slots` at a time, until there are no more.
  /// \throw Error of a task; leave() must then be called
  void serve(const ComputeTask& compute, std::size_t slots, const Cancellation* cancel);
  /// Other ranks: tells rank 0 that this rank cannot continue, and why.
  void leave(const std::string& why);

  /// Rank 0: allows the other ranks to end, after its results are written. Before, the launcher might end all ranks as
  /// soon as one ends with an error. Other ranks: wait for this permission.
  /// \return true if MPI was finalized; otherwise, for example if ranks were lost, the process must end with _exit()
  bool end();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace retrace::studies

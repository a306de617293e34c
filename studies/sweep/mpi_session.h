#pragma once

// One work on several machines under MPI: rank 0 deals out tasks, such as the points of a sweep, the others compute
// them.

#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"

namespace retrace::studies {

/// One work on several machines: rank 0 holds its ledger and deals tasks out, the others ask for some whenever they
/// have none. Nothing of MPI is touched unless the process was launched by mpirun or srun. Ranks that fall silent are
/// given up, and their tasks dealt to others; a rank that hears nothing of rank 0 ends. No wait is without a limit.
class MpiSession {
 public:
  /// Whether mpirun or srun launched this process with MPI.
  static bool is_launched();
  /// Initialises MPI. \pre is_launched(); once in a process \throw OutputError if the module with MPI cannot be loaded;
  /// InputError for a limit of silence (RETRACE_MPI_SILENCE_S) out of range; BudgetError if MPI does not start
  MpiSession();
  /// As end().
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  int rank() const;

  /// Rank 0: deals tasks out and computes some itself, `slots` at a time. \pre called once \return whether all are
  /// finished \throw Error of the ledger, or of a task that it computed itself
  bool deal(const ComputeTask& compute, TaskLedger& ledger, std::size_t slots, const Cancellation* cancel);
  /// What rank 0 learnt about the others that a user should know.
  std::vector<std::string> remarks() const;

  /// The other ranks: compute what they are dealt, `slots` tasks at a time, until there is no more. \throw Error of a
  /// task, after which leave() is to be called
  void serve(const ComputeTask& compute, std::size_t slots, const Cancellation* cancel);
  /// The other ranks: tells rank 0 that this one cannot serve, and why.
  void leave(const std::string& why);

  /// Rank 0: lets the others go, once its results are written: what launched the job may end all ranks as soon as one
  /// has left out of order. The others: wait until they are let go. \return whether MPI was ended in order; if not, as
  /// with ranks that are gone, the process is to end with _exit()
  bool end();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace retrace::studies

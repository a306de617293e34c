#pragma once

// One sweep on several machines under MPI: rank 0 deals out points, the others compute them.

#include <memory>
#include <string>
#include <vector>

#include "core/progress.h"
#include "studies/store/store.h"
#include "studies/sweep/sweep.h"

namespace retrace::studies {

/// One sweep on several machines: rank 0 holds the store and deals points out, the others ask for some whenever they
/// have none. Nothing of MPI is touched unless the process was launched by mpirun or srun. Ranks that fall silent are
/// given up, and their points dealt to others; a rank that hears nothing of rank 0 ends. No wait is without a limit.
class MpiSession {
 public:
  /// Whether mpirun or srun launched this process with MPI.
  static bool is_launched();
  /// Initialises MPI. \pre is_launched(); once in a process \throw InputError if retrace was built without MPI, or for
  /// a limit of silence (RETRACE_MPI_SILENCE_S) out of range; BudgetError if MPI does not start
  MpiSession();
  /// As end().
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  int rank() const;

  /// Rank 0: deals points out and computes some itself, `slots` at a time. \return whether all are finished
  /// \throw OutputError as run_sweep()
  bool deal(const Sweep& sweep, ResultStore& store, std::size_t slots, SweepObserver* observer,
            const Cancellation* cancel);
  /// What rank 0 learnt about the others that a user should know.
  std::vector<std::string> remarks() const;

  /// The other ranks: compute what they are dealt, `slots` points at a time, until there is no more.
  void serve(const Sweep& sweep, std::size_t slots, const Cancellation* cancel);
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

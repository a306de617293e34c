#pragma once

// Internal to studies/sweep: messages between the ranks of an MPI job. MPI stays behind this file and its .cpp.

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace retrace::studies {

/// What one rank told another.
struct Letter {
  int rank = 0;  ///< that wrote it
  int tag = 0;
  std::string bytes;
};

/// Letters between the ranks of a job. All of MPI happens on a thread of its own, which also tells the others that this
/// rank is at work: whatever becomes of a rank, and whatever MPI makes of its end, no call
/// here waits for MPI without a limit. One thread reads; any thread may post.
class MpiMailbox {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts MPI. \param sign_of_life how often the other ranks are told that this one is at work: rank 0 tells all, the
  /// others tell rank 0 \throw BudgetError if MPI has not started after ten minutes
  explicit MpiMailbox(std::chrono::milliseconds sign_of_life);
  /// Without close(): leaves MPI as it is.
  ~MpiMailbox();
  MpiMailbox(const MpiMailbox&) = delete;
  MpiMailbox& operator=(const MpiMailbox&) = delete;

  int rank() const;
  int size() const;

  /// Sends a letter without waiting for it to go. \param tag > 0
  void post(int to, int tag, std::string bytes);
  /// The next letter, if one comes in time.
  std::optional<Letter> take(std::chrono::microseconds patience);
  /// For how long nothing, not even a sign of life, has come from a rank.
  std::chrono::duration<double> silence(int rank) const;
  /// Counts all silences from now on: when this process itself has been away.
  void forgive_silence();
  /// Nothing more is told to a rank that was given up; what is on its way to it is not waited for.
  void forget(int rank);

  /// Waits until what was posted has gone. \return whether it has
  bool flush(std::chrono::milliseconds patience);
  /// Ends MPI together with all other ranks. \return whether that came off in time; if not, MPI is left as it is and
  /// the process is to end with _exit()
  bool close(std::chrono::milliseconds patience);

 private:
  struct State;
  std::shared_ptr<State> state_;  ///< shared with the thread, which may outlive this
};

}  // namespace retrace::studies

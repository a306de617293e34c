#pragma once

// Internal to studies/sweep: messages between the ranks of an MPI job. MPI itself is in a module, mpi_module.cpp.

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
  /// Without close(): leaves MPI as it is.
  virtual ~MpiMailbox() = default;

  /// Waits for MPI, which starts when the mailbox is made. \return whether it has
  virtual bool wait_for_start(std::chrono::milliseconds patience) = 0;

  /// \pre MPI has started, here and below
  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// Sends a letter without waiting for it to go. \param tag > 0
  virtual void post(int to, int tag, std::string bytes) = 0;
  /// The next letter, if one comes in time.
  virtual std::optional<Letter> take(std::chrono::microseconds patience) = 0;
  /// For how long nothing, not even a sign of life, has come from a rank.
  virtual std::chrono::duration<double> silence(int rank) const = 0;
  /// Counts all silences from now on: when this process itself has been away.
  virtual void forgive_silence() = 0;
  /// Nothing more is told to a rank that was given up; what is on its way to it is not waited for.
  virtual void forget(int rank) = 0;

  /// Waits until what was posted has gone. \return whether it has
  virtual bool flush(std::chrono::milliseconds patience) = 0;
  /// Ends MPI together with all other ranks. \return whether that came off in time; if not, MPI is left as it is and
  /// the process is to end with _exit()
  virtual bool close(std::chrono::milliseconds patience) = 0;
};

/// Starts MPI. \param sign_of_life how often the other ranks are told that this one is at work: rank 0 tells all, the
/// others tell rank 0 \throw OutputError if the module with MPI cannot be loaded
std::unique_ptr<MpiMailbox> open_mpi_mailbox(std::chrono::milliseconds sign_of_life);

}  // namespace retrace::studies

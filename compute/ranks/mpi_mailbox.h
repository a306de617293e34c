#pragma once

// Messages between the ranks (processes) of an MPI job. Only the module mpi_module.cpp uses MPI itself. Only files of
// compute/ranks include this header.

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace retrace::compute {

/// Message from one rank to another.
struct MpiMessage {
  int rank = 0;  ///< sender
  int tag = 0;
  std::string bytes;
};

/// Sends and receives messages between the ranks of a job. A separate thread makes all MPI calls. It also sends signs
/// of life: short messages that show that the process is alive. No function of this class waits for MPI without a time
/// limit, even if another rank dies or MPI cannot be finalized. Parameters named `timeout` are maximum waiting times.
/// Only one thread may read messages; any thread may post them.
class MpiMailbox {
 public:
  /// Destroys the mailbox. MPI is finalized only if close() was called.
  virtual ~MpiMailbox() = default;

  /// Waits until MPI has started. It starts in the background as soon as the mailbox is created.
  /// \return true if MPI has started
  virtual bool wait_for_start(std::chrono::milliseconds timeout) = 0;

  /// Returns the rank of this process.
  /// \pre MPI has started. This precondition also applies to all following functions
  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// Sends a message without waiting for its transfer.
  /// \param tag must be > 0
  virtual void post(int to, int tag, std::string bytes) = 0;
  /// Returns the next message, or nothing if none arrives within `timeout`.
  virtual std::optional<MpiMessage> take(std::chrono::microseconds timeout) = 0;
  /// Returns the time since the last message or sign of life of a rank.
  virtual std::chrono::duration<double> silence(int rank) const = 0;
  /// Restarts the measurement of the silence of all ranks. Must be called after this process itself was suspended.
  virtual void reset_silence() = 0;
  /// Stops sending messages to a rank that was given up. Other functions do not wait for messages to this rank.
  virtual void drop_rank(int rank) = 0;

  /// Waits until all posted messages have been sent.
  /// \return true if they have been sent within `timeout`
  virtual bool flush(std::chrono::milliseconds timeout) = 0;
  /// Finalizes MPI together with all other ranks.
  /// \return true if this succeeded within `timeout`; otherwise, MPI is not finalized and the process must end with
  /// _exit()
  virtual bool close(std::chrono::milliseconds timeout) = 0;
};

/// Starts MPI.
/// \param sign_of_life time between two signs of life. Rank 0 sends signs of life to all other ranks. Each other rank
/// sends its signs of life only to rank 0.
/// \throw OutputError if the module that contains MPI cannot be loaded
std::unique_ptr<MpiMailbox> open_mpi_mailbox(std::chrono::milliseconds sign_of_life);

}  // namespace retrace::compute

#pragma once

// Handles Ctrl-C, SIGTERM and SIGHUP. A long computation stops and its finished results are written. If no long
// computation is running, the process ends immediately.

#include <functional>
#include <optional>

#include "app/command.h"
#include "app/progress_bar.h"
#include "core/progress.h"

namespace retrace::app {

/// Installs handlers for the interrupts SIGINT, SIGTERM and SIGHUP. An interrupt ends the program with exit code 130.
/// If the program was started with SIGHUP ignored, for example by nohup, SIGHUP remains ignored.
void install_interrupt_handlers();

/// Makes later interrupts end the program without a message. Use this function for an MPI rank that has nothing to
/// report: the launcher interrupts all ranks as soon as one of them ends with an error.
void print_nothing_on_interrupt();

/// While an object of this class exists, the first interrupt only requests that the computation stops. The finished
/// results are then written. The second interrupt ends the program immediately.
class OrderlyInterrupt {
 public:
  OrderlyInterrupt();
  ~OrderlyInterrupt();
  OrderlyInterrupt(const OrderlyInterrupt&) = delete;
  OrderlyInterrupt& operator=(const OrderlyInterrupt&) = delete;

  /// Runs a computation that regularly checks whether it should stop. If the computation does not stop within one
  /// second after the interrupt, the program ends and writes no results. On a busy machine, the program waits up to
  /// nine seconds, until the computation has had half a second of processor time. If it stops in time, writing its
  /// results has no time limit. \param threads number of threads; if there is no value or it is 0, the number of cores
  /// \param work computation; its parameter is the request to stop
  void run(std::optional<unsigned> threads, const std::function<void(const Cancellation*)>& work) const;
  /// Runs a computation like the overload above and shows a progress bar.
  /// \param common options of the command; only the number of threads and --quiet are used
  /// \param text texts of the progress bar
  /// \param work computation; its parameters are the progress bar and the request to stop
  void run(const CommonOptions& common, const RunText& text,
           const std::function<void(Progress*, const Cancellation*)>& work) const;
};

}  // namespace retrace::app

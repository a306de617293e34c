#pragma once

// Handles Ctrl-C, SIGTERM and SIGHUP. Long work stops in order and keeps its finished results. Other work ends
// immediately.

#include <functional>
#include <optional>

#include "app/command.h"
#include "app/progress_bar.h"
#include "core/progress.h"

namespace retrace::app {

/// Installs handlers for the interrupts SIGINT, SIGTERM and SIGHUP, which end the program with exit code 130. If SIGHUP
/// was ignored before, as it is under nohup, it remains ignored.
void install_interrupt_handlers();

/// Handles interrupts while an object exists. The first interrupt requests the work to stop, so that finished results
/// are written. The second interrupt ends the program immediately.
class OrderlyInterrupt {
 public:
  OrderlyInterrupt();
  ~OrderlyInterrupt();
  OrderlyInterrupt(const OrderlyInterrupt&) = delete;
  OrderlyInterrupt& operator=(const OrderlyInterrupt&) = delete;

  /// Runs work that checks regularly whether to stop. If the work has not stopped one second after the interrupt, the
  /// program ends and nothing is written. If it has stopped in time, its results are written, however long that takes.
  /// \param threads number of threads; empty or 0: as many as there are cores
  void run(std::optional<unsigned> threads, const std::function<void(const Cancellation*)>& work) const;
  /// Does the same as the overload above and also shows a progress bar.
  /// \param text text of the progress bar
  void run(const CommonOptions& common, const RunText& text,
           const std::function<void(Progress*, const Cancellation*)>& work) const;
};

}  // namespace retrace::app

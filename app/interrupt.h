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

/// While one exists, the first interrupt only asks for the end, so that work can stop in order and write what it has;
/// the second ends the program at once.
class OrderlyInterrupt {
 public:
  OrderlyInterrupt();
  ~OrderlyInterrupt();
  OrderlyInterrupt(const OrderlyInterrupt&) = delete;
  OrderlyInterrupt& operator=(const OrderlyInterrupt&) = delete;

  /// Does work that asks whether to stop. Work that has not stopped within a second of the interrupt ends the program
  /// with it, and nothing is written; once it has stopped, what it has is written however long that takes.
  /// \param threads none or 0: as many as there are cores
  void run(std::optional<unsigned> threads, const std::function<void(const Cancellation*)>& work) const;
  /// Does the same with a progress bar. \param text text of the bar
  void run(const CommonOptions& common, const RunText& text,
           const std::function<void(Progress*, const Cancellation*)>& work) const;
};

}  // namespace retrace::app

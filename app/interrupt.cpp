#include "app/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "core/error.h"

namespace retrace::app {
namespace {

Cancellation cancellation_asked;
std::atomic<bool> is_orderly{false};

extern "C" void on_interrupt(int) {
  // Work that nobody stops in order, such as waiting for standard input, must not swallow the interrupt.
  if (!is_orderly.load() || cancellation_asked.requested()) ::_exit(static_cast<int>(ExitCode::interrupted));
  cancellation_asked.request();
}

}  // namespace

void install_interrupt_handlers() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

OrderlyInterrupt::OrderlyInterrupt() {
  is_orderly.store(true);
}
OrderlyInterrupt::~OrderlyInterrupt() {
  is_orderly.store(false);
}

const Cancellation& OrderlyInterrupt::cancellation() const {
  return cancellation_asked;
}

}  // namespace retrace::app

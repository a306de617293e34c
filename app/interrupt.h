#pragma once

#include "core/progress.h"

namespace retrace::app {

/// From here on an interrupt (SIGINT, SIGTERM) ends the program with exit code 130.
void install_interrupt_handlers();

/// While one exists, the first interrupt only asks for the end, so that work can stop in order and write what it has;
/// the second ends the program at once.
class OrderlyInterrupt {
 public:
  OrderlyInterrupt();
  ~OrderlyInterrupt();
  OrderlyInterrupt(const OrderlyInterrupt&) = delete;
  OrderlyInterrupt& operator=(const OrderlyInterrupt&) = delete;

  const Cancellation& cancellation() const;
};

}  // namespace retrace::app

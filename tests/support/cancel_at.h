#pragma once

#include "core/progress.h"

namespace retrace::testing {

/// Progress that cancels the computation when it reaches a fraction.
class CancelAt : public Progress {
 public:
  explicit CancelAt(double fraction) : fraction_(fraction) {}
  void at(double fraction) override {
    if (fraction >= fraction_) cancel.request();
  }
  Cancellation cancel;

 private:
  double fraction_;
};

}  // namespace retrace::testing

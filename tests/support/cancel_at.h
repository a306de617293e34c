#pragma once

#include "core/progress.h"

namespace retrace::testing {

/// Progress object that cancels the computation as soon as a given fraction is complete.
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

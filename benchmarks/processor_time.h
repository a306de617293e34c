#pragma once

// Measures the processor time of a computation on one thread, and cancels it if it takes too long.

#include <atomic>
#include <chrono>
#include <ctime>
#include <string>
#include <thread>

#include "core/progress.h"
#include "core/threads.h"
#include "studies/rre/rre.h"

namespace retrace::benchmarks {

/// Cancels a run when a given time has elapsed.
class Deadline {
 public:
  explicit Deadline(double seconds)
      : thread_([this, seconds] {
          const auto end = Clock::now() + std::chrono::duration<double>(seconds);
          while (!is_over_ && Clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(2));
          cancellation.request();
        }) {}
  ~Deadline() {
    is_over_ = true;
    thread_.join();
  }

  Cancellation cancellation;

 private:
  using Clock = std::chrono::steady_clock;

  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

struct Timed {
  double s = 0.0;  ///< processor time, which does not depend on other load on the machine
  bool is_complete = false;
  std::string engine;
};

/// Measures the time of a request on one thread. The check of the request is not included.
/// \param max_s time after which the request is cancelled
inline Timed timed(const design::Design& design, const studies::RreSettings& request, double max_s) {
  const studies::RreStudy study({design}, request);
  Timed result;
  run_with_threads(1, [&] {
    const Deadline deadline(max_s);
    const std::clock_t start = std::clock();
    const studies::RreResult found = study.run(nullptr, &deadline.cancellation);
    result = {static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, found.complete, found.engine};
  });
  return result;
}

}  // namespace retrace::benchmarks

#pragma once

// Runs a computation of the library in a separate thread while the Python thread waits without the interpreter's lock.
// Interrupts stop the computation, and its progress is reported.

#include <pybind11/pybind11.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "retrace/running.h"

namespace retrace::python {
namespace py = pybind11;

/// Error of a computation in a forked process. The threads that its parent process used for computations do not exist
/// in the forked process.
class Forked : public std::runtime_error {
 public:
  Forked()
      : std::runtime_error(
            "this process was forked after retrace had started its threads, which do not exist in the fork: "
            "use multiprocessing.get_context(\"forkserver\") or \"spawn\", or fork before the first computation") {}
};

/// Records the first process that runs a computation.
/// \throw Forked if the current process is a forked child of the recorded process
inline void refuse_after_fork() {
  static std::atomic<pid_t> computing{0};
  pid_t expected = 0;
  if (!computing.compare_exchange_strong(expected, ::getpid()) && expected != ::getpid()) throw Forked();
}

/// Completed fraction of the computation, set by its threads.
class Share : public Progress {
 public:
  void at(double share) override { share_.store(share, std::memory_order_relaxed); }
  double now() const { return share_.load(std::memory_order_relaxed); }

 private:
  std::atomic<double> share_{0.0};
};

/// State shared by the computation's thread and the waiting thread.
template <class Result>
struct Work {
  Share share;
  Cancellation cancellation;
  std::mutex mutex;
  std::condition_variable ended;
  bool has_ended = false;
  std::optional<Result> result;
  std::exception_ptr error;

  /// Waits for some time. The interpreter's lock is released meanwhile.
  /// \pre the interpreter's lock is held
  /// \return true if the computation has ended
  bool wait(std::chrono::milliseconds time) {
    const py::gil_scoped_release others_run;
    std::unique_lock lock(mutex);
    return ended.wait_for(lock, time, [this] { return has_ended; });
  }
};

/// Runs compute(const Running&) in a separate thread. `compute` must own copies of all its data and must not use Python
/// objects: if it does not stop within a second of an interrupt, it is abandoned and continues to run.
/// \param progress Python function that the waiting thread calls with the completed fraction, or None
/// \throw any exception of `compute`; py::error_already_set from a signal handler or from `progress`
template <class Compute>
auto watched(const py::object& progress, unsigned threads, Compute compute) {
  using Result = decltype(compute(std::declval<const Running&>()));
  constexpr std::chrono::milliseconds kPoll{50};
  constexpr std::chrono::milliseconds kPatience{900};
  refuse_after_fork();
  const auto work = std::make_shared<Work<Result>>();
  std::thread thread([work, threads, compute = std::move(compute)]() mutable {
    try {
      work->result.emplace(compute(Running{&work->share, &work->cancellation, threads}));
    } catch (...) {
      work->error = std::current_exception();
    }
    const std::lock_guard lock(work->mutex);
    work->has_ended = true;
    work->ended.notify_all();
  });
  double told = -1.0;
  try {
    while (!work->wait(kPoll)) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (const double share = work->share.now(); !progress.is_none() && share > told) progress(told = share);
    }
    thread.join();
    if (work->error) std::rethrow_exception(work->error);
    if (!progress.is_none() && told < 1.0) progress(1.0);
  } catch (...) {
    if (thread.joinable()) {
      work->cancellation.request();
      work->wait(kPatience) ? thread.join() : thread.detach();
    }
    throw;
  }
  return *std::move(work->result);
}

}  // namespace retrace::python

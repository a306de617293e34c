#pragma once

// Runs work of the library on a thread of its own while Python's waits: without the interpreter's lock, told of
// interrupts, and telling how far it has come.

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

/// A process that was forked has none of the threads that its parent computed with.
class Forked : public std::runtime_error {
 public:
  Forked()
      : std::runtime_error(
            "this process was forked after retrace had begun to compute, and has none of its threads: "
            "use multiprocessing.get_context(\"forkserver\") or \"spawn\", or fork before") {}
};

/// Remembers which process has computed. \throw Forked in a child of it
inline void refuse_after_fork() {
  static std::atomic<pid_t> computing{0};
  pid_t expected = 0;
  if (!computing.compare_exchange_strong(expected, ::getpid()) && expected != ::getpid()) throw Forked();
}

/// How far work has come, as told by any of its threads.
class Share : public Progress {
 public:
  void at(double share) override { share_.store(share, std::memory_order_relaxed); }
  double now() const { return share_.load(std::memory_order_relaxed); }

 private:
  std::atomic<double> share_{0.0};
};

/// Work, shared by its thread and the one that waits.
template <class Result>
struct Work {
  Share share;
  Cancellation cancellation;
  std::mutex mutex;
  std::condition_variable ended;
  bool has_ended = false;
  std::optional<Result> result;
  std::exception_ptr error;

  /// \return whether it has ended by then. \pre the interpreter's lock is held; it is given up meanwhile
  bool wait(std::chrono::milliseconds time) {
    const py::gil_scoped_release others_run;
    std::unique_lock lock(mutex);
    return ended.wait_for(lock, time, [this] { return has_ended; });
  }
};

/// Runs compute(const Running&). It must hold copies of all that it needs and nothing of Python: work that does not
/// stop within a second of an interrupt is left to itself. \param progress called with the share that is done, from the
/// thread that waits; or None \throw what compute throws; py::error_already_set of a signal's handler, or of `progress`
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

#include "app/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <string_view>

#include "core/error.h"
#include "core/temporary_files.h"
#include "core/threads.h"

namespace retrace::app {
namespace {

Cancellation cancellation_asked;
std::atomic<bool> is_orderly{false};
std::atomic<bool> is_silent{false};

// Time from the first interrupt within which the work must stop. After this time, a timer sends SIGALRM, which ends the
// process. If other processes use the processor, the work has hardly run in this time. The timer is then started again.
constexpr itimerspec kPatience{{0, 0}, {0, 900'000'000}};
// Minimum processor time that the work must have had after the interrupt before the process ends.
constexpr std::int64_t kMinWorkNs = 450'000'000;
// Maximum number of times that the timer is started.
constexpr int kMaxPeriods = 10;
std::atomic<std::int64_t> worked_at_interrupt_ns{0};
std::atomic<int> periods{0};
constexpr itimerspec kNever{{0, 0}, {0, 0}};
timer_t deadline;
bool has_deadline = false;

void set_deadline(const itimerspec& when) {
  if (has_deadline) ::timer_settime(deadline, 0, &when, nullptr);
}

/// Line that is written to standard error if the process ends without results. On a terminal, it replaces the progress
/// bar.
std::string_view last_line;

extern "C" void end_now(int) {
  remove_temporary_files();
  if (!is_silent.load()) static_cast<void>(!::write(STDERR_FILENO, last_line.data(), last_line.size()));
  ::_exit(static_cast<int>(ExitCode::interrupted));
}

/// Returns the processor time of this process. The function may be called by signal handlers.
std::int64_t processor_time_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  return std::int64_t{time.tv_sec} * ns_per_s + time.tv_nsec;
}

extern "C" void on_deadline(int) {
  const bool has_worked = processor_time_ns() - worked_at_interrupt_ns.load() >= kMinWorkNs;
  if (has_worked || ++periods >= kMaxPeriods) end_now(0);
  set_deadline(kPatience);
}

extern "C" void on_interrupt(int) {
  // The process ends immediately if no OrderlyInterrupt exists, for example while the process waits for standard input.
  // The second interrupt always ends the process immediately.
  if (!is_orderly.load() || cancellation_asked.requested()) end_now(0);
  cancellation_asked.request();
  worked_at_interrupt_ns.store(processor_time_ns());
  set_deadline(kPatience);
}

}  // namespace

void install_interrupt_handlers() {
  constexpr std::string_view line = "\r\033[Kretrace: the command was interrupted before the results were written\n";
  last_line = ::isatty(STDERR_FILENO) != 0 ? line : line.substr(4);
  std::signal(SIGALRM, on_deadline);
  has_deadline = ::timer_create(CLOCK_MONOTONIC, nullptr, &deadline) == 0;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

void print_nothing_on_interrupt() {
  is_silent.store(true);
}

OrderlyInterrupt::OrderlyInterrupt() {
  is_orderly.store(true);
}
OrderlyInterrupt::~OrderlyInterrupt() {
  is_orderly.store(false);
}

void OrderlyInterrupt::run(std::optional<unsigned> threads,
                           const std::function<void(const Cancellation*)>& work) const {
  run_with_threads(threads.value_or(0), [&] { work(&cancellation_asked); });
  set_deadline(kNever);
}

void OrderlyInterrupt::run(const CommonOptions& common, const RunText& text,
                           const std::function<void(Progress*, const Cancellation*)>& work) const {
  ProgressBar bar(text, common);
  run(common.threads, [&](const Cancellation* cancel) { work(&bar, cancel); });
}

}  // namespace retrace::app

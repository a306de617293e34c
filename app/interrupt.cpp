#include "app/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
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
// process.
constexpr itimerspec kPatience{{0, 0}, {0, 900'000'000}};
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

extern "C" void on_interrupt(int) {
  // The process ends immediately if no OrderlyInterrupt exists, for example while the process waits for standard input.
  // The second interrupt always ends the process immediately.
  if (!is_orderly.load() || cancellation_asked.requested()) end_now(0);
  cancellation_asked.request();
  set_deadline(kPatience);
}

}  // namespace

void install_interrupt_handlers() {
  constexpr std::string_view line = "\r\033[Kretrace: the command was interrupted before the results were written\n";
  last_line = ::isatty(STDERR_FILENO) != 0 ? line : line.substr(4);
  std::signal(SIGALRM, end_now);
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

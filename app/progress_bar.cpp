#include "app/progress_bar.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "app/output.h"

namespace retrace::app {
namespace {

constexpr int kWidth = 30;
constexpr std::chrono::milliseconds kRedraw{100};

}  // namespace

ProgressBar::ProgressBar(RunText text, const CommonOptions& common)
    : text_(std::move(text)), is_quiet_(common.quiet), is_terminal_(::isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::clear() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

double ProgressBar::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

bool ProgressBar::is_time_to_draw(bool is_end) {
  const auto now = std::chrono::steady_clock::now();
  if (is_quiet_ || !is_terminal_ || (drawn_ && !is_end && now - last_ < kRedraw)) return false;
  last_ = now;
  drawn_ = true;
  return true;
}

void ProgressBar::notice(double fraction, const std::string& work) {
  if (is_quiet_) return;
  const std::optional<double> remaining_s = run_.notice_s(fraction, elapsed_s());
  if (!remaining_s) return;
  clear();
  const std::string advice = fmt::format("{}", fmt::join(text_.to_shorten, ", or "));
  print_to_stderr(fmt::format("note: {} will take about {} longer{}{}", work, duration_text(*remaining_s),
                              advice.empty() ? "" : "; to shorten it, ", advice));
  if (after_notice_) after_notice_(*remaining_s);
}

void ProgressBar::after_notice(std::function<void(double)> action) {
  const std::lock_guard lock(mutex_);
  after_notice_ = std::move(action);
}

std::optional<double> ProgressBar::remaining_s() {
  const std::lock_guard lock(mutex_);
  return remaining_s_;
}

void ProgressBar::write_lines(const std::string& lines) {
  const std::lock_guard lock(mutex_);
  if (is_quiet_) return;
  clear();
  for (std::size_t from = 0; from < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', from), lines.size());
    print_to_stderr(std::string_view(lines).substr(from, end - from));
    from = end + 1;
  }
}

void ProgressBar::at(double fraction) {
  at(fraction, "");
}

void ProgressBar::at(double fraction, const std::string& remark) {
  const std::lock_guard lock(mutex_);
  notice(fraction, "this run");
  remaining_s_ = run_.remaining_s(fraction, elapsed_s());
  if (!is_time_to_draw(fraction >= 1.0)) return;
  const auto full = static_cast<int>(std::lround(fraction * kWidth));
  fmt::print(stderr, "\r\033[K{} [{:=>{}}{:>{}}] {:3.0f} %", text_.doing, "", full, "", kWidth - full,
             100.0 * fraction);
  if (remaining_s_) fmt::print(stderr, "  {:.0f} s left", *remaining_s_);
  fmt::print(stderr, "{}", remark);
  std::fflush(stderr);
}

void ProgressBar::count(const std::string& done) {
  const std::lock_guard lock(mutex_);
  if (!is_time_to_draw(false)) return;
  fmt::print(stderr, "\r\033[K{}: {}, {:.0f} s", text_.doing, done, elapsed_s());
  std::fflush(stderr);
}

void ProgressBar::begin_group(double fraction) {
  const std::lock_guard lock(mutex_);
  run_.begin_part(fraction, elapsed_s());
}

void ProgressBar::at_group(double fraction, const std::string& group) {
  const std::lock_guard lock(mutex_);
  notice(fraction, group);
}

}  // namespace retrace::app

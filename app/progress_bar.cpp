#include "app/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace retrace::app {
namespace {

constexpr int kWidth = 30;
constexpr std::chrono::milliseconds kRedraw{100};

}  // namespace

ProgressBar::ProgressBar(std::string what, bool enabled)
    : what_(std::move(what)), enabled_(enabled && ::isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::at(double share) {
  at(share, "");
}

void ProgressBar::at(double share, const std::string& remark) {
  if (first_share_ < 0.0) first_share_ = share;
  const auto now = std::chrono::steady_clock::now();
  if (!enabled_ || (drawn_ && share < 1.0 && now - last_ < kRedraw)) return;
  last_ = now;
  drawn_ = true;
  const auto full = static_cast<int>(std::lround(share * kWidth));
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  fmt::print(stderr, "\r\033[K{} [{:=>{}}{:>{}}] {:3.0f} %", what_, "", full, "", kWidth - full, 100.0 * share);
  if (share > first_share_) fmt::print(stderr, "  {:.0f} s left", elapsed_s * (1.0 - share) / (share - first_share_));
  fmt::print(stderr, "{}", remark);
  std::fflush(stderr);
}

void ProgressBar::count(const std::string& done) {
  const auto now = std::chrono::steady_clock::now();
  if (!enabled_ || (drawn_ && now - last_ < kRedraw)) return;
  last_ = now;
  drawn_ = true;
  fmt::print(stderr, "\r\033[K{}: {}, {:.0f} s", what_, done, std::chrono::duration<double>(now - start_).count());
  std::fflush(stderr);
}

}  // namespace retrace::app

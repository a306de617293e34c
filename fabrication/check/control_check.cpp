#include "fabrication/check/control_check.h"

#include <fmt/format.h>

#include <utility>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

bool has_bit(unsigned bits, char axis) {
  return (bits >> kNcAxisLetters.find(axis) & 1U) != 0;
}

}  // namespace

void ControlCheck::begin() {
  settings_are_checked_ = false;
  has_spindle_fault_ = false;
}

void ControlCheck::settings(const NcSettings& settings, const NcPlace& place) {
  if (settings_are_checked_) return;
  settings_are_checked_ = true;
  const std::pair<bool, const char*> required[] = {
      {settings.absolute.has_value(), "whether positions are absolute or incremental"},
      {settings.feed_time_s.has_value(), "that feeds are per minute"},
      {settings.exact_stop.value_or(false), "that moves stop exactly: corners would be rounded"},
      {settings.compensation_off.value_or(false), "that compensations of the tool are off"},
      {spindle_.turns != NcSpindle::stopped || settings.spindle == NcSpindle::stopped,
       "that the spindle stands still"}};
  for (const auto& [holds, what] : required)
    if (!holds)
      findings_.add("setup", place.line, std::string("before the first cut the program does not say ") + what);
}

void ControlCheck::find_spindle(std::int32_t line, const std::string& message, double rpm) {
  if (!std::exchange(has_spindle_fault_, true)) findings_.add("spindle", line, message, rpm, spindle_.rpm);
}

void ControlCheck::spindle(const NcSettings& settings, const NcPlace& place) {
  const NcSpindle is = settings.spindle.value_or(NcSpindle::stopped);
  const double rpm = settings.spindle_rpm.value_or(0.0);
  if (is == NcSpindle::stopped || is == NcSpindle::stopped_by_text)
    find_spindle(place.line, "the tool feeds while the spindle stands still", 0.0);
  else if (is != spindle_.turns)
    find_spindle(
        place.line,
        spindle_.is_by_text() ? "the spindle is not started by spindle_start" : "the spindle turns the wrong way", rpm);
  else if (!spindle_.is_by_text() && rpm != spindle_.rpm)
    find_spindle(place.line, "the spindle turns at another speed", rpm);
}

void ControlCheck::spindle_at_end(const NcEnd& end) {
  if (end.settings.spindle != (spindle_.is_by_text() ? NcSpindle::stopped_by_text : NcSpindle::stopped))
    find_spindle(end.line, "the program ends without stopping the spindle", end.settings.spindle_rpm.value_or(0.0));
}

void ControlCheck::axes(const Machine& machine, const NcMotion& motion) {
  const char missing = machine.tilt == Tilt::table ? 'B' : 'A';
  if (has_bit(motion.moved, missing))
    findings_.add("axis_unknown", motion.place.line, fmt::format("machine {} has no axis {}", machine.name, missing));
  for (const LimitExcess& excess : limit_excesses(machine, motion.to)) {
    if (!has_bit(motion.known | motion.moved, excess.axis)) continue;
    findings_.add("axis_limit", motion.place.line,
                  fmt::format("{} goes to {}, beyond its limits {} to {}", excess.axis, shortest(excess.position),
                              shortest(excess.limits.low), shortest(excess.limits.high)),
                  excess.position, excess.position > excess.limits.high ? excess.limits.high : excess.limits.low);
  }
}

void ControlCheck::feed(const NcMotion& motion, double most_mm_per_min) {
  if (motion.feed_mm_per_min <= 0.0)
    findings_.add("zero_feed", motion.place.line, "a cutting move has a feed of 0");
  else if (most_mm_per_min > 0.0 && motion.feed_mm_per_min > most_mm_per_min * (1.0 + 1e-9))
    findings_.add("feed_too_high", motion.place.line,
                  fmt::format("a cut has a feed of {} mm/min, the process allows {}", shortest(motion.feed_mm_per_min),
                              shortest(most_mm_per_min)),
                  motion.feed_mm_per_min, most_mm_per_min);
}

}  // namespace retrace::fabrication

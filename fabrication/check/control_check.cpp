#include "fabrication/check/control_check.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/number_format.h"
#include "fabrication/read/nc_needs.h"

namespace retrace::fabrication {
namespace {

constexpr std::uint8_t kZBit = 0b100;
/// Rounding of words.
constexpr double kSlackMm = 1e-9;

bool has_bit(unsigned bits, char axis) {
  return (bits >> kNcAxisLetters.find(axis) & 1U) != 0;
}

}  // namespace

void ControlCheck::begin(NcDialect dialect) {
  dialect_ = dialect;
  wrong_.clear();
}

bool ControlCheck::turns_wrong(const char* kind, bool holds) {
  if (!holds) return wrong_.insert(kind).second;
  wrong_.erase(kind);
  return false;
}

void ControlCheck::way(const NcSettings& settings, const NcMotion& motion) {
  if (motion.before == 0) return first_move(settings, motion);
  const bool goes_low = motion.to.z_mm < rule_.safe_z_mm - kSlackMm && (motion.moved & kZBit) != 0;
  if (!goes_low || (motion.known & rule_.axes) == rule_.axes) return;
  std::string unknown;
  for (std::size_t axis = 0; axis < kNcAxes; ++axis)
    if ((rule_.axes >> axis & 1U) != 0 && (motion.known >> axis & 1U) == 0)
      unknown += fmt::format("{}{}", unknown.empty() ? "" : ", ", kNcAxisLetters[axis]);
  findings_.add(
      "unknown_position", motion.place.line,
      fmt::format("Z goes below {} mm while the program does not know where {} is", shortest(rule_.safe_z_mm), unknown),
      motion.to.z_mm, rule_.safe_z_mm);
}

void ControlCheck::first_move(const NcSettings& settings, const NcMotion& motion) {
  const auto ask = [&](const NcNeed& need) {
    if ((settings.said & need.said) == 0)
      findings_.add("setup", motion.place.line,
                    fmt::format("before the first move the program does not say {}: {}", need.words, need.meaning));
  };
  for (const NcNeed& need : needs_of(dialect_)) ask(need);
  if (dialect_ == NcDialect::fanuc && control_.has_rotation)
    ask({nc_said::kRotationOff, "G69", "that coordinates are not turned"});
  if (dialect_ == NcDialect::fanuc && control_.has_mirror)
    ask({nc_said::kMirrorOff, "G50.1", "that coordinates are not mirrored"});
  const double safe_mm = rule_.safe_z_mm;
  if (motion.moved != kZBit || motion.to.z_mm < safe_mm - kSlackMm)
    findings_.add("first_move", motion.place.line,
                  std::isfinite(safe_mm)
                      ? fmt::format("the first move must be of Z alone, to {} mm or higher: nothing is known of where "
                                    "the tool stands",
                                    shortest(safe_mm))
                      : "the first move must be of Z alone: nothing is known of where the tool stands",
                  motion.to.z_mm, std::isfinite(safe_mm) ? safe_mm : 0.0);
}

void ControlCheck::cut(const NcSettings& settings, const NcPlace& place) {
  if (turns_wrong("blending", rule_.may_blend || settings.exact_stop.value_or(false)))
    findings_.add("blending", place.line, "the tool cuts while blocks are blended: corners are rounded");
  if (turns_wrong("mist", !rule_.needs_mist || settings.mist_on.value_or(false)))
    findings_.add("mist", place.line, "the tool cuts without the mist that the process asks for");
  spindle(settings, place);
}

void ControlCheck::spindle(const NcSettings& settings, const NcPlace& place) {
  const SpindleRule& rule = rule_.spindle;
  const NcSpindle is = settings.spindle.value_or(NcSpindle::stopped);
  const double rpm = settings.spindle_rpm.value_or(0.0);
  const bool stands = is == NcSpindle::stopped || is == NcSpindle::stopped_by_text;
  std::string message;
  if (rule.turns == NcSpindle::stopped && !settings.spindle && dialect_ != NcDialect::pmac)
    message = "the program does not say that the spindle stands still";
  else if (rule.turns == NcSpindle::stopped && !stands)
    message = "the spindle turns while the tool cuts";
  else if (rule.turns == NcSpindle::stopped)
    message = "";
  else if (stands)
    message = "the tool feeds while the spindle stands still";
  else if (is != rule.turns)
    message = rule.is_by_text() ? "the spindle is not started by spindle_start" : "the spindle turns the wrong way";
  else if (!rule.is_by_text() && rpm != rule.rpm)
    message = "the spindle turns at another speed";
  if (turns_wrong("spindle", message.empty()))
    findings_.add("spindle", place.line, message, stands ? 0.0 : rpm, rule.rpm);
}

void ControlCheck::spindle_at_end(const NcEnd& end) {
  const auto stopped = rule_.spindle.is_by_text() ? NcSpindle::stopped_by_text : NcSpindle::stopped;
  if (end.settings.spindle != stopped && turns_wrong("spindle", false))
    findings_.add("spindle", end.line, "the program ends without stopping the spindle",
                  end.settings.spindle_rpm.value_or(0.0), rule_.spindle.rpm);
}

void ControlCheck::axes(const Machine& machine, const NcMotion& motion) {
  const char missing = machine.tilt == Tilt::table ? 'B' : 'A';
  if (has_bit(motion.moved, missing))
    findings_.add("axis_unknown", motion.place.line, fmt::format("machine {} has no axis {}", machine.name, missing));
  for (const LimitExcess& excess : limit_excesses(machine, motion.to)) {
    if (!has_bit(motion.known | motion.moved, excess.axis) || is_within_turn(excess)) continue;
    findings_.add("axis_limit", motion.place.line,
                  fmt::format("{} goes to {}, beyond its limits {} to {}", excess.axis, shortest(excess.position),
                              shortest(excess.limits.low), shortest(excess.limits.high)),
                  excess.position, excess.position > excess.limits.high ? excess.limits.high : excess.limits.low);
  }
  if (motion.move == NcMove::linear) axis_speeds(machine, motion);
}

/// An axis that is counted within a turn goes on without end: one of its words for the place must be within the limits.
bool ControlCheck::is_within_turn(const LimitExcess& excess) const {
  constexpr double turn_deg = 360.0;
  if (dialect_ != NcDialect::sinumerik || control_.modulo_axes.find(excess.axis) == std::string::npos) return false;
  const double turns = std::ceil((excess.limits.low - excess.position) / turn_deg);
  return excess.position + turns * turn_deg <= excess.limits.high;
}

/// Each axis takes its share of the feed, which is that of the three together.
void ControlCheck::axis_speeds(const Machine& machine, const NcMotion& motion) {
  const std::array<double, 3> by = {motion.to.x_mm - motion.from.x_mm, motion.to.y_mm - motion.from.y_mm,
                                    motion.to.z_mm - motion.from.z_mm};
  const std::array<const LinearAxis*, 3> linear = {&machine.x, &machine.y, &machine.z};
  const double length_mm = std::hypot(by[0], by[1], by[2]);
  if (length_mm == 0.0) return;
  const double feed = motion.duration_s > 0.0 ? 60.0 * length_mm / motion.duration_s : motion.feed_mm_per_min;
  for (std::size_t axis = 0; axis < by.size(); ++axis) {
    const double speed = feed * std::abs(by[axis]) / length_mm;
    const double most = linear[axis]->max_feed_mm_per_min.value;
    if ((motion.known >> axis & 1U) == 0 || speed <= most * (1.0 + 1e-9)) continue;
    findings_.add("feed_too_high", motion.place.line,
                  fmt::format("{} is fed at {} mm/min, the machine's limit is {}", kNcAxisLetters[axis],
                              shortest(std::round(speed * 1e3) / 1e3), shortest(most)),
                  speed, most);
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

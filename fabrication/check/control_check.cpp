#include "fabrication/check/control_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

constexpr std::uint8_t kZBit = 0b100;
constexpr std::uint8_t kLinearBits = 0b111;
/// Allowance for the rounding errors of floating-point sums, in mm or degrees.
constexpr double kSlack = 1e-9;
/// Maximum tolerance, in mm or degrees, for the rounding of a position in a program. The tolerance is half of the last
/// decimal of the position, but at most this value. Example: half of 1e-4 inch is 1.3e-3 mm.
constexpr double kMaxRounding = 2e-3;
/// Maximum tolerance, relative to the limit, for the rounding of a feed or an inverse time in a program.
constexpr double kMaxRelativeRounding = 1e-3;

constexpr RequiredSetting kRotationNeed = {nc_setting::kRotationOff, "G69",
                                           "to switch off the rotation of coordinates"};
constexpr RequiredSetting kMirrorNeed = {nc_setting::kMirrorOff, "G50.1", "to switch off the mirroring of coordinates"};

bool has_bit(unsigned bits, char axis) {
  return (bits >> kNcAxisLetters.find(axis) & 1U) != 0;
}

}  // namespace

double rounding_slack(const NcMotion& motion, char axis) {
  return kSlack + std::min(kMaxRounding, motion.rounding[kNcAxisLetters.find(axis)]);
}

void ControlCheck::begin(const NcProgram& program) {
  dialect_ = program.dialect;
  dwelled_s_ = 0.0;
  has_moved_ = false;
  known_axes_ = 0;
  wrong_.clear();
  if (program.coordinate_system != 0 && program.coordinate_system != control_.coordinate_system)
    findings_.add(
        "setup", 0,
        fmt::format("the program uses coordinate system {}, but the machine's axes belong to coordinate system {}",
                    program.coordinate_system, control_.coordinate_system),
        program.coordinate_system, control_.coordinate_system);
}

bool ControlCheck::becomes_wrong(const std::string& kind, bool holds) {
  if (!holds) return wrong_.insert(kind).second;
  wrong_.erase(kind);
  return false;
}

void ControlCheck::move(const NcSettings& settings, const NcMotion& motion) {
  if (motion.moved != 0) dwelled_s_ = 0.0;
  z_slack_mm_ = rounding_slack(motion, 'Z');
  const std::uint8_t known = known_axes_;
  known_axes_ = static_cast<std::uint8_t>(known_axes_ | motion.absolute | motion.shortest);
  if (!std::exchange(has_moved_, true)) return first_move(settings, motion);
  const bool goes_low = motion.to.z_mm < rule_.safe_z_mm - z_slack_mm_ && (motion.moved & kZBit) != 0;
  if (!goes_low || (known & rule_.axes) == rule_.axes) return;
  std::string unknown;
  for (std::size_t axis = 0; axis < kNcAxes; ++axis)
    if ((rule_.axes >> axis & 1U) != 0 && (known >> axis & 1U) == 0)
      unknown += fmt::format("{}{}", unknown.empty() ? "" : ", ", kNcAxisLetters[axis]);
  findings_.add(
      "unknown_position", motion.location.line,
      fmt::format("Z goes below {} mm while the position of {} is not known", shortest(rule_.safe_z_mm), unknown),
      motion.to.z_mm, rule_.safe_z_mm);
}

void ControlCheck::first_move(const NcSettings& settings, const NcMotion& motion) {
  const auto ask = [&](const RequiredSetting& need) {
    if ((settings.settings_made & need.setting) == 0)
      findings_.add("setup", motion.location.line,
                    fmt::format("before this move, the program must contain {} {}", need.words, need.meaning));
  };
  for (const RequiredSetting& need : required_settings_of(dialect_)) ask(need);
  if (dialect_ == NcDialect::fanuc && control_.has_rotation) ask(kRotationNeed);
  if (dialect_ == NcDialect::fanuc && control_.has_mirror) ask(kMirrorNeed);
  const double safe_mm = rule_.safe_z_mm;
  if ((motion.absolute | motion.shortest) != kZBit || motion.to.z_mm < safe_mm - z_slack_mm_)
    findings_.add("first_move", motion.location.line,
                  std::isfinite(safe_mm)
                      ? fmt::format("the first move must move only Z, to {} mm or higher, because the position of the "
                                    "tool is not known",
                                    shortest(safe_mm))
                      : "the first move must move only Z, because the position of the tool is not known",
                  motion.to.z_mm, std::isfinite(safe_mm) ? safe_mm : 0.0);
}

void ControlCheck::stop(const NcSettings& settings, const AxisPositions& at, const NcLocation& place) {
  const auto ask = [&](bool holds, std::string message) {
    if (!holds && has_moved_) findings_.add("unsafe_stop", place.line, std::move(message));
  };
  ask((known_axes_ & rule_.axes) == rule_.axes && at.z_mm >= rule_.safe_z_mm - z_slack_mm_,
      fmt::format("the program stops while Z is at {} mm, but Z must be at {} mm or higher", shortest(at.z_mm),
                  shortest(rule_.safe_z_mm)));
  const auto is_at_zero = [](double deg) { return std::abs(std::remainder(deg, 360.0)) < kSlack; };
  ask(is_at_zero(at.a_deg) && is_at_zero(at.b_deg) && is_at_zero(at.c_deg),
      "the program stops while the rotary axes are not at 0; for the operator, they must be at 0");
  ask(!settings.mist_on.value_or(false), "the program stops with the mist on");
  const NcSpindle spindle = settings.spindle.value_or(NcSpindle::stopped);
  ask(spindle == NcSpindle::stopped || spindle == NcSpindle::stopped_by_text,
      "the program stops while the spindle is running");
  has_moved_ = false;
  known_axes_ = 0;
  wrong_.clear();
}

void ControlCheck::cut(const NcSettings& settings, const NcLocation& place) {
  if (becomes_wrong("blending", rule_.may_blend || settings.exact_stop.value_or(false)))
    findings_.add("blending", place.line, "the tool cuts while blocks are blended: corners are rounded");
  if (becomes_wrong("mist", !rule_.needs_mist || settings.mist_on.value_or(false)))
    findings_.add("mist", place.line, "the tool cuts without the mist that the process requires");
  spindle(settings, place);
}

void ControlCheck::state(const NcSettings& settings, const NcLocation& place, bool is_in_material) {
  refuse_option(settings, place, control_.has_rotation, kRotationNeed);
  refuse_option(settings, place, control_.has_mirror, kMirrorNeed);
  if (is_in_material) return cut(settings, place);
  // If the spindle must stand still during cuts, it must not turn between the cuts either.
  if (settings.spindle && rule_.spindle.state == NcSpindle::stopped) spindle(settings, place);
}

/// Adds a finding if the program uses a code of an option that the control does not have, because such a code stops the
/// control with an alarm.
void ControlCheck::refuse_option(const NcSettings& settings, const NcLocation& place, bool is_there,
                                 const RequiredSetting& option) {
  const bool holds = dialect_ != NcDialect::fanuc || is_there || (settings.settings_made & option.setting) == 0;
  if (becomes_wrong(std::string(option.words), holds))
    findings_.add("setup", place.line,
                  fmt::format("the program uses {}, an option that the machine's control does not have", option.words));
}

void ControlCheck::dwell(double seconds, const NcLocation& place) {
  const double most_s = rule_.max_dwell_s * (1.0 + 1e-9);
  const bool was_long = dwelled_s_ > most_s;
  dwelled_s_ += seconds;
  if (was_long || dwelled_s_ <= most_s) return;
  const bool is_stop = std::isinf(seconds);
  findings_.add("dwell_too_long", place.line,
                is_stop ? "the program stops for the operator while the tool is in the material"
                        : fmt::format("the tool dwells in the material for {} s, but at most {} s are allowed",
                                      fixed(dwelled_s_, 3), fixed(rule_.max_dwell_s, 3)),
                is_stop ? 0.0 : dwelled_s_, rule_.max_dwell_s);
}

void ControlCheck::spindle(const NcSettings& settings, const NcLocation& place) {
  const SpindleRule& rule = rule_.spindle;
  const NcSpindle is = settings.spindle.value_or(NcSpindle::stopped);
  const double rpm = settings.spindle_rpm.value_or(0.0);
  const bool stands = is == NcSpindle::stopped || is == NcSpindle::stopped_by_text;
  std::string message;
  if (rule.state == NcSpindle::stopped && !settings.spindle && !has_own_texts(dialect_))
    message = "the program must stop the spindle before the first cut";
  else if (rule.state == NcSpindle::stopped && !stands)
    message = "the spindle is running, but it must be stopped";
  else if (rule.state == NcSpindle::stopped)
    message = "";
  else if (stands)
    message = "the tool moves at a feed while the spindle is stopped";
  else if (is != rule.state)
    message = rule.is_by_text() ? "the spindle is not started by spindle_start"
                                : "the spindle rotates in the wrong direction";
  else if (!rule.is_by_text() && rpm != rule.rpm)
    message = fmt::format("the spindle runs at {} rpm instead of {} rpm", shortest(rpm), shortest(rule.rpm));
  if (becomes_wrong("spindle", message.empty()))
    findings_.add("spindle", place.line, message, stands ? 0.0 : rpm, rule.rpm);
}

void ControlCheck::spindle_at_end(const NcEnd& end) {
  const auto stopped = rule_.spindle.is_by_text() ? NcSpindle::stopped_by_text : NcSpindle::stopped;
  if (end.settings.spindle != stopped && becomes_wrong("spindle", false))
    findings_.add("spindle", end.line, "the program ends without stopping the spindle",
                  end.settings.spindle_rpm.value_or(0.0), rule_.spindle.rpm);
}

void ControlCheck::axes(const Machine& machine, const NcMotion& motion) {
  const char missing = machine.tilt == Tilt::table ? 'B' : 'A';
  if (has_bit(motion.moved, missing))
    findings_.add("axis_unknown", motion.location.line,
                  fmt::format("machine {} has no axis {}", machine.name, missing));
  axis_words(motion);
  for (const LimitExcess& excess : limit_excesses(machine, motion.to)) {
    const double beyond = std::max(excess.limits.low - excess.position, excess.position - excess.limits.high);
    const double limit = excess.position > excess.limits.high ? excess.limits.high : excess.limits.low;
    const bool is_rounding = beyond <= rounding_slack(motion, excess.axis);
    if (!has_bit(motion.known | motion.moved, excess.axis) || is_rounding || is_within_full_turn(excess)) continue;
    findings_.add(
        "axis_limit", motion.location.line,
        fmt::format("{} goes to {}, beyond its limits {} to {}", excess.axis, fixed_apart(excess.position, limit, 3),
                    shortest(excess.limits.low), shortest(excess.limits.high)),
        excess.position, limit);
  }
  if (motion.move != NcMove::linear) return;
  require_feed(motion);
  axis_speeds(machine, motion);
}

/// Adds findings for axis words that the control refuses: more decimals than the increment system of a Fanuc allows,
/// positions of a Sinumerik's modulo axis outside of 0 to 360 degrees, and DC() for an axis that is not a modulo axis.
void ControlCheck::axis_words(const NcMotion& motion) {
  constexpr double turn_deg = 360.0;
  const int decimals = 3 + static_cast<int>(control_.increment_system);
  if (dialect_ == NcDialect::fanuc && motion.decimals > decimals)
    findings_.add("word", motion.location.line,
                  fmt::format("a word has {} decimals, but increment system IS-{} allows {}", motion.decimals,
                              kIncrementSystemWords[static_cast<std::size_t>(control_.increment_system)], decimals),
                  motion.decimals, decimals);
  if (dialect_ != NcDialect::sinumerik) return;
  const std::array<double, kNcAxes> to = {motion.to.x_mm,  motion.to.y_mm,  motion.to.z_mm,
                                          motion.to.a_deg, motion.to.c_deg, motion.to.b_deg};
  for (std::size_t axis = kFirstRotaryAxis; axis < kNcAxes; ++axis) {
    const char letter = kNcAxisLetters[axis];
    const bool is_modulo = control_.modulo_axes.find(letter) != std::string::npos;
    if (is_modulo && has_bit(motion.absolute, letter) && (to[axis] < 0.0 || to[axis] >= turn_deg))
      findings_.add("word", motion.location.line,
                    fmt::format("{} is a modulo axis: a position of {} degrees without DC() causes an alarm", letter,
                                shortest(to[axis])),
                    to[axis], turn_deg);
    if (!is_modulo && has_bit(motion.shortest, letter))
      findings_.add("word", motion.location.line,
                    fmt::format("DC() is used for {}, which is not one of the machine's modulo_axes", letter));
  }
}

/// Returns true if the position of a modulo axis, plus a number of full turns, is within the limits of the axis.
bool ControlCheck::is_within_full_turn(const LimitExcess& excess) const {
  constexpr double turn_deg = 360.0;
  if (dialect_ != NcDialect::sinumerik || control_.modulo_axes.find(excess.axis) == std::string::npos) return false;
  const double turns = std::ceil((excess.limits.low - excess.position) / turn_deg);
  return excess.position + turns * turn_deg <= excess.limits.high;
}

/// Checks the speed of each axis in a move at a feed. The feed is the speed along the path of the linear axes, or along
/// that of the rotary axes if only these axes move. The speed of an axis is its component of the feed. If the start
/// position of an axis is unknown, the axis is assumed to move at the full feed.
void ControlCheck::axis_speeds(const Machine& machine, const NcMotion& motion) {
  const AxisPositions& from = motion.from;
  const AxisPositions& to = motion.to;
  const RotaryPose from_pose = rotary_pose(machine, from);
  const RotaryPose to_pose = rotary_pose(machine, to);
  struct Travel {
    char letter;
    double by;
    double max_per_min;
  };
  const std::array<Travel, 3> linear = {Travel{'X', to.x_mm - from.x_mm, machine.x.max_feed_mm_per_min.value},
                                        Travel{'Y', to.y_mm - from.y_mm, machine.y.max_feed_mm_per_min.value},
                                        Travel{'Z', to.z_mm - from.z_mm, machine.z.max_feed_mm_per_min.value}};
  const std::array<Travel, 2> rotary = {
      Travel{machine.tilt_letter(), to_pose.a_deg - from_pose.a_deg, 60.0 * machine.a.speed_deg_per_s.value},
      Travel{'C', to_pose.c_deg - from_pose.c_deg, 60.0 * machine.c.speed_deg_per_s.value}};
  const auto judge = [&](std::span<const Travel> axes, const char* unit) {
    double length = 0.0;
    for (const Travel& axis : axes) length = std::hypot(length, axis.by);
    for (const Travel& axis : axes) {
      if (!has_bit(motion.moved, axis.letter)) continue;
      const double share = has_bit(motion.known, axis.letter) ? std::abs(axis.by) / length : 1.0;
      const double speed = motion.path_speed_per_min() * share;
      if (!is_too_fast(speed, axis.max_per_min, motion)) continue;
      findings_.add("feed_too_high", motion.location.line,
                    fmt::format("{} moves at {} {}/min, but the machine's limit is {}", axis.letter,
                                fixed_apart(speed, axis.max_per_min, 3), unit, shortest(axis.max_per_min)),
                    speed, axis.max_per_min);
    }
  };
  judge(linear, "mm");
  if ((motion.moved & kLinearBits) == 0) judge(rotary, "degrees");
}

bool ControlCheck::is_too_fast(double speed, double limit, const NcMotion& motion) const {
  return speed * (1.0 - std::min(kMaxRelativeRounding, motion.rate_rounding)) > limit * (1.0 + 1e-9);
}

void ControlCheck::require_feed(const NcMotion& motion) {
  if (motion.feed_mm_per_min <= 0.0 && motion.duration_s <= 0.0)
    findings_.add("zero_feed", motion.location.line, "a move by G1 has no feed");
}

void ControlCheck::feed(const NcMotion& motion, double process_mm_per_min) {
  constexpr double kMinFeedFraction = 0.1;
  const double feed = motion.path_speed_per_min();
  if (feed <= 0.0) return findings_.add("zero_feed", motion.location.line, "a cutting move has no feed");
  const auto find = [&](const char* kind, const char* bound, double limit) {
    findings_.add(kind, motion.location.line,
                  fmt::format("a cut has a feed of {} mm/min, but {} {}", fixed_apart(feed, limit, 3), bound,
                              fixed_visible(limit, 3)),
                  feed, limit);
  };
  if (is_too_fast(feed, process_mm_per_min, motion))
    find("feed_too_high", "the process allows at most", process_mm_per_min);
  if (is_too_fast(kMinFeedFraction * process_mm_per_min, feed, motion))
    find("feed_too_low", "the tool rubs at less than a tenth of the process's feed,",
         kMinFeedFraction * process_mm_per_min);
}

}  // namespace retrace::fabrication

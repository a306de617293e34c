#include "studies/calibration/time_programs.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "fabrication/post/post.h"

namespace retrace::studies {
namespace {

using namespace fabrication;

constexpr double kSecondsPerMinute = 60.0;
constexpr double kTurnDeg = 2.0;

/// Program of moves back and forth along X and Y, or about C and the tilting axis, from the centre of the travel.
class TimeProgram {
 public:
  TimeProgram(std::string name, std::string what, const Machine& machine, std::string_view dialect)
      : increments_(position_increments(dialect, machine.control)) {
    program_.name = std::move(name);
    program_.header = {std::move(what), "Cuts nothing: the time that it takes tells how axes speed up and settle"};
    program_.has_mist = program_.needs_mist = false;
    program_.tilt_letter = machine.tilt_letter();
    program_.control = machine.control;
    AxisWords start{};
    start[kZ] = linear(machine.first_z_mm());
    go(start);
    start = {};
    start[kTilt] = start[kC] = 0;
    go(start);
    start = {};
    start[kX] = linear(middle(machine.x.limits_mm.value));
    start[kY] = linear(middle(machine.y.limits_mm.value));
    go(start);
  }

  /// Adds moves along X and Y in turn, each back and forth.
  void strokes(int times, double length_mm, std::optional<double> feed_mm_per_min) {
    const Nanometres length = linear(length_mm);
    for (int k = 0; k < times; ++k) {
      const Axis axis = k / 2 % 2 == 0 ? kX : kY;
      AxisWords to{};
      to[axis] = *at_[axis] + (k % 2 == 0 ? length : -length);
      go(to, feed_mm_per_min);
    }
  }

  /// Adds rotations about C and the tilting axis in turn, each back and forth.
  void turns(int times, double tilt_deg, double c_deg) {
    for (int k = 0; k < times; ++k) {
      const Axis axis = k / 2 % 2 == 0 ? kC : kTilt;
      AxisWords to{};
      to[axis] =
          k % 2 == 0 ? to_step((axis == kC ? c_deg : tilt_deg) * kRotaryUnitsPerDeg, increments_.rotary_units) : 0;
      go(to);
    }
  }

  Program take() { return std::move(program_); }

 private:
  static double middle(const Interval& limits) { return 0.5 * (limits.low + limits.high); }
  Nanometres linear(double mm) const { return to_step(mm * kNanometresPerMm, increments_.linear_nm); }

  void go(const AxisWords& to, std::optional<double> feed_mm_per_min = std::nullopt) {
    Move move;
    move.to = to;
    if (feed_mm_per_min) {
      move.motion = Motion::translate;
      move.feed_mm_per_min = *feed_mm_per_min;
    }
    program_.items.emplace_back(move);
    go_to(at_, to);
  }

  Increments increments_;
  Program program_;
  AxisWords at_{};
};

double quarter(const Interval& limits) {
  return 0.25 * (limits.high - limits.low);
}

/// Returns half of the limit that is farther from 0, with its sign.
double half_way_deg(const RotaryAxis& axis) {
  const Interval& limits = axis.limits_deg.value;
  return 0.5 * (limits.high > -limits.low ? limits.high : limits.low);
}

}  // namespace

std::vector<Program> time_programs(const Machine& machine, std::string_view dialect) {
  const double most_mm = std::min(quarter(machine.x.limits_mm.value), quarter(machine.y.limits_mm.value));
  const double rapid_mm_per_s =
      std::min(machine.x.rapid_mm_per_min.value, machine.y.rapid_mm_per_min.value) / kSecondsPerMinute;
  const double acceleration = std::min(machine.x.acceleration_mm_per_s2.value, machine.y.acceleration_mm_per_s2.value);
  // Shortest distance in which an axis reaches its rapid speed and stops again.
  const double to_speed_mm = rapid_mm_per_s * rapid_mm_per_s / acceleration;

  TimeProgram steps("times-steps", "Short moves at a low feed", machine, dialect);
  constexpr double kStepMm = 0.01;
  constexpr double kStepFeed = 60.0;
  steps.strokes(2000, kStepMm,
                std::min({kStepFeed, machine.x.max_feed_mm_per_min.value, machine.y.max_feed_mm_per_min.value}));
  TimeProgram strokes("times-strokes", "Rapid moves too short for the rapid speed", machine, dialect);
  strokes.strokes(2000, std::min(0.3 * to_speed_mm, most_mm), std::nullopt);
  TimeProgram ways("times-ways", "Rapid moves that reach the rapid speed", machine, dialect);
  ways.strokes(400, std::min(4.0 * to_speed_mm, most_mm), std::nullopt);
  TimeProgram turns("times-turns", "Turns of the rotary axes", machine, dialect);
  const auto turn_deg = [](const RotaryAxis& axis) { return std::clamp(half_way_deg(axis), -kTurnDeg, kTurnDeg); };
  turns.turns(100, turn_deg(machine.a), turn_deg(machine.c));
  return {steps.take(), strokes.take(), ways.take(), turns.take()};
}

}  // namespace retrace::studies

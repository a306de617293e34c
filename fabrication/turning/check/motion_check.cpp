#include "fabrication/turning/check/motion_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/angle.h"
#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

/// Maximum rounding errors of lengths and times in programs: half of the last decimal. For times, the value of the
/// coarsest dialect is used.
constexpr double kHalfWordMm = 0.5e-6;
constexpr double kHalfWordS = 0.5e-9;
constexpr double kDegreesPerTurn = 360.0;

double half_word_deg(NcDialect dialect) {
  return dialect == NcDialect::fanuc ? 0.5e-6 : 0.5e-7;
}

/// Measured value, and its maximum error due to rounding.
struct Figure {
  double value = 0.0;
  double doubt = 0.0;

  /// Returns the part of the absolute value that cannot be caused by rounding.
  double sure() const { return std::max(0.0, std::abs(value) - doubt); }
};

/// Tracks the largest excess above a limit along the cuts of a program.
class Worst {
 public:
  explicit Worst(const std::optional<double>& limit) : limit_(limit) {}

  void add(const Figure& figure, std::int32_t line) {
    max_ = std::max(max_, figure.sure());
    if (!limit_ || figure.sure() <= *limit_ * (1.0 + 1e-9)) return;
    ++count_;
    if (figure.sure() <= excess_) return;
    excess_ = figure.sure();
    line_ = line;
  }
  double most() const { return max_; }

  void report(FindingList& findings, const char* kind, const std::string& program, const std::string& what,
              const char* unit, const char* whose) const {
    if (count_ == 0) return;
    Finding finding{kind, program, line_, -1, "", excess_, *limit_, count_};
    finding.message = fmt::format("{} of {} {} exceeds the {} limit of {}", what, fixed_apart(excess_, *limit_, 4),
                                  unit, whose, shortest(*limit_));
    findings.add(std::move(finding));
  }

 private:
  std::optional<double> limit_;
  double max_ = 0.0;
  double excess_ = 0.0;
  std::int32_t line_ = 0;
  std::int64_t count_ = 0;
};

/// Returns, for each point of a pass, the duration of the block that contains the point or ends there.
std::vector<double> whole_blocks_s(const CutPass& pass) {
  std::vector<double> seconds = pass.block_s;
  for (std::size_t i = seconds.size(); i-- > 1;)
    if (seconds[i] == 0.0 && i + 1 < seconds.size()) seconds[i] = seconds[i + 1];
  return seconds;
}

/// Returns true if a pass has points inside of blocks, whose duration is stored as 0. Only cubic moves have such
/// points. The first point of a pass, before all blocks, also has the duration 0 and does not count.
bool has_cubics(const CutPass& pass) {
  return std::count(pass.block_s.begin(), pass.block_s.end(), 0.0) > 1;
}

/// Returns a pass with only the ends of blocks. The acceleration of cubic moves may have steps at these points.
CutPass block_ends(const CutPass& pass) {
  CutPass ends;
  ends.program = pass.program;
  for (std::size_t i = 0; i < pass.size(); ++i) {
    if (i > 0 && pass.block_s[i] == 0.0) continue;
    ends.x_mm.push_back(pass.x_mm[i]);
    ends.y_mm.push_back(pass.y_mm[i]);
    ends.z_mm.push_back(pass.z_mm[i]);
    ends.c_rad.push_back(pass.c_rad[i]);
    ends.duration_s.push_back(pass.block_s[i]);
    ends.block_s.push_back(pass.block_s[i]);
    ends.line.push_back(pass.line[i]);
    if (!pass.servo_mm.empty()) ends.servo_mm.push_back(pass.servo_mm[i]);
  }
  return ends;
}

/// Computes difference quotients of a position over the blocks of a pass. The index of a velocity is that of the point
/// at the end of the block. The index of an acceleration or a jerk is that of the node (point) between two blocks.
class Quotients {
 public:
  Quotients(const CutPass& pass, const std::function<double(std::size_t)>& position, double half_word)
      : pass_(pass), block_s_(whole_blocks_s(pass)), velocity_(pass.size()), noise_(pass.size(), 0.0) {
    for (std::size_t i = 1; i < pass.size(); ++i) {
      const double dt = pass.duration_s[i];
      if (!(dt > 0.0)) continue;
      const double v = (position(i) - position(i - 1)) / dt;
      // Rounding of the end points changes the velocity of a straight move by the difference of their rounding errors
      // divided by the duration. At half the duration of a cubic move, the change is 1.5 times as large. The
      // acceleration of the cubic move changes by 6 times the difference divided by the squared duration.
      const double most = dt < block_s_[i] ? 3.0 : 1.0;
      velocity_[i] = {v, (most * 2.0 * half_word + std::abs(v) * kHalfWordS) / block_s_[i]};
      noise_[i] = 4.0 * std::numeric_limits<double>::epsilon() * std::abs(position(i)) / dt;
    }
  }

  Figure velocity(std::size_t block) const { return {velocity_[block].value, velocity_[block].doubt + noise_[block]}; }

  /// Returns the acceleration at node i, from the velocities of the blocks before and after it. A pass starts and ends
  /// at rest.
  Figure acceleration(std::size_t i) const {
    const Figure before = i > 0 ? velocity_[i] : Figure{};
    const Figure after = i + 1 < pass_.size() ? velocity_[i + 1] : Figure{};
    const double s = (i > 0 ? pass_.duration_s[i] : 0.0) + (i + 1 < pass_.size() ? pass_.duration_s[i + 1] : 0.0);
    if (!(s > 0.0)) return {};
    const double blocks_s = (i > 0 ? block_s_[i] : 0.0) + (i + 1 < pass_.size() ? block_s_[i + 1] : 0.0);
    const double noise = (i > 0 ? noise_[i] : 0.0) + (i + 1 < pass_.size() ? noise_[i + 1] : 0.0);
    return {2.0 * (after.value - before.value) / s, 2.0 * (after.doubt + before.doubt) / blocks_s + 2.0 * noise / s};
  }

  /// Returns the jerk at node i, from the accelerations at the neighbouring nodes.
  /// \pre 2 <= i < size - 2
  Figure jerk(std::size_t i) const {
    const Figure before = acceleration(i - 1);
    const Figure after = acceleration(i + 1);
    const double s = pass_.duration_s[i] + pass_.duration_s[i + 1];
    if (!(s > 0.0)) return {};
    return {(after.value - before.value) / s, (after.doubt + before.doubt) / s};
  }

 private:
  const CutPass& pass_;
  std::vector<double> block_s_;
  std::vector<Figure> velocity_;  ///< velocities with their error due to rounded numbers in the program
  std::vector<double> noise_;     ///< errors of the velocities due to double precision
};

/// Calls `use` for each pass of one program.
template <class Use>
void for_passes(const TurningCuts& cuts, std::size_t program, const Use& use) {
  for (const CutPass& pass : cuts.passes)
    if (pass.program == program) use(pass);
}

double position_of(const CutPass& pass, std::size_t axis, std::size_t i) {
  switch (axis) {
    case 0: return pass.x_mm[i];
    case 1: return pass.y_mm[i];
    case 2: return pass.servo_mm.empty() ? pass.z_mm[i] : pass.z_mm[i] - pass.servo_mm[i];
    default: return pass.servo_mm.empty() ? 0.0 : pass.servo_mm[i];
  }
}

void check_axis(const AxisLimits& limits, std::size_t axis, const TurningCuts& cuts, std::size_t program,
                AxisMotion& motion, FindingList& findings) {
  static constexpr const char* kNames[] = {"X", "Y", "Z", "servo"};
  Worst speed(limits.speed_mm_per_s);
  Worst acceleration(limits.acceleration_mm_per_s2);
  Worst jerk(limits.jerk_mm_per_s3);
  for_passes(cuts, program, [&](const CutPass& pass) {
    const Quotients q(
        pass, [&](std::size_t i) { return position_of(pass, axis, i); }, kHalfWordMm);
    for (std::size_t i = 1; i < pass.size(); ++i) {
      speed.add(q.velocity(i), pass.line[i]);
      if (i + 1 < pass.size()) acceleration.add(q.acceleration(i), pass.line[i + 1]);
    }
    const auto add_jerk = [&](const CutPass& nodes, const Quotients& of_nodes) {
      for (std::size_t i = 2; i + 2 < nodes.size(); ++i) jerk.add(of_nodes.jerk(i), nodes.line[i + 1]);
    };
    if (!has_cubics(pass)) return add_jerk(pass, q);
    const CutPass ends = block_ends(pass);
    add_jerk(ends, Quotients(
                       ends, [&](std::size_t i) { return position_of(ends, axis, i); }, kHalfWordMm));
  });
  motion.speed_mm_per_s = std::max(motion.speed_mm_per_s, speed.most());
  motion.acceleration_mm_per_s2 = std::max(motion.acceleration_mm_per_s2, acceleration.most());
  motion.jerk_mm_per_s3 = std::max(motion.jerk_mm_per_s3, jerk.most());
  const std::string name = kNames[axis];
  const std::string& file = cuts.programs[program];
  speed.report(findings, "axis_speed", file, name + ": speed", "mm/s", "machine's");
  acceleration.report(findings, "axis_acceleration", file, name + ": acceleration", "mm/s^2", "machine's");
  jerk.report(findings, "axis_jerk", file, name + ": jerk", "mm/s^3", "machine's");
}

/// Checks the stroke of a fast tool servo.
void check_stroke(const AxisLimits& limits, const TurningCuts& cuts, AxisMotion& motion, FindingList& findings) {
  bool is_first = true;
  for (const CutPass& pass : cuts.passes)
    for (const double stroke : pass.servo_mm) {
      motion.low_mm = is_first ? stroke : std::min(motion.low_mm, stroke);
      motion.high_mm = is_first ? stroke : std::max(motion.high_mm, stroke);
      is_first = false;
    }
  for (const auto& [limit, at, sign] :
       {std::tuple{limits.low_mm, motion.low_mm, -1.0}, {limits.high_mm, motion.high_mm, 1.0}})
    if (limit && sign * (at - *limit) > kHalfWordMm)
      findings.add("axis_limit", 0, fmt::format("servo: travels to {} mm, beyond the machine's limits", fixed(at, 4)),
                   at, *limit);
}

void check_spindle(const TurnedPart& part, const TurningCuts& cuts, std::size_t program, MotionFigures& figures,
                   FindingList& findings) {
  const auto deg_per_s = [](const std::optional<double>& rpm) -> std::optional<double> {
    if (!rpm) return std::nullopt;
    return *rpm * kDegreesPerTurn / 60.0;
  };
  const bool is_spiral = part.path.strategy == Strategy::spiral;
  const std::optional<double> asked = is_spiral ? std::optional(part.path.spindle_rpm) : std::nullopt;
  Worst by_machine(deg_per_s(part.machine.spindle_rpm));
  Worst by_path(deg_per_s(asked));
  Worst acceleration(part.machine.c_acceleration_deg_per_s2);
  for_passes(cuts, program, [&](const CutPass& pass) {
    const Quotients q(
        pass, [&](std::size_t i) { return pass.c_rad[i] / kRadPerDeg; }, half_word_deg(cuts.dialects[program]));
    for (std::size_t i = 0; i < pass.size(); ++i) {
      const std::int32_t line = pass.line[std::min(i + 1, pass.size() - 1)];
      if (i > 0) by_machine.add(q.velocity(i), pass.line[i]);
      if (i > 0) by_path.add(q.velocity(i), pass.line[i]);
      acceleration.add(q.acceleration(i), line);
    }
  });
  figures.spindle_rpm = std::max(figures.spindle_rpm, by_path.most() * 60.0 / kDegreesPerTurn);
  figures.c_acceleration_deg_per_s2 = std::max(figures.c_acceleration_deg_per_s2, acceleration.most());
  const std::string& file = cuts.programs[program];
  by_machine.report(findings, "axis_speed", file, "C: speed", "deg/s", "machine's");
  by_path.report(findings, "feed_too_high", file, "C: speed", "deg/s", "path's");
  acceleration.report(findings, "axis_acceleration", file, "C: acceleration", "deg/s^2", "machine's");
}

void check_blocks(const TurnedPart& part, const TurningCuts& cuts, std::size_t program, MotionFigures& figures,
                  FindingList& findings) {
  const bool is_raster = part.path.strategy == Strategy::raster;
  Worst rate(part.machine.blocks_per_s);
  Worst feed(is_raster ? std::optional(part.path.cutting_mm_per_min) : std::nullopt);
  for_passes(cuts, program, [&](const CutPass& pass) {
    for (std::size_t i = 1; i < pass.size(); ++i) {
      const double dt = pass.duration_s[i];
      if (!(dt > 0.0)) continue;
      figures.time_s += dt;
      const double block_s = pass.block_s[i];
      if (block_s > 0.0) rate.add({1.0 / block_s, kHalfWordS / (block_s * block_s)}, pass.line[i]);
      const double way = std::hypot(pass.x_mm[i] - pass.x_mm[i - 1], pass.y_mm[i] - pass.y_mm[i - 1]);
      feed.add({60.0 * way / dt, 60.0 * (3.0 * kHalfWordMm + way * kHalfWordS / dt) / dt}, pass.line[i]);
    }
  });
  figures.blocks_per_s = std::max(figures.blocks_per_s, rate.most());
  rate.report(findings, "block_rate", cuts.programs[program], "a rate", "blocks/s", "machine's");
  feed.report(findings, "feed_too_high", cuts.programs[program], "a feed along the line", "mm/min", "path's");
}

}  // namespace

MotionFigures check_motion(const TurnedPart& part, const TurningCuts& cuts, FindingList& findings) {
  MotionFigures figures;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    figures.axes[axis].low_mm = cuts.lowest_travel_mm[axis];
    figures.axes[axis].high_mm = cuts.highest_travel_mm[axis];
  }
  const bool has_servo = part.path.servo == Servo::fast;
  if (has_servo) check_stroke(part.machine.servo, cuts, figures.axes[3], findings);
  for (std::size_t program = 0; program < cuts.programs.size(); ++program) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      check_axis(part.machine.axes[axis], axis, cuts, program, figures.axes[axis], findings);
    if (has_servo) check_axis(part.machine.servo, 3, cuts, program, figures.axes[3], findings);
    check_spindle(part, cuts, program, figures, findings);
    check_blocks(part, cuts, program, figures, findings);
  }
  return figures;
}

}  // namespace retrace::fabrication::turning

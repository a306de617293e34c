#include "fabrication/turning/check/cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/angle.h"
#include "core/csv.h"
#include "core/number_format.h"
#include "fabrication/check/control_check.h"
#include "fabrication/check/known_axes.h"

namespace retrace::fabrication::turning {
namespace {

constexpr std::uint8_t kAxesXyzc = 0b10111;
constexpr std::uint8_t kXyc = 0b10011;
/// Value of the last decimal of X, Y and Z positions, in mm.
constexpr double kWordMm = 1e-6;

ControlRule rule_of_c_axis() {
  ControlRule rule;
  rule.axes = kAxesXyzc;
  rule.max_dwell_s = 0.0;
  return rule;
}

/// Reads the cuts of programs, one after the other.
class CutReader : public NcSink {
 public:
  CutReader(const TurnedPart& part, FindingList& findings)
      : part_(part), findings_(findings), control_(findings, rule_of_c_axis()), known_(findings, kAxesXyzc) {}

  void follow(const NcProgram& program) {
    cuts_.programs.push_back(program.file);
    cuts_.dialects.push_back(program.dialect);
    cuts_.end_mm.push_back(0.0);
    findings_.begin(program.file);
    control_.begin(program);
    has_soft_start_ = has_free_path_ = is_down_ = false;
    CutRecorder recorder;
    recorder_ = &recorder;
    const NcEnd end = run_nc(program, *this);
    if (end.settings.spindle) control_.spindle_at_end(end);
    if (!end.is_complete) findings_.add("truncated", end.line, end.reason);
    for (const Finding& f : recorder.findings()) findings_.add(f.kind, f.line, f.message);
    for (CutPass& pass : recorder.take()) {
      pass.program = cuts_.programs.size() - 1;
      cuts_.passes.push_back(std::move(pass));
    }
    find_travel();
  }

  void motion(const NcMotion& motion, const NcSettings& settings) override {
    known_.motion(motion);
    check_state(motion, settings);
    follow_travel(motion);
    cuts_.end_mm.back() = motion.to.z_mm;
    const bool moves_z_alone = (motion.moved & kXyc) == 0;
    is_down_ = motion.move == NcMove::linear;
    if (motion.move == NcMove::rapid) {
      is_cutting_ = false;
      const bool is_z_known = (motion.known & 4U) != 0;
      const double from_z = is_z_known ? motion.from.z_mm : motion.to.z_mm;
      if (!moves_z_alone || motion.to.z_mm < from_z || !is_z_known)
        cuts_.free_moves.push_back({std::min(from_z, motion.to.z_mm), cuts_.programs.size() - 1, motion.location.line});
    } else {
      check_cut(motion, moves_z_alone && !is_cutting_);
    }
    recorder_->motion(motion, settings);
  }

  void dwell(double seconds, const NcLocation& place, const AxisPositions&) override {
    if (is_down_) control_.dwell(seconds, place);
  }

  void state(const NcSettings& settings, const NcLocation& place) override {
    // Cuts are paths without stops. check_state() checks exact stops for each move, so the check of exact stops is
    // disabled here.
    NcSettings asked = settings;
    asked.exact_stop = true;
    control_.state(asked, place, is_down_);
  }

  void stop(NcStop, const NcSettings&, const NcLocation& place) override {
    if (is_down_) control_.dwell(std::numeric_limits<double>::infinity(), place);
  }

  TurningCuts take() { return std::move(cuts_); }

 private:
  void check_state(const NcMotion& motion, const NcSettings& settings) {
    control_.move(settings, motion);
    // Cuts are paths without stops. The check of exact stops is disabled for timed moves and rapid moves.
    NcSettings asked = settings;
    if (motion.duration_s > 0.0 || motion.move == NcMove::rapid) asked.exact_stop = true;
    control_.cut(asked, motion.location);
    if (motion.duration_s > 0.0 && !motion.is_exact_stop)
      cuts_.blend_mm = std::max(cuts_.blend_mm, settings.blend_mm.value_or(0.0));
    const bool is_free = cuts_.dialects.back() == NcDialect::rs274ngc && motion.duration_s > 0.0 &&
                         !motion.is_exact_stop && !settings.blend_mm;
    if (is_free && !std::exchange(has_free_path_, true))
      findings_.add("blending", motion.location.line,
                    "G64 without P allows any distance between the tool and the path between blocks");
  }

  void check_cut(const NcMotion& motion, bool is_approach) {
    is_cutting_ = !is_approach;
    if (!is_approach) return;
    cuts_.down_moves.push_back({motion.to, 0.0, cuts_.programs.size() - 1, motion.location.line});
    if (motion.duration_s == 0.0 || motion.path_speed_per_min() > 0.0)
      control_.feed(motion, part_.path.approach_mm_per_min);
    if (!motion.is_exact_stop && !std::exchange(has_soft_start_, true))
      findings_.add("setup", motion.location.line, "the tool moves down to the start of the cut without an exact stop");
  }

  void follow_travel(const NcMotion& motion) {
    const double to[] = {motion.to.x_mm, motion.to.y_mm, motion.to.z_mm};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (((motion.known | motion.moved) >> axis & 1U) == 0) continue;
      const bool is_first = !std::exchange(is_placed_[axis], true);
      double& low = cuts_.lowest_travel_mm[axis];
      double& high = cuts_.highest_travel_mm[axis];
      low = is_first ? to[axis] : std::min(low, to[axis]);
      high = is_first ? to[axis] : std::max(high, to[axis]);
      const AxisLimits& limits = part_.machine.axes[axis];
      const double below = limits.low_mm ? *limits.low_mm - to[axis] : 0.0;
      const double above = limits.high_mm ? to[axis] - *limits.high_mm : 0.0;
      Excess& worst = excess_[axis];
      if (std::max(below, above) <= kWordMm) continue;
      ++worst.count;
      if (std::max(below, above) <= worst.by_mm) continue;
      worst.by_mm = std::max(below, above);
      worst.at_mm = to[axis];
      worst.limit_mm = below > above ? *limits.low_mm : *limits.high_mm;
      worst.line = motion.location.line;
    }
  }

  void find_travel() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Excess worst = std::exchange(excess_[axis], {});
      if (worst.count == 0) continue;
      Finding finding{"axis_limit", cuts_.programs.back(), worst.line,     -1,
                      "",           worst.at_mm,           worst.limit_mm, worst.count};
      finding.message =
          fmt::format("{}: travels to {} mm, beyond the machine's limits", "XYZ"[axis], fixed(worst.at_mm, 4));
      findings_.add(std::move(finding));
    }
  }

  struct Excess {
    double by_mm = 0.0;
    double at_mm = 0.0;
    double limit_mm = 0.0;
    std::int32_t line = 0;
    std::int64_t count = 0;
  };

  const TurnedPart& part_;
  FindingList& findings_;
  ControlCheck control_;
  KnownAxes known_;
  TurningCuts cuts_;
  CutRecorder* recorder_ = nullptr;
  bool is_placed_[3] = {false, false, false};
  Excess excess_[3];
  bool is_cutting_ = false;
  bool is_down_ = false;  ///< true if there was a move at a feed since the last rapid move
  bool has_soft_start_ = false;
  bool has_free_path_ = false;
};

bool begins_at(const CutPass& pass, const DownMove& move) {
  return pass.program == move.program && pass.x_mm.front() == move.at.x_mm && pass.y_mm.front() == move.at.y_mm &&
         pass.c_rad.front() == move.at.c_deg * kRadPerDeg;
}

}  // namespace

TurningCuts read_cuts(const TurnedPart& part, const std::vector<NcProgram>& programs, FindingList& findings) {
  CutReader reader(part, findings);
  for (const NcProgram& program : programs) reader.follow(program);
  findings.begin("");
  return reader.take();
}

void add_strokes(TurningCuts& cuts, const std::string& table, const std::string& file, FindingList& findings) {
  constexpr double kSameDeg = 2e-6;  // tolerance for angles that are rounded to six or more decimals
  struct Stroke {
    double c_deg;
    double stroke_mm;
    int line;
  };
  static constexpr std::string_view kColumns[] = {"c_deg", "stroke_mm"};
  std::vector<Stroke> strokes;
  CsvReader reader(table, file, table.size(), kColumns);
  while (reader.next()) strokes.push_back({reader.number(0), reader.number(1), reader.line()});
  std::size_t row = 0;
  bool fits = true;
  for (CutPass& pass : cuts.passes) {
    pass.servo_mm.assign(pass.size(), 0.0);
    for (std::size_t i = 0; i < pass.size(); ++i, ++row) {
      if (row >= strokes.size()) continue;
      const Stroke& stroke = strokes[row];
      const double c_deg = pass.c_rad[i] / kRadPerDeg;
      if (std::abs(stroke.c_deg - c_deg) > kSameDeg && std::exchange(fits, false))
        findings.add({"servo", cuts.programs[pass.program], pass.line[i], -1,
                      fmt::format("line {} of the servo's file has a stroke for C {}, but the program moves to C {}",
                                  stroke.line, shortest(stroke.c_deg), fixed(c_deg, 7)),
                      c_deg, stroke.c_deg, 1});
      pass.servo_mm[i] = stroke.stroke_mm;
      pass.z_mm[i] += stroke.stroke_mm;
    }
    for (DownMove& move : cuts.down_moves)
      if (begins_at(pass, move)) move.stroke_mm = pass.servo_mm.front();
  }
  if (row != strokes.size())
    findings.add("servo", 0, "the servo's file must have one stroke for every point of the program");
}

}  // namespace retrace::fabrication::turning

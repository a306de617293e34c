#include "fabrication/planing/check/mill_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/number_format.h"

namespace retrace::fabrication {
namespace {

constexpr double kRoundingMm = 1e-7;
constexpr const char* kLetters = "XYZ";
constexpr std::uint8_t kAxes = 0b111;

/// Returns the requirements on the programs. The mill planes in rapid moves, so each rapid move may be a cut.
ControlRule rule_of(const PlaningMill& mill) {
  ControlRule rule;
  rule.axes = kAxes;
  rule.safe_z_mm = mill.clearance_mm - kRoundingMm;
  return rule;
}

std::array<double, 3> linear(const AxisPositions& at) {
  return {at.x_mm, at.y_mm, at.z_mm};
}

}  // namespace

MillCheck::MillCheck(const PlanedPart& part, FindingList& findings, PlaningCheck& result)
    : part_(part),
      profile_(part.lens),
      findings_(findings),
      result_(result),
      control_(findings, rule_of(*part.mill)),
      known_(findings, kAxes) {
  result_.flank_slope = flank_slope_of(profile_, part.lens.half_width_mm);
}

void MillCheck::begin(const NcProgram& program) {
  programs_.push_back(program.file);
  std::fill(std::begin(has_position_), std::end(has_position_), false);
  height_mm_ = 0.0;
  control_.begin(program);
}

void MillCheck::check_length(const NcMotion& motion, std::size_t axis, double length_mm) {
  const std::array least = {part_.mill->min_move_x_mm, part_.mill->min_move_y_mm, part_.mill->min_move_z_mm};
  double& shortest_mm = axis == 0 ? result_.shortest_x_mm : axis == 1 ? result_.shortest_y_mm : result_.shortest_z_mm;
  if (shortest_mm == 0.0 || length_mm < shortest_mm) shortest_mm = length_mm;
  if (length_mm < least[axis] - kRoundingMm)
    findings_.add("short_move", motion.location.line,
                  fmt::format("a move of {} is shorter than the minimum move of fast feed", kLetters[axis]), length_mm,
                  least[axis]);
}

void MillCheck::check_grid(const NcMotion& motion, std::size_t axis, double position_mm) {
  const double off_mm = std::abs(std::remainder(position_mm, part_.mill->grid_mm));
  result_.off_grid_nm_max = std::max(result_.off_grid_nm_max, 1e6 * off_mm);
  if (off_mm > kRoundingMm)
    findings_.add("off_grid", motion.location.line,
                  fmt::format("{} is at a position that is not on the machine's grid", kLetters[axis]), off_mm, 0.0);
}

/// Checks that the tool does not move across or down while it is in the part, and stores the strokes (cutting moves
/// along the zones).
void MillCheck::check_position(const NcMotion& motion, std::size_t axis) {
  const double lowest = std::min(motion.from.z_mm, motion.to.z_mm);
  const bool is_beside = motion.to.y_mm < 0.0 || motion.to.y_mm > part_.length_mm;
  if (axis == 1) {
    if (!is_beside && lowest < 0.0)
      findings_.add("ends_in_part", motion.location.line, "a stroke ends within the part", motion.to.y_mm,
                    part_.length_mm);
    const bool is_through = std::min(motion.from.y_mm, motion.to.y_mm) < 0.0 &&
                            std::max(motion.from.y_mm, motion.to.y_mm) > part_.length_mm;
    if (is_through && lowest < 0.0)
      strokes_.push_back({motion.to.x_mm, -lowest, programs_.size() - 1, motion.location.line});
  } else if (!is_beside && lowest < 0.0) {
    findings_.add("moves_in_part", motion.location.line,
                  fmt::format("{} moves while the tool is in the part", kLetters[axis]), lowest, 0.0);
  }
}

void MillCheck::motion(const NcMotion& motion, const NcSettings& settings) {
  control_.move(settings, motion);
  control_.cut(settings, motion.location);
  known_.motion(motion);
  height_mm_ = motion.to.z_mm;
  const std::array from = linear(motion.from);
  const std::array to = linear(motion.to);
  std::size_t moved = 0;
  double length_mm = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_known = ((motion.known >> axis) & 1U) != 0;
    if (!is_known && ((motion.moved >> axis) & 1U) == 0) continue;
    low_mm_[axis] = has_position_[axis] ? std::min(low_mm_[axis], to[axis]) : to[axis];
    high_mm_[axis] = has_position_[axis] ? std::max(high_mm_[axis], to[axis]) : to[axis];
    has_position_[axis] = true;
    check_grid(motion, axis, to[axis]);
    if (!is_known || from[axis] == to[axis]) continue;
    ++moved;
    length_mm += std::abs(to[axis] - from[axis]);
    check_length(motion, axis, std::abs(to[axis] - from[axis]));
    check_position(motion, axis);
  }
  if (moved == 0) return;
  if (moved > 1)
    findings_.add("several_axes", motion.location.line, "several axes move at the same time",
                  static_cast<double>(moved), 1.0);
  if (motion.move != NcMove::rapid)
    findings_.add("not_fast", motion.location.line, "the tool must plane in fast feed (rapid moves) only",
                  motion.feed_mm_per_min, 0.0);
  ++result_.frames.back();
  result_.time_s.back() += length_mm / part_.mill->fast_feed_mm_per_min * 60.0 + part_.mill->frame_s;
}

void MillCheck::end(const NcEnd& end) {
  if (end.settings.spindle) control_.spindle_at_end(end);
  const std::array travel = {part_.mill->travel_x_mm, part_.mill->travel_y_mm, part_.mill->travel_z_mm};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (high_mm_[axis] - low_mm_[axis] > travel[axis] + kRoundingMm)
      findings_.add("travel", 0, fmt::format("the travel of {} exceeds that of the machine", kLetters[axis]),
                    high_mm_[axis] - low_mm_[axis], travel[axis]);
  if (height_mm_ < part_.mill->clearance_mm - kRoundingMm)
    findings_.add("ends_low", 0, "the program ends with the tool below clear_mm", height_mm_, part_.mill->clearance_mm);
  const double hours = result_.time_s.back() / 3600.0;
  if (hours > part_.mill->max_hours + 1e-9)
    findings_.add("too_long", 0, fmt::format("the program runs for {} hours", fixed(hours, 3)), hours,
                  part_.mill->max_hours);
}

void MillCheck::measure_at(double x_mm, double left_mm, const Stroke* stroke) {
  const double place_mm = std::abs(x_mm);
  const double design_mm = profile_.depth_mm(place_mm);
  // Close to a wall, a point may belong to either side of the wall. Points within one step of the grid from a wall are
  // therefore not compared with the design.
  const double near_mm = part_.mill->grid_mm;
  double standing = std::max(0.0, design_mm - left_mm);
  double gouge = std::max(0.0, left_mm - design_mm);
  for (const Wall& wall : profile_.walls())
    if (std::abs(place_mm - wall.x_mm) <= near_mm) standing = gouge = 0.0;
  // The other half of the lens is planed after the part has been rotated. Material that remains there is therefore not
  // an error.
  if (x_mm < 0.0 || x_mm > part_.lens.half_width_mm - near_mm) standing = 0.0;
  result_.excess_mm_max = std::max(result_.excess_mm_max, standing);
  result_.gouge_mm_max = std::max(result_.gouge_mm_max, gouge);
  if (x_mm >= 0.0) result_.profile.push_back({x_mm, design_mm, left_mm});
  if (stroke != nullptr && gouge > part_.tolerance_mm + kRoundingMm)
    findings_.add({"gouge", programs_[stroke->program], stroke->line, -1, "a stroke goes below the design", gouge,
                   part_.tolerance_mm, 1});
}

void MillCheck::measure() {
  std::sort(strokes_.begin(), strokes_.end(), [](const Stroke& a, const Stroke& b) { return a.x_mm < b.x_mm; });
  // Evaluate the surface on both sides of each grid point, from the largest to the smallest x. The surface at x is cut
  // by the flank of one of the strokes at or beyond x. It is the stroke with the greatest value of d - slope * p, where
  // p is the position and d the depth of the stroke. All strokes are at grid points, and most material remains just
  // outside of a stroke. The evaluated points are therefore at the distance kBeside, in mm, from the grid points.
  constexpr double kBeside = 1e-9;
  const double grid = part_.mill->grid_mm;
  const double slope = result_.flank_slope;
  double deepest = -1e300;
  const Stroke* of = nullptr;
  auto next = strokes_.rbegin();
  const auto last = 2 * static_cast<std::int64_t>(part_.lens.half_width_mm / grid);
  for (std::int64_t k = last; k >= -last; --k) {
    const auto step = static_cast<double>(k >= 0 ? k / 2 : (k - 1) / 2);
    const double x = step * grid + (k % 2 == 0 ? -kBeside : kBeside);
    for (; next != strokes_.rend() && next->x_mm >= x; ++next) {
      const double flank = next->depth_mm - slope * next->x_mm;
      if (flank <= deepest) continue;
      deepest = flank;
      of = &*next;
    }
    const double left_mm = std::max(0.0, deepest + slope * x);
    if (x >= -kBeside || left_mm > 0.0)
      measure_at(std::clamp(x, x < -kBeside ? -part_.lens.half_width_mm : 0.0, part_.lens.half_width_mm), left_mm, of);
  }
  std::reverse(result_.profile.begin(), result_.profile.end());
  if (result_.excess_mm_max > part_.tolerance_mm + kRoundingMm)
    findings_.add("excess", 0, "material remains above the design", result_.excess_mm_max, part_.tolerance_mm);
}

}  // namespace retrace::fabrication

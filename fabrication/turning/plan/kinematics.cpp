#include <algorithm>
#include <cmath>

#include "fabrication/turning/plan/path.h"

namespace retrace::fabrication::turning {
namespace {

double position_of(const PathPoint& p, int axis) {
  switch (axis) {
    case 0: return p.x_mm;
    case 1: return p.y_mm;
    case 2: return p.z_mm;
    default: return p.servo_mm;
  }
}

}  // namespace

std::vector<AxisState> axis_states(const Pass& pass, int axis) {
  std::vector<AxisState> states(pass.size());
  double time = 0.0;
  for (std::size_t i = 0; i < pass.size(); ++i) {
    time += pass[i].seconds;
    states[i].time_s = time;
    states[i].position_mm = position_of(pass[i], axis);
  }
  for (std::size_t i = 1; i + 1 < states.size(); ++i) {
    const double before = pass[i].seconds;
    const double after = pass[i + 1].seconds;
    const double v0 = (states[i].position_mm - states[i - 1].position_mm) / before;
    const double v1 = (states[i + 1].position_mm - states[i].position_mm) / after;
    states[i].speed_mm_per_s = (v0 * after + v1 * before) / (before + after);
    states[i].acceleration_mm_per_s2 = 2.0 * (v1 - v0) / (before + after);
  }
  for (std::size_t i = 2; i + 2 < states.size(); ++i)
    states[i].jerk_mm_per_s3 = (states[i + 1].acceleration_mm_per_s2 - states[i - 1].acceleration_mm_per_s2) /
                               (pass[i].seconds + pass[i + 1].seconds);
  return states;
}

AxisFigures axis_figures(const std::vector<Pass>& passes, int axis) {
  AxisFigures f;
  bool is_first = true;
  for (const Pass& pass : passes) {
    const std::vector<AxisState> states = axis_states(pass, axis);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const AxisState& s = states[i];
      f.low_mm = is_first ? s.position_mm : std::min(f.low_mm, s.position_mm);
      f.high_mm = is_first ? s.position_mm : std::max(f.high_mm, s.position_mm);
      is_first = false;
      f.speed_mm_per_s = std::max(f.speed_mm_per_s, std::abs(s.speed_mm_per_s));
      f.acceleration_mm_per_s2 = std::max(f.acceleration_mm_per_s2, std::abs(s.acceleration_mm_per_s2));
      f.jerk_mm_per_s3 = std::max(f.jerk_mm_per_s3, std::abs(s.jerk_mm_per_s3));
      if (i >= 2 && i + 1 < states.size())
        f.acceleration_jump_mm_per_s2 = std::max(
            f.acceleration_jump_mm_per_s2, std::abs(s.acceleration_mm_per_s2 - states[i - 1].acceleration_mm_per_s2));
    }
  }
  return f;
}

double path_seconds(const std::vector<Pass>& passes) {
  double sum = 0.0;
  for (const Pass& pass : passes)
    for (const PathPoint& p : pass) sum += p.seconds;
  return sum;
}

}  // namespace retrace::fabrication::turning

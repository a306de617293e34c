#include <algorithm>
#include <cmath>
#include <vector>

#include "core/angle.h"
#include "fabrication/chisel/plan/plan.h"

namespace retrace::fabrication {

double safe_height_mm(const Job& job, const Machine& machine, const std::vector<CuttingPose>& poses) {
  constexpr double kStepDeg = 3.0;
  const geometry::Vec2 half = 0.5 * blank_extent_mm(job);
  double a_low = 0.0;
  double a_high = 0.0;
  for (const CuttingPose& pose : poses) {
    a_low = std::min(a_low, pose.rounded.a_deg);
    a_high = std::max(a_high, pose.rounded.a_deg);
  }
  double highest_mm = 0.0;
  const int a_steps = static_cast<int>(std::ceil((a_high - a_low) / kStepDeg));
  for (int i = 0; i <= a_steps; ++i)
    for (double c_deg = 0.0; c_deg < 360.0; c_deg += kStepDeg)
      for (const double x : {-half.x(), half.x()})
        for (const double y : {-half.y(), half.y()}) {
          const RotaryPose pose{std::min(a_low + kStepDeg * i, a_high), c_deg};
          highest_mm = std::max(highest_mm, inverse(machine, geometry::Vec3(x, y, 0.0), pose).z_mm);
        }
  // Between two sampled angles, a corner of the blank moves on an arc and may be higher by the sagitta of this arc.
  const double sagitta_mm = (1.0 - std::cos(Angle::from_deg(0.5 * kStepDeg).rad())) * 2.0 * highest_mm;
  return highest_mm + sagitta_mm + job.process.rotary_clearance_mm + job.process.clearance_mm;
}

}  // namespace retrace::fabrication

#include "fabrication/chisel/check/cut_assignment.h"

#include "fabrication/chisel/check/collision_check.h"

namespace retrace::fabrication {

using geometry::Vec3;

CutAssignment::CutAssignment(const Machine& machine, const std::vector<Cavity>& grooves, const Vec3& tip_mm)
    : machine_(machine), cavities_(grooves), map_(grooves), tip_mm_(tip_mm) {}

std::optional<std::size_t> CutRunCounter::run_of(const NcMotion& motion) {
  if (motion.moved == 0 && !is_open_) return std::nullopt;
  const bool turns = (motion.moved & ~unsigned{kLinearBits}) != 0;
  if (motion.move == NcMove::rapid || turns || (motion.known & kLinearBits) != kLinearBits) {
    is_open_ = is_open_ && motion.moved == 0;
    return std::nullopt;
  }
  if (!is_open_) ++next_;
  is_open_ = true;
  return next_ - 1;
}

void CutAssignment::motion(const NcMotion& motion, const NcSettings&) {
  const std::optional<std::size_t> run = runs_.run_of(motion);
  if (!run) return;
  if (*run == elements_.size()) {
    elements_.emplace_back();
    depth_mm_ = 0.0;
  }
  const RigidMotion back = machine_from_workpiece(machine_, rotary_pose(machine_, motion.to)).inverse();
  const Vec3 tip = back.point(machine_point(machine_, motion.to) + tip_mm_);
  const std::optional<std::size_t> element = map_.at(tip);
  if (!element) return;
  const double depth_mm = -common(cavities_[*element]).height_over_face_mm(tip);
  if (elements_.back() && depth_mm <= depth_mm_) return;
  elements_.back() = element;
  depth_mm_ = depth_mm;
}

}  // namespace retrace::fabrication

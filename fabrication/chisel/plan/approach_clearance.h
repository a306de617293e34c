#pragma once

// Checks whether rapid moves between elements keep clear of a curved or inclined blank.

#include "fabrication/chisel/plan/section.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Checks that rapid moves keep clear of the blank. The axes of a rapid move may arrive one after the other, so the
/// tool may pass through any point of a box. The tip, or both ends of a chisel's edge, are checked at the corners of
/// this box. Over a blank that is not flat, points inside the box are checked too, in steps of a quarter of an element.
class ApproachClearance {
 public:
  ApproachClearance(const Job& job, const Machine& machine);

  /// Returns true if all rapid moves from `from` to the start of a visit (one call of a subroutine at an element) keep
  /// the clearance of the process.
  bool is_clear(const AxisWords& from, const CycleCall& visit, const CuttingPose& pose) const;

 private:
  bool is_clear_along(const LinearPosition& from, const LinearPosition& to, const CuttingPose& pose) const;
  double min_height_mm(const LinearPosition& at, const CuttingPose& pose) const;

  const Machine& machine_;
  BlankFace face_;
  double half_edge_mm_ = 0.0;
  double step_mm_ = 1.0;
  double clearance_mm_ = 0.0;
};

}  // namespace retrace::fabrication

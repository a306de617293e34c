#pragma once

// Decides whether rapid moves between elements keep clear of a curved or inclined blank.

#include "fabrication/chisel/plan/section.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Whether rapid moves stay above the blank: the tip, and the ends of a chisel's edge, are tried at the corners of the
/// box that a move may pass through, over a blank that is not flat all through it at a quarter of an element's size.
class ClearWay {
 public:
  ClearWay(const Job& job, const Machine& machine);

  /// Whether all rapid moves from there to the start of a visit keep the process's clearance.
  bool is_clear(const Words& from, const Visit& visit, const CuttingPose& pose) const;

 private:
  bool is_clear_along(const Place& from, const Place& to, const CuttingPose& pose) const;
  double least_height_mm(const Place& at, const CuttingPose& pose) const;

  const Machine& machine_;
  BlankFace face_;
  double half_edge_mm_ = 0.0;
  double step_mm_ = 1.0;
  double clearance_mm_ = 0.0;
};

}  // namespace retrace::fabrication

#pragma once

// What a job asks of its stops: that edges cut no more than their life, that programs run no longer than they may, that
// elements are inspected between roughing and finishing, and that nothing is cut cold.

#include <cstdint>
#include <vector>

#include "fabrication/chisel/check/cut_check.h"

namespace retrace::fabrication {

/// Follows programs from stop to stop. What goes beyond a limit is found once between two stops.
class StopCheck {
 public:
  /// All arguments must outlive it.
  StopCheck(const Workpiece3d& workpiece, const ToolWedge& wedge, FindingList& findings);

  /// A program begins. \param now_s that all programs have taken so far
  void begin(double now_s);
  /// The program waits for the operator.
  void stop(double now_s);
  /// A move at a feed within the material of an element. \param now_s when it ends
  void cut(const CutMove& cut, double now_s);

 private:
  void check_length(const CutMove& cut, const FacetCut& along);
  void check_time(const NcPlace& place, std::int64_t element, double now_s);
  void check_inspection(const CutMove& cut, const FacetCut& along);

  const Workpiece3d& workpiece_;
  const ToolWedge& wedge_;
  FindingList& findings_;
  double began_s_ = 0.0;  ///< to run, since the last stop
  double cut_mm_ = 0.0;   ///< by the edge
  bool has_cut_ = false;  ///< since the last stop
  bool is_worn_ = false;  ///< was found
  bool is_late_ = false;
  std::int64_t stops_ = 0;                   ///< and beginnings
  std::vector<std::int64_t> roughed_after_;  ///< by element: stops before its last roughing cut
};

}  // namespace retrace::fabrication

#pragma once

// Checks of the stops in programs: tool life of the edges, maximum run time between stops, inspection between roughing
// and finishing, and warm-up of the machine before the first cut.

#include <cstdint>
#include <vector>

#include "fabrication/chisel/check/cut_check.h"

namespace retrace::fabrication {

/// Checks programs from stop to stop. Adds findings for cuts before the end of the warm-up, for cuts beyond the tool
/// life of the edge, and for cuts that are made too long after the last stop. Also adds a finding if an element is
/// finished without an inspection after its roughing.
class StopCheck {
 public:
  /// \pre all arguments outlive this object
  StopCheck(const VerificationModel& workpiece, const ToolWedge& wedge, FindingList& findings);

  /// Starts the checks of a program.
  /// \param now_s total run time of all programs so far
  void begin(double now_s);
  /// Starts the checks after a stop at which the program waits for the operator.
  void stop(double now_s);
  /// Checks a cutting move in the material of an element.
  /// \param now_s total run time at the end of the move
  void cut(const CutMove& cut, double now_s);

 private:
  void check_length(const CutMove& cut, const FacetCut& along);
  void check_time(const NcLocation& place, std::int64_t element, double now_s);
  void check_inspection(const CutMove& cut, const FacetCut& along);

  const VerificationModel& workpiece_;
  const ToolWedge& wedge_;
  FindingList& findings_;
  double began_s_ = 0.0;                     ///< time of the last stop or program start
  double cut_mm_ = 0.0;                      ///< length that the present edge has cut
  bool has_cut_ = false;                     ///< true after the first cut since the last stop
  bool is_worn_ = false;                     ///< true after a finding about the tool life of the present edge
  bool is_late_ = false;                     ///< true after a finding about the run time since the last stop
  std::int64_t stops_ = 0;                   ///< number of stops and program starts so far
  std::vector<std::int64_t> roughed_after_;  ///< for each element: value of `stops_` at its last roughing cut
};

}  // namespace retrace::fabrication

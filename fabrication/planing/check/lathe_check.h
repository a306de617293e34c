#pragma once

// Judges the lathe programs of a flat lens: spindle and feeds, and the profile that the nose leaves.

#include <vector>

#include "fabrication/check/control_check.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// A place of a turning tool: radius and height of the lowest point of its nose, mm.
struct PathPlace {
  double x_mm = 0.0;
  double z_mm = 0.0;
};

/// Follows a program of a lathe: whether the spindle turns as the part's file says whenever the tool feeds, and stands
/// still at the end. Keeps the feed moves since the last rapid move, which are those of the last pass at the end.
class LatheCheck : public NcSink {
 public:
  LatheCheck(const PlanedPart& part, NcDialect dialect, FindingList& findings, PlaningCheck& result);

  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcPlace&, const AxisPositions&) override { result_.time_s.back() += seconds; }
  void end(const NcEnd& end) { control_.spindle_at_end(end); }
  /// Without the way down to the profile.
  std::vector<PathPlace> last_pass() const;

 private:
  const PlanedPart& part_;
  ControlCheck control_;
  PlaningCheck& result_;
  std::vector<PathPlace> now_;
  std::vector<PathPlace> last_;
  bool feeding_ = false;
};

/// Sweeps the nose along the last pass and compares what is left with the part, both ways.
void measure_turned(const PlanedPart& part, const std::vector<PathPlace>& path, FindingList& findings,
                    PlaningCheck& result);

}  // namespace retrace::fabrication

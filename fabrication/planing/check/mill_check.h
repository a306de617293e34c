#pragma once

// Judges the planing-mill programs of a flat lens: single-axis moves on the machine's grid, and the profile that the
// strokes leave.

#include "fabrication/planing/check/check.h"
#include "fabrication/planing/check/phase_profile.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Follows the programs of a planing mill. Strokes of all programs make one surface.
class MillCheck : public NcSink {
 public:
  MillCheck(const PlanedPart& part, double flank_slope, FindingList& findings, PlaningCheck& result)
      : part_(part), flank_slope_(flank_slope), findings_(findings), result_(result) {}

  /// A program begins.
  void begin();
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcPlace&, const AxisPositions&) override { result_.time_s.back() += seconds; }
  void end();
  /// What all strokes left.
  void measure();

 private:
  struct Stroke {
    double x_mm = 0.0;
    double depth_mm = 0.0;
  };

  void check_length(const NcMotion& motion, std::size_t axis, double length_mm);
  void check_grid(const NcMotion& motion, std::size_t axis, double place_mm);
  void check_place(const NcMotion& motion, std::size_t axis);
  void measure_at(double x_mm, double left_mm, const PhaseProfile& profile);

  const PlanedPart& part_;
  double flank_slope_;
  FindingList& findings_;
  PlaningCheck& result_;
  std::vector<Stroke> strokes_;
  double low_mm_[3] = {0.0, 0.0, 0.0};
  double high_mm_[3] = {0.0, 0.0, 0.0};
  bool is_placed_[3] = {false, false, false};
};

}  // namespace retrace::fabrication

#pragma once

// Checks the programs of a flat lens for a planing mill: moves of single axes on the machine's grid, and the profile
// that the strokes produce.

#include "fabrication/check/control_check.h"
#include "fabrication/check/known_axes.h"
#include "fabrication/planing/check/check.h"
#include "fabrication/planing/check/phase_profile.h"
#include "fabrication/read/nc_motion.h"

namespace retrace::fabrication {

/// Receives the moves of a planing mill's programs. The strokes of all programs produce one surface.
class MillCheck : public NcSink {
 public:
  MillCheck(const PlanedPart& part, FindingList& findings, PlaningCheck& result);

  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcLocation&, const AxisPositions&) override { result_.time_s.back() += seconds; }
  void state(const NcSettings& settings, const NcLocation& place) override { control_.state(settings, place, false); }

  /// Starts the checks of a program.
  void begin(const NcProgram& program);
  void end(const NcEnd& end);
  /// Compares the surface after all strokes with the design.
  void measure();

 private:
  struct Stroke {
    double x_mm = 0.0;
    double depth_mm = 0.0;
    std::size_t program = 0;
    std::int32_t line = 0;
  };

  void check_length(const NcMotion& motion, std::size_t axis, double length_mm);
  void check_grid(const NcMotion& motion, std::size_t axis, double position_mm);
  void check_position(const NcMotion& motion, std::size_t axis);
  /// Compares one point of the surface with the design.
  /// \param stroke stroke that produced this point; null if no stroke did
  void measure_at(double x_mm, double left_mm, const Stroke* stroke);

  const PlanedPart& part_;
  PhaseProfile profile_;
  FindingList& findings_;
  PlaningCheck& result_;
  ControlCheck control_;
  KnownAxes known_;
  std::vector<std::string> programs_;
  std::vector<Stroke> strokes_;
  double height_mm_ = 0.0;
  double low_mm_[3] = {0.0, 0.0, 0.0};
  double high_mm_[3] = {0.0, 0.0, 0.0};
  bool has_position_[3] = {false, false, false};
};

}  // namespace retrace::fabrication

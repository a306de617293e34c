#pragma once

// Computes the surface that a turning tool produces along the cuts of NC programs: the lower envelope of its edge.

#include <cstdint>
#include <optional>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/turning/tool.h"

namespace retrace::fabrication::turning {

/// Axis positions of a cut, as read from an NC program: the start of the first block, and the end of every block.
struct CutPass {
  std::vector<double> x_mm;
  std::vector<double> y_mm;
  std::vector<double> z_mm;  ///< Z of the tool, including the strokes of a servo
  std::vector<double> c_rad;
  std::vector<double> duration_s;  ///< time since the previous point; 0 for the first point
  std::vector<std::int32_t> line;  ///< program line of the block that ends at the point
  /// Duration of the whole block that ends at the point; 0 for a point inside of a cubic move.
  std::vector<double> block_s;
  std::vector<double> servo_mm;  ///< strokes of a servo, which are part of z_mm; empty without a servo
  std::size_t program = 0;       ///< index of the program
  double seconds = 0.0;

  std::size_t size() const { return x_mm.size(); }
};

/// Collects the cuts of a program. Cuts are linear moves, except moves of only Z.
class CutRecorder : public NcSink {
 public:
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcLocation& place, const AxisPositions& position) override;

  /// Ends the present cut and returns all cuts.
  std::vector<CutPass> take();
  /// Returns findings about cuts that a control would execute wrongly: cuts with a stop at every point or without a
  /// time.
  const std::vector<Finding>& findings() const { return findings_; }

 private:
  void end_pass();

  CutPass pass_;
  double block_s_ = 0.0;  ///< duration so far of a block that is not complete
  std::vector<CutPass> passes_;
  std::vector<Finding> findings_;
};

/// Surface that the sharp arc of a tool produces along cuts: the minimum height of its edge above each point. In a
/// block, all axes including C move linearly, as the control interpolates them. The result does not depend on the
/// planned path.
class Envelope {
 public:
  /// \throw InputError if there is a cut in which neither C always increases, nor C is constant and Y always decreases
  Envelope(const TurningTool& tool, std::vector<CutPass> passes);

  /// Returns the height of the surface at a point, or nothing where there is no cut.
  /// \pre the point is at least a few feeds away from the spindle's axis
  std::optional<double> height_mm(double x_mm, double y_mm) const;

 private:
  struct Turn {
    std::size_t first = 0;  ///< index of the first point of the turn
    double x_low = 0.0;
    double x_high = 0.0;
  };
  struct Index {
    bool is_spiral = false;
    std::vector<Turn> turns;
  };
  struct Pose {
    double x_mm;
    double y_mm;
    double z_mm;
  };

  Index index_of(const CutPass& pass) const;
  double lift_mm(double aside_mm) const;
  void cross_turning(const CutPass& pass, const Index& index, double x_mm, double y_mm, double& lowest) const;
  /// Computes the height of the edge while it passes over a point of the part, and reduces `lowest` to this height if
  /// it is lower. The angle of the spindle at this time is near `c`.
  void cross_at(const CutPass& pass, double r, double theta, double c, double& lowest) const;
  void cross_line(const CutPass& pass, double x_mm, double y_mm, double& lowest) const;

  double radius_mm_;
  double reach_mm_;  ///< half of the width of the sharp arc
  double sin_rake_;
  double cos_rake_;
  std::vector<CutPass> passes_;
  std::vector<Index> indices_;
};

}  // namespace retrace::fabrication::turning

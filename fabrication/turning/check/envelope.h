#pragma once

// The surface that a turning tool's arc leaves along the cuts of NC text: the lower envelope of its edge over every
// place.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_motion.h"
#include "fabrication/turning/tool.h"

namespace retrace::fabrication::turning {

/// Positions of the axes at the ends of the blocks of a cut, as read from NC text, the start of the first one included.
struct CutPass {
  std::vector<double> x_mm;
  std::vector<double> y_mm;
  std::vector<double> z_mm;  ///< of the tool, strokes of a servo included
  std::vector<double> c_rad;
  std::vector<double> duration_s;  ///< of the block that ends there; of the first 0
  std::vector<std::int32_t> line;  ///< likewise
  /// Of the whole block that ends there; 0 where a point lies within a move by a cubic.
  std::vector<double> block_s;
  std::vector<double> servo_mm;  ///< what a servo adds to the slide's Z; empty: nothing
  std::size_t program = 0;       ///< that it is of
  double seconds = 0.0;

  std::size_t size() const { return x_mm.size(); }
};

/// Gathers the cuts of a program: linear moves, without those that only change Z.
class CutRecorder : public NcSink {
 public:
  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double seconds, const NcPlace& place, const AxisPositions& position) override;

  /// The cuts so far; ends the one that is going on.
  std::vector<CutPass> take();
  /// What a controller would not do as meant: cuts that stop at every point or have no time.
  const std::vector<Finding>& findings() const { return findings_; }

 private:
  void end_pass();

  CutPass pass_;
  double block_s_ = 0.0;  ///< of a block that goes on
  std::vector<CutPass> passes_;
  std::vector<Finding> findings_;
};

/// What the sharp arc of a tool leaves along cuts: the lowest height of its edge over every place. Between two blocks
/// the axes move evenly, as a controller interpolates them, C included. Knows nothing of how the cuts were planned.
class Envelope {
 public:
  /// \throw InputError for cuts in which neither C rises throughout nor C stands and Y falls throughout
  Envelope(const TurningTool& tool, std::vector<CutPass> passes);

  /// Nothing where no cut passes. \pre not within a few feeds of the spindle's axis, where the edge turns on the spot
  std::optional<double> height_mm(double x_mm, double y_mm) const;

 private:
  struct Turn {
    std::size_t first = 0;  ///< block end
    double x_low = 0.0;
    double x_high = 0.0;
  };
  struct Index {
    bool turns = false;
    std::vector<Turn> turn;
  };
  struct Pose {
    double x_mm;
    double y_mm;
    double z_mm;
  };

  Index index_of(const CutPass& pass) const;
  double lift_mm(double aside_mm) const;
  void cross_turning(const CutPass& pass, const Index& index, double x_mm, double y_mm, double& lowest) const;
  /// The crossing near an angle of the spindle, if there is one.
  void cross_at(const CutPass& pass, double r, double theta, double c, double& lowest) const;
  void cross_line(const CutPass& pass, double x_mm, double y_mm, double& lowest) const;

  double radius_mm_;
  double reach_mm_;  ///< of the sharp arc, sideways
  double sin_rake_;
  double cos_rake_;
  std::vector<CutPass> passes_;
  std::vector<Index> indices_;
};

}  // namespace retrace::fabrication::turning

#pragma once

// Assigns cutting moves to elements where neighbouring cuts overlap, as on curved and inclined blanks.

#include <cstddef>
#include <optional>
#include <vector>

#include "fabrication/chisel/check/groove.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Counts the runs of moves at a feed between rapid moves and turns.
class CutRuns {
 public:
  /// The run that a move belongs to, from 0; nothing for rapid moves, turns, and before all positions are known.
  std::optional<std::size_t> of(const NcMotion& motion);
  /// A program ends.
  void end() { is_open_ = false; }

 private:
  std::size_t next_ = 0;
  bool is_open_ = false;
};

/// Tells which element each cutting move belongs to where neighbours' cuts run into each other over their rims, as on
/// curved and inclined blanks: that under whose aperture the tool goes deepest from one rapid move to the next.
/// Gathered over all programs before anything is judged.
class VisitFinder : public NcSink {
 public:
  /// \param tip_mm of the cutting wedge from the tool reference point
  VisitFinder(const Machine& machine, const std::vector<Groove>& grooves, const geometry::Vec3& tip_mm);

  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double, const NcPlace&, const AxisPositions&) override {}
  /// After each program.
  void end() { runs_.end(); }

  /// Of each run; nothing where the tool stays beside all elements.
  const std::vector<std::optional<std::size_t>>& elements() const { return elements_; }

 private:
  const Machine& machine_;
  const std::vector<Groove>& grooves_;
  GrooveMap map_;
  geometry::Vec3 tip_mm_;
  std::vector<std::optional<std::size_t>> elements_;
  CutRuns runs_;
  double depth_mm_ = 0.0;  ///< of the deepest place of the run
};

}  // namespace retrace::fabrication

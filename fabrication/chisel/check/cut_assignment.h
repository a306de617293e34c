#pragma once

// Determines the element to which a cutting move belongs if the cuts of neighbouring elements overlap. This is the case
// on curved and inclined blanks.

#include <cstddef>
#include <optional>
#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/machine/machine.h"
#include "fabrication/read/nc_motion.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Counts runs. A run is a sequence of moves at a feed between rapid moves or rotary moves.
class CutRunCounter {
 public:
  /// Returns the number of the run that a move belongs to, from 0. Returns nothing for rapid moves, for rotary moves,
  /// and for moves before the positions of X, Y and Z are known.
  std::optional<std::size_t> run_of(const NcMotion& motion);
  /// Ends the present run at the end of a program.
  void end() { is_open_ = false; }

 private:
  std::size_t next_ = 0;
  bool is_open_ = false;
};

/// Determines which element each run of cutting moves belongs to. On curved and inclined blanks, the cuts of
/// neighbouring elements overlap above their rims. A run belongs to the element in which the tool reaches its largest
/// depth. All programs must be processed before the results are used.
class CutAssignment : public NcSink {
 public:
  /// \param tip_mm position of the wedge's tip relative to the tool reference point
  CutAssignment(const Machine& machine, const std::vector<Cavity>& grooves, const geometry::Vec3& tip_mm);

  void motion(const NcMotion& motion, const NcSettings& settings) override;
  void dwell(double, const NcLocation&, const AxisPositions&) override {}
  /// Ends a program.
  void end() { runs_.end(); }

  /// Returns the element of each run, or nothing for a run outside of all elements.
  const std::vector<std::optional<std::size_t>>& elements() const { return elements_; }

 private:
  const Machine& machine_;
  const std::vector<Cavity>& cavities_;
  CavityMap map_;
  geometry::Vec3 tip_mm_;
  std::vector<std::optional<std::size_t>> elements_;
  CutRunCounter runs_;
  double depth_mm_ = 0.0;  ///< maximum depth of the tip in the present run
};

}  // namespace retrace::fabrication

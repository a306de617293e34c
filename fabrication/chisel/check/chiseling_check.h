#pragma once

// Checks of the micro chiseling of cube corners: order of the layers, dwells, and separation of the chips.

#include <array>
#include <optional>
#include <vector>

#include "fabrication/chisel/check/cut_check.h"

namespace retrace::fabrication {

/// Checks the V-shaped motions of diamond micro chiseling: the dwell at each apex, and the complete separation of each
/// chip (docs/theory/micro_chiseling.md).
class ChiselingCheck : public CutCheck {
 public:
  ChiselingCheck(const VerificationModel& workpiece, const ToolWedge& wedge, ControlCheck& control,
                 FindingList& findings);

  void move(const CutMove& cut) override;
  void dwell(double seconds) override;
  void close() override;
  void finish() override;

 private:
  /// A cut down one dihedral edge to the apex of a layer and up another edge.
  struct OpenCut {
    std::size_t element = 0;
    std::size_t facet = 0;
    std::array<double, 3> tip_mm{};  ///< heights of the tip above the three facets
    NcLocation location;
    double dwell_s = 0.0;  ///< dwell time at the apex
    bool went_up = false;  ///< true after the move up the second dihedral edge
  };
  /// Progress of one element.
  struct State {
    std::array<double, 3> remaining_mm{};  ///< thickness of the material that remains on each facet
    NcLocation last;                       ///< program position of the last cut
  };

  void open(const CutMove& move);
  /// Returns the tolerance, in mm, for the position of the tip at the apex of a layer. At this apex, the heights of the
  /// tip above all facets should be equal. The tolerance is the maximum difference between the height above the facet
  /// `other` and the height above the facet that is cut. It allows for the rounding of positions to the increments of
  /// the control.
  double short_limit_mm(const OpenCut& cut, std::size_t other) const;
  /// Returns the tolerance, in mm, for the difference in remaining material between the facets of one element after a
  /// complete layer.
  double layer_limit_mm(std::size_t element) const;
  void check_layer(const OpenCut& cut, const State& state);

  std::vector<State> states_;
  std::optional<OpenCut> open_;
};

}  // namespace retrace::fabrication

#pragma once

// Cube corners, cut by micro chiseling: layers, dwells, and whether chips come free.

#include <array>
#include <optional>
#include <vector>

#include "fabrication/chisel/check/cut_check.h"

namespace retrace::fabrication {

/// Follows the V-shaped motions of diamond micro chiseling: dwells, and whether chips come free
/// (docs/theory/micro_chiseling.md).
class ChiselingCheck : public CutCheck {
 public:
  ChiselingCheck(const Workpiece3d& workpiece, const ToolWedge& wedge, ControlCheck& control, FindingList& findings);

  void move(const CutMove& cut) override;
  void dwell(double seconds) override;
  void close() override;
  void finish() override;

 private:
  /// A cut down one dihedral edge to the apex of a layer and up another edge.
  struct OpenCut {
    std::size_t element = 0;
    std::size_t facet = 0;
    std::array<double, 3> tip_mm{};  ///< heights of the tip over the facets
    NcPlace place;
    double rest_s = 0.0;  ///< at the apex
    bool went_up = false;
  };
  /// Material that remains on the facets of an element.
  struct State {
    std::array<double, 3> left_mm{};
    NcPlace last;
  };

  void open(const CutMove& move);
  /// Returns the tolerance, in mm, for the position of the tip at the apex of a layer: the largest allowed excess of
  /// its height over the facet `other` above its height over the facet that is cut. It allows for the rounding to the
  /// increments of the control.
  double short_limit_mm(const OpenCut& cut, std::size_t other) const;
  /// Returns the tolerance, in mm, for the difference in remaining material between the facets of one element after a
  /// complete layer.
  double layer_limit_mm(std::size_t element) const;
  void check_layer(const OpenCut& cut, const State& state);

  std::vector<State> states_;
  std::optional<OpenCut> open_;
};

}  // namespace retrace::fabrication

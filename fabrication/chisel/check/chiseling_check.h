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
  /// Down one edge to the apex of a layer, and up the other.
  struct OpenCut {
    std::size_t element = 0;
    std::size_t facet = 0;
    std::array<double, 3> tip_mm{};  ///< heights of the tip over the facets
    NcPlace place;
    double rest_s = 0.0;  ///< at the apex
    bool went_up = false;
  };
  /// What stands on the facets of an element.
  struct State {
    std::array<double, 3> left_mm{};
    NcPlace last;
  };

  void open(const CutMove& move);
  /// Returns the distance by which the tip of a right cut may stop short of its layer's apex over another facet: the
  /// tolerance, or what rounding to the increments of the control does if that is more.
  double short_limit_mm(const OpenCut& cut, std::size_t other) const;
  /// Returns the distance by which right cuts of one layer may differ in height over their facets.
  double layer_limit_mm(std::size_t element) const;
  void check_layer(const OpenCut& cut, const State& state);

  std::vector<State> states_;
  std::optional<OpenCut> open_;
};

}  // namespace retrace::fabrication

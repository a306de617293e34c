#pragma once

// Prisms, cut by plunging and ploughing: dwells, and whether chips come free.

#include <array>
#include <optional>
#include <vector>

#include "fabrication/chisel/check/cut_check.h"

namespace retrace::fabrication {

/// Follows the plunges and ploughs of a chisel (docs/theory/cutting.md).
class PlungeCheck : public CutCheck {
 public:
  PlungeCheck(const Workpiece3d& workpiece, const ToolWedge& wedge, ControlCheck& control, FindingList& findings)
      : CutCheck(workpiece, wedge, control, findings), states_(workpiece.grooves.size()) {}

  void move(const CutMove& cut) override;
  void dwell(double seconds) override;
  void close() override;

 private:
  /// Cuts of one element so far, as heights over its two facets.
  struct State {
    struct Plunge {
      std::array<double, 2> tip_mm{};  ///< heights of the tip over the facets
      std::int32_t line = 0;
    };
    std::array<std::optional<Plunge>, 2> last;   ///< on each facet
    std::array<double, 2> surface_mm{1e9, 1e9};  ///< of each facet above the design
    std::vector<std::array<double, 4>> tips;     ///< ends of plunges and their facet, to find repeated ones
  };
  /// A plunge whose chip has not been looked after yet.
  struct OpenPlunge {
    std::size_t element = 0;
    std::size_t facet = 0;
    std::array<double, 2> tip_mm{};
    double chip_mm = 0.0;
    NcPlace place;
    double rest_s = 0.0;  ///< since it ended
  };

  void plunge(const CutMove& cut);
  void plough(const CutMove& cut);
  void check_dwell();
  void check_chip();

  std::vector<State> states_;
  std::optional<OpenPlunge> open_;
};

}  // namespace retrace::fabrication

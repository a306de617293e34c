#pragma once

// Checks of the plunging and ploughing of prisms: dwell times and separation of the chips.

#include <array>
#include <optional>
#include <vector>

#include "fabrication/chisel/check/cut_check.h"

namespace retrace::fabrication {

/// Checks the plunges and ploughs of a chisel (docs/theory/cutting.md).
class PlungeCheck : public CutCheck {
 public:
  PlungeCheck(const VerificationModel& workpiece, const ToolWedge& wedge, ControlCheck& control, FindingList& findings)
      : CutCheck(workpiece, wedge, control, findings), states_(workpiece.cavities.size()) {}

  void move(const CutMove& cut) override;
  void dwell(double seconds) override;
  void close() override;

 private:
  /// Progress of one element. All heights are measured above its two designed facets.
  struct State {
    struct Plunge {
      std::array<double, 2> tip_mm{};  ///< heights of the tip above the two facets
      std::int32_t line = 0;
    };
    std::array<std::optional<Plunge>, 2> last;   ///< last plunge along each facet
    std::array<double, 2> surface_mm{1e9, 1e9};  ///< height of the machined surface above each designed facet
    std::vector<std::array<double, 4>> tips;     ///< end point and facet of each plunge, to detect repeated plunges
  };
  /// Plunge whose chip separation has not been checked yet.
  struct OpenPlunge {
    std::size_t element = 0;
    std::size_t facet = 0;
    std::array<double, 2> tip_mm{};
    double chip_mm = 0.0;
    NcLocation location;
    double dwell_s = 0.0;  ///< dwell time at the end of the plunge
  };

  void plunge(const CutMove& cut);
  void plough(const CutMove& cut);
  void check_dwell();
  void check_chip();

  std::vector<State> states_;
  std::optional<OpenPlunge> open_;
};

}  // namespace retrace::fabrication

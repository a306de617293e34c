#pragma once

// Compares the material that each cut of an element removes with the limits of the process.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/chisel/check/facet_cut.h"
#include "fabrication/chisel/check/simulation/remaining_stock.h"
#include "fabrication/chisel/check/verification_model.h"

namespace retrace::fabrication {

/// Findings and chip thicknesses of one element.
struct ChipFigures {
  std::vector<Finding> findings;        ///< findings; their member `program` is empty
  std::vector<std::uint32_t> programs;  ///< for each finding: SweptVolume::program of the cut
  double thickest_mm = 0.0;             ///< maximum chip thickness
  double max_thickness_ratio = 0.0;     ///< maximum of chip thickness divided by its limit
};

/// Checks the cuts of one element in the order of cutting. Adds a finding for a chip that is thicker than its limit.
/// Also adds a finding if fewer finishing cuts than required remove the last layers of a facet. The checks depend only
/// on the removed material, and not on the names of the cuts in the program.
class ChipCheck {
 public:
  /// \param material material before the first cut. Each call of cut() removes a part of it
  /// \pre all arguments outlive this object
  ChipCheck(const VerificationModel& workpiece, std::size_t element, RemainingStock& material, const ToolWedge& wedge,
            std::span<const RigidMotion> poses);

  void cut(const SweptVolume& sweep);
  /// Returns the result. Must be called after the last cut.
  ChipFigures finish();

 private:
  /// Measuring line in a section, normal to a facet.
  struct FacetLine {
    std::size_t section = 0, facet = 0;
    geometry::Vec2 origin_mm = geometry::Vec2::Zero();
    geometry::Vec2 direction = geometry::Vec2::UnitY();
    int finishing_cuts = 0;  ///< number of cuts that removed material of the finishing layers on this line
    SweptVolume last;
  };

  void add_lines();
  void check_chips(const SweptVolume& sweep, const std::optional<FacetCut>& cut, const RigidMotion& back,
                   std::span<const std::vector<ConvexPolygon>> removed);
  /// Adds a finding if the cutting edge rubs: the maximum chip thickness of a plunge is less than the minimum chip
  /// thickness of the process.
  void check_rubbing(const SweptVolume& sweep, const FacetCut& cut, double thickest_mm);
  void count_finishing(const SweptVolume& sweep, const FacetCut& cut,
                       std::span<const std::vector<ConvexPolygon>> removed);
  void find(const char* kind, const SweptVolume& sweep, std::string message, double value_um, double limit_um);

  const VerificationModel& workpiece_;
  const Cavity& cavity_;
  const DesignElement& design_;
  bool is_cube_;
  std::size_t element_;
  RemainingStock& material_;
  const ToolWedge& wedge_;
  std::span<const RigidMotion> poses_;
  double allowance_mm_;
  std::vector<FacetLine> lines_;
  std::vector<bool> is_begun_;  ///< for each facet: true after the first cut along it
  ChipFigures figures_;
};

}  // namespace retrace::fabrication

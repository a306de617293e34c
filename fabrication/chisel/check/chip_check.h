#pragma once

// What every cut of an element takes of the material that stands there, against what the process allows.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/chisel/check/facet_cut.h"
#include "fabrication/chisel/check/simulation/standing_material.h"
#include "fabrication/chisel/check/workpiece.h"

namespace retrace::fabrication {

/// What was found of one element.
struct ChipFigures {
  std::vector<Finding> findings;        ///< `program` is left empty
  std::vector<std::uint32_t> programs;  ///< of each finding: SweptVolume::program
  double thickest_mm = 0.0;             ///< chip
  double thickest_share = 0.0;          ///< of a chip over what is allowed there, at most
};

/// Follows the cuts of one element in their order: chips thicker than their limit, and facets whose last layers were
/// not taken by as many finishing cuts as the process has. Judged is what is removed, not what it is called.
class ChipCheck {
 public:
  /// \param material what stands before the first cut; it is cut. All arguments must outlive it
  ChipCheck(const Workpiece3d& workpiece, std::size_t element, StandingMaterial& material, const ToolWedge& wedge,
            std::span<const RigidMotion> poses);

  void cut(const SweptVolume& sweep);
  /// After the last cut.
  ChipFigures finish();

 private:
  /// A line normal to a facet, in a section.
  struct FacetLine {
    std::size_t section = 0;
    std::size_t facet = 0;
    geometry::Vec2 foot_mm = geometry::Vec2::Zero();
    geometry::Vec2 direction = geometry::Vec2::UnitY();
    int finishing_cuts = 0;  ///< that took some of its last layers
    SweptVolume last;
  };

  void add_lines();
  void check_chips(const SweptVolume& sweep, const std::optional<FacetCut>& cut, const RigidMotion& back,
                   std::span<const std::vector<ConvexPiece>> removed);
  /// A plunge of a chisel that takes less than the least chip, wherever it takes most, rubs.
  void check_rubbing(const SweptVolume& sweep, const FacetCut& cut, double thickest_mm);
  void count_finishing(const SweptVolume& sweep, const FacetCut& cut,
                       std::span<const std::vector<ConvexPiece>> removed);
  void find(const char* kind, const SweptVolume& sweep, std::string message, double value_um, double limit_um);

  const Workpiece3d& workpiece_;
  const Groove& groove_;
  std::size_t element_;
  StandingMaterial& material_;
  const ToolWedge& wedge_;
  std::span<const RigidMotion> poses_;
  double allowance_mm_;
  std::vector<FacetLine> lines_;
  std::vector<bool> is_begun_;  ///< by facet: something was cut along it
  ChipFigures figures_;
};

}  // namespace retrace::fabrication

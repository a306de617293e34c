#pragma once

// Represents the remaining stock of a round blank while a turning tool moves in its cross-section: heights at positions
// along the radius.

#include <cstdint>
#include <vector>

#include "fabrication/planing/check/swept_nose.h"

namespace retrace::fabrication {

/// Cross-section of the blank from the axis to the rim, with its face at z = 0, at equally spaced positions. A straight
/// move removes the material above the surface that the nose sweeps. For a pointed tool, a vertical move also removes
/// material up to half a spacing away on both sides.
class StockProfile {
 public:
  StockProfile(double end_mm, double spacing_mm, double nose_mm);

  /// Removes the material of a straight move of the nose's lowest point. Because the workpiece rotates, a nose beyond
  /// the axis cuts the section from the opposite side.
  /// \param who number of the move, which is stored at all positions where it removes material
  /// \return the maximum thickness, along Z, of the removed material
  double cut(const SectionPoint& from, const SectionPoint& to, std::int32_t who);

  const std::vector<double>& heights_mm() const { return heights_; }
  double position_mm(std::size_t index) const { return spacing_ * static_cast<double>(index); }
  /// Returns the number of the move that cut last at a position; -1 if no move cut there.
  std::int32_t who(std::size_t index) const { return who_[index]; }

 private:
  double cut_side(const SectionPoint& from, const SectionPoint& to, std::int32_t who);
  template <class Height>
  double lower(double from_mm, double to_mm, std::int32_t who, const Height& height);

  double spacing_;
  double nose_;
  std::vector<double> heights_;
  std::vector<std::int32_t> who_;
};

}  // namespace retrace::fabrication

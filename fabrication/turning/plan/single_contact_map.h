#pragma once

// Map of positions at which the tool's nose provably has only one point of contact. The nose compensation can omit its
// global search there.

#include <vector>

#include "fabrication/turning/tool.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Map of positions at which the nose has only one point of contact. The proof is that the surface below the nose is
/// less concave than the nose: z'' < 1 / r along every line (docs/theory/turning.md, section Paths).
class SingleContactMap {
 public:
  /// Creates an empty map, for which has_single_contact() is false at every position.
  SingleContactMap() = default;
  /// Computes the map by interval arithmetic. The proof is possible only inside of the base's boundary, only for bases
  /// and lenslets that are not given by a formula, and only for tools without rake.
  /// \param reach_mm maximum distance of the edge from the origin
  SingleContactMap(const geometry::FreeformSurface& surface, const TurningTool& tool, double reach_mm);

  /// Returns true if a tool with its lowest point above (x, y) provably has only one point of contact.
  bool has_single_contact(double x_mm, double y_mm) const {
    const double column = (x_mm + half_mm_) * per_mm_;
    const double row = (y_mm + half_mm_) * per_mm_;
    if (has_single_contact_.empty() || !(column >= 0.0 && row >= 0.0 && column < kCells && row < kCells)) return false;
    return has_single_contact_[static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column)] != 0;
  }

 private:
  static constexpr std::size_t kCells = 256;  ///< number of cells along each side of the map

  /// Marks the cells of a rectangle, and all cells within the radius of the nose around it, as cells without a proven
  /// single contact.
  void clear_around(const geometry::Vec2& low, const geometry::Vec2& high, double nose_mm);

  double half_mm_ = 0.0;
  double per_mm_ = 0.0;  ///< number of cells per mm
  std::vector<char> has_single_contact_ = {};
};

}  // namespace retrace::fabrication::turning

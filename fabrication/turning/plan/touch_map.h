#pragma once

// Where the tool's nose provably touches the surface in one place only, so that compensation may skip its global
// search.

#include <vector>

#include "fabrication/turning/tool.h"
#include "geometry/surface/freeform_surface.h"

namespace retrace::fabrication::turning {

/// Where the nose is proved to touch the surface in one place only, so that the first one found is the only one: within
/// the nose's reach the surface is nowhere as hollow as the nose, z'' < 1 / r along every line (docs/theory/turning.md,
/// section Paths).
class TouchMap {
 public:
  /// Nothing is known anywhere.
  TouchMap() = default;
  /// What interval arithmetic can prove: of bases and lenslets without a formula, inside of the base's boundary, for
  /// tools without rake. \param reach_mm how far from the origin the edge gets
  TouchMap(const geometry::FreeformSurface& surface, const TurningTool& tool, double reach_mm);

  /// The edge of a tool whose lowest point stands over (x, y) touches in one place.
  bool touches_once(double x_mm, double y_mm) const {
    const double column = (x_mm + half_mm_) * per_mm_;
    const double row = (y_mm + half_mm_) * per_mm_;
    if (once_.empty() || !(column >= 0.0 && row >= 0.0 && column < kCells && row < kCells)) return false;
    return once_[static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column)] != 0;
  }

 private:
  static constexpr std::size_t kCells = 256;  ///< along each side of the square that is looked at

  /// Nothing is known within the nose's radius of a rectangle.
  void forget(const geometry::Vec2& low, const geometry::Vec2& high, double nose_mm);

  double half_mm_ = 0.0;
  double per_mm_ = 0.0;  ///< cells
  std::vector<char> once_ = {};
};

}  // namespace retrace::fabrication::turning

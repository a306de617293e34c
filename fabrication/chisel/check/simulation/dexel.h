#pragma once

// Dexel model of the blank: stores the lengths that cuts remove from parallel lines. It is a second, independent
// simulation of the cuts, for tests and pictures.

#include <cstddef>
#include <span>
#include <vector>

#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Box of the blank in the workpiece frame, from its low corner to its high corner. The high corner is on the blank's
/// face.
struct DexelBox {
  geometry::Vec3 low_mm = geometry::Vec3::Zero();
  geometry::Vec3 high_mm = geometry::Vec3::Zero();
};

/// Material that is removed from a grid of lines parallel to one axis of the workpiece frame.
struct DexelField {
  int axis = 2;  ///< direction of the lines: 0, 1, 2 for x, y, z
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<double> removed_mm;  ///< removed length of each line, row by row
  std::vector<double> lowest_mm;   ///< lowest removed point of each line; the high end of the box if nothing is removed
  double cell_area_mm2 = 0.0;

  double volume_mm3() const;
};

/// Simulates the cuts on a grid of lines. The algorithm is independent of swept_span(): it intersects the lines with
/// the supporting planes of the swept bodies.
/// \param lines number of lines along the longer side of the field
/// \pre lines >= 1, and the box has a volume
DexelField cut_dexels(std::span<const SweptVolume> sweeps, std::span<const RigidMotion> poses, const ToolWedge& wedge,
                      const DexelBox& box, int axis, std::size_t lines);

}  // namespace retrace::fabrication

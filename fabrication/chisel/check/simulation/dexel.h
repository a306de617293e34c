#pragma once

// A dexel model of the blank: lengths that cuts remove from parallel lines. A second, independent way to cut, for
// checks and pictures.

#include <cstddef>
#include <span>
#include <vector>

#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// A box of the blank, in the workpiece frame: from its low corner to its high one, which lies on the blank's face.
struct DexelBox {
  geometry::Vec3 low_mm = geometry::Vec3::Zero();
  geometry::Vec3 high_mm = geometry::Vec3::Zero();
};

/// What lines along one axis of the workpiece frame lose, on a grid across it.
struct DexelField {
  int axis = 2;  ///< 0, 1, 2: x, y, z
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::vector<double> removed_mm;  ///< length that each line loses, row by row
  std::vector<double> lowest_mm;   ///< where the lowest removed part begins; the box's high end if nothing is
  double cell_area_mm2 = 0.0;

  double volume_mm3() const;
};

/// Cuts a field of lines, as a check of the exact figures and for pictures: the swept bodies are clipped here as
/// polyhedra, by their supporting planes, and not as in swept_span(). Resolution is that of the grid.
/// \param lines along the longer side of the field \pre lines >= 1, the box has a volume
DexelField cut_dexels(std::span<const SweptVolume> sweeps, std::span<const RigidMotion> poses, const ToolWedge& wedge,
                      const DexelBox& box, int axis, std::size_t lines);

}  // namespace retrace::fabrication

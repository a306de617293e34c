#pragma once

// Lattice of directions of light, and cells of a reflection table whose directions are points of this lattice.

#include <array>
#include <utility>
#include <vector>

#include "core/angle.h"
#include "geometry/vec.h"
#include "studies/appearance/reflection_table.h"

namespace retrace::studies {

/// Position on the lattice: entrance angle and azimuth, in lattice steps.
using LatticeIndex = std::pair<int, int>;

/// Cell of the reflection table while the table is being made.
struct PlannedCell {
  std::array<int, 2> corner{};  ///< position of the lower corner on the lattice: entrance angle, azimuth
  std::array<int, 2> size{};    ///< number of lattice steps along each side; multiples of 3
  double error = 0.0;           ///< relative error of values that are interpolated inside the cell

  bool is_smallest() const { return size[0] <= 3 && size[1] <= 3; }
};

/// Lattice of directions of light, which is common to all cells. Neighbouring cells therefore share the directions on
/// their common sides, even after they have been halved.
class LightLattice {
 public:
  /// \param entrance_deg maximum entrance angle
  /// \param table table whose range of directions the lattice covers
  LightLattice(double entrance_deg, const ReflectionTable& table);

  /// Returns the cells from which refinement starts.
  std::vector<PlannedCell> first_cells() const;
  /// Returns the lattice positions of a cell's 4 x 4 directions, ordered by azimuth and then by entrance angle. At
  /// normal incidence, all azimuths have the same lattice position. If the azimuths cover a full circle, the last
  /// azimuth has the same lattice position as the first.
  std::vector<LatticeIndex> indices_of(const PlannedCell& cell) const;
  Angle entrance_at(double steps) const { return Angle::from_rad(steps * entrance_step_.rad()); }
  Angle azimuth_at(double steps) const { return Angle::from_rad(first_azimuth_.rad() + steps * azimuth_step_.rad()); }
  /// Returns the direction to the source at a position within a cell. The position is given as fractions of the cell's
  /// sides.
  geometry::Vec3 to_source(const PlannedCell& cell, double entrance_fraction, double azimuth_fraction) const;
  /// Returns the minimum extent in entrance angle over all given cells.
  double min_extent_deg(const std::vector<PlannedCell>& cells) const;

 private:
  int entrance_cells_;
  int azimuth_cells_;
  bool is_full_circle_;  ///< true if the azimuths cover a full circle
  Angle first_azimuth_;
  Angle entrance_step_;
  Angle azimuth_step_;
};

}  // namespace retrace::studies

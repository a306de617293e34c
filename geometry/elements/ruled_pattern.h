#pragma once

// Arrays of ruled cells. A ruling machine cuts sets of parallel V-grooves into the master of a sheeting. In the part
// frame, the surface is the upper envelope of the groove faces. docs/theory/ruled_arrays.md derives the formulas.

#include <array>
#include <optional>
#include <vector>

#include "geometry/elements/array_layout.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/lattice.h"

namespace retrace::geometry {

/// A set of parallel V-grooves. Groove m has the position `offset_mm` plus the first m spacings. Positions are measured
/// along the left normal of the grooves, from the origin of the pattern.
struct GrooveSet {
  double azimuth_deg = 0.0;  ///< direction of the grooves, from +x towards +y
  /// Distances between neighbouring grooves; the list repeats; all > 0
  std::vector<double> spacing_mm;
  /// Angles between the vertical and the two faces of each groove: the face on the left and the face on the right. The
  /// list repeats; all angles are between 0 and 90.
  std::vector<std::array<double, 2>> half_angles_deg;
  double offset_mm = 0.0;
  double rise_mm = 0.0;  ///< height of the groove bottoms above z = 0, <= 0
  /// Width of a flat that replaces the groove bottom, > 0; 0: none. The planes of the faces are not changed.
  double bottom_flat_mm = 0.0;
  /// Radius of an arc that replaces the groove bottom and is tangent to the faces; 0: none. Not together with a flat.
  double bottom_radius_mm = 0.0;
  int bottom_chords = 16;  ///< number of chords that approximate the arc

  friend bool operator==(const GrooveSet&, const GrooveSet&) = default;
};

/// Groove sets and the cells between them.
struct RuledPattern {
  std::vector<GrooveSet> sets;
  /// Depth of the tops below z = 0. Pyramids that would be higher are truncated. Empty: no pyramid is truncated.
  std::optional<double> depth_mm;

  // The following members are computed by ruled_pattern().

  /// Smallest period along x and y. Empty if the grooves have no common period along these axes.
  std::optional<Vec2> period_mm;
  /// Cells of one period. Without a period, the cells around the origin.
  std::vector<Cell> cells;
  double mean_cell_mm2 = 0.0;  ///< mean area of a cell in plan
  double lowest_mm = 0.0;      ///< height of the lowest point of these cells
};

/// Triangle of groove sets with perpendicular faces. `base_deg` are the angles of the base triangle, all below 90.
/// The apex of one cell is at the origin. The grooves of the first set, which is opposite to the first angle, are along
/// y, and this angle is at the +x end of the cell.
/// \param spacing_mm distance between neighbouring grooves of the first set
std::vector<GrooveSet> perpendicular_groove_sets(const std::array<double, 3>& base_deg, double spacing_mm);

/// Returns the base angles of an isosceles cell with perpendicular faces. The first angle is the one that differs.
/// \param cant_deg angle between the axis of the cube corner and +z; positive: the face opposite to the first angle is
///     more parallel to the entrance face; negative: the dihedral edge towards the first angle is
std::array<double, 3> base_angles_of_cant(double cant_deg);

/// Largest number of cells of a finite part without a period, and of a period. Longer periods count as no period.
inline constexpr std::size_t kMaxRuledCells = 20000;
inline constexpr std::size_t kMaxCellsOfPeriod = 1000;

/// Computes the period and the cells of a pattern.
/// \pre the members of the sets are in their ranges
/// \throw InputError if the grooves leave no cells, or if the groove bottoms are wider than the spacing. The error
///     contains the key if a single key is the cause.
RuledPattern ruled_pattern(std::vector<GrooveSet> sets, std::optional<double> depth_mm);

/// Returns the cells of an array: those of one period, or all cells of a finite part without a period.
/// \throw InputError if an infinite array has no period, or if a finite part without a period has too many cells
Lattice ruled_lattice(const RuledPattern& pattern, const ArrayLayout& array);

/// Returns the largest cell of the pattern, with its apex at the origin.
Cell largest_cell(const RuledPattern& pattern);

/// Returns the size of an equilateral cell of mean area: the diameter of its circumscribed circle.
double aperture_of_mean_cell_mm(const RuledPattern& pattern);

}  // namespace retrace::geometry

#pragma once

// Cells of a ruled array: angles between their faces, cant, base triangle, effective aperture and truncated tops.

#include <array>
#include <optional>
#include <vector>

#include "geometry/elements/ruled_pattern.h"

namespace retrace::studies {

/// Properties of one cell.
struct RuledCellReport {
  double area_mm2 = 0.0;  ///< area in plan
  int faces = 0;          ///< number of groove faces
  /// Angles between neighbouring faces, measured inside the part as for a cube corner, for cells with three faces.
  std::optional<std::array<double, 3>> dihedral_deg;
  /// Angle between +z and the axis, which has equal angles to the three faces, and azimuth of the axis.
  std::optional<double> cant_deg;
  double cant_azimuth_deg = 0.0;
  /// Angles of the outline of triangular cells, starting with the smallest.
  std::optional<std::array<double, 3>> base_deg;
  /// Fraction of the plan area in which light along -z inside the part meets three different faces.
  double effective_aperture = 0.0;
  double truncated_fraction = 0.0;  ///< fraction of the plan area that flat tops occupy
  double bottom_fraction = 0.0;     ///< fraction of the plan area that flat or round groove bottoms occupy
};

struct RuledReport {
  bool is_period = true;  ///< false if the grooves have no period; the cells are then those around the origin
  std::vector<RuledCellReport> cells;
  double dead_fraction = 0.0;  ///< fraction of the area that flat tops and groove bottoms occupy
};

RuledReport report_ruled(const geometry::RuledPattern& pattern);

/// Returns the effective fraction of the area that the outline of a cell encloses in the plane z = 0. Light that enters
/// the effective area meets three different faces of the cell and leaves within the outline. Refraction and
/// reflectances are not considered. \param direction direction of the light inside the part; its z component is
/// negative
double effective_aperture(const geometry::Cell& cell, const geometry::Vec3& direction);

}  // namespace retrace::studies

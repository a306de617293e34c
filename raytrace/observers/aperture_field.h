#pragma once

// Far fields of cells, computed for many directions at a time.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/observers/coherent_group.h"
#include "raytrace/observers/field_lanes.h"

namespace retrace::raytrace {

/// Returns the contribution of a polygon to a field.
/// \param wave index of the polygon's transform
field_lanes::Use use_of(std::size_t wave, const FieldPolygon& polygon);

/// Far-field power of groups of polygons as a function of the direction. A polygon is the part of the entrance face
/// through which a plane wave leaves. The fields of the polygons of a group are added, and the powers of the groups are
/// added. Different cells often have the same strong polygons and differ only in weak ones. The transform of a polygon
/// is therefore computed one time for all cells that have it. Groups of resampled beams are separated by replicate.
class ApertureField {
 public:
  ApertureField() = default;
  /// \param coherency coherency matrix of the incident light along the axes of the source
  /// \param same_mm polygons are treated as equal if their corners differ by less than about this distance
  /// \param replicates number of replicates of resampled beams
  ApertureField(const std::vector<CoherentGroup>& groups, double wavelength_mm, const Eigen::Matrix2cd& coherency,
                double same_mm, std::size_t replicates = 0);

  bool empty() const { return fields_.empty(); }
  /// Returns the power of the mean field per unit area of direction cosines. Each row belongs to a direction. The first
  /// column is the power of beams that were traced exactly. The other columns are the replicates divided by the number
  /// of replicates, so that the sum of a row is the mean power. Rows are 0 if the computation was cancelled.
  Eigen::ArrayXXd per_cosines(std::span<const geometry::Vec2> cosines, const Cancellation* cancel) const;

 private:
  struct Wave {
    field_lanes::Outline outline;
    geometry::Vec2 cosines;
  };
  struct Field {
    std::vector<field_lanes::Use> uses;
    double copies = 1.0;
    std::size_t column = 0;
  };

  double wavelength_mm_ = 0.0;
  std::array<double, 4> coherency_{};
  std::vector<Wave> waves_;
  std::vector<Field> fields_;
  std::size_t columns_ = 1;
};

}  // namespace retrace::raytrace

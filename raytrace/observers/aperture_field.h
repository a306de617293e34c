#pragma once

// The fields of cells at many directions at once.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/progress.h"
#include "raytrace/observers/coherent_group.h"
#include "raytrace/observers/field_lanes.h"

namespace retrace::raytrace {

/// What groups send into directions, each group's polygons by their fields and the groups by their powers. Cells
/// differ by weak light from their neighbours while their strong light is the same: of polygons that several cells
/// send out the same way the transform is worked out once. Groups of resampled beams are kept apart by replicate.
class ApertureField {
 public:
  ApertureField() = default;
  /// \param coherency of the incident light along the axes of the source
  /// \param same_mm polygons whose corners differ by less are one \param replicates of resampled beams
  ApertureField(const std::vector<CoherentGroup>& groups, double wavelength_mm, const Eigen::Matrix2cd& coherency,
                double same_mm, std::size_t replicates = 0);

  bool empty() const { return fields_.empty(); }
  /// Power by the cosines of directions, of the mean field: a row each. The first column is what was followed exactly,
  /// the others are replicates over their number, so that all columns add up to the mean. Zeros if it was cancelled.
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

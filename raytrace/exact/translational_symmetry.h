#pragma once

// Translational symmetry of arrays. Identical elements act on light identically. A beam and its copies at other
// elements are therefore traced as one beam until their paths differ near a border.

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/exact/beam.h"
#include "raytrace/exact/periodic_region.h"

namespace retrace::raytrace {

/// Translational symmetry of an array: identical cells, and the region in which a shift by one period maps each cell to
/// an identical cell. In a part with zones (areas with different arrays), each region has its own symmetry.
class TranslationalSymmetry {
 public:
  /// Returns the symmetry of a part, or nothing if it cannot be used. This is the case if the array has too few
  /// identical elements, or an outline that is not a rectangle along the axes. A part with zones has no symmetry if
  /// none of its regions is periodic.
  /// \param centre_mm point of the plane z = 0 that becomes the origin
  static std::optional<TranslationalSymmetry> of(const geometry::Part& part, const geometry::Vec2& centre_mm);

  /// Returns the identity and position of a cell. The id is that of the first identical cell.
  /// \param offset_mm displacement of the cell as given by CellIndex
  CellInstance instance_of(const geometry::SurfacePatch& patch, const geometry::PatchCell& cell,
                           const geometry::Vec2& offset_mm) const;

  /// Returns the period of the array. It is not defined for a part with zones.
  const geometry::Vec2& period_mm() const { return period_mm_; }
  /// Returns the regions of a part with zones, which together cover the part. The list is empty for a single array.
  const std::vector<PeriodicRegion>& regions() const { return regions_; }
  /// Returns a shift within the period that maps an infinite part to itself, if there is any.
  const std::optional<geometry::Vec2>& within_period_mm() const { return within_period_mm_; }

  /// Divides the copies of a beam into groups. All copies of a group meet identical facets.
  /// \param places displacements of the copies from the beam; they are multiples of the periods
  /// \param sweep box in x and y around all facets that the beam itself may meet
  /// \param region index of the region that contains the copies; it is used only for parts with zones
  /// \return the displacements of each group; empty if all copies form one group
  std::vector<InstanceOffsets> divided(const InstanceOffsets& places, const geometry::Rectangle& sweep,
                                       std::uint32_t region) const;

 private:
  struct Shape {
    std::uint64_t id = 0;
    geometry::Vec2 shift_mm = geometry::Vec2::Zero();  ///< displacement from the first cell with this shape
  };

  void find_shapes(const geometry::Part& part);
  void find_region(const geometry::Part& part, const geometry::Vec2& centre_mm);
  void find_shift_within_period(const geometry::Part& part);
  void find_regions(const geometry::Part& part, const geometry::Vec2& centre_mm);
  bool is_within(const geometry::Rectangle& sweep, const geometry::Vec2& by, Eigen::Index axis) const;

  const geometry::Part* part_ = nullptr;
  geometry::Vec2 period_mm_ = geometry::Vec2::Zero();
  std::vector<std::vector<Shape>> shapes_;  ///< indexed by patch and cell
  /// Region in which a shift by one period along an axis maps cells to identical cells, if the shifted cell is also in
  /// the region.
  geometry::Rectangle region_mm_;
  std::optional<geometry::Vec2> within_period_mm_;
  std::vector<PeriodicRegion> regions_;
  double near_mm_ = 0.0;
};

}  // namespace retrace::raytrace

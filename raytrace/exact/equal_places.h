#pragma once

// Where light of an array meets the same: its elements are alike, so that a beam and its copies at other elements are
// followed once, until a border tells them apart.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/part/part.h"
#include "raytrace/exact/beam.h"
#include "raytrace/exact/repeat_region.h"

namespace retrace::raytrace {

/// Translational symmetry of an array: the identical cells, and the region within which a shift by one period maps the
/// part to itself. A part with zones has a separate symmetry for each region.
class EqualPlaces {
 public:
  /// Returns the symmetry of a part, or nothing if it has none: if the elements differ, are too few, or have an outline
  /// that is not a rectangle along the axes. For a part with zones, returns nothing if no region is periodic.
  /// \param centre_mm point of the plane z = 0 that becomes the origin
  static std::optional<EqualPlaces> of(const geometry::Part& part, const geometry::Vec2& centre_mm);

  /// A cell as one of those that are like it: the id is that of the first of them. \param offset_mm as CellIndex tells
  /// it
  CellPlace place_of(const geometry::SurfacePatch& patch, const geometry::PatchCell& cell,
                     const geometry::Vec2& offset_mm) const;

  /// Period of a part that is a single array.
  const geometry::Vec2& period_mm() const { return period_mm_; }
  /// Regions of a part with zones, which together cover the part. Empty for a part with a single array.
  const std::vector<RepeatRegion>& regions() const { return regions_; }
  /// Of a part that repeats without end: by what it may be moved besides, within its period, and stay the same.
  const std::optional<geometry::Vec2>& within_period_mm() const { return within_period_mm_; }

  /// Divides the copies of a beam into groups that meet identical facets.
  /// \param places offsets of the beam and its copies, which differ by whole periods
  /// \param sweep box, in projection along z, around all facets that the first copy may meet
  /// \param region parts with zones: index of the region that contains the copies
  /// \return the offsets of each group; empty if all copies form one group
  std::vector<BeamPlaces> divided(const BeamPlaces& places, const geometry::Rectangle& sweep,
                                  std::uint32_t region) const;

 private:
  struct Shape {
    std::uint64_t id = 0;
    geometry::Vec2 shift_mm = geometry::Vec2::Zero();  ///< from the first of the shape
  };

  void find_shapes(const geometry::Part& part);
  void find_region(const geometry::Part& part, const geometry::Vec2& centre_mm);
  void find_shift_within_period(const geometry::Part& part);
  void find_regions(const geometry::Part& part, const geometry::Vec2& centre_mm);
  bool is_within(const geometry::Rectangle& sweep, const geometry::Vec2& by, Eigen::Index axis) const;

  const geometry::Part* part_ = nullptr;
  geometry::Vec2 period_mm_ = geometry::Vec2::Zero();
  std::vector<std::vector<Shape>> shapes_;  ///< by patch and cell
  /// Along each axis the part is the same moved by a period as long as one stays between these.
  geometry::Rectangle region_mm_;
  std::optional<geometry::Vec2> within_period_mm_;
  std::vector<RepeatRegion> regions_;
  double near_mm_ = 0.0;
};

}  // namespace retrace::raytrace

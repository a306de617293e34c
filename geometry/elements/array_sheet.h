#pragma once

// Lays out the cells of an array on a sheet. A sheet is a plane on which the cells form a regular lattice; it is then
// placed on the plane z = 0 or on a curved substrate. The back surface is built from its cells.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/lattice.h"
#include "geometry/elements/part_spec.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/outline/plan_region.h"
#include "geometry/polygon.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::geometry {

/// Range of lattice indices. The upper bounds are excluded.
struct IndexRange {
  std::array<std::int64_t, 2> lower{};
  std::array<std::int64_t, 2> upper{};
};

/// Plane sheet on which an array is laid out. If the elements are upright (on the plane z = 0, or parallel to z on a
/// substrate), the sheet is the projection of the part onto the xy plane ("plan"). Otherwise it is the substrate
/// unrolled into a plane (SubstrateSurface), and sheet and plan coincide only at the centre of the part. Lengths are in
/// mm in the part frame.
struct ArraySheet {
  /// \pre the array is not `single`; `spec` outlives the sheet
  /// \throw InputError if the array is smaller than one element
  explicit ArraySheet(const PartSpec& spec);

  /// Returns the indices of all cells of the lattice that may overlap the part.
  IndexRange indices() const;
  /// Returns the origin of the lattice, shifted by (i, j) periods, as a position on the sheet.
  Vec2 at_mm(std::int64_t i, std::int64_t j) const;
  /// Returns true if a shift along this axis (0: x, 1: y) changes only the height of the substrate. Periods of the
  /// lattice that differ only in their index along this axis then have the same shape.
  bool repeats_along(std::size_t axis) const;

  const PartSpec* spec;
  const PlanRegion* outline = nullptr;      ///< outline that cuts the array; null for a rectangle along the axes
  std::optional<SubstrateSurface> surface;  ///< not set for the plane z = 0
  bool is_upright = true;
  std::optional<PrismBlock> prisms;  ///< set if the elements are prisms; positions are relative to the block's centre
  Lattice lattice;
  Vec2 anchor_mm = Vec2::Zero();  ///< origin of the lattice on the sheet
  Vec2 centre_mm = Vec2::Zero();  ///< centre of the part, where the substrate has its origin
  Rectangle part_mm;              ///< extent of the part in plan
  Rectangle coverage_mm;          ///< area of the sheet that covers the part
  /// area of the sheet that elements fill; the rest is flat land (surface without elements)
  Rectangle block_mm;
  /// Height, in coordinates of the substrate, that becomes z = 0 of the part. Usually, it is the height of the highest
  /// point of the substrate. For a substrate below an entrance surface, it is the height of the lowest point instead,
  /// so that the entrance surface is above z = 0 everywhere.
  double zero_mm = 0.0;
  /// cells that extend beyond a border of the sheet by at most this length count as inside
  double sliver_mm = 0.0;
  double tolerance_mm = 0.0;              ///< tolerance for the border of the part in plan
  std::vector<Vec2> reference_points_mm;  ///< for each cell of the lattice, the point that is placed on the substrate
  /// For each cell, the height of each corner of its outline (its rim) above the substrate. The corners of one cell may
  /// have different heights, because the rim of a full cube corner is not horizontal.
  std::vector<std::vector<double>> rims_mm;

 private:
  void lay_out_infinite();
  void lay_out_finite();
  void lay_on_substrate();
  void lay_out_prisms(const RtpElement& prism);
  void lay_out_cubes();
  Rectangle arcs_of_border() const;
  void measure_cells();
};

/// Position of a lattice cell. Coordinates are relative to the origin of its SheetPortion.
struct SheetCell {
  Vec2 shift_mm = Vec2::Zero();  ///< shift on the sheet, relative to the cell's position in the lattice
  Polygon on_sheet;
  Polygon outline;       ///< in plan
  SubstrateFrame frame;  ///< frame of the substrate at the cell's reference point
};

/// Portion of a sheet. Its coordinates are relative to the lattice's origin in the period (i, j). Portions of the same
/// shape therefore have the same coordinates, wherever they are on the sheet.
class SheetPortion {
 public:
  /// \param is_alone true if this is the only portion of the sheet; heights are then relative to z = 0 of the part
  SheetPortion(const ArraySheet& sheet, std::int64_t i, std::int64_t j, bool is_alone);

  SheetCell sheet_cell(std::size_t cell, const Vec2& shift_mm) const;
  BorderRelation border_relation(const SheetCell& place) const;
  /// Returns true if the cell does not overlap the part in plan.
  bool is_clear_of_part(const SheetCell& place) const;
  /// Returns the part of an outline in plan that is within the part and within a rectangle of the sheet.
  /// \param outline the outline of `place`, or an outline within it
  Polygon within(const SheetCell& place, const Polygon& outline, const Rectangle& on_sheet) const;
  /// Returns the portions of a polygon in plan that are inside the outline's margin, where elements are. Without an
  /// outline, returns the polygon.
  std::vector<Polygon> in_element_area(Polygon in_plan) const;
  /// Returns the portions of a polygon in plan on the flat margin of the outline. Without an outline, there are none.
  std::vector<Polygon> in_outline_margin(Polygon in_plan) const;
  /// Returns the portions of a plan polygon that are inside the outline, including the outline's margin. Returns the
  /// whole polygon if there is no outline.
  std::vector<Polygon> in_outline(Polygon in_plan) const;
  /// Returns true if a plan polygon is completely inside the area of elements, which the margin of the outline
  /// encloses. Returns true if there is no outline.
  bool is_in_element_area(const Polygon& in_plan) const;
  /// Returns the borders of the outline and of the area of elements. Walls on them are border walls of the array.
  std::vector<PolygonLoop> outline_borders() const;
  /// Returns the bounding box in plan of a rectangle on the sheet.
  Rectangle plan_bounding_box(const Rectangle& on_sheet) const;
  /// Returns the area in plan that elements fill. Walls on its border are border walls of the array.
  Rectangle block_in_plan() const;

  const Rectangle& part() const { return part_; }
  const Rectangle& reach() const { return reach_; }
  const Rectangle& block() const { return block_; }
  /// Returns the origin in the part frame.
  const Vec2& origin_mm() const { return origin_; }
  double height_mm() const { return height_ - sheet_->zero_mm; }

 private:
  Vec2 plan_of(const Vec2& on_sheet, double rim_mm = 0.0) const;
  SubstrateFrame frame_at(const Vec2& on_sheet) const;
  /// Returns the portions of a plan polygon that are inside a region of the outline. Returns the whole polygon if there
  /// is no outline.
  std::vector<Polygon> clipped(Polygon in_plan, ConvexRegion PlanRegion::*region) const;

  const ArraySheet* sheet_;
  Vec2 at_;              ///< origin on the sheet
  Vec2 origin_;          ///< origin in plan
  double height_ = 0.0;  ///< height of the substrate at the origin
  Rectangle part_;
  Rectangle reach_;
  Rectangle block_;
};

}  // namespace retrace::geometry

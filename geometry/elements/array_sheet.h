#pragma once

// Lays out the cells of an array on a sheet, which lies on what the part stands on: the plane z = 0 or a curved
// substrate. The back surface is tiled from it.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/elements/lattice.h"
#include "geometry/elements/part_spec.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/polygon.h"
#include "geometry/substrate/substrate_surface.h"

namespace retrace::geometry {

/// Range of lattice indices, upper bounds excluded.
struct IndexRange {
  std::array<std::int64_t, 2> lower{};
  std::array<std::int64_t, 2> upper{};
};

/// The sheet that an array is laid out on. Where elements stand upright - on the plane z = 0, or parallel to z on a
/// substrate - it is the part in plan; otherwise the substrate rolled out (SubstrateSurface), which touches the plan in
/// the part's middle. All lengths in mm, in the part frame.
struct ArraySheet {
  /// \pre the array is not `single`; `spec` lives as long as the sheet
  /// \throw InputError where the array is smaller than one element
  explicit ArraySheet(const PartSpec& spec);

  /// All cells of the lattice that may reach into the part.
  IndexRange indices() const;
  /// Where the lattice's origin of that period lies.
  Vec2 at_mm(std::int64_t i, std::int64_t j) const;
  /// Whether periods that differ along an axis (0: x, 1: y) alone are alike but for their height.
  bool repeats_along(std::size_t axis) const;

  const PartSpec* spec;
  std::optional<SubstrateSurface> surface;  ///< none: the plane z = 0
  bool is_upright = true;
  std::optional<PrismBlock> prisms;  ///< from the block's middle
  Lattice lattice;
  Vec2 anchor_mm = Vec2::Zero();  ///< the lattice's origin on the sheet
  Vec2 middle_mm = Vec2::Zero();  ///< of the part: where the substrate has its origin
  Rectangle part_mm;              ///< in plan
  Rectangle reach_mm;             ///< of the sheet: what covers the part
  Rectangle block_mm;             ///< of the sheet: what elements fill; the rest is flat land
  double top_mm = 0.0;            ///< height of the substrate that is z = 0
  double sliver_mm = 0.0;         ///< what crosses a border of the sheet by no more lies within it
  double tolerance_mm = 0.0;      ///< likewise of the part's border in plan
  std::vector<Vec2> middles_mm;   ///< of each cell of the lattice: what stands on the substrate
  /// Of each corner of each cell: its height over the substrate, as rims of full cubes are not level.
  std::vector<std::vector<double>> rims_mm;

 private:
  void lay_out_endless();
  void lay_out_finite();
  void lay_on_substrate();
  void lay_out_prisms(const RtpElement& prism);
  void lay_out_cubes();
  Rectangle arcs_of_border() const;
  void measure_cells();
};

/// A cell of the lattice in its place; lengths from the origin of its piece.
struct CellPlace {
  Vec2 shift_mm = Vec2::Zero();  ///< on the sheet, from where the lattice has the cell
  Polygon on_sheet;
  Polygon outline;       ///< in plan
  SubstrateFrame frame;  ///< the substrate under its middle
};

/// A piece of a sheet, told from the origin of one of the lattice's periods, so that like pieces are equal.
class SheetPiece {
 public:
  /// \param is_alone the only piece of the sheet, which is told in heights of the part
  SheetPiece(const ArraySheet& sheet, std::int64_t i, std::int64_t j, bool is_alone);

  CellPlace place(std::size_t cell, const Vec2& shift_mm) const;
  Standing standing(const CellPlace& place) const;
  /// Whether the cell's place in plan is clear of the part.
  bool is_clear_of_part(const CellPlace& place) const;
  /// What of an outline in plan, which is the place's or lies in it, lies within a rectangle of the sheet and the part.
  Polygon within(const CellPlace& place, const Polygon& outline, const Rectangle& on_sheet) const;
  /// The box in plan round a rectangle of the sheet.
  Rectangle plan_round(const Rectangle& on_sheet) const;
  /// What elements fill in plan: walls on its border are the array's.
  Rectangle block_in_plan() const;

  const Rectangle& part() const { return part_; }
  const Rectangle& reach() const { return reach_; }
  const Rectangle& block() const { return block_; }
  /// The origin in the part frame.
  const Vec2& origin_mm() const { return origin_; }
  double height_mm() const { return height_ - sheet_->top_mm; }

 private:
  Vec2 plan_of(const Vec2& on_sheet, double rim_mm = 0.0) const;
  SubstrateFrame frame_at(const Vec2& on_sheet) const;

  const ArraySheet* sheet_;
  Vec2 at_;              ///< the origin on the sheet
  Vec2 origin_;          ///< in plan
  double height_ = 0.0;  ///< the substrate's own there
  Rectangle part_;
  Rectangle reach_;
  Rectangle block_;
};

}  // namespace retrace::geometry

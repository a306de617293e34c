#pragma once

// Substrates as surfaces for elements: heights, normals and local frames, and the arc lengths that are used to lay out
// an array.

#include <cstdint>
#include <memory>

#include "geometry/polygon.h"
#include "geometry/substrate/substrate.h"
#include "geometry/surface/sag.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Local frame on a substrate: three unit vectors. The third is the substrate's normal, towards the light.
struct SubstrateFrame {
  Vec3 origin = Vec3::Zero();
  Vec3 along_u = Vec3::UnitX();
  Vec3 along_v = Vec3::UnitY();
  Vec3 normal = Vec3::UnitZ();
};

/// Substrate over a part of a given size: heights, normals and arc lengths. Coordinates are in mm relative to the
/// centre of the part.
///
/// Arc coordinates (u, v) are positions on a sheet that is laid on the substrate. On planes and cylinders they preserve
/// lengths. On other substrates, v is the arc length along x = 0, and u is the arc length along the line y = const
/// through the point. Lengths along rows are then exact, but distances between rows are exact only at x = 0. Lines of
/// equal v are straight in plan.
class SubstrateSurface {
 public:
  /// \param half_mm half of the part's size in plan
  /// \param size_mm size of an element, which determines the step for the integration of formulas
  SubstrateSurface(const Substrate& substrate, const Vec2& half_mm, double size_mm);
  ~SubstrateSurface();
  SubstrateSurface(SubstrateSurface&&) noexcept;

  /// Returns the height over the part's xy plane and its derivatives. Outside the part, where the substrate may be
  /// undefined, the surface is continued along its tangent.
  Jet at(const Vec2& plan) const;
  Vec3 normal_at(const Vec2& plan) const;
  /// Returns the minimum height of the surface over a convex polygon in plan.
  double lowest_over(const Polygon& plan) const;
  /// Returns true if the substrate follows an entrance surface. Each element is then placed at the minimum height of
  /// the substrate over the element's outline.
  bool is_offset() const { return std::holds_alternative<OffsetSubstrate>(substrate_.shape); }

  /// Returns the position in plan for arc coordinates. The two are equal if the elements are parallel to z.
  Vec2 plan_of(const Vec2& arc) const;
  /// Returns the arc coordinates for a position in plan.
  Vec2 arc_of(const Vec2& plan) const;
  /// Returns the arc coordinates at which the lines v = 0 and u = 0 cross the part's border.
  Rectangle arc_reach() const;
  /// Return the frame at arc coordinates, and the frame at a position in plan.
  SubstrateFrame frame_at(const Vec2& arc) const { return frame_over(plan_of(arc)); }
  SubstrateFrame frame_over(const Vec2& plan) const;

  /// Return true if a shift along u (or along v) changes the substrate only by a constant height. Both are true for a
  /// plane. For a cylinder, only the function for the direction of its axis returns true.
  bool repeats_along_u() const;
  bool repeats_along_v() const;
  bool is_upright() const { return substrate_.element_axes == ElementAxes::parallel; }

 private:
  struct ArcTables;
  ArcTables& tables() const;

  Jet jet_at(const Vec2& plan) const;

  Substrate substrate_;
  Sag sag_;
  Vec2 half_mm_;
  double size_mm_;
  /// for formulas only; created on first use, so not safe for several threads
  mutable std::unique_ptr<ArcTables> tables_;
};

/// Properties of a substrate over a part.
struct SubstrateMeasures {
  double area_mm2 = 0.0;
  double lowest_mm = 0.0;  ///< heights of the substrate itself, before it is shifted to z = 0
  double highest_mm = 0.0;
  double steepest_deg = 0.0;
  double min_radius_mm = 0.0;  ///< minimum radius of curvature; infinite for a plane
};

/// Measures a substrate on a grid of 129 x 129 points.
/// \throw InputError if the substrate is not finite
SubstrateMeasures measure_substrate(const SubstrateSurface& substrate, const Vec2& half_mm);

}  // namespace retrace::geometry

#pragma once

// Substrates as surfaces that elements stand on: height, normal and local frame at every place, and the arc lengths by
// which an array is laid out on them.

#include <cstdint>
#include <memory>

#include "geometry/polygon.h"
#include "geometry/substrate/substrate.h"
#include "geometry/surface/sag.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Where something stands on a substrate: three unit axes, the third along the substrate's normal towards the light.
struct SubstrateFrame {
  Vec3 origin = Vec3::Zero();
  Vec3 along_u = Vec3::UnitX();
  Vec3 along_v = Vec3::UnitY();
  Vec3 normal = Vec3::UnitZ();
};

/// A substrate with the part's size: heights, normals and arc lengths. Coordinates are in mm from the middle of the
/// part.
///
/// Arc coordinates (u, v) lie on the substrate as a sheet does that was laid on it. On planes and cylinders lengths are
/// true. On others v is the arc length along x = 0, and u that along the line y = const through that place: rows have
/// true lengths, and are as far apart as they should be along x = 0. Lines of equal v are straight in plan.
class SubstrateSurface {
 public:
  /// \param half_mm half the part's size in plan \param size_mm of an element: how finely formulas are integrated
  SubstrateSurface(const Substrate& substrate, const Vec2& half_mm, double size_mm);
  ~SubstrateSurface();
  SubstrateSurface(SubstrateSurface&&) noexcept;

  /// Height over the part's xy plane and its derivatives; what has no value beyond the part goes on straight.
  Jet at(const Vec2& plan) const;
  Vec3 normal_at(const Vec2& plan) const;

  /// The place in plan of arc coordinates, which are those of the plan where elements stand parallel.
  Vec2 plan_of(const Vec2& arc) const;
  /// The other way round.
  Vec2 arc_of(const Vec2& plan) const;
  /// Where the lines v = 0 and u = 0 end at the part's border.
  Rectangle arc_reach() const;
  /// How an element stands at arc coordinates, and over a place in plan.
  SubstrateFrame frame_at(const Vec2& arc) const { return frame_over(plan_of(arc)); }
  SubstrateFrame frame_over(const Vec2& plan) const;

  /// Whether the substrate is the same, but for its height, at every u and at every v.
  bool repeats_along_u() const;
  bool repeats_along_v() const;
  bool is_upright() const { return substrate_.element_axes == ElementAxes::parallel; }

 private:
  struct ArcTables;
  ArcTables& tables() const;

  Jet jet_at(const Vec2& plan) const { return sag_.evaluate(Jet(plan.x(), 1.0, 0.0), Jet(plan.y(), 0.0, 1.0)); }

  Substrate substrate_;
  Sag sag_;
  Vec2 half_mm_;
  double size_mm_;
  mutable std::unique_ptr<ArcTables> tables_;  ///< of formulas, from when they are needed: not to be shared by threads
};

/// What a substrate is like over a part.
struct SubstrateMeasures {
  double area_mm2 = 0.0;
  double lowest_mm = 0.0;  ///< heights as the substrate itself has them
  double highest_mm = 0.0;
  double steepest_deg = 0.0;
  double least_radius_mm = 0.0;  ///< of curvature; infinite of a plane
};

/// Measured on a grid of 129 x 129 places. \throw InputError where the substrate is not finite
SubstrateMeasures measure_substrate(const SubstrateSurface& substrate, const Vec2& half_mm);

}  // namespace retrace::geometry

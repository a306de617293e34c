#pragma once

// Collisions between tool, holder, table and fixtures as convex bodies along straight moves.

#include <span>
#include <string>
#include <vector>

#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/machine/machine.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Whether the convex hulls of two sets of points have a point in common; hulls that only touch may count either way.
/// \pre neither set is empty
bool hulls_meet(std::span<const geometry::Vec3> a, std::span<const geometry::Vec3> b);

/// A convex body in the frame of the machine: the hull of its points.
struct PlacedBody {
  std::string name;
  std::vector<geometry::Vec3> points_mm;
};

/// What the tool consists of, relative to its tip: the diamond up to `diamond_mm` above its edge, and the bodies that
/// the machine file says move with it.
std::vector<PlacedBody> tool_bodies(const Machine& machine, const ToolWedge& wedge, double diamond_mm);

/// Table, cradle and fixtures of the machine file where the rotary axes put them.
std::vector<PlacedBody> standing_bodies(const Machine& machine, const RotaryPose& pose);

/// Two bodies that meet.
struct BodyContact {
  std::string tool;
  std::string other;
};
/// What the tool runs into while its tip goes anywhere within the hull of some places, such as the ends of a straight
/// move: the swept hull of a convex body is exact.
std::vector<BodyContact> contacts(std::span<const PlacedBody> tool, std::span<const PlacedBody> standing,
                                  std::span<const geometry::Vec3> tips_mm);

}  // namespace retrace::fabrication

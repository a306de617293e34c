#pragma once

// Detects collisions of tool and holder with table and fixtures. All bodies are convex, and all moves are straight.

#include <span>
#include <string>
#include <vector>

#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/machine/machine.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Returns true if the convex hulls of two sets of points intersect. If the hulls only touch, the result may be true or
/// false.
/// \pre neither set is empty
bool hulls_meet(std::span<const geometry::Vec3> a, std::span<const geometry::Vec3> b);

/// Convex body in the machine frame: the convex hull of its points.
struct PlacedBody {
  std::string name;
  std::vector<geometry::Vec3> points_mm;
};

/// Returns the bodies that move with the tool, relative to its tip. They are the diamond up to `diamond_mm` above its
/// edge, and the tool bodies of the machine file.
std::vector<PlacedBody> tool_bodies(const Machine& machine, const ToolWedge& wedge, double diamond_mm);

/// Returns table, cradle and fixtures of the machine file, as positioned by the rotary axes.
std::vector<PlacedBody> standing_bodies(const Machine& machine, const RotaryPose& pose);

/// Names of two bodies that collide.
struct BodyContact {
  std::string tool;
  std::string other;
};
/// Returns the collisions of the tool while its tip moves inside the convex hull of some points, for example along a
/// straight move between two end points. The result is exact, because the swept volume of a convex body is convex.
std::vector<BodyContact> contacts(std::span<const PlacedBody> tool, std::span<const PlacedBody> standing,
                                  std::span<const geometry::Vec3> tips_mm);

}  // namespace retrace::fabrication

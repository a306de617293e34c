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

/// Returns the bodies that move with the tool, relative to its tip. They are the tool bodies of the machine file, and
/// the part of the diamond from its edge up to the height `diamond_mm`.
std::vector<PlacedBody> tool_bodies(const Machine& machine, const ToolWedge& wedge, double diamond_mm);

/// Returns the table, the cradle and the fixtures that the machine file describes, in their positions for a rotary
/// pose.
std::vector<PlacedBody> stationary_bodies(const Machine& machine, const RotaryPose& pose);

/// Names of two bodies that collide.
struct BodyContact {
  std::string tool;
  std::string other;
};
/// Returns the pairs of bodies that collide while the tip of the tool moves inside the convex hull of `tips_mm`. For a
/// straight move, `tips_mm` contains the two end points. The result is exact, because the swept volume of a convex body
/// is convex.
/// \param tool bodies that move with the tool
/// \param stationary bodies that do not move
std::vector<BodyContact> contacts(std::span<const PlacedBody> tool, std::span<const PlacedBody> stationary,
                                  std::span<const geometry::Vec3> tips_mm);

}  // namespace retrace::fabrication

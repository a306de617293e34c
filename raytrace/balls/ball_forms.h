#pragma once

// Closed forms for retroreflecting balls: return error, paraxial focus, share of the aperture that comes back, packing.

#include <optional>

#include "raytrace/balls/ball_layer.h"

namespace retrace::raytrace {

/// Closed forms of a ball with a concentric mirror, for light in the plane through its centre that goes in, meets the
/// mirror once and leaves (docs/theory/beads.md). Heights are distances of the incident ray from the centre over the
/// ball's radius, 0 to 1; indices are relative to air.

/// By how much the light that leaves is turned away from the one back to the source: positive where it crosses the axis
/// on its way to the source, as behind balls that focus beyond their mirror. rad
double return_error_rad(double height, double index, double spacer_index, double mirror_radius_over_radius);

/// Its slope at height 0: the paraxial power 2 (1 - 2 / n + (1 - R / rho) / m). 0: light near the axis comes back
/// parallel.
double paraxial_error(double index, double spacer_index, double mirror_radius_over_radius);

/// The offset over the ball's radius at which the mirror lies in the paraxial focus. None for n >= 2, which focuses on
/// or inside its own back, and where the spacer's index is so high that no finite bowl does.
std::optional<double> focal_offset_over_radius(double index, double spacer_index);

/// Share of the aperture whose light comes back within `half_angle_rad`: measure of the heights, by area.
double share_within(double half_angle_rad, double index, double spacer_index, double mirror_radius_over_radius);

/// Largest |return error| over all heights. rad
double largest_return_error_rad(double index, double spacer_index, double mirror_radius_over_radius);

/// Share of the plan that balls of a layer cover: pi / (2 sqrt 3) (diameter / pitch)^2; 1 for a single ball.
double packing_share(const BallLayer& layer);

}  // namespace retrace::raytrace

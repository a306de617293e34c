#pragma once

// Formulas for retroreflecting balls: return error, paraxial focus, retroreflecting fraction of the aperture, packing.

#include <optional>

#include "raytrace/balls/ball_layer.h"

namespace retrace::raytrace {

/// The formulas hold for a ball with a concentric mirror. The light travels in a plane through the centre of the ball,
/// enters, meets the mirror one time and leaves (docs/theory/beads.md). A height is the distance of the incident ray
/// from the centre divided by the radius, 0 to 1. Indices are relative to air.

/// Returns the angle in rad between the leaving light and the direction to the source. It is positive if the leaving
/// light crosses the axis (the line through the ball's centre in the direction to the source). Near the axis, this is
/// the case for balls whose focus is in front of their mirror.
double return_error_rad(double height, double index, double spacer_index, double mirror_radius_over_radius);

/// Returns the derivative of the return error at height 0. This is the paraxial power 2 (1 - 2 / n + (1 - R / rho) /
/// m). n is the index of the ball and m that of the spacer; R is the radius of the ball and rho that of the mirror. If
/// the power is 0, light near the axis leaves parallel to the axis.
double paraxial_error(double index, double spacer_index, double mirror_radius_over_radius);

/// Returns the distance of the mirror from the ball, divided by the radius of the ball, for which the mirror is at the
/// paraxial focus. Returns nothing for n >= 2, because the focus is then not behind the ball. Also returns nothing if
/// the index of the spacer is too high for a finite distance.
std::optional<double> focal_offset_over_radius(double index, double spacer_index);

/// Returns the fraction of the aperture, by area, whose light returns within `half_angle_rad`.
double fraction_within(double half_angle_rad, double index, double spacer_index, double mirror_radius_over_radius);

/// Returns the maximum absolute return error over all heights, in rad.
double largest_return_error_rad(double index, double spacer_index, double mirror_radius_over_radius);

/// Returns the fraction of the layer's area that the balls cover, in projection along z: pi / (2 sqrt 3) (diameter /
/// pitch)^2, or 1 for a single ball.
double packing_fraction(const BallLayer& layer);

}  // namespace retrace::raytrace

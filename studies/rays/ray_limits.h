#pragma once

// Internal to studies/rays: what sources may hold of each ray, whatever their format.

#include <optional>
#include <string>

#include "studies/rays/ray_set.h"

namespace retrace::studies {

/// From X rays to the far infrared: what lies outside is in another unit.
bool is_wavelength(double nm);
/// A message of one that is none.
std::string wavelength_text(double nm);

/// Returns the unit vector along a direction. Its length may be any finite number above 0: squares of coordinates
/// neither overflow nor vanish. Returns nothing if the length is 0 or not finite.
std::optional<Vec3> unit_along(const Vec3& direction);

/// +x, seen across a direction; another axis where the direction lies along it.
Vec3 axis_across(const Vec3& direction);

/// Turns the axis across the direction. \return what is wrong with the Stokes parameters; null if nothing is
const char* settle_stokes(SetRay& ray);

}  // namespace retrace::studies

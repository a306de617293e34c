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

/// Returns the unit vector in the direction of a vector. Very long and very short vectors cause no overflow or
/// underflow. Returns nothing if the length is 0 or not finite.
std::optional<Vec3> unit_along(const Vec3& direction);

/// +x, seen across a direction; another axis where the direction lies along it.
Vec3 axis_across(const Vec3& direction);

/// Maximum total power of all rays, in W or lm. With this limit, the sum of the squares of the powers is finite, too.
inline constexpr double kMaxTotalPower = 1e150;

/// Total power of all rays that have been read from a source so far.
class TotalPower {
 public:
  /// Adds the power of a ray. Returns false if the total radiant or luminous power is then above kMaxTotalPower.
  bool add(const SetRay& ray);

 private:
  double radiant_w_ = 0.0;
  double luminous_lm_ = 0.0;
};
/// Returns the error message for a ray with which the total power exceeds kMaxTotalPower.
std::string total_power_text(double power);

/// Turns the axis across the direction. \return what is wrong with the Stokes parameters; null if nothing is
const char* settle_stokes(SetRay& ray);

}  // namespace retrace::studies

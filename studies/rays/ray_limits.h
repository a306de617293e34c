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

/// Returns the unit vector in the direction of a vector of any finite length above 0. Very long and very short vectors
/// cause no overflow or underflow. Returns nothing if the length is 0 or not finite.
std::optional<Vec3> unit_along(const Vec3& direction);

/// +x, seen across a direction; another axis where the direction lies along it.
Vec3 axis_across(const Vec3& direction);

/// Maximum total power of all rays, in W or lm. The sum of the squares of the powers is then finite as well.
inline constexpr double kMaxTotalPower = 1e150;

/// Total power of the rays of a source that have been read so far.
class TotalPower {
 public:
  /// Adds the power of a ray. Returns false if a total is then above kMaxTotalPower.
  bool add(const SetRay& ray);

 private:
  double radiant_w_ = 0.0;
  double luminous_lm_ = 0.0;
};
/// Returns a message on a ray whose power makes the total too large.
std::string total_power_text(double power);

/// Turns the axis across the direction. \return what is wrong with the Stokes parameters; null if nothing is
const char* settle_stokes(SetRay& ray);

}  // namespace retrace::studies

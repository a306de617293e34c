#pragma once

// Limits of the values of a ray, for sources of all formats. Internal to studies/rays.

#include <optional>
#include <string>

#include "studies/rays/ray_set.h"

namespace retrace::studies {

/// Returns true if a value in nm is between X rays and the far infrared. Other values are probably in another unit.
bool is_wavelength(double nm);
/// Returns the error message for a value that is not a valid wavelength.
std::string wavelength_text(double nm);

/// Returns the unit vector in the direction of a vector. Very long and very short vectors cause no overflow or
/// underflow. Returns nothing if the length is 0 or not finite.
std::optional<Vec3> unit_along(const Vec3& direction);

/// Returns the x axis projected perpendicular to a direction. If the direction is parallel to x, another axis is used.
Vec3 perpendicular_axis(const Vec3& direction);

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

/// Makes the polarisation axis of a ray perpendicular to its direction.
/// \return error message on the Stokes parameters or the axis; null if they are valid
const char* orthogonalize_stokes_axis(SetRay& ray);

}  // namespace retrace::studies

#include "studies/rays/ray_limits.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

namespace retrace::studies {
namespace {

constexpr double kMinNm = 100.0;
constexpr double kMaxNm = 100'000.0;
// Tolerance of checks on Stokes parameters, which may be given in single precision.
constexpr double kRounding = 1e-5;
// Minimum sine of the angle between the polarisation axis and the direction of a ray.
constexpr double kMinAxisSine = 1e-3;

/// Multiplies a finite vector by a power of two so that its largest coordinate is between 1 and 2. A power of two
/// causes no rounding error.
Vec3 moderate(const Vec3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0.0) || !v.allFinite()) return v;
  const int exponent = -std::ilogb(largest);
  return v.unaryExpr([exponent](double c) { return std::scalbn(c, exponent); });
}

}  // namespace

bool is_wavelength(double nm) {
  return nm >= kMinNm && nm <= kMaxNm;
}

std::string wavelength_text(double nm) {
  return fmt::format("a wavelength must be {} to {} nm, got {}", kMinNm, kMaxNm, nm);
}

std::optional<Vec3> unit_along(const Vec3& direction) {
  const Vec3 scaled = moderate(direction);
  const double length = scaled.norm();
  if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return scaled / length;
}

Vec3 perpendicular_axis(const Vec3& direction) {
  const Vec3 across = Vec3::UnitX() - direction.x() * direction;
  return across.norm() > kMinAxisSine ? across.normalized() : direction.unitOrthogonal();
}

bool TotalPower::add(const SetRay& ray) {
  radiant_w_ += ray.radiant_w;
  luminous_lm_ += ray.luminous_lm;
  return radiant_w_ <= kMaxTotalPower && luminous_lm_ <= kMaxTotalPower;
}

std::string total_power_text(double power) {
  return fmt::format("the powers of all rays must add up to at most {}, got {} here", kMaxTotalPower, power);
}

const char* orthogonalize_stokes_axis(SetRay& ray) {
  double sum = 0.0;
  for (const double s : ray.stokes) sum += s * s;
  if (sum == 0.0) {
    ray.axis = ray.direction.unitOrthogonal();
    return nullptr;
  }
  if (sum > 1.0 + kRounding) return "the squares of S1, S2 and S3 must add up to at most 1";
  if (sum > 1.0)
    for (double& s : ray.stokes) s /= std::sqrt(sum);
  const Vec3 axis = moderate(ray.axis);
  const Vec3 across = axis - axis.dot(ray.direction) * ray.direction;
  if (!(across.norm() > kMinAxisSine * axis.norm()))
    return "the axis of polarisation must not be parallel to the direction";
  ray.axis = across.normalized();
  return nullptr;
}

}  // namespace retrace::studies

#include "studies/image/lamp.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/sin_cos.h"

namespace retrace::studies {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kTurnDeg = 360.0;

/// Returns the integral of f(t) cos(t) over t = from .. to, in rad. f is linear with f(from) = a and f(to) = b.
double cosine_integral(double from, double to, double a, double b) {
  const double slope = (b - a) / (to - from);
  return b * std::sin(to) - a * std::sin(from) + slope * (std::cos(to) - std::cos(from));
}

}  // namespace

LuminousIntensity::LuminousIntensity(Planes kind, std::vector<double> planes_deg, std::vector<double> angles_deg,
                                     std::vector<double> cd)
    : kind_(kind), planes_deg_(std::move(planes_deg)), angles_deg_(std::move(angles_deg)), cd_(std::move(cd)) {}

double LuminousIntensity::in_plane(std::size_t plane, double angle_deg) const {
  if (angle_deg < angles_deg_.front() || angle_deg > angles_deg_.back()) return 0.0;
  const double* const row = cd_.data() + plane * angles_deg_.size();
  const auto above = std::lower_bound(angles_deg_.begin(), angles_deg_.end(), angle_deg);
  const auto k = static_cast<std::size_t>(above - angles_deg_.begin());
  if (angles_deg_[k] == angle_deg) return row[k];
  return std::lerp(row[k - 1], row[k], (angle_deg - angles_deg_[k - 1]) / (angles_deg_[k] - angles_deg_[k - 1]));
}

double LuminousIntensity::cd(const geometry::Vec3& direction) const {
  const geometry::Vec3 d = direction.normalized();
  double plane_deg = 0.0;
  double angle_deg = 0.0;
  switch (kind_) {
    case Planes::c:
      plane_deg = std::atan2(d.y(), d.x()) / kRadPerDeg;
      if (plane_deg < 0.0) plane_deg += kTurnDeg;
      angle_deg = std::atan2(std::hypot(d.x(), d.y()), -d.z()) / kRadPerDeg;
      break;
    case Planes::a:
      plane_deg = std::atan2(d.x(), -d.z()) / kRadPerDeg;
      angle_deg = std::atan2(d.y(), std::hypot(d.x(), d.z())) / kRadPerDeg;
      break;
    case Planes::b:
      plane_deg = std::atan2(d.y(), -d.z()) / kRadPerDeg;
      angle_deg = std::atan2(d.x(), std::hypot(d.y(), d.z())) / kRadPerDeg;
      break;
  }
  if (planes_deg_.size() == 1) return kind_ == Planes::c ? in_plane(0, angle_deg) : 0.0;
  if (plane_deg < planes_deg_.front() || plane_deg > planes_deg_.back()) return 0.0;
  const auto above = std::lower_bound(planes_deg_.begin() + 1, planes_deg_.end(), plane_deg);
  const auto k = static_cast<std::size_t>(above - planes_deg_.begin());
  return std::lerp(in_plane(k - 1, angle_deg), in_plane(k, angle_deg),
                   (plane_deg - planes_deg_[k - 1]) / (planes_deg_[k] - planes_deg_[k - 1]));
}

/// Returns the luminous flux per radian of rotation of a plane. The circle that a direction describes during the
/// rotation has a length proportional to sin(gamma), or to the cosine of the angle in planes of type A and B.
double LuminousIntensity::flux_of_plane(std::size_t plane) const {
  const double from_axis_deg = kind_ == Planes::c ? 90.0 : 0.0;
  const double* const row = cd_.data() + plane * angles_deg_.size();
  double flux = 0.0;
  for (std::size_t k = 1; k < angles_deg_.size(); ++k)
    flux += cosine_integral((angles_deg_[k - 1] - from_axis_deg) * kRadPerDeg,
                            (angles_deg_[k] - from_axis_deg) * kRadPerDeg, row[k - 1], row[k]);
  return flux;
}

double LuminousIntensity::lumens() const {
  if (planes_deg_.size() == 1) return kind_ == Planes::c ? kTurnDeg * kRadPerDeg * flux_of_plane(0) : 0.0;
  double flux = 0.0;
  for (std::size_t k = 1; k < planes_deg_.size(); ++k)
    flux += 0.5 * (planes_deg_[k] - planes_deg_[k - 1]) * kRadPerDeg * (flux_of_plane(k - 1) + flux_of_plane(k));
  return flux;
}

double LuminousIntensity::largest_cd() const {
  return *std::max_element(cd_.begin(), cd_.end());
}

geometry::Vec3 from_aimed(const geometry::Vec3& direction, double down_deg) {
  const auto [sine, cosine] = sin_cos_deg(down_deg);
  return {direction.x(), cosine * direction.y() - sine * direction.z(), sine * direction.y() + cosine * direction.z()};
}

}  // namespace retrace::studies

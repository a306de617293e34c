#pragma once

// Internal parts of CameraTracer: the lens from which rays start, the intersection of rays with a film, and the lamp.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "raytrace/light/aperture_kernel.h"
#include "raytrace/light/light.h"
#include "raytrace/observers/camera.h"

namespace retrace::raytrace {

/// A ray outside the part, in the camera frame (see camera.h).
struct WorldRay {
  Vec3 origin;
  Vec3 direction;
};

/// Point where a camera ray meets the part. `world` is in the camera frame. `local` is in the frame in which light is
/// traced. For a film, the entrance face in this frame is tangent to the film at the point. `outside` means that the
/// ray comes close to the part but does not meet the entrance face or a side. `dark` is the back of a film.
struct Contact {
  enum class Kind { nothing, face, side, outside, dark };
  Kind kind = Kind::nothing;
  Vec3 world = Vec3::Zero();
  Vec3 local = Vec3::Zero();
  Eigen::Matrix3d world_from_local = Eigen::Matrix3d::Identity();
  std::size_t side = 0;
};

/// Axes and pixels of the camera.
class Lens {
 public:
  explicit Lens(const CameraView& view)
      : eye_(view.eye_mm),
        target_(view.target_mm),
        pixel_mm_(view.width_mm / static_cast<double>(view.columns)),
        half_(0.5 * static_cast<double>(view.columns), 0.5 * static_cast<double>(view.rows)) {
    const Vec3 forward = (view.target_mm - view.eye_mm).normalized();
    right_ = forward.cross(view.up).normalized();
    up_ = right_.cross(forward);
    pupil_radius_mm_ = 0.5 * view.pupil.rad() * (view.target_mm - view.eye_mm).norm();
  }

  /// Returns the ray through a point of the picture.
  /// \param at position in pixels, from the upper left corner of the picture
  /// \param pupil point of the unit disc, which is scaled to the disc of the pupil
  WorldRay ray(const Vec2& at, const Vec2& pupil) const {
    const Vec3 origin = eye_ + pupil_radius_mm_ * (pupil.x() * right_ + pupil.y() * up_);
    const Vec3 focus = target_ + pixel_mm_ * ((at.x() - half_.x()) * right_ + (half_.y() - at.y()) * up_);
    return {origin, (focus - origin).normalized()};
  }

 private:
  Vec3 eye_;
  Vec3 target_;
  double pixel_mm_;
  Vec2 half_;
  Vec3 right_;
  Vec3 up_;
  double pupil_radius_mm_ = 0.0;
};

/// The lamp as seen along a ray that leaves the part.
class Luminaire {
 public:
  Luminaire(const LampDisc& lamp, const CameraView& view, DiscAverage discs)
      : position_(lamp.position_mm), eye_(view.eye_mm), discs_(discs) {
    const Vec3 to_lamp = lamp.position_mm - view.target_mm;
    const double distance = to_lamp.norm();
    axis_ = to_lamp / distance;
    radius_mm_ = 0.5 * lamp.diameter.rad() * distance;
    pupil_radius_mm_ = 0.5 * view.pupil.rad() * (view.eye_mm - view.target_mm).norm();
    intensity_ = lamp.illuminance_lx * distance * distance;
  }

  /// Returns the luminance of the lamp along a ray, in cd/m^2. With DiscAverage::kernel, it is the average over the
  /// discs of lamp and pupil, spread by diffraction.
  double luminance(const Vec3& from, const Vec3& direction, const DiffractionBlur& blur = {}) const {
    if (!(intensity_ > 0.0)) return 0.0;
    return discs_ == DiscAverage::kernel ? averaged(from, direction, blur) : luminance_of_disc(from, direction);
  }

 private:
  double averaged(const Vec3& from, const Vec3& direction, const DiffractionBlur& blur) const {
    const Vec3 way = position_ - from;
    const double distance = way.norm();
    const double lamp_rad = radius_mm_ / distance;
    const double pupil_rad = pupil_radius_mm_ / (eye_ - from).norm();
    const double chord = (direction - way / distance).norm();
    if (!(blur.tail_fraction > 0.0) && chord > 1.01 * (lamp_rad + pupil_rad)) return 0.0;
    const ApertureKernel kernel({Angle::from_rad(2.0 * lamp_rad), Angle::from_rad(2.0 * pupil_rad)});
    // The result is the illuminance at this point, times the probability density of this direction per steradian. The
    // density is that of the difference between the directions to a random point of the lamp's disc and to a random
    // point of the pupil's disc.
    return intensity_ / (distance * distance) * blur.per_sr(kernel, 2.0 * std::asin(std::min(1.0, 0.5 * chord)));
  }

  double luminance_of_disc(const Vec3& from, const Vec3& direction) const {
    const double towards = direction.dot(axis_);
    if (!(towards > 0.0)) return 0.0;
    const Vec3 at = from + (position_ - from).dot(axis_) / towards * direction;
    if ((at - position_).norm() > radius_mm_) return 0.0;
    return intensity_ / (std::numbers::pi * radius_mm_ * radius_mm_);
  }

  Vec3 position_;
  Vec3 eye_;
  Vec3 axis_;
  DiscAverage discs_;
  double radius_mm_ = 0.0;
  double pupil_radius_mm_ = 0.0;
  double intensity_ = 0.0;  ///< luminous intensity towards the target, in lx mm^2
};

/// Returns the frame in which light is traced at a point of a film. The columns of the matrix are the axes of this
/// frame.
/// \param normal outward unit normal of the film at the point
inline Eigen::Matrix3d axes_of_film(const Vec3& normal) {
  Eigen::Matrix3d axes;
  axes << Vec3::UnitY().cross(normal), Vec3::UnitY(), normal;
  return axes;
}

/// Returns the first intersection of a ray with a curved or plane film. The film touches the plane z = thickness_mm at
/// x = y = 0.
inline Contact contact_with(const Film& film, double thickness_mm, const WorldRay& ray) {
  Contact contact;
  const auto is_on_it = [&](double u, double v) {
    return std::abs(u) <= 0.5 * film.width_mm && std::abs(v) <= 0.5 * film.height_mm;
  };
  const auto take = [&](double t, double u, const Vec3& normal) {
    const Vec3 world = ray.origin + t * ray.direction;
    if (!(t > 0.0) || !is_on_it(u, world.y())) return false;
    contact.kind = normal.dot(ray.direction) < 0.0 ? Contact::Kind::face : Contact::Kind::dark;
    contact.world = world;
    contact.local = {u, world.y(), thickness_mm};
    contact.world_from_local = axes_of_film(normal);
    return true;
  };
  if (!film.radius_mm) {
    const double t = (thickness_mm - ray.origin.z()) / ray.direction.z();
    if (std::isfinite(t)) take(t, ray.origin.x() + t * ray.direction.x(), Vec3::UnitZ());
    return contact;
  }
  const double radius = *film.radius_mm;
  // The axis of the cylinder passes through the point x = 0, z = thickness_mm - radius.
  const Vec2 o(ray.origin.x(), ray.origin.z() - thickness_mm + radius);
  const Vec2 d(ray.direction.x(), ray.direction.z());
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double root2 = b * b - a * (o.squaredNorm() - radius * radius);
  if (!(a > 0.0) || root2 < 0.0) return contact;
  for (const double sign : {-1.0, 1.0}) {
    const double t = (-b + sign * std::sqrt(root2)) / a;
    const Vec2 at = (o + t * d) / radius;
    if (take(t, radius * std::atan2(at.x(), at.y()), Vec3(at.x(), 0.0, at.y()).normalized())) break;
  }
  return contact;
}

}  // namespace retrace::raytrace

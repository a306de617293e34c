#include "raytrace/observers/tangent_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "raytrace/light/light_setup.h"
#include "raytrace/observers/error_free_exit.h"

namespace retrace::raytrace {
namespace {

// Position of the compared rays on the lines from the centroid (0) to the corners (1) of a beam.
constexpr double kTowardsCorner = 0.9;

/// Light that has left the part, described at a point of the tangent plane.
struct OutgoingRay {
  Vec2 at_mm;  ///< intersection with the tangent plane, relative to the centre of the excerpt
  Vec2 cosines;
  double path_mm = 0.0;  ///< optical path up to this point, with the same origin as ReturnedBeam::phase_mm
};

/// Traces rays through the curved surface, with the same reflections as a given beam. Coordinates are those of
/// ReturnedBeam.
class RayFollower {
 public:
  RayFollower(const geometry::EntranceSurface& surface, const ElementScene& scene, const ReturnedBeam& beam,
              const PathIsometry& path)
      : surface_(surface), scene_(scene), beam_(beam), path_(path) {}

  /// \param entry_mm point at which the incident ray would cross the tangent plane without refraction
  std::optional<OutgoingRay> follow(const Vec2& entry_mm) const {
    const Vec3 down = -scene_.to_source;
    const std::optional<Met> in = met({entry_mm.x(), entry_mm.y(), 0.0}, down);
    if (!in) return std::nullopt;
    const Vec3 inside = bent(down, in->normal, 1.0 / beam_.index);
    const Vec3 unfolded = path_.matrix * inside;
    const Vec3 start = path_.matrix * in->at + path_.shift_mm;
    // The search starts at the intersection with the tangent plane.
    const double about_mm = -start.z() / unfolded.z();
    const std::optional<Met> out = met(start + about_mm * unfolded, unfolded);
    if (!out) return std::nullopt;
    const Vec3 outside = bent(unfolded, -out->normal, beam_.index);
    if (!outside.allFinite() || !(outside.z() > 0.0)) return std::nullopt;
    const double beyond_mm = -out->at.z() / outside.z();
    const double length_mm = about_mm + out->distance_mm;
    return OutgoingRay{(out->at + beyond_mm * outside).head<2>(), outside.head<2>(),
                       down.dot(in->at) + beam_.index * length_mm + beyond_mm};
  }

 private:
  struct Met {
    Vec3 at;      ///< relative to the centre of the excerpt, with z = 0 on the tangent plane
    Vec3 normal;  ///< out of the part
    double distance_mm = 0.0;
  };

  Vec3 centre() const { return {beam_.centre_mm.x(), beam_.centre_mm.y(), 0.0}; }

  std::optional<Met> met(const Vec3& start, const Vec3& direction) const {
    const Eigen::Matrix3d part_from_frame = scene_.plane.frame_from_part.transpose();
    const std::optional<SurfacePoint> hit =
        nearest_intersection(surface_, scene_.plane.to_part(start + centre()), part_from_frame * direction);
    if (!hit) return std::nullopt;
    const Vec3 normal = Vec3(-hit->slope.x(), -hit->slope.y(), 1.0).normalized();
    return Met{scene_.plane.to_frame(hit->point_mm) - centre(), scene_.plane.frame_from_part * normal,
               hit->distance_mm};
  }

  /// Returns the direction after refraction. It is not finite beyond the critical angle.
  static Vec3 bent(const Vec3& direction, const Vec3& facing_normal, double ratio) {
    const double cosine = -facing_normal.dot(direction);
    return refracted(direction, facing_normal, ratio, cosine, std::sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine)));
  }

  const geometry::EntranceSurface& surface_;
  const ElementScene& scene_;
  const ReturnedBeam& beam_;
  const PathIsometry& path_;
};

/// Optical path and direction at a point of the tangent plane, according to the model of tangent planes.
struct ModelWave {
  double path_mm = 0.0;
  Vec2 cosines;
};

ModelWave wave_at(const ReturnedBeam& beam, const Vec2& at_mm) {
  ModelWave wave{beam.phase_mm + beam.direction.head<2>().dot(at_mm), beam.direction.head<2>()};
  for (const TexturedHit& hit : beam.hits) {
    if (hit.form == nullptr) continue;
    const Vec2 local = hit.frame.local(hit.constant_mm + hit.slope.leftCols<2>() * at_mm);
    wave.path_mm += hit.path_per_height * hit.form->height_mm(local);
    wave.cosines += hit.path_per_height * hit.slope.topLeftCorner<2, 2>().transpose() * hit.form->slope(local);
  }
  return wave;
}

}  // namespace

void TangentError::add(const geometry::EntranceSurface& surface, const ElementScene& scene, const ReturnedBeam& beam) {
  const std::optional<PathIsometry> path = path_isometry(beam, scene.to_source);
  if (!path || beam.entry_polygon_mm.size() < 3) return;
  const RayFollower rays(surface, scene, beam, *path);
  const Vec2 middle = geometry::centroid(beam.entry_polygon_mm);
  std::vector<Vec2> entries = {middle};
  for (const Vec2& corner : beam.entry_polygon_mm) entries.push_back(middle + kTowardsCorner * (corner - middle));
  std::vector<double> differences;
  double sum = 0.0;
  const double power = beam.stokes.i / static_cast<double>(entries.size());
  for (const Vec2& entry : entries) {
    const std::optional<OutgoingRay> ray = rays.follow(entry - beam.centre_mm);
    if (!ray) {
      add_failure();
      continue;
    }
    const ModelWave wave = wave_at(beam, ray->at_mm);
    const double angle = (ray->cosines - wave.cosines).norm() / beam.direction.z();
    differences.push_back(ray->path_mm - wave.path_mm);
    sum += differences.back();
    squared_angle_ += power * angle * angle;
    max_angle_rad_ = std::max(max_angle_rad_, angle);
  }
  rays_ += differences.size();
  power_ += power * static_cast<double>(differences.size());
  for (const double difference : differences)
    squared_path_mm2_ += power * std::pow(difference - sum / static_cast<double>(differences.size()), 2.0);
}

void TangentError::add(const TangentError& other) {
  rays_ += other.rays_;
  power_ += other.power_;
  squared_path_mm2_ += other.squared_path_mm2_;
  squared_angle_ += other.squared_angle_;
  max_angle_rad_ = std::max(max_angle_rad_, other.max_angle_rad_);
}

void TangentError::add_failure() {
  max_angle_rad_ = std::numeric_limits<double>::infinity();
}

double TangentError::path_rms_mm() const {
  return power_ > 0.0 ? std::sqrt(squared_path_mm2_ / power_) : 0.0;
}

double TangentError::angle_rms_rad() const {
  return power_ > 0.0 ? std::sqrt(squared_angle_ / power_) : 0.0;
}

}  // namespace retrace::raytrace

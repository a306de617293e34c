#pragma once

// Rays that take the next step together, the faces that they meet, and access to single rays.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raytrace/cells/cell_lanes.h"
#include "raytrace/cells/ray_store.h"
#include "raytrace/faces/textured_facet.h"

namespace retrace::raytrace {

/// Location of rays relative to the surface of a column: inside the part, below the surface, or below the surface after
/// leaving the part through it. The surface is convex. Rays that have left through it can therefore meet only the
/// surfaces of other columns.
enum class RayLocation : std::uint8_t { inside, below, below_after_leaving };

/// Identifies a stream. A stream contains the rays of one column with the same `location` and the same `scattered`.
struct StreamKey {
  std::uint32_t column = 0;
  RayLocation location = RayLocation::inside;
  bool scattered = false;  ///< true if there was a non-specular event on the paths of the rays

  bool inside() const { return location == RayLocation::inside; }
};

/// Returns a vector of ray k, such as its direction.
/// \param first index of the array of the x component; the arrays of the y and z components follow
inline Vec3 vector_of(const lanes::Rays& rays, std::size_t first, std::size_t k) {
  return {rays[first][k], rays[first + 1][k], rays[first + 2][k]};
}

/// Returns the position of ray k, relative to the centre of the entrance face instead of the origin of a period.
/// \pre rays.have_periods()
inline Vec3 position_of(const lanes::Rays& rays, std::size_t k) {
  return vector_of(rays, lanes::kX, k) + Vec3(rays[lanes::kOx][k], rays[lanes::kOy][k], 0.0);
}

inline std::uint32_t owner_of(const lanes::Rays& rays, std::size_t k) {
  return rays.component_count == lanes::kRayComponents ? static_cast<std::uint32_t>(rays[lanes::kOwner][k]) : 0;
}

/// Returns the direction and the light of ray k.
inline Ray ray_of(const lanes::Rays& rays, std::size_t k, bool inside, bool scattered) {
  return {vector_of(rays, lanes::kDx, k),
          {{rays[lanes::kI][k], rays[lanes::kQ][k], rays[lanes::kU][k], rays[lanes::kV][k]},
           vector_of(rays, lanes::kAx, k).normalized()},
          inside,
          scattered};
}

/// Sets the direction and the light of ray k.
inline void set_ray(const lanes::Rays& rays, std::size_t k, const Ray& ray) {
  const auto put = [&](std::size_t first, const auto& values) {
    for (std::size_t n = 0; n < values.size(); ++n) rays[first + n][k] = values[n];
  };
  const auto three = [](const Vec3& v) { return std::array{v.x(), v.y(), v.z()}; };
  put(lanes::kDx, three(ray.direction));
  put(lanes::kI, ray.light.stokes.values());
  put(lanes::kAx, three(ray.light.s_axis));
}

/// Copies ray k of `from` to ray `at` of `to`. The direction and the light of the copy are those of `ray`.
inline void copy_ray(const lanes::Rays& from, std::size_t k, const lanes::Rays& to, std::size_t at, const Ray& ray) {
  for (std::size_t n = 0; n < from.component_count; ++n) to[n][at] = from[n][k];
  set_ray(to, at, ray);
}

/// Labels and normals of the faces that rays have met.
class HitStore {
 public:
  void reserve(std::size_t count) {
    if (capacity_ >= count + lanes::kPadding) return;
    capacity_ = 2 * count + lanes::kPadding;
    labels_.resize(capacity_);
    normals_.resize(3 * capacity_);
  }

  lanes::FaceHits face_hits() {
    return {labels_.data(), {&normals_[0], &normals_[capacity_], &normals_[2 * capacity_]}};
  }
  lanes::Label* labels() { return labels_.data(); }
  bool is_facet(std::size_t k) const { return labels_[k] == lanes::label_of(lanes::Hit::facet); }
  bool contain(lanes::Label label, std::size_t count) const {
    const auto end = labels_.begin() + static_cast<std::ptrdiff_t>(count);
    return std::find(labels_.begin(), end, label) != end;
  }
  Vec3 normal(std::size_t k) const { return {normals_[k], normals_[capacity_ + k], normals_[2 * capacity_ + k]}; }
  /// Sets the normals of rays k to k + count - 1.
  void set_normals(std::size_t k, std::size_t count, const Vec3& normal) {
    for (std::size_t n = 0; n < 3; ++n)
      std::fill_n(&normals_[n * capacity_ + k], count, normal[static_cast<Eigen::Index>(n)]);
  }

 private:
  std::size_t capacity_ = 0;
  std::vector<lanes::Label> labels_;
  std::vector<double> normals_;
};

/// Rays of one stream that take the next step together.
struct RayBatch {
  StreamKey stream;
  RayStore rays;
  HitStore hits;

  Ray ray(const lanes::Rays& all, std::size_t k) const { return ray_of(all, k, stream.inside(), stream.scattered); }
};

}  // namespace retrace::raytrace

#include "geometry/centroid.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <vector>

namespace retrace::geometry {
namespace {

/// Maximum relative area of a polygon that is treated as having no area. The value is of the order of rounding errors.
/// The relative area is computed from a fan of triangles that share the polygon's first corner. It is twice the
/// polygon's area, divided by the sum of |p| |q| over all triangles. Here p and q are the two sides of a triangle at
/// the shared corner, and |.| is the 1-norm.
constexpr double kRelativeAreaRounding = 8.0 * std::numeric_limits<double>::epsilon();

Eigen::Matrix<double, 1, 1> twice_area(const Vec2& p, const Vec2& q) {
  return Eigen::Matrix<double, 1, 1>(p.x() * q.y() - p.y() * q.x());
}

Vec3 twice_area(const Vec3& p, const Vec3& q) {
  return p.cross(q);
}

/// Returns the centroid of the closed polyline through the corners: the average of the midpoints of its edges, weighted
/// by edge length. Inserting a vertex in an edge does not change this centroid.
template <class Vec>
Vec border_centroid(std::span<const Vec> corners) {
  const Vec& origin = corners.front();
  Vec moment = Vec::Zero();
  double border = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec from = corners[k] - origin;
    const Vec to = corners[(k + 1) % corners.size()] - origin;
    const double length = (to - from).norm();
    moment += 0.5 * length * (from + to);
    border += length;
  }
  return border > 0.0 ? Vec(origin + moment / border) : origin;
}

template <class Vec>
Vec area_centroid(std::span<const Vec> corners) {
  const Vec& origin = corners.front();
  decltype(twice_area(origin, origin)) twice;
  twice.setZero();
  double sides = 0.0;
  Vec lower = origin, upper = origin;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const Vec p = corners[k - 1] - origin, q = corners[k] - origin;
    twice += twice_area(p, q);
    sides += p.template lpNorm<1>() * q.template lpNorm<1>();
    lower = lower.cwiseMin(corners[k]);
    upper = upper.cwiseMax(corners[k]);
  }
  if (!(twice.norm() > kRelativeAreaRounding * sides)) return border_centroid(corners);
  Vec moment = Vec::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const Vec p = corners[k - 1] - origin, q = corners[k] - origin;
    moment += twice.dot(twice_area(p, q)) * (p + q);
  }
  // The area of a very narrow polygon has a large relative rounding error, so the quotient may be far outside the
  // polygon. The result is therefore clamped to the bounding box of the corners.
  const Vec centroid = origin + moment / (3.0 * twice.squaredNorm());
  return centroid.cwiseMax(lower).cwiseMin(upper);
}

}  // namespace

Vec2 centroid(std::span<const Vec2> corners) {
  return area_centroid(corners);
}

Vec3 centroid(std::span<const Vec3> corners) {
  return area_centroid(corners);
}

Vec3 ring_centroid(std::span<const Vec3> vertices, std::span<const std::uint32_t> ring) {
  std::vector<Vec3> corners;
  corners.reserve(ring.size());
  for (const std::uint32_t number : ring) corners.push_back(vertices[number]);
  return centroid(std::span<const Vec3>(corners));
}

}  // namespace retrace::geometry

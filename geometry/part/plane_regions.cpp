#include "geometry/part/plane_regions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {
namespace {

constexpr std::uint32_t kNoTriangle = UINT32_MAX;
// Factor by which the number of vertices of a region must grow before the plane is fitted again.
constexpr double kGrowthPerFit = 1.25;
// Maximum height of a triangle whose normal is ignored, in multiples of the maximum error of a vertex. The height is
// measured above the longest edge. Rounding may have reversed the normal of such a flat triangle.
constexpr double kHeightWithNormal = 16.0;
// Minimum uncertainty of a fitted normal, in radians, at which the plane may be made exactly vertical or horizontal.
// The plane is changed only if its deviation from that orientation is less than the uncertainty and less than
// kMaxError_rad.
constexpr double kCertain_rad = 1e-4, kMaxError_rad = 0.5;
constexpr int kMaxRounds = 100;
// snap_to_planes() ends when all vertices are within this distance of their planes. The distance is relative to the
// size of the mesh.
constexpr double kAgreement = 1e-14;
// Regularization of the least-squares movement of a vertex. Without this term, rounding errors would determine how far
// a vertex moves along two nearly parallel planes towards their intersection.
constexpr double kDamping = 1e-4;

Vec3 twice_area(const std::vector<Vec3>& vertices, const MeshTriangle& t) {
  return (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
}

/// Fits a plane to points by total least squares: the normal is the eigenvector of the scatter matrix with the smallest
/// eigenvalue. Only sums over the points are stored, so that points can be added one by one.
class PlaneFit {
 public:
  explicit PlaneFit(const Vec3& origin) : origin_(origin) {}

  void add(const Vec3& p) {
    const Vec3 from = p - origin_;
    ++count_;
    sum_ += from;
    products_ += from * from.transpose();
  }
  double count() const { return count_; }

  /// Fits the plane to all points added so far.
  /// \param outward vector that points out of the part; it determines the sign of the normal
  /// \param kind constraint on the plane
  void fit(const Vec3& outward, PlaneKind kind = PlaneKind::any) {
    middle_ = sum_ / count_;
    const Eigen::Matrix3d scatter = products_ - count_ * middle_ * middle_.transpose();
    if (kind == PlaneKind::vertical) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> in_plan(scatter.topLeftCorner<2, 2>());
      axes_.col(0) << in_plan.eigenvectors().col(0), 0.0;
    } else if (kind == PlaneKind::horizontal) {
      axes_.col(0) = Vec3::UnitZ();
    } else {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
      axes_ = solver.eigenvectors();
      spread_ = solver.eigenvalues();
    }
    if (axes_.col(0).dot(outward) < 0.0) axes_.col(0) *= -1.0;
  }
  FacetPlane plane() const { return {axes_.col(0), axes_.col(0).dot(origin_ + middle_)}; }

  /// Returns the standard error of the normal's direction, divided by the standard error of a vertex position, in
  /// rad/mm.
  /// \pre the last call of fit() had PlaneKind::any
  double tilt() const { return 1.0 / std::sqrt(std::max(spread_[1], 1e-300)); }

  /// Returns the standard error of the plane's height at a point `p`, divided by the standard error of a vertex
  /// position.
  /// \pre the last call of fit() had PlaneKind::any
  double uncertainty(const Vec3& p) const {
    const Vec3 along = axes_.transpose() * (p - origin_ - middle_);
    double variance = 1.0 / count_;
    for (const Eigen::Index k : {1, 2}) variance += along[k] * along[k] / std::max(spread_[k], 1e-300);
    return std::sqrt(variance);
  }

 private:
  Vec3 origin_;
  double count_ = 0.0;
  Vec3 sum_ = Vec3::Zero();
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
  Vec3 middle_ = Vec3::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
  Vec3 spread_ = Vec3::Zero();  ///< sums of the squared distances from middle_ along the columns of axes_, mm2
};

/// Returns the three neighbours of each triangle. Neighbour k shares the edge that begins at corner k; it is
/// kNoTriangle if no triangle shares this edge.
std::vector<MeshTriangle> neighbours_of(const std::vector<MeshTriangle>& triangles) {
  struct Side {
    std::uint64_t edge;
    std::uint32_t triangle;
    std::uint32_t side;
  };
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k)
      sides.push_back({directed_edge(triangles[t][k], triangles[t][(k + 1) % 3]), t, k});
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle); });
  std::vector<MeshTriangle> neighbours(triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  for (const Side& side : sides) {
    const std::uint64_t opposite = (side.edge << 32) | (side.edge >> 32);
    const auto it = std::lower_bound(sides.begin(), sides.end(), opposite,
                                     [](const Side& other, std::uint64_t edge) { return other.edge < edge; });
    if (it != sides.end() && it->edge == opposite) neighbours[side.triangle][side.side] = it->triangle;
  }
  return neighbours;
}

/// Groups triangles into plane regions by region growing, as plane_regions() describes.
class RegionGrower {
 public:
  RegionGrower(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles, double rounding_mm)
      : vertices_(vertices),
        triangles_(triangles),
        rounding_mm_(rounding_mm),
        neighbours_(neighbours_of(triangles)),
        last_region_(vertices.size(), kNoTriangle) {
    regions_.region_of.assign(triangles.size(), kNoTriangle);
  }

  PlaneRegions grow_all() {
    // Regions grow from the largest triangles first, because large triangles have the most accurate normals.
    std::vector<double> area;
    for (const MeshTriangle& t : triangles_) area.push_back(twice_area(vertices_, t).norm());
    std::vector<std::uint32_t> seeds(triangles_.size());
    std::iota(seeds.begin(), seeds.end(), 0U);
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });
    for (const std::uint32_t seed : seeds)
      if (regions_.region_of[seed] == kNoTriangle) grow(seed);
    return std::move(regions_);
  }

 private:
  void grow(std::uint32_t seed) {
    const auto region = static_cast<std::uint32_t>(regions_.planes.size());
    PlaneFit fit(vertices_[triangles_[seed][0]]);
    outward_ = twice_area(vertices_, triangles_[seed]);
    add(seed, region, fit);
    fit.fit(outward_);
    double fitted = fit.count();
    std::vector<std::uint32_t> open = {seed};
    for (std::size_t k = 0; k < open.size(); ++k)
      for (const std::uint32_t next : neighbours_[open[k]]) {
        if (next == kNoTriangle || regions_.region_of[next] != kNoTriangle || !is_in(next, fit)) continue;
        add(next, region, fit);
        open.push_back(next);
        if (fit.count() < kGrowthPerFit * fitted) continue;
        fit.fit(outward_);
        fitted = fit.count();
      }
    fit.fit(outward_);
    const PlaneKind kind = kind_of(fit.plane().normal, rounding_mm_ * fit.tilt());
    fit.fit(outward_, kind);
    regions_.planes.push_back(fit.plane());
    regions_.kinds.push_back(kind);
  }

  static PlaneKind kind_of(const Vec3& normal, double error_rad) {
    if (error_rad < kCertain_rad) return PlaneKind::any;
    const double angle = std::min(error_rad, kMaxError_rad);
    if (std::abs(normal.z()) < angle) return PlaneKind::vertical;
    return normal.head<2>().norm() < angle ? PlaneKind::horizontal : PlaneKind::any;
  }

  void add(std::uint32_t triangle, std::uint32_t region, PlaneFit& fit) {
    regions_.region_of[triangle] = region;
    outward_ += twice_area(vertices_, triangles_[triangle]);
    for (const std::uint32_t v : triangles_[triangle]) {
      if (last_region_[v] == region) continue;
      last_region_[v] = region;
      fit.add(vertices_[v]);
    }
  }

  bool is_in(std::uint32_t triangle, const PlaneFit& fit) const {
    const FacetPlane plane = fit.plane();
    const MeshTriangle& t = triangles_[triangle];
    for (const std::uint32_t v : t)
      if (std::abs(plane.height(vertices_[v])) > rounding_mm_ * (1.0 + fit.uncertainty(vertices_[v]))) return false;
    const Vec3 twice = twice_area(vertices_, t);
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (vertices_[t[(k + 1) % 3]] - vertices_[t[k]]).norm());
    return twice.dot(plane.normal) > 0.0 || twice.norm() <= kHeightWithNormal * rounding_mm_ * longest;
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<MeshTriangle>& triangles_;
  double rounding_mm_;
  std::vector<MeshTriangle> neighbours_;
  std::vector<std::uint32_t> last_region_;  ///< for each vertex, the last region that contains it
  Vec3 outward_ = Vec3::Zero();
  PlaneRegions regions_;
};

/// List of (key, value) pairs. sorted() orders the pairs and removes duplicates.
using Incidence = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Calls visit(key, first, last) for each different key. The pairs with this key are at the indices first ... last - 1.
/// \pre the pairs are sorted
template <class Visit>
void for_each_key(const Incidence& incidence, const Visit& visit) {
  for (std::size_t first = 0; first < incidence.size();) {
    std::size_t last = first;
    while (last < incidence.size() && incidence[last].first == incidence[first].first) ++last;
    visit(incidence[first].first, first, last);
    first = last;
  }
}

Incidence sorted(Incidence incidence) {
  std::sort(incidence.begin(), incidence.end());
  incidence.erase(std::unique(incidence.begin(), incidence.end()), incidence.end());
  return incidence;
}

}  // namespace

PlaneRegions plane_regions(const std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
                           double rounding_mm) {
  return RegionGrower(vertices, triangles, rounding_mm).grow_all();
}

void snap_to_planes(std::vector<Vec3>& vertices, const std::vector<MeshTriangle>& triangles,
                    const std::vector<VertexConstraint>& freedom, PlaneRegions& regions) {
  Incidence regions_of_vertices;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t v : triangles[t]) regions_of_vertices.emplace_back(v, regions.region_of[t]);
  regions_of_vertices = sorted(std::move(regions_of_vertices));
  Incidence vertices_of_regions;
  for (const auto& [vertex, region] : regions_of_vertices) vertices_of_regions.emplace_back(region, vertex);
  vertices_of_regions = sorted(std::move(vertices_of_regions));

  Vec3 lower = Vec3::Constant(INFINITY);
  Vec3 upper = Vec3::Constant(-INFINITY);
  for (const auto& [vertex, region] : regions_of_vertices) {
    lower = lower.cwiseMin(vertices[vertex]);
    upper = upper.cwiseMax(vertices[vertex]);
  }
  const double agreement_mm = kAgreement * (upper - lower).norm();
  double apart_mm = INFINITY;
  for (int round = 0; round < kMaxRounds && apart_mm > agreement_mm; ++round) {
    apart_mm = 0.0;
    for_each_key(regions_of_vertices, [&](std::uint32_t v, std::size_t first, std::size_t last) {
      Eigen::Matrix3d normal_matrix = kDamping * Eigen::Matrix3d::Identity();
      Vec3 right_side = Vec3::Zero();
      for (std::size_t k = first; k < last; ++k) {
        const FacetPlane& plane = regions.planes[regions_of_vertices[k].second];
        const Vec3 along = freedom[v] * plane.normal;
        const double height = plane.height(vertices[v]);
        apart_mm = std::max(apart_mm, std::abs(height));
        normal_matrix += along * along.transpose();
        right_side -= height * along;
      }
      vertices[v] += freedom[v] * normal_matrix.ldlt().solve(right_side);
    });
    for_each_key(vertices_of_regions, [&](std::uint32_t region, std::size_t first, std::size_t last) {
      PlaneFit fit(vertices[vertices_of_regions[first].second]);
      for (std::size_t k = first; k < last; ++k) fit.add(vertices[vertices_of_regions[k].second]);
      fit.fit(regions.planes[region].normal, regions.kinds[region]);
      regions.planes[region] = fit.plane();
    });
  }
}

void weld_short_edges(const std::vector<Vec3>& vertices, double limit_mm, std::vector<MeshTriangle>& triangles) {
  std::vector<std::uint32_t> same_as(vertices.size());
  std::iota(same_as.begin(), same_as.end(), 0U);
  const auto first_of = [&](std::uint32_t v) {
    while (same_as[v] != v) v = same_as[v] = same_as[same_as[v]];
    return v;
  };
  for (const MeshTriangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = first_of(t[k]);
      const std::uint32_t b = first_of(t[(k + 1) % 3]);
      if ((vertices[a] - vertices[b]).norm() < limit_mm) same_as[std::max(a, b)] = std::min(a, b);
    }
  for (MeshTriangle& t : triangles)
    for (std::uint32_t& v : t) v = first_of(v);
  std::erase_if(triangles, [](const MeshTriangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

}  // namespace retrace::geometry

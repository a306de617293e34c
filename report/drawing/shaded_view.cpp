#include "report/drawing/shaded_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace retrace::report {
namespace {

using geometry::BoundaryMesh, geometry::FacetRole, geometry::Vec2, geometry::Vec3;

constexpr std::size_t kFiner = 3;         ///< number of sample points along each side of a pixel
constexpr double kMarginFraction = 0.04;  ///< margin on every side, as a fraction of the picture
constexpr double kEdgeWidth = 1.1;        ///< width of edges in pixels
/// Depth tolerance for edges, as a fraction of the depth of the scene. Edges are on the surface, so rounding may move
/// them behind it. They are still drawn if they are behind the surface by less than this tolerance.
constexpr double kBias = 2e-3;

constexpr Colour kBackground{247.0 / 255.0, 249.0 / 255.0, 252.0 / 255.0};
constexpr Colour kEdge{0.13, 0.2, 0.28};

Colour colour_of(FacetRole role) {
  switch (role) {
    case FacetRole::retro_facet: return {0.45, 0.66, 0.86};
    case FacetRole::flat_back: return {0.80, 0.79, 0.75};
    case FacetRole::inner_wall:
    case FacetRole::border_wall: return {0.92, 0.70, 0.45};
    case FacetRole::entrance:
    case FacetRole::side: return {0.72, 0.80, 0.87};
  }
  return kEdge;
}

/// Projects points into the picture. x points to the right and y down, both in sample points; z points towards the eye,
/// in mm.
class Projection {
 public:
  Projection(const BoundaryMesh& mesh, const ViewDirection& direction, std::size_t columns, std::size_t rows) {
    forward_ = direction.from.normalized();
    right_ = direction.up.cross(forward_).normalized();
    up_ = forward_.cross(right_);
    Vec3 low = Vec3::Constant(INFINITY);
    Vec3 high = Vec3::Constant(-INFINITY);
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t k : triangle) {
        const Vec3& v = mesh.vertices[k];
        const Vec3 p(v.dot(right_), v.dot(up_), v.dot(forward_));
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    const Vec2 room = (1.0 - 2.0 * kMarginFraction) * Vec2(static_cast<double>(columns), static_cast<double>(rows));
    const Vec2 size = (high - low).head<2>();
    mm_per_pixel_ = std::max(size.x() / room.x(), size.y() / room.y());
    middle_ = 0.5 * (low + high);
    half_ = 0.5 * static_cast<double>(kFiner) * Vec2(static_cast<double>(columns), static_cast<double>(rows));
    depth_mm_ = (high - low).norm();
  }

  Vec3 at(const Vec3& v) const {
    const Vec2 off = Vec2(v.dot(right_), v.dot(up_)) - middle_.head<2>();
    const double unit = static_cast<double>(kFiner) / mm_per_pixel_;
    return {half_.x() + unit * off.x(), half_.y() - unit * off.y(), v.dot(forward_)};
  }
  double mm_per_pixel() const { return mm_per_pixel_; }
  double depth_mm() const { return depth_mm_; }
  const Vec3& forward() const { return forward_; }

  /// Returns the light that a face reflects to the eye, relative to a white face that faces the eye.
  double shade(const Vec3& normal) const {
    const Vec3 lamp = (0.7 * forward_ - 0.8 * right_ + 0.6 * up_).normalized();
    return 0.45 + 0.12 * std::abs(normal.dot(forward_)) + 0.52 * std::max(0.0, normal.dot(lamp));
  }

 private:
  Vec3 forward_;
  Vec3 right_;
  Vec3 up_;
  Vec3 middle_ = Vec3::Zero();
  Vec2 half_ = Vec2::Zero();
  double mm_per_pixel_ = 1.0;
  double depth_mm_ = 1.0;
};

class DepthBuffer {
 public:
  DepthBuffer(std::size_t columns, std::size_t rows)
      : columns_(columns),
        rows_(rows),
        depth_(columns * rows, -std::numeric_limits<float>::infinity()),
        colour_(columns * rows, kNothing) {}

  /// Fills a triangle: all sample points whose centres are inside it.
  void fill(const std::array<Vec3, 3>& p, std::uint32_t colour) {
    const Vec2 a = p[0].head<2>();
    const Vec2 ab = p[1].head<2>() - a;
    const Vec2 ac = p[2].head<2>() - a;
    const double twice = ab.x() * ac.y() - ab.y() * ac.x();
    if (twice == 0.0) return;
    const Span x = span(p, 0, columns_);
    const Span y = span(p, 1, rows_);
    for (std::size_t row = y.from; row < y.to; ++row)
      for (std::size_t column = x.from; column < x.to; ++column) {
        const Vec2 at = Vec2(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5) - a;
        const double u = (at.x() * ac.y() - at.y() * ac.x()) / twice;
        const double v = (ab.x() * at.y() - ab.y() * at.x()) / twice;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        const auto z = static_cast<float>(p[0].z() + u * (p[1].z() - p[0].z()) + v * (p[2].z() - p[0].z()));
        const std::size_t k = row * columns_ + column;
        if (z <= depth_[k]) continue;
        depth_[k] = z;
        colour_[k] = colour;
      }
  }

  /// Draws the visible parts of a line.
  void stroke(const Vec3& from, const Vec3& to, double width, double bias_mm) {
    const Vec2 along = (to - from).head<2>();
    const double length = along.norm();
    const auto steps = static_cast<std::size_t>(std::ceil(2.0 * length)) + 1;
    const double half = 0.5 * width;
    for (std::size_t s = 0; s <= steps; ++s) {
      const Vec3 p = from + static_cast<double>(s) / static_cast<double>(steps) * (to - from);
      const Span x = span(p.x() - half, p.x() + half, columns_);
      const Span y = span(p.y() - half, p.y() + half, rows_);
      for (std::size_t row = y.from; row < y.to; ++row)
        for (std::size_t column = x.from; column < x.to; ++column) {
          const std::size_t k = row * columns_ + column;
          const bool is_hidden = static_cast<double>(depth_[k]) > p.z() + bias_mm;
          if (colour_[k] != kNothing && !is_hidden) colour_[k] = kLine;
        }
    }
  }

  static constexpr std::uint32_t kNothing = 0xffffffffU;
  static constexpr std::uint32_t kLine = 0xfffffffeU;
  std::uint32_t colour(std::size_t column, std::size_t row) const { return colour_[row * columns_ + column]; }

 private:
  struct Span {
    std::size_t from = 0;
    std::size_t to = 0;
  };
  /// Returns the sample points whose centres are between two coordinates.
  static Span span(double low, double high, std::size_t count) {
    const double most = static_cast<double>(count);
    const double from = std::clamp(std::ceil(low - 0.5), 0.0, most);
    const double to = std::clamp(std::floor(high - 0.5) + 1.0, from, most);
    return {static_cast<std::size_t>(from), static_cast<std::size_t>(to)};
  }
  static Span span(const std::array<Vec3, 3>& p, Eigen::Index axis, std::size_t count) {
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    return span(low, high, count);
  }

  std::size_t columns_;
  std::size_t rows_;
  std::vector<float> depth_;
  std::vector<std::uint32_t> colour_;
};

Colour scaled(const Colour& c, double by) {
  return {std::min(1.0, by * c.red), std::min(1.0, by * c.green), std::min(1.0, by * c.blue)};
}

void add(Colour& sum, const Colour& c, double weight) {
  sum.red += weight * c.red;
  sum.green += weight * c.green;
  sum.blue += weight * c.blue;
}

}  // namespace

ShadedView shaded_view(const BoundaryMesh& mesh, const std::vector<std::array<std::uint32_t, 2>>& edges,
                       const ViewDirection& direction, std::size_t columns, std::size_t rows) {
  const Projection projection(mesh, direction, columns, rows);
  DepthBuffer buffer(kFiner * columns, kFiner * rows);
  std::vector<Vec3> at;
  at.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) at.push_back(projection.at(v));
  std::vector<Colour> colours;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized();
    buffer.fill({at[a], at[b], at[c]}, static_cast<std::uint32_t>(colours.size()));
    colours.push_back(scaled(colour_of(mesh.roles[t]), projection.shade(normal)));
  }
  const double bias_mm = kBias * projection.depth_mm();
  for (const auto& [a, b] : edges) buffer.stroke(at[a], at[b], kEdgeWidth * kFiner, bias_mm);

  ShadedView view;
  view.columns = columns;
  view.rows = rows;
  view.mm_per_pixel = projection.mm_per_pixel();
  constexpr double share = 1.0 / (kFiner * kFiner);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      Colour sum;
      for (std::size_t k = 0; k < kFiner * kFiner; ++k) {
        const std::uint32_t what = buffer.colour(kFiner * column + k % kFiner, kFiner * row + k / kFiner);
        if (what == DepthBuffer::kNothing) {
          add(sum, kBackground, share);
        } else {
          add(sum, what == DepthBuffer::kLine ? kEdge : colours[what], share);
          view.covered += share;
        }
      }
      view.colours.push_back(sum);
    }
  return view;
}

}  // namespace retrace::report

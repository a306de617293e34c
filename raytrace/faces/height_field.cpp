#include "raytrace/faces/height_field.h"
#include "core/infinity.h"
#include "core/threads.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrace::raytrace {
namespace {

using geometry::EntranceSurface;

constexpr double kWithinX = geometry::kWithinEntranceCell[0];
constexpr double kWithinY = geometry::kWithinEntranceCell[1];

// Safety factor for curvatures that are estimated from the slopes at the corners of a cell.
constexpr double kBendMargin = 2.0;
// Difference of heights that is caused by rounding, as a fraction of the part's size.
constexpr double kSameHeight = 4e-16;
// Margin above the highest and below the lowest point, as a fraction of the part's size.
constexpr double kRoom = 1e-12;
constexpr int kMaxIterations = 200;
// Maximum distance from the surface, in multiples of Search::same_mm, at which a point of a ray counts as on the
// surface.
constexpr double kStillOn = 8.0;

/// Returns the curvature between two points, estimated from the difference of their slopes.
double bend_between(const EntranceSurface::SurfaceSample& a, const EntranceSurface::SurfaceSample& b,
                    double distance_mm) {
  const double bend = (a.slope - b.slope).norm() / distance_mm;
  return std::isfinite(bend) ? bend : 0.0;
}

}  // namespace

HeightField::HeightField(std::shared_ptr<const geometry::EntranceSurface> surface, const geometry::Polygon& outline,
                         const Vec2& centre_mm)
    : EntranceFace(geometry::entrance_range(surface, outline), centre_mm),
      surface_(std::move(surface)),
      x0_(centre_mm.x()),
      y0_(centre_mm.y()) {
  make_cells(outline, geometry::cells_to_resolve(*surface_, outline));
  widen_curvatures();
}

void HeightField::make_cells(const geometry::Polygon& outline, int cells) {
  const geometry::Rectangle box = geometry::bounding_box(outline);
  const double cell_mm = box.size().maxCoeff() / cells;
  columns_ = std::max(1, static_cast<int>(std::ceil(box.size().x() / cell_mm * (1.0 - 1e-12))));
  rows_ = std::max(1, static_cast<int>(std::ceil(box.size().y() / cell_mm * (1.0 - 1e-12))));
  lower_ = box.lower - Vec2(x0_, y0_);
  cell_mm_ = box.size().cwiseQuotient(Vec2(columns_, rows_));
  const auto across = static_cast<std::size_t>(columns_) + 1;
  std::vector<EntranceSurface::SurfaceSample> nodes(across * (static_cast<std::size_t>(rows_) + 1));
  for_each_in_parallel(static_cast<std::size_t>(rows_) + 1, [&](std::size_t j) {
    for (int i = 0; i <= columns_; ++i)
      nodes[j * across + static_cast<std::size_t>(i)] =
          at(lower_.x() + i * cell_mm_.x(), lower_.y() + static_cast<double>(j) * cell_mm_.y());
  });
  cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
  for_each_in_parallel(static_cast<std::size_t>(rows_), [&](std::size_t j) {
    for (int i = 0; i < columns_; ++i) {
      const std::size_t n = j * across + static_cast<std::size_t>(i);
      const EntranceSurface::SurfaceSample within = at(lower_.x() + (i + kWithinX) * cell_mm_.x(),
                                                       lower_.y() + (static_cast<double>(j) + kWithinY) * cell_mm_.y());
      const std::array<const EntranceSurface::SurfaceSample*, 5> places = {&nodes[n], &nodes[n + 1], &nodes[n + across],
                                                                           &nodes[n + across + 1], &within};
      cells_[j * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)] = cell_between(places);
    }
  });
}

HeightField::Cell HeightField::cell_between(const std::array<const EntranceSurface::SurfaceSample*, 5>& places) const {
  Cell cell{kInfinity, -kInfinity, 0.0};
  for (const EntranceSurface::SurfaceSample* place : places) {
    // The surface may be undefined outside of the outline. A cell with such a corner has unlimited bounds.
    const bool known = std::isfinite(place->height_mm);
    cell.low_mm = std::min(cell.low_mm, known ? place->height_mm : -kInfinity);
    cell.high_mm = std::max(cell.high_mm, known ? place->height_mm : kInfinity);
  }
  static const std::array<Vec2, 5> shares = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(kWithinX, kWithinY)};
  double most = 0.0;
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      most =
          std::max(most, bend_between(*places[a], *places[b], (shares[a] - shares[b]).cwiseProduct(cell_mm_).norm()));
  cell.curvature_per_mm = kBendMargin * most;
  return cell;
}

/// Enlarges the bounds of the cells. The largest curvature may be just outside of the cell in which it was estimated.
/// Each cell therefore receives the maximum of its own bound and the bounds of its neighbours. The range of heights is
/// enlarged by the error of bilinear interpolation at this curvature.
void HeightField::widen_curvatures() {
  std::vector<Cell> wide = cells_;
  const double square = cell_mm_.squaredNorm();
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      Cell& c = wide[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
      for (int v = std::max(0, j - 1); v <= std::min(rows_ - 1, j + 1); ++v)
        for (int u = std::max(0, i - 1); u <= std::min(columns_ - 1, i + 1); ++u)
          c.curvature_per_mm = std::max(c.curvature_per_mm, cell(u, v).curvature_per_mm);
      // Upper bound of the error of bilinear interpolation (W. Gautschi, Numerical Analysis, section 2.2, generalized
      // to two dimensions).
      const double room_mm = 0.25 * c.curvature_per_mm * square;
      c.low_mm -= room_mm;
      c.high_mm += room_mm;
    }
  cells_ = std::move(wide);
}

/// Search along one ray. g(t) is the distance of the ray from the surface, measured along z. It is positive on the side
/// from which the ray comes.
struct HeightField::Search {
  const HeightField& field;
  const SurfaceRay& ray;
  double sign = 1.0;         ///< -1 for a ray inside the part, which is below the surface
  double across2 = 0.0;      ///< squared length of the direction in projection along z
  double same_mm = 0.0;      ///< heights that differ by less are treated as equal
  double last_clear = -1.0;  ///< largest t at which the ray is known not to have crossed the surface; negative if none
                             ///< is known

  struct Gap {
    double value = 0.0;
    double slope = 0.0;
    EntranceSurface::SurfaceSample place;
  };

  Gap gap(double t) const {
    const Vec3 p = ray.origin + t * ray.direction;
    const EntranceSurface::SurfaceSample place = field.at(p.x(), p.y());
    return {sign * (p.z() - place.height_mm), sign * (ray.direction.z() - place.slope.dot(ray.direction.head<2>())),
            place};
  }

  static EntranceHit hit_at(double t, const Gap& at) {
    const Vec3 normal = Vec3(-at.place.slope.x(), -at.place.slope.y(), 1.0).normalized();
    return {{{0, 0}, t}, normal};
  }

  /// Returns the intersection between two points of the ray by bisection. At `clear`, the ray is on the side from which
  /// it comes; at `beyond`, it has crossed the surface.
  EntranceHit between(double clear, double beyond) const {
    for (int k = 0; k < kMaxIterations; ++k) {
      const double middle = 0.5 * (clear + beyond);
      if (middle <= clear || middle >= beyond) break;
      (gap(middle).value > 0.0 ? clear : beyond) = middle;
    }
    return hit_at(beyond, gap(beyond));
  }

  /// Returns a distance for a ray that starts on the surface and moves away from it. Within this distance, the
  /// curvature of the surface is too small for a second intersection.
  static double free_way(double slope, double bend) { return bend > 0.0 ? 2.0 * slope / bend : kInfinity; }

  /// Returns a distance that a ray can travel without crossing the surface.
  /// \param g present distance of the ray from the surface, and slope of this distance
  /// \param bend upper bound of the second derivative of this distance
  static double safe_step(const Gap& g, double bend) {
    const double root = std::sqrt(g.slope * g.slope + 2.0 * bend * g.value);
    if (g.slope < 0.0) return 2.0 * g.value / (root - g.slope);
    return bend > 0.0 ? (g.slope + root) / bend : kInfinity;
  }

  /// Returns the first intersection between two points of a ray within a cell.
  /// \param on_surface true if the ray starts on the surface, at `from`
  std::optional<EntranceHit> within(const Cell& cell, double from, double to, bool on_surface);
};

std::optional<EntranceHit> HeightField::Search::within(const Cell& cell, double from, double to, bool on_surface) {
  const double bend = cell.curvature_per_mm * across2;
  double t = from;
  Gap g = gap(t);
  // A ray that starts on the border of two cells may leave the first cell immediately. In the next cell, its distance
  // from the surface is then a rounding error.
  if (g.slope > 0.0 && (on_surface || std::abs(g.value) <= kStillOn * same_mm)) {
    const double step = free_way(g.slope, bend);
    if (!(t + step < to)) return std::nullopt;
    t += step;
    g = gap(t);
    // The curvature may exceed the bound of the cell. The step is then halved until the ray is on the side from which
    // it comes.
    double clear = t;
    for (int k = 0; g.value <= 0.0 && k < kMaxIterations; ++k) {
      clear = 0.5 * (from + clear);
      if (gap(clear).value > 0.0) return between(clear, t);
    }
  }
  for (int k = 0; k < kMaxIterations; ++k) {
    if (!std::isfinite(g.value)) return std::nullopt;  // the point is outside of the outline because of rounding
    if (g.value <= same_mm) {
      if (g.value < -same_mm && last_clear >= 0.0) return between(last_clear, t);
      // After one more Newton step, the error is below rounding.
      const double rest = g.slope < 0.0 ? -g.value / g.slope : 0.0;
      return hit_at(std::max(t + rest, 0.0), g);
    }
    last_clear = t;
    const double step = safe_step(g, bend);
    if (!(t + step < to)) return std::nullopt;
    if (t + step <= t) return hit_at(t, g);
    t += step;
    g = gap(t);
  }
  return hit_at(t, g);  // the ray is nearly parallel to the surface; this is the closest approximation
}

/// Sequence of grid cells along a ray.
struct HeightField::Walk {
  std::array<int, 2> index{};
  std::array<int, 2> step{};
  std::array<double, 2> next{};  ///< t at which the ray leaves the present column and row
  std::array<double, 2> pace{};  ///< increase of t from one border to the next

  Walk(const HeightField& field, const SurfaceRay& ray, double from) {
    const std::array<int, 2> count = {field.columns_, field.rows_};
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const double along = ray.direction[axis];
      const double place = (ray.origin[axis] + from * along - field.lower_[axis]) / field.cell_mm_[axis];
      index[k] = std::clamp(static_cast<int>(std::floor(place)), 0, count[k] - 1);
      step[k] = along > 0.0 ? 1 : -1;
      pace[k] = along != 0.0 ? field.cell_mm_[axis] / std::abs(along) : kInfinity;
      const double border = field.lower_[axis] + (index[k] + (along > 0.0 ? 1 : 0)) * field.cell_mm_[axis];
      next[k] = along != 0.0 ? (border - ray.origin[axis]) / along : kInfinity;
    }
  }
  std::size_t axis() const { return next[0] < next[1] ? 0 : 1; }
  void advance(std::size_t over) {
    index[over] += step[over];
    next[over] += pace[over];
  }
};

/// Returns the range of t in which the ray is between the minimum and maximum height of the surface.
std::optional<std::array<double, 2>> HeightField::span_of(const SurfaceRay& ray, double room_mm) const {
  const double dz = ray.direction.z();
  const double z = ray.origin.z();
  const double near_mm = ray.inside ? lowest_mm() - room_mm : highest_mm() + room_mm;
  const double far_mm = ray.inside ? highest_mm() + room_mm : lowest_mm() - room_mm;
  const double way = ray.inside ? 1.0 : -1.0;  // sign of the z direction from the ray towards the entrance surface
  if (way * dz > 0.0) {
    const bool starts_on = ray.source.placement != FacetRef::kNone;
    const double from = starts_on ? 0.0 : std::max(0.0, (near_mm - z) / dz);
    return std::array{from, std::min(ray.t_max, (far_mm - z) / dz)};
  }
  if (way * (near_mm - z) > 0.0) return std::nullopt;  // the ray has not reached the surface and moves away from it
  return std::array{0.0, dz != 0.0 ? std::min(ray.t_max, (near_mm - z) / dz) : ray.t_max};
}

std::optional<EntranceHit> HeightField::first_hit(const SurfaceRay& ray) const {
  const double dz = ray.direction.z();
  const double z = ray.origin.z();
  const double part_mm = lower_.cwiseAbs().maxCoeff() + std::abs(z);
  const auto span = span_of(ray, kRoom * part_mm);
  if (!span) return std::nullopt;
  auto [t, end] = *span;
  if (t > end) return std::nullopt;
  Search search{*this, ray, ray.inside ? -1.0 : 1.0, ray.direction.head<2>().squaredNorm(), kSameHeight * part_mm,
                -1.0};
  Walk walk(*this, ray, t);
  bool on_surface = ray.source.placement != FacetRef::kNone;
  while (t <= end) {
    const std::size_t axis = walk.axis();
    const bool goes_on = walk.next[axis] < end;
    const double leave = std::max(t, goes_on ? walk.next[axis] : end);
    const Cell& c = cell(walk.index[0], walk.index[1]);
    const double z_from = z + t * dz;
    const double z_to = z + leave * dz;
    const bool is_clear = ray.inside ? std::max(z_from, z_to) < c.low_mm : std::min(z_from, z_to) > c.high_mm;
    if (is_clear) {
      search.last_clear = leave;
    } else {
      const auto hit = search.within(c, t, goes_on ? leave : std::nextafter(end, kInfinity), on_surface);
      if (hit) return hit->hit.t <= ray.t_max ? hit : std::nullopt;
    }
    on_surface = false;
    if (!goes_on) break;
    t = leave;
    walk.advance(axis);
    if (walk.index[0] < 0 || walk.index[0] >= columns_ || walk.index[1] < 0 || walk.index[1] >= rows_) break;
  }
  return std::nullopt;
}

}  // namespace retrace::raytrace

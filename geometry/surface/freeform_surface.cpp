#include "geometry/surface/freeform_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/number_format.h"

namespace retrace::geometry {
namespace {

using jets::Gradient;
using jets::Jet2;
using jets::kAnyOrder;
using jets::line_series;
using jets::Series;
using jets::value_of;

/// Point in polar coordinates about a centre.
template <class T>
struct Polar {
  T radius;
  T angle;
  T cosine;
  T sine;
};

template <class T>
Polar<T> polar(const T& x, const T& y, const Vec2& centre) {
  using std::atan2;
  using std::sqrt;
  const T dx = x - centre.x();
  const T dy = y - centre.y();
  const T r = sqrt(dx * dx + dy * dy);
  return {r, atan2(dy, dx), dx / r, dy / r};
}

std::string place_elements(double x_mm, double y_mm) {
  return fmt::format("x = {}, y = {} mm", fixed(x_mm, 4), fixed(y_mm, 4));
}

}  // namespace

FreeformSurface::FreeformSurface(Sag base, std::optional<Extrapolation> extrapolation, std::vector<Lenslet> lenslets,
                                 const InputLocation& where)
    : base_(std::move(base)), extrapolation_(std::move(extrapolation)), lenslets_(std::move(lenslets)) {
  if (!lenslets_.empty()) sort_into_grid(where);
}

namespace {

/// Radial line that passes outward through a point. Its coordinates are series in the distance along the line.
template <class T, int N = kAnyOrder>
struct RadialLine {
  Series<T, N> x;
  Series<T, N> y;
};

template <int N = kAnyOrder, class T>
RadialLine<T, N> radial_line(const Polar<T>& p, const Vec2& centre, const T& radius, int order) {
  return {line_series<T, N>(T(radius * p.cosine + centre.x()), p.cosine, order),
          line_series<T, N>(T(radius * p.sine + centre.y()), p.sine, order)};
}

/// Returns the blend around a lenslet at a point in polar coordinates.
/// \param base returns z of the base along a line
template <int N, class T, class Base>
T blend_at(const Lenslet& lenslet, const Polar<T>& p, const Base& base) {
  const Vec2& centre = lenslet.outer.centre_mm;
  const T r = lenslet.inner.radius_mm.evaluate(p.angle);
  const T R = lenslet.outer.radius_mm.evaluate(p.angle);
  const int order = N == kAnyOrder ? lenslet.blend_order : N;
  const RadialLine<T, N> near = radial_line<N>(p, centre, r, order);
  const RadialLine<T, N> far = radial_line<N>(p, centre, R, order);
  return hermite_blend(T((p.radius - r) / (R - r)), T(R - r), lenslet.evaluate(near.x, near.y), base(far.x, far.y),
                       order);
}

}  // namespace

template <class T>
T FreeformSurface::extrapolated(const T& x_mm, const T& y_mm) const {
  const Boundary& boundary = extrapolation_->boundary;
  const Polar<T> p = polar(x_mm, y_mm, boundary.centre_mm);
  const T edge = boundary.radius_mm.evaluate(p.angle);
  const RadialLine<T> line = radial_line(p, boundary.centre_mm, edge, extrapolation_->order);
  const Series<T> z = base_.evaluate(line.x, line.y);
  const T beyond = p.radius - edge;
  T sum = z[z.order];
  for (int k = z.order - 1; k >= 0; --k) sum = sum * beyond + z[k];
  return sum;
}

template <class T>
T FreeformSurface::evaluate_base(const T& x_mm, const T& y_mm) const {
  if (!extrapolation_ || extrapolation_->boundary.contains(value_of(x_mm), value_of(y_mm)))
    return base_.evaluate(x_mm, y_mm);
  return extrapolated(x_mm, y_mm);
}

template <class T>
T FreeformSurface::evaluate_blend(const Lenslet& lenslet, const T& x_mm, const T& y_mm) const {
  const Polar<T> p = polar(x_mm, y_mm, lenslet.outer.centre_mm);
  const FreeformSurface& self = *this;
  const auto base = [&self](const auto& x, const auto& y) { return self.base_.evaluate(x, y); };
  if (!lenslet.ends_on_base)
    return blend_at<kAnyOrder>(lenslet, p, [&self](const auto& x, const auto& y) { return self.evaluate_base(x, y); });
  if constexpr (std::is_same_v<T, Jet2> || std::is_same_v<T, double>) {
    // Tool paths spend most of their time here, so common orders are compiled with a fixed length.
    if (lenslet.blend_order == 1) return blend_at<1>(lenslet, p, base);
    if (lenslet.blend_order == 2) return blend_at<2>(lenslet, p, base);
    if (lenslet.blend_order == 3) return blend_at<3>(lenslet, p, base);
    if (lenslet.blend_order == 4) return blend_at<4>(lenslet, p, base);
  }
  return blend_at<kAnyOrder>(lenslet, p, base);
}

template <class T>
T FreeformSurface::evaluate(const T& x_mm, const T& y_mm) const {
  const Lenslet* const lenslet = lenslet_at(value_of(x_mm), value_of(y_mm));
  if (lenslet == nullptr) return evaluate_base(x_mm, y_mm);
  if (lenslet->inner.contains(value_of(x_mm), value_of(y_mm))) return lenslet->evaluate(x_mm, y_mm);
  return evaluate_blend(*lenslet, x_mm, y_mm);
}

template double FreeformSurface::evaluate(const double&, const double&) const;
template Gradient FreeformSurface::evaluate(const Gradient&, const Gradient&) const;
template Jet2 FreeformSurface::evaluate(const Jet2&, const Jet2&) const;
template Series<double> FreeformSurface::evaluate(const Series<double>&, const Series<double>&) const;
template double FreeformSurface::evaluate_base(const double&, const double&) const;
template Gradient FreeformSurface::evaluate_base(const Gradient&, const Gradient&) const;
template Jet2 FreeformSurface::evaluate_base(const Jet2&, const Jet2&) const;
template Series<double> FreeformSurface::evaluate_base(const Series<double>&, const Series<double>&) const;

Zone FreeformSurface::zone_at(double x_mm, double y_mm) const {
  if (const Lenslet* const lenslet = lenslet_at(x_mm, y_mm))
    return lenslet->inner.contains(x_mm, y_mm) ? Zone::lenslet : Zone::blend;
  return !extrapolation_ || extrapolation_->boundary.contains(x_mm, y_mm) ? Zone::base : Zone::extrapolation;
}

const Lenslet* FreeformSurface::lenslet_at(double x_mm, double y_mm) const {
  if (cells_.empty()) return nullptr;
  const double column = (x_mm - grid_low_.x()) / cell_mm_;
  const double row = (y_mm - grid_low_.y()) / cell_mm_;
  if (!(column >= 0.0 && row >= 0.0 && column < static_cast<double>(columns_) && row < static_cast<double>(rows_)))
    return nullptr;
  const auto cell = static_cast<std::size_t>(static_cast<long>(row) * columns_ + static_cast<long>(column));
  for (const std::uint32_t index : cells_[cell])
    if (lenslets_[index].outer.contains(x_mm, y_mm)) return &lenslets_[index];
  return nullptr;
}

namespace {

/// Checks that two blends do not overlap.
/// \throw InputError if a point of one outer boundary is inside the other outer boundary
void check_apart(const std::vector<Lenslet>& lenslets, std::uint32_t a, std::uint32_t b, const InputLocation& where) {
  const Boundary& first = lenslets[a].outer;
  const Boundary& second = lenslets[b].outer;
  if ((first.centre_mm - second.centre_mm).norm() > first.max_radius_mm + second.max_radius_mm) return;
  constexpr int kAngles = 360;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = kTwoPi * i / kAngles;
    const Vec2 p = first.point_mm(angle);
    if (second.contains(p.x(), p.y()))
      throw InputError(where, fmt::format("must be far enough apart that their blends do not overlap, but the blends "
                                          "of lenslets {} and {} overlap at {}",
                                          a + 1, b + 1, place_elements(p.x(), p.y())));
  }
}

/// Returns true if a boundary is inside another boundary at all angles.
bool is_inside(const Boundary& inner, const Boundary& outer) {
  constexpr int kAngles = 360;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = kTwoPi * i / kAngles;
    const Vec2 p = inner.point_mm(angle);
    if (!outer.contains(p.x(), p.y())) return false;
  }
  return true;
}

}  // namespace

void FreeformSurface::sort_into_grid(const InputLocation& where) {
  Vec2 low = lenslets_.front().outer.centre_mm;
  Vec2 high = low;
  cell_mm_ = 0.0;
  for (std::size_t i = 0; i < lenslets_.size(); ++i) {
    const Boundary& outer = lenslets_[i].outer;
    low = low.cwiseMin(outer.centre_mm - Vec2::Constant(outer.max_radius_mm));
    high = high.cwiseMax(outer.centre_mm + Vec2::Constant(outer.max_radius_mm));
    cell_mm_ = std::max(cell_mm_, outer.max_radius_mm);
    lenslets_[i].ends_on_base = !extrapolation_ || is_inside(outer, extrapolation_->boundary);
  }
  grid_low_ = low;
  columns_ = static_cast<long>((high.x() - low.x()) / cell_mm_) + 1;
  rows_ = static_cast<long>((high.y() - low.y()) / cell_mm_) + 1;
  cells_.assign(static_cast<std::size_t>(columns_ * rows_), {});
  for (std::uint32_t i = 0; i < lenslets_.size(); ++i) {
    const Boundary& outer = lenslets_[i].outer;
    const Vec2 first = (outer.centre_mm - Vec2::Constant(outer.max_radius_mm) - low) / cell_mm_;
    const Vec2 last = (outer.centre_mm + Vec2::Constant(outer.max_radius_mm) - low) / cell_mm_;
    for (long row = static_cast<long>(first.y()); row <= std::min(rows_ - 1, static_cast<long>(last.y())); ++row)
      for (long column = static_cast<long>(first.x()); column <= std::min(columns_ - 1, static_cast<long>(last.x()));
           ++column) {
        std::vector<std::uint32_t>& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
        for (const std::uint32_t other : cell) check_apart(lenslets_, other, i, where);
        cell.push_back(i);
      }
  }
}

void place_on_base(Lenslet& lenslet, const FreeformSurface& base, double x_mm, double y_mm, double height_mm,
                   bool tilted, const InputLocation& where) {
  const Gradient z = base.gradient(x_mm, y_mm);
  if (!std::isfinite(z.value) || !std::isfinite(z.x) || !std::isfinite(z.y))
    throw InputError(
        where, "must be at a position where the base has a height and a slope, got " + place_elements(x_mm, y_mm));
  const Vec3 normal = Vec3(-z.x, -z.y, 1.0).normalized();
  lenslet.origin_mm = Vec3(x_mm, y_mm, z.value) + height_mm * (tilted ? normal : Vec3(Vec3::UnitZ()));
  lenslet.part_from_lenslet = Eigen::Matrix3d::Identity();
  if (tilted && (z.x != 0.0 || z.y != 0.0))
    lenslet.part_from_lenslet = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
}

void check_surface(const FreeformSurface& surface, double radius_mm, const InputLocation& where) {
  constexpr int kCircles = 128;
  constexpr int kAngles = 180;
  for (int i = 0; i <= kCircles; ++i)
    for (int k = 0; k < (i == 0 ? 1 : kAngles); ++k) {
      const double r = radius_mm * i / kCircles;
      const double angle = kTwoPi * k / kAngles;
      const double x = r * std::cos(angle);
      const double y = r * std::sin(angle);
      if (!std::isfinite(surface.height_mm(x, y)))
        throw InputError(where, "the height of this surface must be finite over the whole part, but is not finite at " +
                                    place_elements(x, y));
      // At the centre, a formula of the radius r may have no slope. An example is a cone.
      if (i == 0) continue;
      const Gradient z = surface.gradient(x, y);
      const double slope = std::hypot(z.x, z.y);
      if (!(slope < kMaxSlope))
        throw InputError(
            where, fmt::format("the surface must not be vertical, but at {} its slope is {}", place_elements(x, y),
                               std::isfinite(slope) ? "above 89 degrees" : "not finite"));
    }
}

}  // namespace retrace::geometry

#include "fabrication/turning/surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/number_format.h"

namespace retrace::fabrication::turning {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// How often a correction of a value must be repeated until all parts of it that vanish to some power are right.
int nilpotency(double) {
  return 0;
}
int nilpotency(const Dual&) {
  return 1;
}
template <class T>
int nilpotency(const Series<T>& s) {
  return s.order + nilpotency(s[0]);
}

double binomial(int n, int k) {
  double b = 1.0;
  for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
  return b;
}

/// A place in polar coordinates about a centre.
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

/// A line through the place at that radius, outwards, as a pair of series in the distance along it.
template <class T>
struct RadialLine {
  Series<T> x;
  Series<T> y;
};

template <class T>
RadialLine<T> radial_line(const Polar<T>& p, const Vec2& centre, const T& radius, int order) {
  return {line_series(T(radius * p.cosine + centre.x()), p.cosine, order),
          line_series(T(radius * p.sine + centre.y()), p.sine, order)};
}

std::string place(double x_mm, double y_mm) {
  return fmt::format("x = {}, y = {} mm", fixed(x_mm, 4), fixed(y_mm, 4));
}

}  // namespace

template <class T>
T hermite_blend(const T& share, const T& width, const Series<T>& first, const Series<T>& second, int order) {
  const T rest = 1.0 - share;
  const T to_first = power(rest, order + 1);
  const T to_second = power(share, order + 1);
  T sum = constant_like(share, 0.0);
  T scale = constant_like(share, 1.0);
  T share_k = constant_like(share, 1.0);
  T rest_k = constant_like(share, 1.0);
  for (int k = 0; k <= order; ++k) {
    T near_first = constant_like(share, 0.0);
    T near_second = constant_like(share, 0.0);
    for (int j = order - k; j >= 0; --j) {
      near_first = near_first * share + binomial(order + j, j);
      near_second = near_second * rest + binomial(order + j, j);
    }
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    sum = sum + scale * (first[k] * (share_k * to_first * near_first) +
                         second[k] * (rest_k * to_second * near_second) * sign);
    scale = scale * width;
    share_k = share_k * share;
    rest_k = rest_k * rest;
  }
  return sum;
}
template double hermite_blend(const double&, const double&, const Series<double>&, const Series<double>&, int);

template <class T>
T Lenslet::evaluate(const T& x_mm, const T& y_mm) const {
  const Eigen::Matrix3d& r = part_from_lenslet;
  const T px = x_mm - origin_mm.x();
  const T py = y_mm - origin_mm.y();
  if (r(2, 2) == 1.0) return sag.evaluate(px, py) + origin_mm.z();
  // The height z over the origin solves F(z) = w - sag(u, v) = 0 with (u, v, w) the point in the lenslet's frame.
  const double x = value_of(px);
  const double y = value_of(py);
  double z = -(x * r(0, 2) + y * r(1, 2)) / r(2, 2);
  double slope = r(2, 2);
  constexpr int kMostSteps = 50;
  double last = 1e300;
  for (int step = 0; step < kMostSteps; ++step) {
    const double u = x * r(0, 0) + y * r(1, 0) + z * r(2, 0);
    const double v = x * r(0, 1) + y * r(1, 1) + z * r(2, 1);
    const Dual s = sag.evaluate(Dual(u, 1.0, 0.0), Dual(v, 0.0, 1.0));
    slope = r(2, 2) - s.dx * r(2, 0) - s.dy * r(2, 1);
    const double change = (x * r(0, 2) + y * r(1, 2) + z * r(2, 2) - s.v) / slope;
    z -= change;
    if (!(std::abs(change) > 1e-16 * (std::abs(z) + 1e-3)) || (std::abs(change) < 1e-12 && std::abs(change) >= last))
      break;
    last = std::abs(change);
  }
  // F falling there would be the underside of an overhang.
  if (!(slope > 0.0)) z = std::numeric_limits<double>::quiet_NaN();
  T height = constant_like(x_mm, z);
  for (int step = nilpotency(x_mm); step > 0; --step) {
    const T u = px * r(0, 0) + py * r(1, 0) + height * r(2, 0);
    const T v = px * r(0, 1) + py * r(1, 1) + height * r(2, 1);
    const T w = px * r(0, 2) + py * r(1, 2) + height * r(2, 2);
    height = height - (w - sag.evaluate(u, v)) / slope;
  }
  return height + origin_mm.z();
}
template double Lenslet::evaluate(const double&, const double&) const;
template Dual Lenslet::evaluate(const Dual&, const Dual&) const;
template Series<double> Lenslet::evaluate(const Series<double>&, const Series<double>&) const;

TurnedSurface::TurnedSurface(Sag base, std::optional<Extrapolation> extrapolation, std::vector<Lenslet> lenslets,
                             const InputLocation& where)
    : base_(std::move(base)), extrapolation_(std::move(extrapolation)), lenslets_(std::move(lenslets)) {
  if (!lenslets_.empty()) sort_into_grid(where);
}

template <class T>
T TurnedSurface::evaluate_base(const T& x_mm, const T& y_mm) const {
  if (!extrapolation_ || extrapolation_->boundary.contains(value_of(x_mm), value_of(y_mm)))
    return base_.evaluate(x_mm, y_mm);
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
T TurnedSurface::evaluate(const T& x_mm, const T& y_mm) const {
  const Lenslet* const lenslet = lenslet_at(value_of(x_mm), value_of(y_mm));
  if (lenslet == nullptr) return evaluate_base(x_mm, y_mm);
  if (lenslet->inner.contains(value_of(x_mm), value_of(y_mm))) return lenslet->evaluate(x_mm, y_mm);
  const Vec2& centre = lenslet->outer.centre_mm;
  const Polar<T> p = polar(x_mm, y_mm, centre);
  const T r = lenslet->inner.radius_mm.evaluate(p.angle);
  const T R = lenslet->outer.radius_mm.evaluate(p.angle);
  const RadialLine<T> near = radial_line(p, centre, r, lenslet->blend_order);
  const RadialLine<T> far = radial_line(p, centre, R, lenslet->blend_order);
  const Series<T> on_lenslet = lenslet->evaluate(near.x, near.y);
  // Blends lie where the base is defined, so that its extrapolation is not met here.
  const Series<T> on_base = base_.evaluate(far.x, far.y);
  return hermite_blend(T((p.radius - r) / (R - r)), T(R - r), on_lenslet, on_base, lenslet->blend_order);
}

template double TurnedSurface::evaluate(const double&, const double&) const;
template Dual TurnedSurface::evaluate(const Dual&, const Dual&) const;
template Series<double> TurnedSurface::evaluate(const Series<double>&, const Series<double>&) const;
template double TurnedSurface::evaluate_base(const double&, const double&) const;
template Dual TurnedSurface::evaluate_base(const Dual&, const Dual&) const;
template Series<double> TurnedSurface::evaluate_base(const Series<double>&, const Series<double>&) const;

Zone TurnedSurface::zone_at(double x_mm, double y_mm) const {
  if (const Lenslet* const lenslet = lenslet_at(x_mm, y_mm))
    return lenslet->inner.contains(x_mm, y_mm) ? Zone::lenslet : Zone::blend;
  return !extrapolation_ || extrapolation_->boundary.contains(x_mm, y_mm) ? Zone::base : Zone::extrapolation;
}

const Lenslet* TurnedSurface::lenslet_at(double x_mm, double y_mm) const {
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

/// \throw InputError if two blends reach into each other: a point of one's outer boundary lies inside the other's
void check_apart(const std::vector<Lenslet>& lenslets, std::uint32_t a, std::uint32_t b, const InputLocation& where) {
  const Boundary& first = lenslets[a].outer;
  const Boundary& second = lenslets[b].outer;
  if ((first.centre_mm - second.centre_mm).norm() > first.most_mm + second.most_mm) return;
  constexpr int kAngles = 360;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAngles;
    const double r = first.radius_mm.evaluate(angle);
    const Vec2 p = first.centre_mm + r * Vec2(std::cos(angle), std::sin(angle));
    if (second.contains(p.x(), p.y()))
      throw InputError(where, fmt::format("must leave room between blends, lenslets {} and {} cross at {}", a + 1,
                                          b + 1, place(p.x(), p.y())));
  }
}

/// \throw InputError if a blend ends where the base is only extrapolated
void check_on_base(const Lenslet& lenslet, const Boundary& base, std::size_t number, const InputLocation& where) {
  constexpr int kAngles = 360;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAngles;
    const Vec2 p =
        lenslet.outer.centre_mm + lenslet.outer.radius_mm.evaluate(angle) * Vec2(std::cos(angle), std::sin(angle));
    if (!base.contains(p.x(), p.y()))
      throw InputError(where, fmt::format("must lie with its blend inside the base's boundary, lenslet {} crosses it "
                                          "at {}",
                                          number, place(p.x(), p.y())));
  }
}

}  // namespace

void TurnedSurface::sort_into_grid(const InputLocation& where) {
  Vec2 low = lenslets_.front().outer.centre_mm;
  Vec2 high = low;
  cell_mm_ = 0.0;
  for (std::size_t i = 0; i < lenslets_.size(); ++i) {
    const Boundary& outer = lenslets_[i].outer;
    low = low.cwiseMin(outer.centre_mm - Vec2::Constant(outer.most_mm));
    high = high.cwiseMax(outer.centre_mm + Vec2::Constant(outer.most_mm));
    cell_mm_ = std::max(cell_mm_, outer.most_mm);
    if (extrapolation_) check_on_base(lenslets_[i], extrapolation_->boundary, i + 1, where);
  }
  grid_low_ = low;
  columns_ = static_cast<long>((high.x() - low.x()) / cell_mm_) + 1;
  rows_ = static_cast<long>((high.y() - low.y()) / cell_mm_) + 1;
  cells_.assign(static_cast<std::size_t>(columns_ * rows_), {});
  for (std::uint32_t i = 0; i < lenslets_.size(); ++i) {
    const Boundary& outer = lenslets_[i].outer;
    const Vec2 first = (outer.centre_mm - Vec2::Constant(outer.most_mm) - low) / cell_mm_;
    const Vec2 last = (outer.centre_mm + Vec2::Constant(outer.most_mm) - low) / cell_mm_;
    for (long row = static_cast<long>(first.y()); row <= std::min(rows_ - 1, static_cast<long>(last.y())); ++row)
      for (long column = static_cast<long>(first.x()); column <= std::min(columns_ - 1, static_cast<long>(last.x()));
           ++column) {
        std::vector<std::uint32_t>& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
        for (const std::uint32_t other : cell) check_apart(lenslets_, other, i, where);
        cell.push_back(i);
      }
  }
}

void place_on_base(Lenslet& lenslet, const TurnedSurface& base, double x_mm, double y_mm, double height_mm, bool tilted,
                   const InputLocation& where) {
  const Dual z = base.gradient(x_mm, y_mm);
  if (!std::isfinite(z.v) || !std::isfinite(z.dx) || !std::isfinite(z.dy))
    throw InputError(where, "must lie where the base has a height and slope, got " + place(x_mm, y_mm));
  const Vec3 normal = Vec3(-z.dx, -z.dy, 1.0).normalized();
  lenslet.origin_mm = Vec3(x_mm, y_mm, z.v) + height_mm * (tilted ? normal : Vec3(Vec3::UnitZ()));
  lenslet.part_from_lenslet = Eigen::Matrix3d::Identity();
  if (tilted && (z.dx != 0.0 || z.dy != 0.0))
    lenslet.part_from_lenslet = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
}

void check_surface(const TurnedSurface& surface, double radius_mm, const InputLocation& where) {
  constexpr int kCircles = 128;
  constexpr int kAngles = 180;
  for (int i = 0; i <= kCircles; ++i)
    for (int k = 0; k < (i == 0 ? 1 : kAngles); ++k) {
      const double r = radius_mm * i / kCircles;
      const double angle = 2.0 * std::numbers::pi * k / kAngles;
      const double x = r * std::cos(angle);
      const double y = r * std::sin(angle);
      if (!std::isfinite(surface.height_mm(x, y)))
        throw InputError(where, "must be finite all over the part, is not at " + place(x, y));
      // At the centre a formula of r may have no slope, as that of a cone.
      if (i == 0) continue;
      const Dual z = surface.gradient(x, y);
      const double slope = std::hypot(z.dx, z.dy);
      if (!(slope < kSteepestSlope))
        throw InputError(where, fmt::format("must have no vertical slope, at {} it is {}", place(x, y),
                                            std::isfinite(slope) ? "above 89 degrees" : "not finite"));
    }
}

}  // namespace retrace::fabrication::turning

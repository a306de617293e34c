#include "geometry/substrate/substrate_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "core/angle.h"
#include "core/error.h"
#include "core/overloaded.h"
#include "geometry/centroid.h"
#include "geometry/direction.h"

namespace retrace::geometry {
namespace {

// Maximum distance from the centre at which circles are evaluated, relative to the radius. Only material that the
// border cuts off is beyond this distance.
constexpr double kMaxSine = 0.999;

Eigen::Matrix3d turn_of(const PlaneSubstrate& plane) {
  // The axis of rotation is the horizontal line at right angles to the azimuth. The plane then rises towards the
  // azimuth.
  const Vec2 along = direction_at(Angle::from_deg(plane.azimuth_deg));
  return rotation_about({along.y(), -along.x(), 0.0}, Angle::from_deg(plane.incline_deg));
}

Sag sag_of(const PlaneSubstrate& plane) {
  const double rise = std::tan(plane.incline_deg * kRadPerDeg);
  const Vec2 along = direction_at(Angle::from_deg(plane.azimuth_deg));
  Sag sag;
  sag.polynomial = XyPolynomial{1.0, 1, {0.0, rise * along.y(), rise * along.x()}};
  return sag;
}

Sag sag_of(const CylinderSubstrate& cylinder) {
  Sag sag;
  sag.asphere.curvature_per_mm = -1.0 / cylinder.radius_mm;
  sag.asphere.across = cylinder.axis_is_x ? Asphere::Across::y : Asphere::Across::x;
  return sag;
}

Sag sag_of(const SphereSubstrate& sphere) {
  Sag sag;
  sag.asphere.curvature_per_mm = -1.0 / sphere.radius_mm;
  return sag;
}

Sag sag_of(const FormulaSubstrate& formula) {
  Sag sag;
  sag.formula = *formula.sag_mm;
  return sag;
}

Sag sag_of(const StepFace& face) {
  Sag sag;
  sag.patches = patches_of(face);
  return sag;
}

/// Returns an empty sag, because an offset substrate is evaluated from the entrance surface instead.
Sag sag_of(const OffsetSubstrate&) {
  return {};
}

/// Returns a height and its derivatives, which are computed from central differences.
template <class Height>
Jet jet_by_differences(const Height& height, const Vec2& p, double step) {
  const auto at = [&](int i, int j) { return height(Vec2(p + step * Vec2(i, j))); };
  const double middle = at(0, 0);
  const double xx = at(1, 0) - 2.0 * middle + at(-1, 0);
  const double yy = at(0, 1) - 2.0 * middle + at(0, -1);
  const double xy = 0.25 * (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1));
  return {middle,
          (at(1, 0) - at(-1, 0)) / (2.0 * step),
          (at(0, 1) - at(0, -1)) / (2.0 * step),
          xx / (step * step),
          xy / (step * step),
          yy / (step * step)};
}

/// Returns the point nearest to `p` at which a circular cross section is not yet vertical.
Vec2 short_of_upright(const SubstrateShape& shape, const Vec2& p) {
  if (const auto* const c = std::get_if<CylinderSubstrate>(&shape)) {
    const double most = kMaxSine * std::abs(c->radius_mm);
    const Vec2 clamped = p.cwiseMax(-most).cwiseMin(most);
    return c->axis_is_x ? Vec2(p.x(), clamped.y()) : Vec2(clamped.x(), p.y());
  }
  const auto* const sphere = std::get_if<SphereSubstrate>(&shape);
  const double most = sphere != nullptr ? kMaxSine * std::abs(sphere->radius_mm) : INFINITY;
  return p.norm() <= most ? p : Vec2(p * (most / p.norm()));
}

double arc_of_chord(double radius, double t) {
  const double r = std::abs(radius);
  return r * std::asin(std::clamp(t / r, -kMaxSine, kMaxSine));
}

double chord_of_arc(double radius, double s) {
  const double r = std::abs(radius);
  return r * std::sin(std::clamp(s / r, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi));
}

/// The next two functions return the slope along the line x = 0, and the slope along a line of constant y.
auto middle_slope(const SubstrateSurface& surface) {
  return [&surface](double y) { return surface.at({0.0, y}).y; };
}
auto row_slope(const SubstrateSurface& surface, double y) {
  return [&surface, y](double x) { return surface.at({x, y}).x; };
}

/// Table of the arc length along a curve z(t), measured from t = 0 and computed from the slope of the curve. It also
/// returns t for a given arc length.
class ArcTable {
 public:
  template <class Slope>
  ArcTable(double half_mm, double beyond_mm, double step_mm, const Slope& slope) {
    // The border is a node of the table, so that no interval of integration contains a kink at the border. A formula
    // may have a kink there, because it is continued along its tangent outside the border.
    const double within = std::ceil(half_mm / step_mm);
    step_ = half_mm / within;
    const double count = within + std::ceil(beyond_mm / step_);
    excess_.resize(2 * static_cast<std::size_t>(count) + 1, 0.0);
    middle_ = static_cast<std::size_t>(count);
    for (std::size_t k = 0; k < middle_; ++k) {
      const double from = static_cast<double>(k) * step_;
      excess_[middle_ + k + 1] = excess_[middle_ + k] + excess(from, from + step_, slope);
      excess_[middle_ - k - 1] = excess_[middle_ - k] - excess(-from - step_, -from, slope);
    }
  }

  template <class Slope>
  double arc(double t, const Slope& slope) const {
    const std::size_t k = node_below(t);
    return t + excess_[k] + excess(place(k), t, slope);
  }

  /// Returns the parameter t at which the arc length is `s`.
  template <class Slope>
  double place_at(double s, const Slope& slope) const {
    std::size_t low = 0;
    std::size_t high = excess_.size() - 1;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (place(middle) + excess_[middle] <= s ? low : high) = middle;
    }
    double t = place(low) + (s - place(low) - excess_[low]) / std::hypot(1.0, slope(place(low)));
    constexpr int kMaxSteps = 30;
    for (int k = 0; k < kMaxSteps; ++k) {
      const double step = (s - t - excess_[low] - excess(place(low), t, slope)) / std::hypot(1.0, slope(t));
      t += step;
      if (std::abs(step) <= 1e-14 * (std::abs(t) + step_)) break;
    }
    return t;
  }

 private:
  double place(std::size_t k) const { return (static_cast<double>(k) - static_cast<double>(middle_)) * step_; }
  std::size_t node_below(double t) const {
    const double k = std::floor(t / step_) + static_cast<double>(middle_);
    return static_cast<std::size_t>(std::clamp(k, 0.0, static_cast<double>(excess_.size() - 1)));
  }

  /// Returns arc length minus projected length between two parameters, by Gauss-Legendre quadrature with five points.
  /// The result is exactly 0 if the curve is horizontal.
  template <class Slope>
  static double excess(double from, double to, const Slope& slope) {
    constexpr std::array<double, 3> kPlaces = {0.0, 0.5384693101056831, 0.9061798459386640};
    constexpr std::array<double, 3> kWeights = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    const double middle = 0.5 * (from + to);
    const double half = 0.5 * (to - from);
    const auto more = [&](double t) {
      const double d = slope(t);
      return d * d / (1.0 + std::hypot(1.0, d));
    };
    double sum = kWeights[0] * more(middle);
    for (const std::size_t k : {1U, 2U})
      sum += kWeights[k] * (more(middle - kPlaces[k] * half) + more(middle + kPlaces[k] * half));
    return half * sum;
  }

  double step_ = 1.0;
  std::size_t middle_ = 0;
  std::vector<double> excess_;  ///< for each node, arc length minus projected length, measured from the centre
};

}  // namespace

/// Arc lengths for a formula: along x = 0, and along the rows that were requested.
struct SubstrateSurface::ArcTables {
  ArcTables(const SubstrateSurface& surface, double size_mm)
      : step_mm(std::max(0.5 * size_mm, surface.half_mm_.maxCoeff() / kMaxSteps)),
        beyond_mm(8.0 * size_mm),
        along_y(surface.half_mm_.y(), beyond_mm, step_mm, middle_slope(surface)) {}

  /// Returns the table of a row. Tables are cached, because all elements of a row need the same table.
  const ArcTable& row(const SubstrateSurface& surface, double y) {
    const auto key = static_cast<std::int64_t>(std::llround(y / (1e-9 * step_mm)));
    if (const auto known = rows.find(key); known != rows.end()) return known->second;
    if (rows.size() >= kMaxRows) rows.clear();
    return rows.emplace(key, ArcTable(surface.half_mm_.x(), beyond_mm, step_mm, row_slope(surface, y))).first->second;
  }

  static constexpr double kMaxSteps = 20000.0;
  static constexpr std::size_t kMaxRows = 512;
  double step_mm;
  double beyond_mm;
  ArcTable along_y;
  std::unordered_map<std::int64_t, ArcTable> rows;
};

FormulaSubstrate formula_substrate(std::string_view sag_mm) {
  return {std::make_shared<const Formula>(parse_formula(std::string(sag_mm), {"x", "y"}, InputLocation{}))};
}

SubstrateSurface::SubstrateSurface(const Substrate& substrate, const Vec2& half_mm, double size_mm)
    : substrate_(substrate),
      sag_(std::visit([](const auto& shape) { return sag_of(shape); }, substrate.shape)),
      half_mm_(half_mm),
      size_mm_(size_mm) {}

SubstrateSurface::ArcTables& SubstrateSurface::tables() const {
  if (tables_ == nullptr) tables_ = std::make_unique<ArcTables>(*this, size_mm_);
  return *tables_;
}

SubstrateSurface::~SubstrateSurface() = default;
SubstrateSurface::SubstrateSurface(SubstrateSurface&&) noexcept = default;

// Outside the region where the substrate is valid, it is continued along its tangent. The region of a circular cross
// section ends just before the circle becomes vertical. If a formula has no value or is steep at a point outside the
// part, the region ends at the part's border. Only cells that the border cuts extend that far.
Jet SubstrateSurface::at(const Vec2& plan) const {
  constexpr double kSteepBeyond = 4.0;
  Vec2 from = short_of_upright(substrate_.shape, plan);
  Jet jet = jet_at(from);
  if ((sag_.formula || sag_.patches || is_offset()) && (!jet.is_finite() || std::hypot(jet.x, jet.y) >= kSteepBeyond)) {
    from = plan.cwiseMax(-half_mm_).cwiseMin(half_mm_);
    jet = jet_at(from);
  }
  jet.value += jet.x * (plan.x() - from.x()) + jet.y * (plan.y() - from.y());
  return jet;
}

Jet SubstrateSurface::jet_at(const Vec2& plan) const {
  constexpr double kStep = 1e-3;  // as a fraction of the element size
  const auto* const offset = std::get_if<OffsetSubstrate>(&substrate_.shape);
  if (offset == nullptr) return sag_.evaluate(Jet(plan.x(), 1.0, 0.0), Jet(plan.y(), 0.0, 1.0));
  Jet jet = jet_by_differences(offset->entrance_mm, plan, kStep * size_mm_);
  jet.value -= offset->wall_mm;
  return jet;
}

double SubstrateSurface::lowest_over(const Polygon& plan) const {
  constexpr int kPointsOfSide = 4;
  constexpr double kSmallestStep = 1e-7;  // as a fraction of the element size
  const auto height = [&](const Vec2& p) {
    const auto* const offset = std::get_if<OffsetSubstrate>(&substrate_.shape);
    const double value = offset != nullptr ? offset->entrance_mm(p) - offset->wall_mm : at(p).value;
    return std::isfinite(value) ? value : at(p).value;
  };
  Vec2 lowest = centroid(plan);
  double lowest_mm = height(lowest);
  const auto take = [&](const Vec2& p) {
    const double value = height(p);
    if (!(value < lowest_mm)) return false;
    lowest_mm = value;
    lowest = p;
    return true;
  };
  for (std::size_t k = 0; k < plan.size(); ++k)
    for (int i = 0; i < kPointsOfSide; ++i)
      take(plan[k] + (static_cast<double>(i) / kPointsOfSide) * (plan[(k + 1) % plan.size()] - plan[k]));
  // Searches for a minimum in decreasing steps along the axes (R. Hooke, T. A. Jeeves, J. ACM 8 (1961), 212).
  for (double step = 0.125 * size_mm_; step > kSmallestStep * size_mm_;) {
    bool moved = false;
    for (const Vec2& way : {Vec2(step, 0.0), Vec2(-step, 0.0), Vec2(0.0, step), Vec2(0.0, -step)})
      moved = (contains(plan, lowest + way, 0.0) && take(lowest + way)) || moved;
    if (!moved) step *= 0.5;
  }
  return lowest_mm;
}

Vec3 SubstrateSurface::normal_at(const Vec2& plan) const {
  const Jet jet = at(plan);
  return Vec3(-jet.x, -jet.y, 1.0).normalized();
}

Vec2 SubstrateSurface::plan_of(const Vec2& arc) const {
  if (is_upright()) return arc;
  return std::visit(
      Overloaded{[&](const PlaneSubstrate& plane) { return Vec2(turn_of(plane).topLeftCorner<2, 2>() * arc); },
                 [&](const CylinderSubstrate& c) {
                   return c.axis_is_x ? Vec2(arc.x(), chord_of_arc(c.radius_mm, arc.y()))
                                      : Vec2(chord_of_arc(c.radius_mm, arc.x()), arc.y());
                 },
                 [&](const SphereSubstrate& s) {
                   const double y = chord_of_arc(s.radius_mm, arc.y());
                   const double row = std::sqrt(s.radius_mm * s.radius_mm - y * y);
                   return Vec2(row > 0.0 ? chord_of_arc(row, arc.x()) : 0.0, y);
                 },
                 [&](const auto&) {
                   const double y = tables().along_y.place_at(arc.y(), middle_slope(*this));
                   return Vec2(tables().row(*this, y).place_at(arc.x(), row_slope(*this, y)), y);
                 },
                 [&](const OffsetSubstrate&) { return arc; }},
      substrate_.shape);
}

Vec2 SubstrateSurface::arc_of(const Vec2& plan) const {
  if (is_upright()) return plan;
  return std::visit(
      Overloaded{
          [&](const PlaneSubstrate& plane) { return Vec2(turn_of(plane).topLeftCorner<2, 2>().inverse() * plan); },
          [&](const CylinderSubstrate& c) {
            return c.axis_is_x ? Vec2(plan.x(), arc_of_chord(c.radius_mm, plan.y()))
                               : Vec2(arc_of_chord(c.radius_mm, plan.x()), plan.y());
          },
          [&](const SphereSubstrate& s) {
            const double row = std::sqrt(std::max(0.0, s.radius_mm * s.radius_mm - plan.y() * plan.y()));
            return Vec2(row > 0.0 ? arc_of_chord(row, plan.x()) : 0.0, arc_of_chord(s.radius_mm, plan.y()));
          },
          [&](const auto&) {
            return Vec2(tables().row(*this, plan.y()).arc(plan.x(), row_slope(*this, plan.y())),
                        tables().along_y.arc(plan.y(), middle_slope(*this)));
          },
          [&](const OffsetSubstrate&) { return plan; }},
      substrate_.shape);
}

Rectangle SubstrateSurface::arc_reach() const {
  if (const auto* plane = std::get_if<PlaneSubstrate>(&substrate_.shape); plane != nullptr && !is_upright()) {
    const Eigen::Matrix3d turn = turn_of(*plane);
    const Vec2 reach(half_mm_.x() / turn(0, 0), half_mm_.y() / turn(1, 1));
    return {-reach, reach};
  }
  const double left = arc_of({-half_mm_.x(), 0.0}).x();
  const double right = arc_of({half_mm_.x(), 0.0}).x();
  return {{left, arc_of({0.0, -half_mm_.y()}).y()}, {right, arc_of({0.0, half_mm_.y()}).y()}};
}

SubstrateFrame SubstrateSurface::frame_over(const Vec2& plan) const {
  const Jet jet = at(plan);
  SubstrateFrame frame;
  frame.origin = {plan.x(), plan.y(), jet.value};
  if (is_upright()) return frame;
  if (const auto* plane = std::get_if<PlaneSubstrate>(&substrate_.shape)) {
    const Eigen::Matrix3d turn = turn_of(*plane);
    frame.along_u = turn.col(0);
    frame.along_v = turn.col(1);
    frame.normal = turn.col(2);
    return frame;
  }
  frame.normal = Vec3(-jet.x, -jet.y, 1.0).normalized();
  frame.along_u = Vec3(1.0, 0.0, jet.x).normalized();
  frame.along_v = frame.normal.cross(frame.along_u);
  return frame;
}

bool SubstrateSurface::repeats_along_u() const {
  const auto* cylinder = std::get_if<CylinderSubstrate>(&substrate_.shape);
  return std::holds_alternative<PlaneSubstrate>(substrate_.shape) || (cylinder != nullptr && cylinder->axis_is_x);
}

bool SubstrateSurface::repeats_along_v() const {
  const auto* cylinder = std::get_if<CylinderSubstrate>(&substrate_.shape);
  return std::holds_alternative<PlaneSubstrate>(substrate_.shape) || (cylinder != nullptr && !cylinder->axis_is_x);
}

namespace {

/// Returns the larger magnitude of the two principal curvatures. They are the eigenvalues of the shape operator I^-1 II
/// (do Carmo, Differential Geometry, 3-3).
double max_curvature(const Jet& jet) {
  const double w2 = 1.0 + jet.x * jet.x + jet.y * jet.y;
  const double w = std::sqrt(w2);
  const double gauss = (jet.xx * jet.yy - jet.xy * jet.xy) / (w2 * w2);
  const double mean =
      ((1.0 + jet.y * jet.y) * jet.xx - 2.0 * jet.x * jet.y * jet.xy + (1.0 + jet.x * jet.x) * jet.yy) / (2.0 * w2 * w);
  return std::abs(mean) + std::sqrt(std::max(0.0, mean * mean - gauss));
}

}  // namespace

SubstrateMeasures measure_substrate(const SubstrateSurface& substrate, const Vec2& half_mm) {
  constexpr int kSteps = 128;
  SubstrateMeasures measures;
  measures.lowest_mm = std::numeric_limits<double>::infinity();
  measures.highest_mm = -std::numeric_limits<double>::infinity();
  double curvature = 0.0;
  double steepness = 0.0;
  double area = 0.0;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const Vec2 p = half_mm.cwiseProduct(Vec2(2.0 * i / kSteps - 1.0, 2.0 * j / kSteps - 1.0));
      const Jet jet = substrate.at(p);
      if (!jet.is_finite())
        throw InputError(
            fmt::format("the substrate must have a finite height, slope and curvature at every point, but has none at "
                        "x = {:.6g}, y = {:.6g} mm from the centre of the part",
                        p.x(), p.y()));
      measures.lowest_mm = std::min(measures.lowest_mm, jet.value);
      measures.highest_mm = std::max(measures.highest_mm, jet.value);
      const double rise = std::hypot(jet.x, jet.y);
      steepness = std::max(steepness, rise);
      curvature = std::max(curvature, max_curvature(jet));
      // Weights of Simpson's rule along both axes.
      const auto weight = [](int k) { return k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0; };
      area += weight(i) * weight(j) * std::hypot(1.0, rise);
    }
  measures.area_mm2 = area * half_mm.prod() * 4.0 / (9.0 * kSteps * kSteps);
  measures.steepest_deg = std::atan(steepness) / kRadPerDeg;
  measures.min_radius_mm = curvature > 0.0 ? 1.0 / curvature : std::numeric_limits<double>::infinity();
  return measures;
}

}  // namespace retrace::geometry

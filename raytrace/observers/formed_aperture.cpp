#include "raytrace/observers/formed_aperture.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "raytrace/exact/flat_polygon.h"
#include "raytrace/light/aperture_kernel.h"

namespace retrace::raytrace {
namespace {

using geometry::Vec2;

// Number of points along an edge of the triangles over which phases are averaged. The average is exact for quadratic
// phases.
constexpr std::size_t kPoints = 3;
// Corners are merged if their distance is less than this fraction of the polygon's size.
constexpr double kOneCorner = 1e-12;
// Minimum relative power in the formula for the subdivision. Weaker polygons are subdivided as if they had this power.
constexpr double kMinRelativePower = 1e-4;

/// Phase that the forms of surfaces add to the light of a polygon, as a function of the point where the light leaves
/// the entrance face.
struct FormPhase {
  const std::vector<FieldHit>& hits;
  double wave_number = 0.0;

  double at(const Vec2& r) const {
    double path_mm = 0.0;
    for (const FieldHit& hit : hits)
      if (hit.path_per_height != 0.0)
        path_mm += hit.path_per_height * hit.form->height_mm(hit.form_constant_mm + hit.form_slope * r);
    return wave_number * path_mm;
  }
  Vec2 gradient(const Vec2& r) const {
    Vec2 sum = Vec2::Zero();
    for (const FieldHit& hit : hits)
      if (hit.path_per_height != 0.0)
        sum += hit.path_per_height * hit.form_slope.transpose() *
               hit.form->slope(hit.form_constant_mm + hit.form_slope * r);
    return wave_number * sum;
  }
};

/// Linear function that best approximates the phase over a polygon, and measures of the approximation error along two
/// axes.
struct LinearPhase {
  struct Axis {
    Vec2 direction = Vec2::UnitX();
    double bend = 0.0;  ///< square of the phase error due to curvature along this axis, except for a constant factor
  };

  double at_origin_rad = 0.0;
  Vec2 rad_per_mm = Vec2::Zero();
  double left_rad = 0.0;  ///< root mean square of the difference between the phase and the linear function
  Vec2 middle = Vec2::Zero();
  std::array<Axis, 2> across;

  LinearPhase(const FlatPolygon& polygon, const FormPhase& phase) {
    static const GaussRule rule = gauss_legendre(kPoints);
    struct Point {
      Vec2 r;
      double weight = 0.0, phase = 0.0;
    };
    std::vector<Point> points;
    double sum = 0.0;
    const auto add = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
      const Vec2 p = b - a, q = c - a;
      const double twice = p.x() * q.y() - p.y() * q.x();
      for (std::size_t i = 0; i < kPoints; ++i)
        for (std::size_t j = 0; j < kPoints; ++j) {
          const double u = rule.nodes[i], v = rule.nodes[j];
          const double weight = twice * u * rule.weights[i] * rule.weights[j];
          points.push_back({a + u * ((1.0 - v) * p + v * q), weight, 0.0});
          sum += weight;
          middle += weight * points.back().r;
        }
    };
    for (std::size_t k = 2; k < polygon.size(); ++k) add(polygon[0], polygon[k - 1], polygon[k]);
    middle /= sum;
    // Coordinates are relative to `middle`, where the linear function is equal to the mean phase.
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d turned = Eigen::Matrix2d::Zero();  // second moments of the gradient
    Vec2 mean_gradient = Vec2::Zero();
    Vec2 moment = Vec2::Zero();
    double mean = 0.0;
    for (Point& point : points) {
      point.phase = phase.at(point.r);
      const Vec2 from = point.r - middle;
      const double share = point.weight / sum;
      mean += share * point.phase;
      moment += share * point.phase * from;
      spread += share * from * from.transpose();
      const Vec2 gradient = phase.gradient(point.r);
      mean_gradient += share * gradient;
      turned += share * gradient * gradient.transpose();
    }
    turned -= mean_gradient * mean_gradient.transpose();
    rad_per_mm = spread.ldlt().solve(moment);
    at_origin_rad = mean - rad_per_mm.dot(middle);
    double squares = 0.0;
    for (const Point& point : points) {
      const double left = point.phase - at_origin_rad - rad_per_mm.dot(point.r);
      squares += point.weight / sum * left * left;
    }
    left_rad = std::sqrt(squares);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
    for (const Eigen::Index k : {0, 1}) {
      Axis& axis = across[static_cast<std::size_t>(k)];
      axis.direction = axes.eigenvectors().col(k);
      axis.bend = axes.eigenvalues()[k] * std::max(0.0, axis.direction.dot(turned * axis.direction));
    }
  }

  /// Returns the number of strips of equal width, perpendicular to an axis, into which a polygon must be divided. If
  /// the polygon is divided along both axes, its phase error decreases to `left`. The error due to the curvature along
  /// an axis is proportional to the square of the width of a strip.
  std::size_t strips(std::size_t axis, double left) const {
    const double all = across[0].bend + across[1].bend;
    const double share = all > 0.0 ? across[axis].bend / all : 0.5;
    return static_cast<std::size_t>(
        std::clamp(std::ceil(std::sqrt(left_rad / left * std::sqrt(2.0 * share))), 1.0, 64.0));
  }
};

/// Divides a polygon into strips of equal width along a direction.
FlatPolygons cut_across(const FlatPolygon& polygon, const Vec2& direction, std::size_t count, double merge_mm) {
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (const Vec2& p : polygon) {
    from = std::min(from, direction.dot(p));
    to = std::max(to, direction.dot(p));
  }
  FlatPolygons strips;
  FlatPolygon rest = polygon;
  for (std::size_t k = 1; k <= count && rest.size() >= 3; ++k) {
    const double at = from + (to - from) * static_cast<double>(k) / static_cast<double>(count);
    FlatPolygon strip = k < count ? clipped(rest, {direction.x(), direction.y(), at}, merge_mm) : rest;
    if (strip.size() >= 3) strips.push_back(std::move(strip));
    clip(rest, {-direction.x(), -direction.y(), -at}, merge_mm);
  }
  return strips;
}

class Cutter {
 public:
  Cutter(CoherentGroup& made, const FormedPolicy& policy) : made_(made), policy_(policy) {}

  void cut(const FieldPolygon& whole) {
    if (std::ranges::none_of(whole.hits, [](const FieldHit& hit) { return hit.path_per_height != 0.0; })) {
      add(whole);
      return;
    }
    const FormPhase phase{whole.hits, policy_.wave_number};
    const double share = std::max(kMinRelativePower, made_.copies * whole.power / policy_.strongest);
    const double widened = share < 1.0 ? 1.0 / std::pow(share, 0.25) : 1.0;
    const double merge_mm = kOneCorner * whole.transform.size_mm();
    std::vector<FlatPolygon> waiting = {{whole.transform.polygon().begin(), whole.transform.polygon().end()}};
    const double whole_left_rad = LinearPhase(waiting.front(), phase).left_rad;
    const double left_rad = policy_.target_phase_error_rad * std::cbrt(whole_left_rad) * widened;
    while (!waiting.empty()) {
      const FlatPolygon polygon = std::move(waiting.back());
      waiting.pop_back();
      const LinearPhase linear(polygon, phase);
      if (!(linear.left_rad > left_rad)) {
        add_piece(whole, polygon, linear);
        continue;
      }
      std::array<std::size_t, 2> strips = {linear.strips(0, left_rad), linear.strips(1, left_rad)};
      if (strips[0] * strips[1] == 1) strips[linear.across[0].bend > linear.across[1].bend ? 0 : 1] = 2;
      for (const FlatPolygon& strip : cut_across(polygon, linear.across[0].direction, strips[0], merge_mm))
        for (FlatPolygon& cell : cut_across(strip, linear.across[1].direction, strips[1], merge_mm))
          waiting.push_back(std::move(cell));
      require(waiting.size());
    }
  }

 private:
  void add_piece(const FieldPolygon& whole, const FlatPolygon& polygon, const LinearPhase& linear) {
    FieldPolygon piece{PolygonTransform({polygon.begin(), polygon.end()}),
                       whole.cosines + linear.rad_per_mm / policy_.wave_number,
                       std::polar(1.0, linear.at_origin_rad) * whole.amplitude,
                       0.0,
                       {},
                       whole.phase_variance,
                       whole.mean_factor,
                       whole.path_mm,
                       whole.entry_mm,
                       whole.entry_slope};
    piece.power = whole.power * piece.transform.area_mm2() / whole.transform.area_mm2();
    add(std::move(piece));
  }
  void add(FieldPolygon piece) {
    made_.polygons.push_back(std::move(piece));
    require(0);
  }
  void require(std::size_t waiting) const {
    if (made_.polygons.size() + waiting > policy_.max_polygons)
      throw BudgetError(
          fmt::format("the form of the facets deflects the light of a cell too much for diffraction: more "
                      "than {} plane waves would be required",
                      policy_.max_polygons));
  }

  CoherentGroup& made_;
  const FormedPolicy& policy_;
};

}  // namespace

CoherentGroup formed(const CoherentGroup& group, const FormedPolicy& policy) {
  CoherentGroup made{{}, group.copies, group.extent_mm, group.replicate, group.positions_mm, group.path_mm};
  Cutter cutter(made, policy);
  for (const FieldPolygon& polygon : group.polygons) cutter.cut(polygon);
  return made;
}

double max_deflection(const CoherentGroup& plane, const CoherentGroup& formed) {
  double most = 0.0;
  for (const FieldPolygon& piece : formed.polygons) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const FieldPolygon& whole : plane.polygons)
      nearest = std::min(nearest, (piece.cosines - whole.cosines).norm());
    most = std::max(most, nearest);
  }
  return most;
}

}  // namespace retrace::raytrace

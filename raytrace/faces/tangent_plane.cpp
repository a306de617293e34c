#include "raytrace/faces/tangent_plane.h"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "raytrace/light/light_setup.h"

namespace retrace::raytrace {
namespace {

constexpr int kMaxNewtonSteps = 60;
// Step length below which the iterations for intersections and entry points stop.
constexpr double kAccuracy_mm = 1e-11;
// Degree of the polynomial that describes the height above the tangent plane, and number of sample points along each
// axis.
constexpr int kSagDegree = 6;
constexpr int kSagPoints = 12;
// Maximum degree of the terms that squared_slope() uses. The squares of the slopes of higher terms would exceed the
// maximum degree of a FacetForm.
constexpr int kSquaredDegree = 5;
static_assert(2 * (kSquaredDegree - 1) <= surface_models::FacetForm::kMaxDegree);

Vec3 normal_of(const Vec2& slope) {
  return Vec3(-slope.x(), -slope.y(), 1.0).normalized();
}

bool is_defined(const geometry::EntranceSurface::SurfaceSample& sample) {
  return std::isfinite(sample.height_mm) && sample.slope.allFinite();
}

/// Returns the horizontal displacement (x, y) of a ray per unit increase of z.
Vec2 lean(const Vec3& direction) {
  return direction.head<2>() / direction.z();
}

}  // namespace

std::optional<TangentPlane> tangent_plane(const geometry::EntranceSurface& surface, const Vec2& at_mm) {
  const geometry::EntranceSurface::SurfaceSample sample = surface.at(at_mm);
  if (!is_defined(sample)) return std::nullopt;
  TangentPlane plane;
  plane.point_mm = {at_mm.x(), at_mm.y(), sample.height_mm};
  plane.normal = normal_of(sample.slope);
  plane.surface_slope = sample.slope;
  plane.frame_from_part = Eigen::Quaterniond::FromTwoVectors(plane.normal, Vec3::UnitZ()).toRotationMatrix();
  return plane;
}

Vec3 refracted_inside(const Vec2& slope, const Vec3& to_source, double index) {
  const Vec3 normal = normal_of(slope);
  const double cosine = normal.dot(to_source);
  const double inner = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  return refracted(-to_source, normal, 1.0 / index, cosine, inner);
}

std::optional<Vec2> point_of_entry(const geometry::EntranceSurface& surface, const Vec3& target_mm,
                                   const Vec3& to_source, double index) {
  Vec2 at = target_mm.head<2>();
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const geometry::EntranceSurface::SurfaceSample sample = surface.at(at);
    if (!is_defined(sample)) return std::nullopt;
    const Vec3 direction = refracted_inside(sample.slope, to_source, index);
    if (!(direction.z() < 0.0)) return std::nullopt;
    // The next point is the intersection of the tangent plane at `at` with the line through the target along
    // `direction`.
    const Vec2 per_height = lean(direction);
    const double rise = (sample.height_mm - target_mm.z() + sample.slope.dot(target_mm.head<2>() - at)) /
                        (1.0 - sample.slope.dot(per_height));
    const Vec2 next = target_mm.head<2>() + rise * per_height;
    const double moved_mm = (next - at).norm();
    at = next;
    if (moved_mm < kAccuracy_mm * (1.0 + at.norm())) return at;
  }
  return std::nullopt;
}

std::optional<Eigen::Matrix2d> entry_displacement(const geometry::EntranceSurface& surface, const TangentPlane& plane,
                                                  const Vec3& to_source, double index, double height_mm,
                                                  double step_mm) {
  const auto hit = [&](const Vec2& at) {
    const geometry::EntranceSurface::SurfaceSample sample = surface.at(at);
    if (!is_defined(sample)) return Vec2(NAN, NAN);
    return Vec2(at + (height_mm - sample.height_mm) * lean(refracted_inside(sample.slope, to_source, index)));
  };
  const Vec2 at = plane.point_mm.head<2>();
  Eigen::Matrix2d behind_surface;
  for (const Eigen::Index axis : {0, 1}) {
    const Vec2 by = step_mm * Vec2::Unit(axis);
    behind_surface.col(axis) = (hit(at + by) - hit(at - by)) / (2.0 * step_mm);
  }
  const Vec2& slope = plane.surface_slope;
  const Eigen::Matrix2d behind_plane =
      Eigen::Matrix2d::Identity() - lean(refracted_inside(slope, to_source, index)) * slope.transpose();
  if (!(behind_surface.determinant() > 0.0) || !(behind_plane.determinant() > 0.0)) return std::nullopt;
  // Maps a horizontal displacement to the displacement of the point of the tangent plane above it, in the part frame.
  // The next matrix contains the same displacement in the coordinates of the tangent plane.
  Eigen::Matrix<double, 3, 2> in_part;
  in_part << Eigen::Matrix2d::Identity(), slope.transpose();
  const Eigen::Matrix2d frame_from_plan = (plane.frame_from_part * in_part).topRows<2>();
  return Eigen::Matrix2d(frame_from_plan * behind_surface.inverse() * behind_plane * frame_from_plan.inverse());
}

double rise_above(const geometry::TouchingPlane& plane, const Vec3& to_source) {
  return to_source.z() - plane.slope.dot(to_source.head<2>());
}

std::optional<SurfacePoint> nearest_intersection(const geometry::EntranceSurface& surface, const Vec3& start_mm,
                                                 const Vec3& direction) {
  SurfacePoint found;
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    found.point_mm = start_mm + found.distance_mm * direction;
    const geometry::EntranceSurface::SurfaceSample sample = surface.at(found.point_mm.head<2>());
    if (!is_defined(sample)) return std::nullopt;
    found.slope = sample.slope;
    const double change =
        (found.point_mm.z() - sample.height_mm) / (direction.z() - sample.slope.dot(direction.head<2>()));
    if (!std::isfinite(change)) return std::nullopt;
    if (std::abs(change) < kAccuracy_mm) return found;
    found.distance_mm -= change;
  }
  return std::nullopt;
}

std::optional<SurfaceSag> fitted_sag(const geometry::EntranceSurface& surface, const TangentPlane& plane,
                                     double half_width_mm) {
  SurfaceSag sag;
  std::vector<SurfaceSag::Term>& terms = sag.terms;
  for (int i = 0; i <= kSagDegree; ++i)
    for (int j = 0; i + j <= kSagDegree; ++j)
      if (i + j >= 2) terms.push_back({i, j, 0.0});
  struct Point {
    Vec2 at;  ///< in units of the half width
    double height_mm;
  };
  std::vector<Point> points;
  for (int a = 0; a < kSagPoints; ++a)
    for (int b = 0; b < kSagPoints; ++b) {
      // Chebyshev points keep the error of the polynomial low up to the border of the square.
      const auto node = [](int k) { return std::cos(EIGEN_PI * (k + 0.5) / kSagPoints); };
      const Vec2 at(node(a), node(b));
      const Vec3 foot = plane.to_part({half_width_mm * at.x(), half_width_mm * at.y(), 0.0});
      const std::optional<SurfacePoint> hit = nearest_intersection(surface, foot, plane.normal);
      if (hit) points.push_back({at, hit->distance_mm});
    }
  if (points.size() < 2 * terms.size()) return std::nullopt;
  Eigen::MatrixXd powers(std::ssize(points), std::ssize(terms));
  Eigen::VectorXd heights(std::ssize(points));
  for (Eigen::Index row = 0; row < powers.rows(); ++row) {
    const Point& point = points[static_cast<std::size_t>(row)];
    heights[row] = point.height_mm;
    for (Eigen::Index column = 0; column < powers.cols(); ++column) {
      const SurfaceSag::Term& term = terms[static_cast<std::size_t>(column)];
      powers(row, column) = std::pow(point.at.x(), term.i) * std::pow(point.at.y(), term.j);
    }
  }
  const Eigen::VectorXd coefficients = powers.colPivHouseholderQr().solve(heights);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    SurfaceSag::Term& term = terms[k];
    term.coefficient = coefficients[static_cast<Eigen::Index>(k)] / std::pow(half_width_mm, term.i + term.j);
    sag.form.add(term.i, term.j, term.coefficient);
  }
  sag.error_mm = (powers * coefficients - heights).cwiseAbs().maxCoeff();
  return sag;
}

Eigen::Matrix2d SurfaceSag::curvature_per_mm() const {
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (const Term& term : terms) {
    if (term.i + term.j != 2) continue;
    if (term.i == 1) {
      second(0, 1) += term.coefficient;
      second(1, 0) += term.coefficient;
    } else {
      const Eigen::Index axis = term.i == 2 ? 0 : 1;
      second(axis, axis) += 2.0 * term.coefficient;
    }
  }
  return second;
}

surface_models::FacetForm squared_slope(const SurfaceSag& sag, const Vec2& per_height) {
  // The height of the surface is projected along the light onto a plane perpendicular to the light. For a surface with
  // the slope (a, b), the squared gradient of the projected height is
  // a^2 + b^2 + (a per_height.x + b per_height.y)^2.
  const double xx = 1.0 + per_height.x() * per_height.x();
  const double yy = 1.0 + per_height.y() * per_height.y();
  const double xy = per_height.x() * per_height.y();
  surface_models::FacetForm squared;
  const auto add = [&](int i, int j, double coefficient) {
    if (i >= 0 && j >= 0) squared.add(i, j, coefficient);
  };
  for (const SurfaceSag::Term& p : sag.terms)
    for (const SurfaceSag::Term& q : sag.terms) {
      if (p.i + p.j > kSquaredDegree || q.i + q.j > kSquaredDegree) continue;
      const double both = p.coefficient * q.coefficient;
      add(p.i + q.i - 2, p.j + q.j, xx * both * p.i * q.i);
      add(p.i + q.i, p.j + q.j - 2, yy * both * p.j * q.j);
      add(p.i + q.i - 1, p.j + q.j - 1, 2.0 * xy * both * p.i * q.j);
    }
  return squared;
}

}  // namespace retrace::raytrace

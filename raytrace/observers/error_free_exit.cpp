#include "raytrace/observers/error_free_exit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using Eigen::Matrix3d, geometry::Vec2;

// Maximum norm of M^T M - 1 at which product_of_reflections() M is accepted as an isometry. Rounding errors are
// smaller. The norm is larger if the path contains refractions at the back surface in addition to reflections.
constexpr double kIsometryTolerance = 1e-7;
// Maximum angle between the product of reflections and the nearest involution. An involution is a matrix that is its
// own inverse. Usual errors of angle cause much smaller angles. The same value is used as the minimum z component of
// the direction in which light leaves.
constexpr double kLargestError_rad = 0.1;
// Minimum absolute determinant of the linear part of ReturnedBeam::entry_from_exit. At smaller values, light leaves
// almost parallel to the face, and error_free_exit() returns nothing.
constexpr double kMinExitDeterminant = 1e-6;

/// Returns the unit direction of a ray in the body after refraction at the entrance face.
/// \param in_air x and y components of the unit direction in air
/// \param sign_of_z -1 for light that enters, 1 for light that leaves
Vec3 inside(const Vec2& in_air, double index, double sign_of_z) {
  const Vec2 across = in_air / index;
  return {across.x(), across.y(), sign_of_z * std::sqrt(std::max(0.0, 1.0 - across.squaredNorm()))};
}

/// Returns the product M of the reflections of a path as a 3 x 3 matrix. M maps the direction `entering` to `leaving`.
/// M also maps a displacement e of the entry point to the displacement `exit_from_entry` e of the exit point, except
/// for a multiple of `leaving`.
/// \param exit_from_entry linear map from displacements of the entry point to displacements of the exit point
/// \param entering unit direction inside the part in which light enters
/// \param leaving unit direction inside the part in which light leaves
Matrix3d product_of_reflections(const Eigen::Matrix2d& exit_from_entry, const Vec3& entering, const Vec3& leaving) {
  Matrix3d m;
  for (const Eigen::Index k : {0, 1}) {
    const Vec3 moved(exit_from_entry(0, k), exit_from_entry(1, k), 0.0);
    m.col(k) = moved + (entering[k] - moved.dot(leaving)) * leaving;
  }
  m.col(2) = (leaving - entering.x() * m.col(0) - entering.y() * m.col(1)) / entering.z();
  return m;
}

/// Orthogonal matrix that is its own inverse. Such a matrix is symmetric and has the eigenvalues 1 and -1.
struct Involution {
  Matrix3d matrix = Matrix3d::Identity();
  Eigen::Matrix<double, 3, Eigen::Dynamic> reversed;  ///< orthonormal eigenvectors with the eigenvalue -1
};

/// Returns the involution that is nearest to an orthogonal matrix. Returns nothing if it differs from the matrix by a
/// rotation of more than kLargestError_rad.
std::optional<Involution> nearest_involution(const Matrix3d& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(0.5 * (m + m.transpose()));
  Involution nearest;
  nearest.matrix.setZero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double value = axes.eigenvalues()[k];
    if (std::abs(value) < std::cos(kLargestError_rad)) return std::nullopt;
    const Vec3 axis = axes.eigenvectors().col(k);
    nearest.matrix += (value < 0.0 ? -1.0 : 1.0) * axis * axis.transpose();
    if (value > 0.0) continue;
    nearest.reversed.conservativeResize(3, nearest.reversed.cols() + 1);
    nearest.reversed.rightCols<1>() = axis;
  }
  return nearest;
}

/// Returns the intersection of the entrance face with the line through `point` in the direction `direction`. The
/// entrance face is the plane z = 0 of the coordinates used here.
Vec2 onto_face(const Vec3& point, const Vec3& direction) {
  return (point - point.z() / direction.z() * direction).head<2>();
}

}  // namespace

std::optional<PathIsometry> path_isometry(const ReturnedBeam& beam, const Vec3& to_source) {
  const Eigen::Affine2d& entry_from_exit = beam.entry_from_exit;
  if (std::abs(entry_from_exit.linear().determinant()) < kMinExitDeterminant) return std::nullopt;
  const Vec3 entering = inside(-to_source.head<2>(), beam.index, -1.0);
  const Vec3 leaving = inside(beam.direction.head<2>(), beam.index, 1.0);
  const Matrix3d m = product_of_reflections(entry_from_exit.linear().inverse(), entering, leaving);
  if (((m.transpose() * m) - Matrix3d::Identity()).norm() > kIsometryTolerance) return std::nullopt;
  // Let P be the point at the distance `length_mm` from the entry point along `entering`. Without reflections, the
  // light would reach P. The isometry x -> M x + t maps P to the exit point. The light whose exit point is the origin
  // determines t.
  const Vec2& entered = entry_from_exit.translation();
  const double length_mm = (beam.phase_mm + to_source.head<2>().dot(entered)) / beam.index;
  return PathIsometry{m, -length_mm * leaving - m.leftCols<2>() * entered};
}

std::optional<ErrorFreeExit> error_free_exit(const ReturnedBeam& beam, const Vec3& to_source, const Vec2& cell_mm) {
  const std::optional<PathIsometry> path = path_isometry(beam, to_source);
  if (!path) return std::nullopt;
  const Matrix3d& m = path->matrix;
  const Vec3& t = path->shift_mm;
  const Vec3 entering = inside(-to_source.head<2>(), beam.index, -1.0);
  const Vec3 leaving = inside(beam.direction.head<2>(), beam.index, 1.0);
  const std::optional<Involution> ideal = nearest_involution(m);
  if (!ideal) return std::nullopt;
  const Vec3 leaving_ideal = ideal->matrix * entering;
  if (ideal->reversed.cols() == 0 || leaving_ideal.z() < kLargestError_rad) return std::nullopt;

  // The apex is a fixed point of the isometry. Its coordinates along the reversed axes follow from M and t. Its
  // coordinates along the other axes are arbitrary, and those of the cell's position are used.
  const auto& axes = ideal->reversed;
  const Eigen::MatrixXd system = axes.transpose() * (Matrix3d::Identity() - m) * axes;
  const Vec3 reversed_part = axes * system.partialPivLu().solve(axes.transpose() * t);
  const Vec3 cell(cell_mm.x(), cell_mm.y(), 0.0);
  const Vec3 apex = reversed_part + cell - axes * (axes.transpose() * cell);

  const auto exit_of = [&](const Vec2& entry) {
    return onto_face(ideal->matrix.leftCols<2>() * entry + 2.0 * reversed_part, leaving_ideal);
  };
  ErrorFreeExit exit;
  Eigen::Affine2d from_entry;
  from_entry.translation() = exit_of(Vec2::Zero());
  for (const Eigen::Index k : {0, 1}) from_entry.linear().col(k) = exit_of(Vec2::Unit(k)) - from_entry.translation();
  from_entry.makeAffine();
  exit.from_exit = from_entry * beam.entry_from_exit;
  exit.phase_change_mm = -beam.index * apex.z() / leaving_ideal.z() * (1.0 - leaving.dot(leaving_ideal));
  return exit;
}

}  // namespace retrace::raytrace

#include "raytrace/observers/error_free_exit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace retrace::raytrace {
namespace {

using Eigen::Matrix3d, geometry::Vec2;

// Maximum norm of M^T M - 1 for a path that consists only of reflections, where M is product_of_reflections(). The norm
// exceeds 0 by rounding errors. It is larger than this limit if light is also refracted at the back surface.
constexpr double kIsometryTolerance = 1e-7;
// Maximum angle of the rotation from the product of reflections to the nearest involution, which is a matrix that is
// its own inverse. Errors of angle cause smaller angles. The constant is also the minimum z component of the direction
// in which light leaves.
constexpr double kLargestError_rad = 0.1;
// Minimum absolute determinant of the linear part of ReturnedBeam::entry_from_exit. Below this limit, light leaves
// almost parallel to the face, and no error-free exit is computed.
constexpr double kLeastDeterminant = 1e-6;

/// Returns the unit direction that a ray has in the body after refraction at the entrance face.
/// \param in_air x and y components of the unit direction of the ray in air
Vec3 inside(const Vec2& in_air, double index, double sign_of_z) {
  const Vec2 across = in_air / index;
  return {across.x(), across.y(), sign_of_z * std::sqrt(std::max(0.0, 1.0 - across.squaredNorm()))};
}

/// Returns the product M of the reflections of a path as a matrix. M maps `entering` to `leaving`. For each vector e in
/// the entrance face, M e and `exit_from_entry` e differ only by a multiple of `leaving`.
///
/// \param exit_from_entry linear map from displacements of the entry point to displacements of the exit point
/// \param entering, leaving unit directions inside the part in which light enters and leaves
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

/// Returns the involution nearest to an orthogonal matrix. Returns nothing if the angle between the two matrices
/// exceeds kLargestError_rad.
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

/// Returns the intersection of the entrance face with the line through `point` along `direction`. In the coordinates
/// used here, the face is the plane z = 0.
Vec2 onto_face(const Vec3& point, const Vec3& direction) {
  return (point - point.z() / direction.z() * direction).head<2>();
}

}  // namespace

std::optional<ErrorFreeExit> error_free_exit(const ReturnedBeam& beam, const Vec3& to_source, const Vec2& cell_mm) {
  const Eigen::Affine2d& entry_from_exit = beam.entry_from_exit;
  if (std::abs(entry_from_exit.linear().determinant()) < kLeastDeterminant) return std::nullopt;
  const Vec3 entering = inside(-to_source.head<2>(), beam.index, -1.0);
  const Vec3 leaving = inside(beam.direction.head<2>(), beam.index, 1.0);
  const Matrix3d m = product_of_reflections(entry_from_exit.linear().inverse(), entering, leaving);
  if (((m.transpose() * m) - Matrix3d::Identity()).norm() > kIsometryTolerance) return std::nullopt;
  const std::optional<Involution> ideal = nearest_involution(m);
  if (!ideal) return std::nullopt;
  const Vec3 leaving_ideal = ideal->matrix * entering;
  if (ideal->reversed.cols() == 0 || leaving_ideal.z() < kLargestError_rad) return std::nullopt;

  // Without reflections, light would reach the point P at distance `length_mm` straight beyond the entry point. The
  // isometry x -> M x + t maps P to the exit point. The exit point considered here is the origin.
  const Vec2& entered = entry_from_exit.translation();
  const double length_mm = (beam.phase_mm + to_source.head<2>().dot(entered)) / beam.index;
  const Vec3 t = -length_mm * leaving - m.leftCols<2>() * entered;
  // The apex is the fixed point of the isometry. Its coordinates along the reversed axes follow from M and t. Its other
  // coordinates are undetermined, and the coordinates of the cell are used instead.
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
  exit.from_exit = from_entry * entry_from_exit;
  exit.phase_change_mm = -beam.index * apex.z() / leaving_ideal.z() * (1.0 - leaving.dot(leaving_ideal));
  return exit;
}

}  // namespace retrace::raytrace

#include "studies/calibration/linear_model.h"

#include <array>

#include "core/length_units.h"
#include "fabrication/machine/setup.h"

namespace retrace::studies {
namespace {

using Eigen::Index;
using fabrication::Machine, fabrication::SetupQuantity;

/// Step of the difference quotients, in um and arcsec. Measurements are smooth over millions of such steps.
constexpr double kStep = 1.0;
/// Indices of the unknowns of a part's pose: the kTurns rotations have the indices from 0, and the shifts along X, Y
/// and Z have the indices from kTurns. The pose has kPose unknowns in total. Two further unknowns, the rotations of the
/// face about X and Y, have the indices kPose and kPose + 1.
constexpr Index kTurns = 3;
constexpr Index kPose = 6;

/// Adds an amount to an unknown of a pose.
/// \param unknown index of an unknown of the part's pose, or kPose or kPose + 1 for a rotation of the face
void move_one(PartPose& pose, Index unknown, double amount) {
  if (unknown >= kPose)
    pose.face_rotation_arcsec[unknown - kPose] += amount;
  else
    (unknown < kTurns ? pose.rotation_arcsec[unknown] : pose.shift_um[unknown - kTurns]) += amount;
}

/// Returns the height and tilts of the face that a map would show if the part had this pose.
geometry::Vec3 predicted_face(const FaceFigures& face, const PartPose& pose) {
  const geometry::Vec3 normal = pose.face_rotation().col(2);
  const geometry::Vec3 shift = pose.shift_um / kUmPerMm;
  const double height_mm = shift.z() - (normal.head<2>().dot(face.centroid_mm - shift.head<2>())) / normal.z();
  return {kNmPerMm * height_mm, -kArcsecPerRad * normal.x() / normal.z(), -kArcsecPerRad * normal.y() / normal.z()};
}

}  // namespace

Eigen::VectorXd residual_of(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                            const Machine& machine, const std::vector<std::optional<FaceFigures>>& map_faces,
                            const std::vector<PartPose>& poses) {
  std::vector<double> residual;
  for (const Measurement& m : measurements)
    residual.push_back((m.value - parts[m.part].predicted(m, machine, poses[m.part])) / m.uncertainty);
  for (std::size_t k = 0; k < map_faces.size(); ++k) {
    if (!map_faces[k]) continue;
    const geometry::Vec3 off = map_faces[k]->value - predicted_face(*map_faces[k], poses[k]);
    for (Index row = 0; row < 3; ++row) residual.push_back(off[row] / map_faces[k]->uncertainty[row]);
  }
  return Eigen::Map<const Eigen::VectorXd>(residual.data(), static_cast<Index>(residual.size()));
}

LinearModel linear_model(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                         const Machine& machine, const std::vector<std::optional<FaceFigures>>& map_faces,
                         const std::vector<PartPose>& given) {
  const std::vector<PartPose> poses = given.empty() ? std::vector<PartPose>(parts.size()) : given;
  LinearModel model;
  model.residual = residual_of(parts, measurements, machine, map_faces, poses);
  const auto quantities = fabrication::setup_quantities(machine.tilt);
  std::vector<std::array<Machine, 2>> off;
  for (const SetupQuantity& quantity : quantities)
    off.push_back({with_error(machine, quantity, -kStep), with_error(machine, quantity, kStep)});
  const auto of_face = kPose * static_cast<Index>(parts.size());
  model.setup_jacobian.setZero(model.residual.size(), static_cast<Index>(quantities.size()));
  model.pose_jacobian.setZero(model.residual.size(), of_face + 2);
  const auto poses_about = [](const PartPose& pose, Index unknown) {
    std::array<PartPose, 2> both{pose, pose};
    move_one(both[0], unknown, -kStep);
    move_one(both[1], unknown, kStep);
    return both;
  };
  Index row = 0;
  for (const Measurement& m : measurements) {
    const CutPart& part = parts[m.part];
    const PartPose& pose = poses[m.part];
    const double span = 2.0 * kStep * m.uncertainty;
    for (std::size_t k = 0; k < off.size(); ++k)
      model.setup_jacobian(row, static_cast<Index>(k)) =
          (part.predicted(m, off[k][1], pose) - part.predicted(m, off[k][0], pose)) / span;
    const auto of_pose = [&](Index unknown) {
      const auto [low, high] = poses_about(pose, unknown);
      return (part.predicted(m, machine, high) - part.predicted(m, machine, low)) / span;
    };
    const Index first = kPose * static_cast<Index>(m.part);
    for (Index k = 0; k < (map_faces.empty() ? kPose - 1 : kPose); ++k)
      model.pose_jacobian(row, first + k) = of_pose(k);
    if (!map_faces.empty())
      for (Index k = 0; k < 2; ++k) model.pose_jacobian(row, of_face + k) = of_pose(kPose + k);
    ++row;
  }
  for (std::size_t k = 0; k < map_faces.size(); ++k) {
    if (!map_faces[k]) continue;
    const FaceFigures& face = *map_faces[k];
    for (Index unknown = 0; unknown < kPose; ++unknown) {
      const auto [low, high] = poses_about(poses[k], unknown);
      model.pose_jacobian.block<3, 1>(row, kPose * static_cast<Index>(k) + unknown) =
          (predicted_face(face, high) - predicted_face(face, low)).cwiseQuotient(2.0 * kStep * face.uncertainty);
    }
    row += 3;
  }
  return model;
}

LinearModel with_pose_priors(LinearModel model, const std::vector<PartPose>& poses) {
  // Standard deviations of the priors, in um and arcsec.
  constexpr double shift_by_eye = 100.0;
  constexpr double turn_by_eye = 3600.0;
  const Index rows = model.residual.size();
  const Index unknowns = model.pose_jacobian.cols();
  Eigen::VectorXd value(unknowns);
  Eigen::VectorXd deviation(unknowns);
  for (std::size_t part = 0; part < poses.size(); ++part) {
    const Index first = kPose * static_cast<Index>(part);
    value.segment<kPose>(first) << poses[part].rotation_arcsec, poses[part].shift_um;
    deviation.segment<kPose>(first) << geometry::Vec3::Constant(turn_by_eye), geometry::Vec3::Constant(shift_by_eye);
  }
  value.tail<2>() = poses.front().face_rotation_arcsec;
  deviation.tail<2>().setConstant(turn_by_eye);
  model.setup_jacobian.conservativeResizeLike(Eigen::MatrixXd::Zero(rows + unknowns, model.setup_jacobian.cols()));
  model.pose_jacobian.conservativeResizeLike(Eigen::MatrixXd::Zero(rows + unknowns, unknowns));
  model.residual.conservativeResize(rows + unknowns);
  model.pose_jacobian.bottomRows(unknowns).diagonal() = deviation.cwiseInverse();
  model.residual.tail(unknowns) = -value.cwiseQuotient(deviation);
  return model;
}

void move(std::vector<PartPose>& poses, const Eigen::VectorXd& by) {
  const auto of_face = kPose * static_cast<Index>(poses.size());
  for (std::size_t part = 0; part < poses.size(); ++part) {
    for (Index k = 0; k < kPose; ++k) move_one(poses[part], k, by[kPose * static_cast<Index>(part) + k]);
    for (Index k = 0; k < 2; ++k) move_one(poses[part], kPose + k, by[of_face + k]);
  }
}

}  // namespace retrace::studies

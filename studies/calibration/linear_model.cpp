#include "studies/calibration/linear_model.h"

#include <array>
#include <numbers>

#include "fabrication/machine/setup.h"

namespace retrace::studies {
namespace {

using Eigen::Index;
using fabrication::Machine, fabrication::SetupQuantity;

/// Steps of um and arcsec over which differences are taken: measurements are smooth over millions of them.
constexpr double kStep = 1.0;
/// Of a part's pose: three turns, shifts along X, Y and Z; then the turns of the face about X and Y.
constexpr Index kTurns = 3;
constexpr Index kPose = 6;
constexpr double kNmPerUm = 1e3;
constexpr double kNmPerMmArcsec = 1e6 * std::numbers::pi / (180.0 * 3600.0);

PartPose moved(Index unknown, double amount) {
  PartPose pose;
  (unknown < kTurns ? pose.turn_arcsec[unknown] : pose.shift_um[unknown - kTurns]) = amount;
  return pose;
}

/// What a map that lies askew shows of the face: z = shift + turn_x y - turn_y x.
void add_face(LinearModel& model, Index row, Index pose, const FaceFigures& face) {
  Eigen::Matrix<double, 3, kPose> rows = Eigen::Matrix<double, 3, kPose>::Zero();
  rows.row(0) << kNmPerMmArcsec * face.middle_mm.y(), -kNmPerMmArcsec * face.middle_mm.x(), 0.0, 0.0, 0.0, kNmPerUm;
  rows(1, 1) = -1.0;
  rows(2, 0) = 1.0;
  const Eigen::Vector3d weight = face.uncertainty.cwiseInverse();
  model.of_poses.block<3, kPose>(row, pose) = weight.asDiagonal() * rows;
  model.residual.segment<3>(row) = face.value.cwiseProduct(weight);
}

}  // namespace

LinearModel linear_model(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                         const Machine& machine, const std::vector<std::optional<FaceFigures>>& map_faces) {
  const auto quantities = fabrication::setup_quantities(machine.tilt);
  std::vector<std::array<Machine, 2>> off;
  for (const SetupQuantity& quantity : quantities)
    off.push_back({with_error(machine, quantity, -kStep), with_error(machine, quantity, kStep)});
  const auto rows = static_cast<Index>(measurements.size());
  Index faces = 0;
  for (const auto& face : map_faces) faces += face ? 1 : 0;
  const auto of_face = kPose * static_cast<Index>(parts.size());
  LinearModel model;
  model.of_setup.setZero(rows + 3 * faces, static_cast<Index>(quantities.size()));
  model.of_poses.setZero(rows + 3 * faces, of_face + 2);
  model.residual.resize(rows + 3 * faces);
  for (Index row = 0; row < rows; ++row) {
    const Measurement& m = measurements[static_cast<std::size_t>(row)];
    const CutPart& part = parts[m.part];
    const auto difference = [&](const Machine& low, const Machine& high, const PartPose& before,
                                const PartPose& after) {
      return (part.predicted(m, high, after) - part.predicted(m, low, before)) / (2.0 * kStep * m.uncertainty);
    };
    for (std::size_t k = 0; k < off.size(); ++k)
      model.of_setup(row, static_cast<Index>(k)) = difference(off[k][0], off[k][1], {}, {});
    const Index pose = kPose * static_cast<Index>(m.part);
    for (Index k = 0; k < (map_faces.empty() ? kPose - 1 : kPose); ++k)
      model.of_poses(row, pose + k) = difference(machine, machine, moved(k, -kStep), moved(k, kStep));
    if (!map_faces.empty()) model.of_poses.block<1, 2>(row, of_face) = model.of_poses.block<1, 2>(row, pose);
    model.residual[row] = (m.value - part.predicted(m, machine, {})) / m.uncertainty;
  }
  Index row = rows;
  for (std::size_t k = 0; k < map_faces.size(); ++k) {
    if (!map_faces[k]) continue;
    add_face(model, row, kPose * static_cast<Index>(k), *map_faces[k]);
    row += 3;
  }
  return model;
}

}  // namespace retrace::studies

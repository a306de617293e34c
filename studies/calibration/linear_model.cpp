#include "studies/calibration/linear_model.h"

#include <array>

#include "fabrication/machine/setup.h"

namespace retrace::studies {
namespace {

using Eigen::Index;
using fabrication::Machine, fabrication::SetupQuantity;

/// Steps of um and arcsec over which differences are taken: measurements are smooth over millions of them.
constexpr double kStep = 1.0;
constexpr Index kPoseUnknowns = 5;

PartPose moved(Index unknown, double amount) {
  PartPose pose;
  (unknown < 2 ? pose.shift_um[unknown] : pose.turn_arcsec[unknown - 2]) = amount;
  return pose;
}

}  // namespace

LinearModel linear_model(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                         const Machine& machine) {
  const auto quantities = fabrication::setup_quantities(machine.tilt);
  std::vector<std::array<Machine, 2>> off;
  for (const SetupQuantity& quantity : quantities)
    off.push_back({with_error(machine, quantity, -kStep), with_error(machine, quantity, kStep)});
  const auto rows = static_cast<Index>(measurements.size());
  LinearModel model;
  model.of_setup.resize(rows, static_cast<Index>(quantities.size()));
  model.of_poses.setZero(rows, kPoseUnknowns * static_cast<Index>(parts.size()));
  model.residual.resize(rows);
  for (Index row = 0; row < rows; ++row) {
    const Measurement& m = measurements[static_cast<std::size_t>(row)];
    const CutPart& part = parts[m.part];
    const auto difference = [&](const Machine& low, const Machine& high, const PartPose& before,
                                const PartPose& after) {
      return (part.predicted(m, high, after) - part.predicted(m, low, before)) / (2.0 * kStep * m.uncertainty);
    };
    for (std::size_t k = 0; k < off.size(); ++k)
      model.of_setup(row, static_cast<Index>(k)) = difference(off[k][0], off[k][1], {}, {});
    for (Index k = 0; k < kPoseUnknowns; ++k)
      model.of_poses(row, kPoseUnknowns * static_cast<Index>(m.part) + k) =
          difference(machine, machine, moved(k, -kStep), moved(k, kStep));
    model.residual[row] = (m.value - part.predicted(m, machine, {})) / m.uncertainty;
  }
  return model;
}

}  // namespace retrace::studies

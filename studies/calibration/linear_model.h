#pragma once

// Linear model of measurements: their derivatives with respect to the set-up of the machine and to the poses of the
// parts during the measurement.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fabrication/machine/machine.h"
#include "studies/calibration/measured_facets.h"

namespace retrace::studies {

/// Linear model of the measurements at a given machine. Each row is divided by the standard uncertainty of its
/// measurement.
struct LinearModel {
  Eigen::MatrixXd setup_jacobian;  ///< derivatives with respect to the quantities of setup_quantities()
  /// Derivatives with respect to the poses of the parts. Each part has six columns: three rotations, then the shifts
  /// along X, Y and Z. The last two columns are the rotations of the blank's face in the machine (see
  /// PartPose::face_rotation_arcsec), which are common to all maps of a part.
  ///
  /// For a table of measurements, the column of Z and the last two columns are 0, because measured heights are relative
  /// to the face on which the tool was touched off. For height maps, the measured height and tilts of the blank's face
  /// determine these unknowns.
  Eigen::MatrixXd pose_jacobian;
  Eigen::VectorXd residual;  ///< measured values minus the values that the machine would produce
};

/// Returns the linear model.
/// \param parts measured parts, in the order of Measurement::part
/// \param map_faces value of MeasuredParts::map_faces; each face adds three rows after the rows of all measurements
/// \param poses pose of each part at which the derivatives are taken; if it is empty, the poses in the programs are
///        used
LinearModel linear_model(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                         const fabrication::Machine& machine,
                         const std::vector<std::optional<FaceFigures>>& map_faces = {},
                         const std::vector<PartPose>& poses = {});

/// Returns only LinearModel::residual.
Eigen::VectorXd residual_of(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                            const fabrication::Machine& machine,
                            const std::vector<std::optional<FaceFigures>>& map_faces,
                            const std::vector<PartPose>& poses);

/// Returns the model with prior knowledge about the poses as additional rows at the end. The priors have standard
/// deviations of 100 um and one degree about the poses in the programs. Without them, a shift that moves facets only
/// because they are slightly tilted could become arbitrarily large and hide an observable combination.
LinearModel with_pose_priors(LinearModel model, const std::vector<PartPose>& poses);

/// Adds changes of the unknowns of LinearModel::pose_jacobian to the poses.
/// \pre there is one pose for each part
void move(std::vector<PartPose>& poses, const Eigen::VectorXd& by);

}  // namespace retrace::studies

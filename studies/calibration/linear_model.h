#pragma once

// How measurements change with the set-up of the machine that cut the parts, and with how these lay when they were
// measured.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fabrication/machine/machine.h"
#include "studies/calibration/measured_facets.h"

namespace retrace::studies {

/// Measurements about a machine, each divided by its standard uncertainty.
struct LinearModel {
  Eigen::MatrixXd of_setup;  ///< by setup_quantities()
  /// By the poses of the parts: shifts along X and Y and three turns of each. Heights count from the face that the tool
  /// was touched off on, which therefore lies where programs have it. Maps lie at any height as well, which what they
  /// show of the face tells; how that face lay in the machine, two turns, is common to all maps of a part.
  Eigen::MatrixXd of_poses;
  Eigen::VectorXd residual;  ///< what was measured, less what the machine would leave
};

/// \param parts as Measurement::part counts them
/// \param map_faces as MeasuredParts::map_faces; three rows more for each face, behind all measurements
/// \param poses about which the model is, of each part; none: all as programs have them
LinearModel linear_model(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                         const fabrication::Machine& machine,
                         const std::vector<std::optional<FaceFigures>>& map_faces = {},
                         const std::vector<PartPose>& poses = {});

/// LinearModel::residual alone.
Eigen::VectorXd residual_of(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                            const fabrication::Machine& machine,
                            const std::vector<std::optional<FaceFigures>>& map_faces,
                            const std::vector<PartPose>& poses);

/// The same with what is known of poses without measurements, as rows behind all others: parts lie where programs have
/// them to 100 um and a degree (standard). Without it a shift that only moves facets because they are tilted a little
/// could be of any size, and take the place of what is told.
LinearModel with_poses_by_eye(LinearModel model, const std::vector<PartPose>& poses);

/// Poses moved by the unknowns of LinearModel::of_poses. \pre poses are as many as parts
void move(std::vector<PartPose>& poses, const Eigen::VectorXd& by);

}  // namespace retrace::studies

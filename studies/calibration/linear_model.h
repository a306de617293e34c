#pragma once

// How measurements change with the set-up of the machine that cut the parts, and with how these lay when they were
// measured.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fabrication/machine/machine.h"
#include "studies/calibration/measured_facets.h"

namespace retrace::studies {

/// Measurements about a machine, each divided by its standard uncertainty.
struct LinearModel {
  Eigen::MatrixXd of_setup;  ///< by setup_quantities()
  /// By the poses of the parts: two shifts and three turns of each. Heights count from the face that the tool was
  /// touched off on, which therefore lies where programs have it.
  Eigen::MatrixXd of_poses;
  Eigen::VectorXd residual;  ///< what was measured, less what the machine would leave
};

/// \param parts as Measurement::part counts them
LinearModel linear_model(const std::vector<CutPart>& parts, std::span<const Measurement> measurements,
                         const fabrication::Machine& machine);

}  // namespace retrace::studies

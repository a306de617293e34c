#pragma once

// Data for the verification of a job's programs: the designed elements and the unavoidable errors of the machine.

#include <vector>

#include "fabrication/chisel/check/cavity.h"
#include "fabrication/chisel/check/prediction.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Job, machine, designed elements and predicted errors, which the checks of programs use.
struct VerificationModel {
  const Job* job = nullptr;
  const Machine* machine = nullptr;
  std::vector<Cavity> cavities;
  std::vector<Prediction> predictions;  ///< one for each combination of `rotated` and `orientation` of an element
  std::vector<std::size_t> groups;      ///< for each element: index in `predictions`
  std::vector<CutElement> elements;
  double tolerance_mm = 1e-5;

  const DesignElement& design(std::size_t element) const { return common(cavities[element]); }
  const Prediction& prediction(std::size_t element) const { return predictions[groups[element]]; }
};

/// Builds the data for the verification of a job's programs.
/// \param tolerance_nm tolerance for facet planes, in nm
/// \pre job and machine outlive the result; tolerance_nm > 0
/// \throw InputError if the machine cannot plunge a facet
VerificationModel verification_model_of(const Job& job, const Machine& machine, double tolerance_nm = 10.0);

/// Returns the cutting wedge of the job's tool.
ToolWedge wedge_of(const Job& job, const Machine& machine);

}  // namespace retrace::fabrication

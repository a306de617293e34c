#pragma once

// What must be known to judge programs of a job: its elements as designed, and what the machine makes unavoidable.

#include <vector>

#include "fabrication/chisel/check/groove.h"
#include "fabrication/chisel/check/prediction.h"
#include "fabrication/chisel/check/simulation/swept_volume.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// What must be known to judge a program.
struct Workpiece3d {
  const Job* job = nullptr;
  const Machine* machine = nullptr;
  std::vector<Groove> grooves;
  std::vector<Prediction> predictions;  ///< one for each combination of element shape and orientation (Groove::group)
  std::vector<CutElement> elements;
  double tolerance_mm = 1e-5;

  const Prediction& prediction(std::size_t element) const { return predictions[grooves[element].group]; }
};

/// Job and machine must outlive it. \param tolerance_nm of facet planes; > 0
/// \throw InputError if the machine cannot plunge a facet
Workpiece3d workpiece_of(const Job& job, const Machine& machine, double tolerance_nm = 10.0);

/// The cutting wedge of a job's tool.
ToolWedge wedge_of(const Job& job, const Machine& machine);

}  // namespace retrace::fabrication

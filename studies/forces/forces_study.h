#pragma once

// The study behind `retrace forces`: cutting forces over one cycle of a job.

#include <string>
#include <vector>

#include "core/warning.h"
#include "fabrication/forces/forces.h"
#include "fabrication/job/job.h"

namespace retrace::studies {

/// Which cut's forces are requested.
struct ForcesRequest {
  std::string job;                         ///< file
  std::string configuration = "isolated";  ///< a word of fabrication::kConfigurationWords
  int facet = 1;                           ///< of a bidirectional job: 1 or 2
  double plunge_mm = 0.0;                  ///< length of the plunge; 0: that of the last cut
};

struct ForcesResult {
  ForcesRequest request;
  fabrication::CutConditions cut;
  fabrication::ForceEvents events;
  std::vector<fabrication::ForceSample> profile;
  Warnings warnings;
};

/// Forces over one cycle of a job's roughing (of a bidirectional job: of a layer), by the shipped measurements.
/// \throw InputError for a job or a request that makes no sense
ForcesResult cutting_forces(const ForcesRequest& request);

}  // namespace retrace::studies

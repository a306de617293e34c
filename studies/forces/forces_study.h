#pragma once

// Cutting forces over one cycle of a job. `retrace forces` runs this study.

#include <string>
#include <vector>

#include "core/warning.h"
#include "fabrication/forces/forces.h"

namespace retrace::studies {

/// Request for the forces of a cut.
struct ForcesRequest {
  std::string job;                         ///< name of the job file
  std::string configuration = "isolated";  ///< configuration, a word of fabrication::kConfigurationWords
  int facet = 1;                           ///< number of the facet in a bidirectional job: 1 or 2
  double plunge_mm = 0.0;                  ///< length of the plunge; if 0, the length of the last cut
};

struct ForcesResult {
  ForcesRequest request;
  fabrication::CutConditions cut;
  fabrication::ForceEvents events;
  std::vector<fabrication::ForceSample> profile;
  Warnings warnings;
};

/// Returns the forces over one cycle of a job's roughing, or over one layer of a bidirectional job. They are computed
/// from measured forces, which are shipped with the program.
/// \throw InputError for an invalid job or request
ForcesResult cutting_forces(const ForcesRequest& request);

}  // namespace retrace::studies

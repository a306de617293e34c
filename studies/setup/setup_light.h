#pragma once

// Computes how errors of the set-up change the retroreflected light of a moulded part.

#include <filesystem>
#include <string>
#include <vector>

#include "core/warning.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::studies {

/// Retroreflected light of one part: RRE (retroreflective efficiency) in each acceptance cone of the design for light
/// along the part's normal, and R_A in a geometry of the standards.
struct PartLight {
  std::vector<double> rre;
  double r_a = 0.0;  ///< R_A in cd/(lx m^2), for smooth facets
};

/// Light of a part from a machine without errors, and its changes per um or arcsec of each set-up quantity, in the
/// order of setup_quantities(). The computation is exact, with diffraction, for a few smooth and clean elements from
/// the center of the array.
struct SetupLight {
  static constexpr double kObservationDeg = 0.33;
  static constexpr double kEntranceDeg = 5.0;      ///< entrance angle to the side (H), across the roof edges of prisms
  static constexpr double kApertureArcmin = 10.0;  ///< aperture of source and receiver

  /// Minimum relative change of R_A that is significant. Smaller changes may be due to interference, because all
  /// elements of the computed array are equal.
  static constexpr double kMinRaChange = 5e-4;
  /// Minimum change of RRE that is significant. Smaller changes may be due to truncated beams.
  static constexpr double kMinRreChange = 1e-5;

  std::vector<double> cones_deg;
  PartLight nominal;
  std::vector<PartLight> changes;
  std::size_t elements = 0;
};

/// Returns the reason why the light of a job is not computed, or an empty text if it is computed.
std::string why_no_setup_light(const fabrication::Job& job);

/// Computes the light that a part from a machine without errors retroreflects. Also computes how this light changes if
/// one set-up quantity of the machine has an error.
/// \param job_file job file, whose folder contains the design
/// \param warnings receives a warning if the design does not exist
/// \pre why_no_setup_light() is empty
SetupLight setup_light(const fabrication::Job& job, const std::filesystem::path& job_file,
                       const fabrication::Machine& machine, Warnings& warnings);

}  // namespace retrace::studies

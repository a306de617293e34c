#pragma once

// What a unit of every quantity of the set-up does to the light that a moulded part sends back.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/warning.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"

namespace retrace::studies {

/// Of one part: RRE in each of the design's cones, light along the part's normal; R_A where standards measure it.
struct PartLight {
  std::vector<double> rre;
  double r_a = 0.0;  ///< cd/(lx m^2), of smooth facets
};

/// Of the machine as programs take it, and the changes with a um or an arcsec of each quantity, in the order of
/// setup_quantities(). Exact, with diffraction, of a part of few elements from the middle of the array, smooth and
/// clean.
struct SetupLight {
  static constexpr double kObservationDeg = 0.33;
  static constexpr double kEntranceDeg = 5.0;      ///< to the side, H: across the roof edges of prisms
  static constexpr double kApertureArcmin = 10.0;  ///< of source and receiver

  /// Relative changes of R_A below this are not told from how beams of a perfect array interfere.
  static constexpr double kLeastChangeOfRa = 5e-4;
  static constexpr double kLeastChangeOfRre = 1e-5;  ///< likewise, what is followed no further

  std::vector<double> cones_deg;
  PartLight nominal;
  std::vector<PartLight> changes;
  std::size_t elements = 0;
};

/// What is left out, and why, of a job whose light is not told; empty: it is.
std::string why_no_setup_light(const fabrication::Job& job);

/// \param job_file beside which its design lies \param warnings is told where that is missed
/// \pre why_no_setup_light() is empty
SetupLight setup_light(const fabrication::Job& job, const std::filesystem::path& job_file,
                       const fabrication::Machine& machine, Warnings& warnings);

}  // namespace retrace::studies

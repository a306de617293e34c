#pragma once

// Optical effect of a contaminated, coated or rough entrance face at normal incidence, in closed form
// (docs/theory/entrance.md).

#include <optional>

#include "design/optical_model.h"

namespace retrace::studies {

/// Optical properties for light from the air at normal incidence, averaged over the wavelengths of the light.
struct EntranceStateReport {
  double clean_fraction = 1.0;          ///< fraction of the area without drops, dust or scratches
  double reflectance = 0.0;             ///< reflectance of the clean face with its layers and film
  double transmittance = 0.0;           ///< transmittance of the clean face with its layers and film
  double absorptance = 0.0;             ///< absorptance of the clean face with its layers and film
  double specular_transmittance = 0.0;  ///< fraction of all light that is transmitted without being scattered
  double haze_fraction = 0.0;           ///< fraction of the light that haze deflects in one passage, by any angle
  double dust_cd_per_lx_m2 = 0.0;       ///< R_A of dust and the face under it, along the normal
};

/// Returns the optical properties of an entrance face, or nothing for a clean face.
std::optional<EntranceStateReport> report_entrance_state(const design::Design& design,
                                                         const design::OpticalModel& model);

}  // namespace retrace::studies

#pragma once

// What a soiled, layered or rough entrance face does to light along its normal: closed forms (docs/theory/entrance.md).

#include <optional>

#include "studies/design/optical_model.h"

namespace retrace::studies {

/// At normal incidence from the air, as means over the light.
struct EntranceStateReport {
  double clean_share = 1.0;             ///< of the area: under no drop, dust or scratch
  double reflectance = 0.0;             ///< of the clean face with its layers and film
  double transmittance = 0.0;           ///< the same
  double absorptance = 0.0;             ///< the same
  double specular_transmittance = 0.0;  ///< of the light on the whole face: what goes on as if the face were plane
  double haze_share = 0.0;              ///< of the light of one passage that haze throws off, however little
  double dust_cd_per_lx_m2 = 0.0;       ///< R_A along the normal of dust and the face under it
};

/// Nothing for a clean face.
std::optional<EntranceStateReport> report_entrance_state(const Design& design, const OpticalModel& model);

}  // namespace retrace::studies

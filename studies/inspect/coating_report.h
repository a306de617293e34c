#pragma once

// What the layers on the faces of a part do to light at normal incidence.

#include <optional>
#include <vector>

#include "studies/design/design.h"
#include "studies/design/optical_model.h"

namespace retrace::studies {

/// The layers of one face, and the shares of unpolarised power at normal incidence, as means over the light: of facets
/// for light inside the body (of balls for what their mirror meets), of the entrance face for light from the air.
struct CoatingReport {
  std::vector<CoatingLayer> layers;
  materials::LayerStack stack;  ///< the same at the wavelength of those to trace which lies nearest to the light's
  double reflectance = 0.0;
  double transmittance = 0.0;
  double absorptance = 0.0;
};

/// Of the layers that `[coating]` gives; nothing of a face without, or of facets that are plainly aluminised.
struct CoatingReports {
  std::optional<CoatingReport> facets;
  std::optional<CoatingReport> entrance;
};

CoatingReports report_coating(const Design& design, const OpticalModel& model);

}  // namespace retrace::studies

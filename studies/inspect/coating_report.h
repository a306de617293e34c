#pragma once

// Optical effect of the coatings on the faces of a part at normal incidence.

#include <optional>
#include <vector>

#include "design/design.h"
#include "design/optical_model.h"

namespace retrace::studies {

/// Coating of one face, with fractions of unpolarised power at normal incidence, averaged over the light. The light
/// hits facets from inside the body and the entrance face from the air. The facets of balls are their mirrors.
struct CoatingReport {
  std::vector<design::CoatingLayer> layers;
  materials::LayerStack stack;  ///< layers at the traced wavelength that is nearest to OpticalModel::wavelength_nm
  double reflectance = 0.0;
  double transmittance = 0.0;
  double absorptance = 0.0;
};

/// Coatings of the table [coating]. Empty for faces without a coating, and for facets that are only aluminised.
struct CoatingReports {
  std::optional<CoatingReport> facets;
  std::optional<CoatingReport> entrance;
};

CoatingReports report_coating(const design::Design& design, const design::OpticalModel& model);

}  // namespace retrace::studies

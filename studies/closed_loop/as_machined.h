#pragma once

// Converts the result of verified NC programs to a design that can be traced: the machined part with its facet tilts,
// edges and texture.

#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "design/design.h"
#include "geometry/elements/facet_planes.h"
#include "studies/closed_loop/part_planes.h"
#include "studies/closed_loop/verification.h"

namespace retrace::studies {

/// Surface texture of facets, as keys of a design's [surface]. The published Sa for each kind of motion is divided
/// between roughness and feed marks (docs/theory/verification.md).
struct PredictedTexture {
  double sa_nm = 0.0;
  double roughness_sq_nm = 0.0, correlation_length_um = 0.0;
  double waviness_sq_nm = 0.0, waviness_length_um = 0.0;  ///< waviness due to feed marks
};
PredictedTexture predicted_texture(const fabrication::Job& job);

/// Part as machined, which is moulded in the workpiece or is the workpiece itself. If its elements are nearly equal,
/// the part is described by the mean tilts of their facets. Otherwise, every facet of a moulded part has an individual
/// plane.
struct AsMachined {
  /// Mean tilts of the facets, positive if they open the element. Prism: facets towards -x and +x of the part. Cube
  /// corner: in the order of its facets.
  std::vector<double> facet_tilt_arcmin;
  std::optional<geometry::FacetPlanes> planes;  ///< individual planes of all facets; if empty, mean tilts are used
  /// Zones as machined, which replace `facet_tilt_arcmin` and `planes`. Empty if the job has no zones.
  std::optional<design::ZonedPart> zones;
  double root_radius_um = 0.0, root_chamfer_um = 0.0;
  PredictedTexture texture;
  std::vector<geometry::Scratch> scratches;  ///< scratches caused by chips in the tool's edge
  MachinedBody body;
  design::OutlineKeys outline;  ///< result of outline_of_job(); empty for a rectangle
  Warnings warnings;
};

/// Computes the part as machined.
/// \throw InputError if the facets of no element could be measured
AsMachined as_machined(const VerificationRun& run);

/// Returns the part as the text of a design file (retrace.design/1), for `retrace rre`.
/// \param facets_file name of the file with the facet planes, if there are any
std::string as_machined_toml(const VerificationRun& run, const AsMachined& part, const std::string& facets_file);

}  // namespace retrace::studies

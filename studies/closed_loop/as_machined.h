#pragma once

// From verified NC programs back to optics: the part that they leave, with its facet tilts, edges and texture, as a
// design that can be traced.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "geometry/elements/facet_planes.h"
#include "studies/closed_loop/part_planes.h"
#include "studies/closed_loop/verification.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// Texture that a strategy leaves, in the terms of a design's [surface]: published Sa of facets by motion, shared
/// between roughness and feed marks (docs/theory/verification.md).
struct PredictedTexture {
  double sa_nm = 0.0;
  double roughness_sq_nm = 0.0, correlation_length_um = 0.0;
  double waviness_sq_nm = 0.0, waviness_length_um = 0.0;  ///< of the feed marks
};
PredictedTexture predicted_texture(const fabrication::Job& job);

/// The part that programs leave, moulded in it or cut directly. Where its elements are alike, a design file says it
/// with the mean tilts of their facets; else every facet of a moulded part has a plane of its own.
struct AsMachined {
  /// Opening is positive; of a prism towards -x and +x of the part, of a cube corner in the order of its facets.
  std::vector<double> facet_tilt_arcmin;
  std::optional<geometry::FacetPlanes> planes;
  std::optional<ZonedPart> zones;  ///< only for a job with zones; then used instead of the two members above
  double root_radius_um = 0.0, root_chamfer_um = 0.0;
  PredictedTexture texture;
  std::vector<geometry::Scratch> scratches;  ///< that the chips of the tool's edge leave
  MachinedBody body;
  Warnings warnings;
};

/// \throw InputError if no element was cut whose facets could be measured
AsMachined as_machined(const VerificationRun& run);

/// The design file of it (retrace.design/1), for `retrace rre`. \param facets_file name of the table of its planes, if
/// it has some
std::string as_machined_toml(const VerificationRun& run, const AsMachined& part, const std::string& facets_file);

}  // namespace retrace::studies

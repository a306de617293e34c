#pragma once

// Machining time and roughness of prisms by closed forms, quick enough to be computed at every point of a study.

#include <optional>
#include <string>
#include <vector>

#include "fabrication/job/job.h"
#include "geometry/elements/part_spec.h"

namespace retrace::studies {

/// How prisms are cut by single-point inverted cutting. The defaults are those of the offset samples in acrylic of
/// Milliken (2017), section 2.7.
struct MachiningProcess {
  std::optional<double> tool_width_mm;  ///< without one, a tool as wide as the element
  double clearance_um = 200.0;          ///< normal to the face of the workpiece
  double roughing_depth_um = 15.0;      ///< of a cut
  double finishing_depth_um = 5.0;
  int finishing_cuts = 2;  ///< of each facet
  double roughing_feed_mm_per_min = 50.0;
  double finishing_feed_mm_per_min = 20.0;
  double traverse_feed_mm_per_min = 200.0;
  double plough_length_um = 100.0;
  double dwell_s = 0.1;  ///< at every root
  /// two_step, or unidirectional: then no facet is finished
  fabrication::Strategy strategy = fabrication::Strategy::two_step;
  double edge_radius_um = 0.0;  ///< of the tool's cutting edge, which the roots get
  bool surface_as_cut = false;  ///< facets have the texture and roots the radius that cutting leaves
};

/// Areal roughness Sa that the process leaves on facets, in nm: studies/closed_loop, predicted_texture().
double process_sa_nm(const MachiningProcess& process);

/// The surface that the process leaves, as texts of --set for a design; empty unless surface_as_cut is set.
std::vector<std::string> surface_overrides(const MachiningProcess& process);

/// Roughing cuts of a facet: its length less what is left for finishing, by the depth of a cut.
double roughing_cuts(const geometry::RtpElement& element, const MachiningProcess& process);

/// Time that the tool's path takes for one element, in seconds: every roughing cut approaches and plunges at cutting
/// feed, dwells, ploughs off its chip and goes back at traverse feed; finishing cuts plunge along both facets. An
/// element wider than the tool takes several passes side by side. Measured on 0.451 mm: 27.7 s on the path and 29.2 s
/// by the clock (docs/theory/sizing.md). \pre an apex angle of 90 degrees, within a few
double seconds_per_element(const geometry::RtpElement& element, const MachiningProcess& process);

}  // namespace retrace::studies

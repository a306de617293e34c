#pragma once

// Machining time and roughness of prisms in closed form, fast enough for every point of a study.

#include <optional>
#include <string>
#include <vector>

#include "core/length_units.h"
#include "fabrication/job/job.h"
#include "geometry/elements/part_spec.h"

namespace retrace::studies {

/// Process in which prisms are cut one by one with a plunging tool: single-point inverted cutting. The defaults are
/// those of the offset samples in acrylic of Milliken (2017), section 2.7.
struct MachiningProcess {
  std::optional<double> tool_width_mm;  ///< none: the tool is as wide as the element
  double clearance_um = 200.0;          ///< clearance perpendicular to the surface of the workpiece
  double roughing_depth_um = 15.0;      ///< depth of a roughing cut
  double finishing_depth_um = 5.0;
  int finishing_cuts = 2;  ///< number of finishing cuts of each facet
  double roughing_feed_mm_per_min = 50.0;
  double finishing_feed_mm_per_min = 20.0;
  double traverse_feed_mm_per_min = 200.0;
  double plough_length_um = 100.0;
  double dwell_s = 0.1;  ///< dwell time at every root
  /// Cutting strategy: two_step or unidirectional. With unidirectional, there are no finishing cuts.
  fabrication::Strategy strategy = fabrication::Strategy::two_step;
  double edge_radius_um = 0.0;  ///< radius of the tool's cutting edge, which becomes the radius of the roots
  /// Tool life as the maximum path length of a cutting edge in the material; empty: no limit.
  std::optional<double> edge_life_mm;
  std::string machine;     ///< name or file of a machine; if empty, times are computed only from the tool path
  std::string process;     ///< name or file of a process; if empty, the defaults above apply
  bool has_limits = true;  ///< true: optimizations exclude designs that the tool or the machine cannot cut
  /// True: the design gets the facet texture and the root radius that result from cutting.
  bool surface_as_cut = false;
};

/// Value that occurs both in [machining] and in a fabrication process.
struct ProcessValue {
  const char* key;  ///< key in the table [machining]
  double MachiningProcess::*machining;
  double fabrication::Process::*process;
  double factor = 1.0;  ///< factor that converts the value of the process to the value of [machining]
};
inline constexpr ProcessValue kProcessValues[] = {
    {"clearance_um", &MachiningProcess::clearance_um, &fabrication::Process::clearance_mm, kUmPerMm},
    {"roughing_depth_um", &MachiningProcess::roughing_depth_um, &fabrication::Process::roughing_depth_um},
    {"finishing_depth_um", &MachiningProcess::finishing_depth_um, &fabrication::Process::finishing_depth_um},
    {"plough_length_um", &MachiningProcess::plough_length_um, &fabrication::Process::plough_length_mm, kUmPerMm},
    {"roughing_feed_mm_per_min", &MachiningProcess::roughing_feed_mm_per_min,
     &fabrication::Process::roughing_feed_mm_per_min},
    {"finishing_feed_mm_per_min", &MachiningProcess::finishing_feed_mm_per_min,
     &fabrication::Process::finishing_feed_mm_per_min},
    {"traverse_feed_mm_per_min", &MachiningProcess::traverse_feed_mm_per_min,
     &fabrication::Process::retract_feed_mm_per_min},
    {"dwell_s", &MachiningProcess::dwell_s, &fabrication::Process::dwell_s}};

/// Returns the areal roughness Sa of the facets after cutting, in nm; see predicted_texture() in studies/closed_loop.
double process_sa_nm(const MachiningProcess& process);

/// Returns the surface after cutting as overrides (--set) of a design. Empty unless surface_as_cut is set.
std::vector<std::string> surface_overrides(const MachiningProcess& process);

/// Returns the number of roughing cuts of a facet: its length without the finishing allowance, divided by the depth of
/// a cut.
double roughing_cuts(const geometry::RtpElement& element, const MachiningProcess& process);

/// Returns the time, in seconds, of the tool path for one element. Every roughing cut approaches and plunges at cutting
/// feed, dwells, removes its chip and returns at traverse feed. Finishing cuts plunge along both facets. An element
/// wider than the tool is cut in several passes side by side. For an element of 0.451 mm, the path takes 27.7 s and the
/// measured time is 29.2 s (docs/theory/sizing.md).
/// \pre the apex angle is 90 degrees, within a few degrees
double seconds_per_element(const geometry::RtpElement& element, const MachiningProcess& process);

}  // namespace retrace::studies

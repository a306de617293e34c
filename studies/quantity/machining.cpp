#include "studies/quantity/machining.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/length_units.h"
#include "core/number_format.h"
#include "fabrication/job/tool_limits.h"
#include "studies/closed_loop/as_machined.h"

namespace retrace::studies {
namespace {

constexpr double kSecondsPerMinute = 60.0;

double facet_length_mm(const geometry::RtpElement& element) {
  return element.base_mm / std::numbers::sqrt2;
}

double seconds(double path_mm, double feed_mm_per_min) {
  return kSecondsPerMinute * path_mm / feed_mm_per_min;
}

double passes(const geometry::RtpElement& element, const MachiningProcess& process) {
  if (!process.tool_width_mm) return 1.0;
  return std::max(1.0, std::ceil((element.width_mm - fabrication::kFitToleranceMm) / *process.tool_width_mm));
}

double allowance_mm(const MachiningProcess& process) {
  return process.finishing_cuts * process.finishing_depth_um / kUmPerMm;
}

/// Returns the time of several cuts and of the returns after them. The depths of the cuts add up to `depths_mm`. Each
/// return includes the step to the next cut.
double plunges_s(double cuts, double depths_mm, double step_mm, double feed_mm_per_min,
                 const MachiningProcess& process) {
  // The facet is vertical during the cut. The surface of the workpiece is inclined by 45 degrees to the facet.
  const double approach_mm = std::numbers::sqrt2 * process.clearance_um / kUmPerMm;
  const double path_mm = cuts * approach_mm + depths_mm;
  return seconds(path_mm, feed_mm_per_min) + cuts * process.dwell_s +
         seconds(path_mm + cuts * step_mm, process.traverse_feed_mm_per_min);
}

}  // namespace

namespace {

PredictedTexture texture_of(const MachiningProcess& process) {
  fabrication::Job job;
  job.strategy = process.strategy;
  job.process.roughing_feed_mm_per_min = process.roughing_feed_mm_per_min;
  job.process.finishing_feed_mm_per_min = process.finishing_feed_mm_per_min;
  return predicted_texture(job);
}

}  // namespace

double process_sa_nm(const MachiningProcess& process) {
  return texture_of(process).sa_nm;
}

std::vector<std::string> surface_overrides(const MachiningProcess& process) {
  if (!process.surface_as_cut) return {};
  const PredictedTexture texture = texture_of(process);
  std::vector<std::string> overrides;
  const auto set = [&](const char* key, double value) {
    overrides.push_back(std::string("surface.") + key + "=" + shortest(value));
  };
  set("roughness_sq_nm", texture.roughness_sq_nm);
  set("correlation_length_um", texture.correlation_length_um);
  set("waviness_sq_nm", texture.waviness_sq_nm);
  set("waviness_length_um", texture.waviness_length_um);
  if (process.edge_radius_um > 0.0) set("root_radius_um", process.edge_radius_um);
  return overrides;
}

double roughing_cuts(const geometry::RtpElement& element, const MachiningProcess& process) {
  const double cuts = (facet_length_mm(element) - allowance_mm(process)) / (process.roughing_depth_um / kUmPerMm);
  return std::max(0.0, std::ceil(cuts - 1e-9));
}

double seconds_per_element(const geometry::RtpElement& element, const MachiningProcess& process) {
  const double depth_of_cut_mm = process.roughing_depth_um / kUmPerMm;
  const double plough_mm = process.plough_length_um / kUmPerMm;
  const double deepest_mm = facet_length_mm(element) - allowance_mm(process);
  const double cuts = roughing_cuts(element, process);
  // Each cut is one depth of cut deeper than the cut before it, and the last cut reaches deepest_mm. The first cut may
  // therefore be shallower than one depth of cut.
  const double depths_mm = cuts * deepest_mm - 0.5 * cuts * (cuts - 1.0) * depth_of_cut_mm;
  const double roughing_s =
      plunges_s(cuts, depths_mm, plough_mm + depth_of_cut_mm, process.roughing_feed_mm_per_min, process) +
      seconds(cuts * plough_mm, process.roughing_feed_mm_per_min);
  const double finishing = 2.0 * process.finishing_cuts;
  const double finishing_s =
      plunges_s(finishing, finishing * facet_length_mm(element), process.finishing_depth_um / kUmPerMm,
                process.finishing_feed_mm_per_min, process);
  return passes(element, process) * (roughing_s + finishing_s);
}

}  // namespace retrace::studies

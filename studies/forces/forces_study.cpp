#include "studies/forces/forces_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "fabrication/forces/io/force_table.h"
#include "fabrication/job/io/job_files.h"

namespace retrace::studies {
namespace {

using namespace fabrication;

Configuration configuration_of(const std::string& word) {
  const auto* const found = std::find(std::begin(kConfigurationWords), std::end(kConfigurationWords), word);
  if (found == std::end(kConfigurationWords))
    throw InputError(Field{"configuration"},
                     fmt::format("must be {}, got {}", alternatives(kConfigurationWords), in_quotes(word)));
  return static_cast<Configuration>(found - std::begin(kConfigurationWords));
}

CutConditions conditions_of(const Job& job, const ForcesRequest& request) {
  const geometry::RtpElement element = blank_prism(job);
  const double half_apex = 0.5 * Angle::from_deg(element.apex_angle_deg).rad();
  const double facet_mm = 0.5 * element.base_mm / std::sin(half_apex);
  CutConditions cut;
  // The roughing of a two-step job is unidirectional.
  cut.strategy = job.strategy == Strategy::bidirectional ? Strategy::bidirectional : Strategy::unidirectional;
  cut.facet = request.facet;
  cut.configuration = configuration_of(request.configuration);
  cut.depth_of_cut_um = job.process.roughing_depth_um;
  cut.width_mm = std::min(job.tool.width_mm, element.width_mm);
  cut.plunge_mm = request.plunge_mm > 0.0 ? request.plunge_mm : facet_mm;
  if (cut.plunge_mm > facet_mm * (1.0 + 1e-9))
    throw InputError(Field{"plunge_mm"}, fmt::format("must be at most the length of the facet ({}), got {}",
                                                     shortest(facet_mm), shortest(cut.plunge_mm)));
  cut.plough_mm = job.process.plough_length_mm;
  cut.dwell_s = job.process.dwell_s;
  cut.clearance_mm = job.process.clearance_mm / std::cos(half_apex);
  cut.feed_mm_per_min = job.process.roughing_feed_mm_per_min;
  cut.retract_feed_mm_per_min = job.process.retract_feed_mm_per_min;
  return cut;
}

}  // namespace

ForcesResult cutting_forces(const ForcesRequest& request) {
  if (request.facet != 1 && request.facet != 2)
    throw InputError(Field{"facet"}, fmt::format("must be 1 or 2, got {}", request.facet));
  if (!(request.plunge_mm >= 0.0) || !std::isfinite(request.plunge_mm))
    throw InputError(Field{"plunge_mm"}, "must be > 0, got " + shortest(request.plunge_mm));
  const Job job = read_job(request.job);
  const ForceModel model = calibrate(shipped_forces());
  ForcesResult result;
  result.request = request;
  result.cut = conditions_of(job, request);
  result.events = force_events(model, result.cut);
  result.profile = force_profile(model, result.cut);
  result.warnings = force_warnings(model, result.cut);
  return result;
}

}  // namespace retrace::studies

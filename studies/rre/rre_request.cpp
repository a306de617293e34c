#include "studies/rre/rre_request.h"

#include "requests/descriptions.h"
#include "studies/rre/rre_map.h"

namespace retrace::studies {

RreSettings resolve(const RreRequest& request) {
  requests::check(request);
  RreSettings settings;
  settings.incidence_deg = request.incidence_deg;
  for (const auto& [from, to] : request.incidence_spans_deg) settings.incidence_spans.push_back({from, to});
  settings.azimuth_deg = request.azimuth_deg;
  settings.engine = raytrace::engine_from_name(request.engine);
  settings.rays = request.samples;
  settings.target_error = request.target_error;
  if (request.sampling == "plain") settings.sampling = raytrace::Sampling::Kind::plain;
  settings.cutoff = request.cutoff;
  settings.seed = request.seed;
  settings.derivatives = request.derivatives;
  settings.footprint = request.footprint;
  settings.far_field = request.far_field;
  settings.map = request.map;
  if (settings.map) resolve_grid(settings);
  if (settings.incidence_deg.empty() && settings.incidence_spans.empty()) settings.incidence_deg = {0.0};
  if (settings.azimuth_deg.empty()) settings.azimuth_deg = {0.0};
  return settings;
}

}  // namespace retrace::studies

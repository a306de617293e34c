#include "studies/scene/path_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/number_format.h"

namespace retrace::studies {
namespace {

using geometry::FacetRole, raytrace::PathEvent;

std::string face_name(FacetRole role) {
  switch (role) {
    case FacetRole::entrance: return "the entrance face";
    case FacetRole::retro_facet: return "a facet";
    case FacetRole::flat_back: return "the flat back";
    case FacetRole::inner_wall: return "a wall between elements";
    case FacetRole::border_wall: return "a wall on the border";
    case FacetRole::side: return "a side of the plate";
  }
  return "";
}

}  // namespace

std::string description_of(const raytrace::PathStep& step) {
  const std::string face = face_name(step.role);
  const std::string at = fmt::format("at {} deg", fixed_visible(step.incidence_deg, 1));
  const std::string left = fmt::format("{} % of the incident power continues", fixed(100.0 * step.power, 1));
  switch (step.event) {
    case PathEvent::enters: return fmt::format("Enters {} {}; {}.", face, at, left);
    case PathEvent::total_reflection: return fmt::format("Total reflection at {} {}.", face, at);
    case PathEvent::reflection: return fmt::format("Reflected by {} {}; {}.", face, at, left);
    case PathEvent::leaves:
      return fmt::format("Leaves through {} with {} % of the incident power.", face, fixed(100.0 * step.power, 1));
    case PathEvent::exits: return fmt::format("Leaves through {} {}, no total reflection; {}.", face, at, left);
    case PathEvent::enters_again: return fmt::format("Enters again through {} {}; {}.", face, at, left);
    case PathEvent::leaves_side:
      return fmt::format("Leaves through {} with {} % of the incident power.", face, fixed(100.0 * step.power, 1));
    case PathEvent::escapes: return "Is lost behind the part.";
    case PathEvent::stopped: return "Is stopped by the mount or by the chamfer of the face.";
    case PathEvent::ends: break;
  }
  return "Ends, because the remaining power is negligible.";
}

std::string ending_text(const raytrace::LightPath& path) {
  const auto count = [&](PathEvent event) { return std::ranges::count(path.steps, event, &raytrace::PathStep::event); };
  const auto mirrors = count(PathEvent::reflection);
  const auto reflections = count(PathEvent::total_reflection) + mirrors;
  const PathEvent last = path.steps.empty() ? PathEvent::ends : path.steps.back().event;
  if (path.is_returned)
    return fmt::format("comes back after {} {}reflection{}", reflections, mirrors == 0 ? "total " : "",
                       reflections == 1 ? "" : "s");
  if (last == PathEvent::leaves)
    return fmt::format("leaves through the entrance face at {} deg from the direction to the source",
                       fixed_visible(path.deviation_deg, 1));
  if (last == PathEvent::leaves_side) return "leaves through a side";
  if (last == PathEvent::stopped) return "is stopped by the mount or by the chamfer of the face";
  return last == PathEvent::escapes ? "is lost behind the part" : "loses its power inside the part";
}

}  // namespace retrace::studies

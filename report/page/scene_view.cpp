#include "report/page/scene_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"
#include "core/number_format.h"
#include "report/page/sections.h"

namespace retrace::report {
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

std::string words_of(const raytrace::PathStep& step) {
  const std::string face = face_name(step.role);
  const std::string at = fmt::format("at {} deg", fixed(step.incidence_deg, 1));
  const std::string left = fmt::format("{} % goes on", fixed(100.0 * step.power, 1));
  switch (step.event) {
    case PathEvent::enters: return fmt::format("Enters {} {}; {}.", face, at, left);
    case PathEvent::total_reflection: return fmt::format("Total reflection at {} {}.", face, at);
    case PathEvent::reflection: return fmt::format("Reflected by {} {}; {}.", face, at, left);
    case PathEvent::leaves:
      return fmt::format("Leaves through {}; {} % of what fell in.", face, fixed(100.0 * step.power, 1));
    case PathEvent::exits: return fmt::format("Leaves through {} {}, no total reflection; {}.", face, at, left);
    case PathEvent::enters_again: return fmt::format("Enters again through {} {}; {}.", face, at, left);
    case PathEvent::leaves_side:
      return fmt::format("Leaves through {}; {} % of what fell in.", face, fixed(100.0 * step.power, 1));
    case PathEvent::escapes: return "Is lost behind the part.";
    case PathEvent::ends: break;
  }
  return "Ends: what is left is faint.";
}

std::string fate_of(const raytrace::LightPath& path) {
  const auto reflections = std::count_if(path.steps.begin(), path.steps.end(), [](const raytrace::PathStep& s) {
    return s.event == PathEvent::total_reflection;
  });
  const PathEvent last = path.steps.empty() ? PathEvent::ends : path.steps.back().event;
  if (path.is_returned)
    return fmt::format("comes back after {} total reflection{}", reflections, reflections == 1 ? "" : "s");
  if (last == PathEvent::leaves)
    return fmt::format("leaves the face {} deg off the way back", fixed(path.deviation_deg, 1));
  if (last == PathEvent::leaves_side) return "leaves through a side";
  return last == PathEvent::escapes ? "is lost behind the part" : "fades inside";
}

std::array<double, 3> numbers(const geometry::Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

SceneView scene_view(const studies::DesignScene& scene) {
  SceneView view;
  for (const geometry::Vec3& p : scene.mesh.vertices) view.vertices_mm.push_back(numbers(p));
  view.triangles = scene.mesh.triangles;
  view.edges = scene.edges;
  for (const studies::ScenePath& path : scene.paths) {
    ScenePathView shown;
    shown.label = fmt::format("Incidence {} deg: {} ({} % of the light)", fixed(path.incidence_deg, 1),
                              fate_of(path.path), fixed(100.0 * path.share, 0));
    for (const geometry::Vec3& p : path.path.points_mm) shown.points_mm.push_back(numbers(p));
    for (const raytrace::PathStep& step : path.path.steps) shown.events.push_back(words_of(step));
    view.paths.push_back(std::move(shown));
  }
  return view;
}

std::vector<std::string> add_scene(Page& page, const ResultFolder& folder) {
  std::vector<std::string> warnings;
  const auto* const design = first_design(folder);
  if (design == nullptr) return warnings;
  for (PageSection& section : page.sections) {
    if (!section.has_scene) continue;
    try {
      std::vector<studies::SceneLight> lights;
      for (const auto& [incidence_deg, azimuth_deg] : extreme_directions_deg(folder))
        lights.push_back({incidence_deg, azimuth_deg});
      const studies::DesignScene scene = studies::make_scene(studies::design_of_json(*design), lights);
      page.scene = scene_view(scene);
      std::string text =
          "The most frequent ways of light that falls on an element in the middle, each drawn along its strongest "
          "branch.";
      if (!scene.remarks.empty()) text += fmt::format(" For the eye, {}.", fmt::join(scene.remarks, ", "));
      section.paragraphs.push_back(text);
    } catch (const Error& error) {
      section.paragraphs.push_back(std::string("The design cannot be shown here: ") + error.what());
      warnings.push_back(std::string("no view in three dimensions: ") + error.what());
    }
  }
  return warnings;
}

}  // namespace retrace::report

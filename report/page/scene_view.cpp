#include "report/page/scene_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/schema/json.h"
#include "design/file_names.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"
#include "report/page/design_names.h"
#include "report/page/sections.h"
#include "studies/scene/path_words.h"

namespace retrace::report {
namespace {

std::array<double, 3> numbers(const geometry::Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

/// Checks that all files to which a design refers may be read, see may_read(). The check is needed because result
/// documents may come from untrusted sources.
/// \throw InputError for the first key whose file may not be read
void check_files(const design::Design& design, const ResultFolder& folder) {
  for (const std::string& key : design.document->keys_of_files())
    if (const std::filesystem::path file = design.document->file(key); !may_read(folder, file))
      throw InputError(
          {design.source, 0, key},
          fmt::format("the file {} is outside the folder of results and was not read; allow it with --read FILE",
                      in_quotes(file.string())));
}

}  // namespace

SceneView scene_view(const studies::DesignScene& scene) {
  SceneView view;
  for (const geometry::Vec3& p : scene.mesh.vertices) view.vertices_mm.push_back(numbers(p));
  view.triangles = scene.mesh.triangles;
  view.edges = scene.edges;
  for (const studies::ScenePath& path : scene.paths) {
    ScenePathView shown;
    shown.label = fmt::format("Incidence {} deg: {} ({} % of the light)", fixed_visible(path.incidence_deg, 1),
                              studies::ending_text(path.path), fixed(100.0 * path.fraction, 0));
    for (const geometry::Vec3& p : path.path.points_mm) shown.points_mm.push_back(numbers(p));
    for (const raytrace::PathStep& step : path.path.steps) shown.events.push_back(studies::description_of(step));
    view.paths.push_back(std::move(shown));
  }
  return view;
}

Warnings add_scene(Page& page, const ResultFolder& folder) {
  Warnings warnings = folder.warnings;
  const auto* const design = first_design(folder);
  if (design == nullptr) return warnings;
  for (PageSection& section : page.sections) {
    if (!section.has_scene) continue;
    try {
      std::vector<studies::SceneLight> lights;
      for (const auto& [incidence_deg, azimuth_deg] : extreme_directions_deg(folder))
        lights.push_back({incidence_deg, azimuth_deg});
      const design::Design quoted = studies::design_of_json(*design);
      check_files(quoted, folder);
      const studies::DesignScene scene = studies::make_scene(quoted, lights);
      page.scene = scene_view(scene);
      std::string text =
          "The most frequent light paths in an element at the center of the array. Only the strongest branch of each "
          "path is drawn. Weaker branches, such as the reflection at the entrance face, are not drawn but are part of "
          "RRE.";
      if (!scene.remarks.empty())
        text += fmt::format(" To keep the drawing clear, {}.", fmt::join(scene.remarks, "; "));
      section.paragraphs.push_back(text);
    } catch (const Error& error) {
      section.paragraphs.push_back(std::string("The design cannot be shown here: ") + error.what());
      warnings.push_back({"no_scene", std::string("the 3D view is not available: ") + error.what()});
    }
  }
  return warnings;
}

void add_live(Page& page, const ResultFolder& folder) {
  const auto* const json = first_design(folder);
  if (json == nullptr) return;
  try {
    const std::string toml = schema::toml_of_json(design::design_format(), *json);
    const design::Design design = design::parse_design(toml, "design.toml");
    design::require_no_files(design, "which a self-contained page cannot read");
    PageSection section = titled("Live",
                                 "The design with the engine in this page: change a value or the direction of the "
                                 "light to see the effect. The results of the other sections do not change.");
    if (const DesignNames names(folder); names.are_several()) section.subject = names.of(*json);
    section.id = "live-section";
    section.has_live = true;
    page.live = LiveStart{toml, "design.toml"};
    page.sections.push_back(std::move(section));
  } catch (const Error&) {  // the section is omitted for results of other versions and designs that refer to files
  }
}

}  // namespace retrace::report

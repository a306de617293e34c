// Sections of the page for the pictures of `retrace image`: detector maps, camera pictures and roads at night.
#include <fmt/format.h>

#include "report/page/document_sections.h"
#include "report/page/document_view.h"

namespace retrace::report::document {
namespace {

PageSection detector_section(const Json& json) {
  PageSection section = titled("Detector");
  section.facts = {{"Returned (RRE)", percent(number(json, "rre"))},
                   {"Incidence", measured(number(json, "incidence_deg"), " deg")},
                   {"Azimuth", measured(number(json, "azimuth_deg"), " deg")},
                   {"Engine", text(json, "engine")}};
  section.paragraphs.push_back(
      "Maps of a detector on the entrance face. Irradiances are divided by the irradiance of the beam on the face, so "
      "that the mean of each map is RRE.");
  return section;
}

PageSection camera_section(const Json& json) {
  PageSection section = titled("Camera");
  const double error = number(json, "part_std_error_cd_per_m2");
  section.facts = {{"Mean luminance of the part", measured(number(json, "part_luminance_cd_per_m2"), " cd/m2")},
                   {"Standard error of the mean", measured(error, " cd/m2")},
                   {"Observation angle", measured(number(json, "observation_deg"), " deg")},
                   {"Entrance angle", measured(number(json, "entrance_deg"), " deg")},
                   {"Illuminance of the lamp", measured(number(json, "illuminance_lx"), " lx")},
                   {"Width of the picture", measured(number(json, "width_mm"), " mm")}};
  std::erase_if(section.facts, [](const PageFact& fact) { return fact.value.empty(); });
  section.paragraphs.push_back(
      "The part in the light of a lamp, as the camera sees it. Tones are mapped for the screen; luminances are in the "
      "OpenEXR file next to the result.");
  return section;
}

/// Returns the table cell with a value of a reflector for one lamp.
PageCell of_lamp(const Json& reflector, const char* key, std::size_t lamp) {
  const Json& values = list(reflector, key);
  return lamp < values.size() && values[lamp].is_number() ? PageCell(values[lamp].get<double>()) : PageCell();
}

PageSection road_section(const ResultDocument& document) {
  PageSection section = titled(
      "Night road",
      "Two reflectors of the design on the rear of a car ahead, or a sign, in the light of both headlamps, as the "
      "driver sees them.");
  PageTable table;
  table.caption = "The reflectors";
  table.csv_name = csv_name(document, "reflectors");
  table.columns = {"distance (m)", "reflector", "luminance (cd/m2)"};
  for (const char* lamp : {"left", "right"})
    for (const char* what : {"observation (deg)", "R_A (cd/lx/m2)", "illuminance (lx)"})
      table.columns.push_back(fmt::format("{} lamp: {}", lamp, what));
  for (const Json& view : list(document.json, "views")) {
    const Json& reflectors = list(view, "reflectors");
    for (std::size_t k = 0; k < reflectors.size() && table.rows.size() < kMaxRows; ++k) {
      std::vector<PageCell> row = {number(view, "distance_m"),
                                   reflectors.size() == 1 ? "sign" : (k == 0 ? "left" : "right"),
                                   number(reflectors[k], "luminance_cd_per_m2")};
      for (const std::size_t lamp : {0U, 1U})
        for (const char* key : {"observation_deg", "r_a_cd_per_lx_m2", "illuminance_lx"})
          row.push_back(of_lamp(reflectors[k], key, lamp));
      table.rows.push_back(std::move(row));
    }
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace

PageSection image_section(const ResultDocument& document, const ResultFolder& folder) {
  const std::string kind = text(document.json, "kind");
  if (kind == "detector") return detector_section(document.json);
  if (kind == "camera") return camera_section(document.json);
  return kind == "road" ? road_section(document) : plain_section(document, folder);
}

}  // namespace retrace::report::document

// Answers about an opened design: its keys, and whether its light can be traced.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/number_format.h"
#include "design/azimuth_symmetry.h"
#include "live/engine/answers.h"
#include "live/engine/form.h"

namespace retrace::live {
namespace {

// Number of elements of a finite array above which tracing a direction is too slow for dragging.
constexpr std::int64_t kManyElements = 100;

std::vector<std::string> notes_of(const OpenedDesign& opened) {
  std::vector<std::string> notes;
  const design::OpticalModel* const model = opened.model();
  if (model == nullptr || !opened.why_not().empty()) return notes;
  if (!model->part.period_mm && model->part.elements_full > kManyElements)
    notes.push_back(
        fmt::format("all of its {} elements are traced: an infinite array is much faster", model->part.elements_full));
  if (model->spectral.size() > 1)
    notes.push_back(
        fmt::format("its light has {} wavelengths, which are all traced; footprint and far field are computed at {} nm",
                    model->spectral.size(), fixed(model->optics.wavelength_nm, 1)));
  return notes;
}

}  // namespace

Json design_json(const OpenedDesign& opened) {
  const design::Design& design = opened.design();
  Json json = {{"title", design.title},
               {"source", design.source},
               {"toml", opened.toml()},
               {"keys", keys_json(*design.document)},
               {"traces", opened.why_not().empty()},
               {"why_not", opened.why_not()},
               {"command", opened.command()},
               {"notes", notes_of(opened)},
               {"acceptance_half_angle_deg", design.detector.acceptance_half_angle_deg}};
  if (const auto symmetry = design::azimuth_symmetry(design))
    json["azimuth_symmetry"] = {{"period_deg", symmetry->period_deg}, {"mirror_deg", symmetry->mirror_deg}};
  const design::OpticalModel* const model = opened.model();
  json["warnings"] = texts_of(model != nullptr ? model->warnings : Warnings());
  if (model == nullptr) return json;
  for (const design::SpectralOptics& lit : model->spectral) json["wavelengths_nm"].push_back(lit.wavelength_nm);
  json["refractive_index"] = model->optics.index;
  json["elements"] = model->part.elements_full;
  json["partial_elements"] = model->part.elements_partial;
  json["entrance_area_mm2"] = model->part.entrance_area_mm2;
  json["element_depth_mm"] = model->part.element_depth_mm;
  json["thickness_mm"] = model->part.thickness_mm;
  return json;
}

}  // namespace retrace::live

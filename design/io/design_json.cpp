#include "design/io/design_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/number_format.h"
#include "core/overloaded.h"
#include "core/schema/json.h"
#include "design/io/design_document.h"
#include "geometry/elements/ruled_pattern.h"

namespace retrace::design {
namespace {

using Json = nlohmann::ordered_json;
using namespace geometry;

struct ElementName {
  std::string operator()(const RtpElement& e) const {
    return fmt::format("RTP {} x {} mm", shortest(e.base_mm), shortest(e.width_mm));
  }
  std::string operator()(const HexagonalCube& e) const {
    return fmt::format("hexagonal ICC {} mm", fixed(e.aperture_mm, 3));
  }
  std::string operator()(const TriangularCube& e) const {
    return fmt::format("triangular ICC {} mm", fixed(e.aperture_mm, 3));
  }
  std::string operator()(const RuledCells& e) const {
    return fmt::format("ruled cells of {} groove sets", e.pattern->sets.size());
  }
  std::string operator()(const RoundCube& e) const { return fmt::format("round ICC {} mm", fixed(e.diameter_mm, 3)); }
};

}  // namespace

nlohmann::ordered_json to_json(const Design& design) {
  Json json = {{"source", design.source}};
  json.update(schema::to_json(document_of(design)));
  return json;
}

nlohmann::ordered_json spectrum_json(const std::vector<SpectralOptics>& light) {
  double centroid_nm = 0.0;
  Json wavelengths_nm = Json::array();
  Json weights = Json::array();
  Json indices = Json::array();
  for (const SpectralOptics& at : light) {
    centroid_nm += at.weight * at.wavelength_nm;
    wavelengths_nm.push_back(at.wavelength_nm);
    weights.push_back(at.weight);
    indices.push_back(at.optics.index);
  }
  return {{"centroid_nm", centroid_nm},
          {"wavelengths_nm", wavelengths_nm},
          {"weights", weights},
          {"refractive_index", indices}};
}

std::string short_name(const Design& design) {
  if (!design.title.empty()) return design.title;
  return std::visit(
      Overloaded{[&](const ElementArray& array) {
                   const std::string element = std::visit(ElementName{}, array.part.element);
                   return fmt::format("{}, {}", element, document_of(design).text("array.arrangement"));
                 },
                 [](const PartMesh& mesh) { return mesh.name; },
                 [](const Plate& plate) {
                   return fmt::format("plate {} x {} mm", shortest(plate.size_mm[0]), shortest(plate.size_mm[1]));
                 },
                 [](const ZonedPart& zoned) { return fmt::format("part of {} zones", zoned.spec.zones.size()); },
                 [](const raytrace::BallLayer& balls) {
                   return fmt::format("{} {} mm", balls.pitch_mm ? "balls" : "ball", shortest(balls.diameter_mm));
                 }},
      design.shape);
}

}  // namespace retrace::design

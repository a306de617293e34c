#include "studies/design/design_json.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "core/number_format.h"
#include "core/overloaded.h"
#include "geometry/formula.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;
using namespace geometry;

const char* name_of(Arrangement arrangement) {
  switch (arrangement) {
    case Arrangement::single:
      return "single";
    case Arrangement::aligned:
      return "aligned";
    case Arrangement::offset:
      return "offset";
    case Arrangement::checker:
      return "checker";
    case Arrangement::honeycomb:
      return "honeycomb";
    case Arrangement::triangular:
      return "triangular";
  }
  return "";
}

const char* arrangement_name(const PartSpec& part) {
  return part.is_pin_bundle ? "pins" : name_of(part.arrangement);
}

struct ElementJson {
  Json operator()(const RtpElement& e) const {
    return {{"kind", "rtp"}, {"base_mm", e.base_mm}, {"width_mm", e.width_mm}, {"apex_angle_deg", e.apex_angle_deg}};
  }
  Json operator()(const HexagonalCube& e) const { return cube("hexagonal_icc", e.aperture_mm, e.cant); }
  Json operator()(const TriangularCube& e) const { return cube("triangular_icc", e.aperture_mm, e.cant); }

  static Json cube(const char* kind, double aperture_mm, const Cant& cant) {
    Json json = {{"kind", kind}, {"aperture_mm", aperture_mm}};
    if (cant.deg != 0.0) json.update({{"cant_deg", cant.deg}, {"cant_azimuth_deg", cant.azimuth_deg}});
    return json;
  }
};

Json array_json(const ElementArray& elements) {
  const PartSpec& part = elements.part;
  Json array = {{"arrangement", arrangement_name(part)}};
  if (part.arrangement == Arrangement::single) return array;
  array["extent"] = part.extent == Extent::infinite ? "infinite" : "finite";
  if (part.extent == Extent::finite) {
    array["x_length_mm"] = part.x_length_mm;
    array["y_length_mm"] = part.y_length_mm;
    array["x_offset_mm"] = part.x_offset_mm;
    array["y_offset_mm"] = part.y_offset_mm;
    array["partial_elements"] = part.partial_elements == PartialElements::cut ? "cut" : "omit";
  }
  if (std::holds_alternative<RtpElement>(part.element)) {
    array["x_gap_mm"] = part.x_gap_mm;
    array["y_gap_mm"] = part.y_gap_mm;
  }
  if (part.arrangement == Arrangement::offset) {
    array["overlap_percent"] = part.overlap_percent;
    array["shifted_rows"] = part.shifted_rows == RowParity::even ? "even" : "odd";
  }
  if (elements.mask) array.update({{"mask", elements.mask->name}, {"mask_threshold", elements.mask->threshold}});
  return array;
}

Json ball_json(const raytrace::BallLayer& balls) {
  return {{"kind", "ball"},
          {"diameter_mm", balls.diameter_mm},
          {"mirror_offset_mm", balls.mirror_offset_mm},
          {"mirror_half_angle_deg", balls.mirror_half_angle_deg}};
}

Json ball_array_json(const raytrace::BallLayer& balls) {
  if (!balls.pitch_mm) return {{"arrangement", "single"}};
  return {{"arrangement", "packed"}, {"extent", "infinite"}, {"gap_mm", *balls.pitch_mm - balls.diameter_mm}};
}

struct BaseJson {
  Json operator()(const PlaneBase& b) const {
    return {{"kind", "plane"}, {"incline_deg", b.incline_deg}, {"azimuth_deg", b.azimuth_deg}};
  }
  Json operator()(const CylinderBase& b) const {
    return {{"kind", "cylinder"}, {"radius_mm", b.radius_mm}, {"axis", b.axis_is_x ? "x" : "y"}};
  }
  Json operator()(const SphereBase& b) const { return {{"kind", "sphere"}, {"radius_mm", b.radius_mm}}; }
  Json operator()(const FormulaBase& b) const { return {{"kind", "formula"}, {"sag_mm", b.sag_mm->text()}}; }
};

Json base_json(const Base& base) {
  Json json = std::visit(BaseJson{}, base.shape);
  json["elements"] = base.standing == Standing::normal ? "normal" : "parallel";
  return json;
}

/// The word that the design file has for it, or [i, q, u, v].
Json polarisation_json(const raytrace::Stokes& stokes) {
  const std::array<double, 4> values = stokes.values();
  if (values == raytrace::kUnpolarised.values()) return "unpolarised";
  if (values == std::array{1.0, 0.0, 0.0, 1.0}) return "right_circular";
  if (values == std::array{1.0, 0.0, 0.0, -1.0}) return "left_circular";
  return values;
}

const char* name_of(FacetTexture::Model model) {
  switch (model) {
    case FacetTexture::Model::smooth:
      return "smooth";
    case FacetTexture::Model::harvey_shack:
      return "harvey_shack";
    case FacetTexture::Model::abg:
      return "abg";
    case FacetTexture::Model::microfacet:
      return "microfacet";
    case FacetTexture::Model::height_map:
      break;
  }
  return "height_map";
}

void add_texture(Json& json, const FacetTexture& t) {
  using Model = FacetTexture::Model;
  if (t.absorbing_walls) json["walls"] = "absorbing";
  if (t.model == Model::smooth) return;
  json["model"] = name_of(t.model);
  if (t.model == Model::abg) json.update({{"abg_a", t.abg_a}, {"abg_b", t.abg_b}, {"abg_g", t.abg_g}});
  if (t.model == Model::height_map)
    json.update({{"height_map", t.height_map},
                 {"height_map_level_axis", t.height_map_level_axis == HeightMapAxis::x ? "x" : "y"},
                 {"height_map_form",
                  t.height_map_form_degree == 1 ? "plane" : fmt::format("poly{}", t.height_map_form_degree)}});
  if (t.model == Model::microfacet) json["slope_distribution"] = t.ggx ? "ggx" : "beckmann";
  if (t.roughness_sq_nm > 0.0)
    json.update({{"roughness_sq_nm", t.roughness_sq_nm}, {"correlation_length_um", t.correlation_length_um}});
  if (t.waviness_sq_nm > 0.0)
    json.update({{"waviness_sq_nm", t.waviness_sq_nm}, {"waviness_length_um", t.waviness_length_um}});
}

Json texture_json(const FacetTexture& texture) {
  Json json = Json::object();
  add_texture(json, texture);
  return json;
}

Json surface_json(const Design& design) {
  const PartSpec& part = design.part();
  const auto& [dihedral, tilt] = part.angle_errors;
  Json json = {{"dihedral_error_arcmin", dihedral}, {"facet_tilt_arcmin", tilt}};
  if (std::holds_alternative<RtpElement>(part.element))
    json = {{"dihedral_error_arcmin", dihedral[0]}, {"facet_tilt_arcmin", {tilt[0], tilt[1]}}};
  if (part.random_tilts.sigma_arcmin > 0.0) {
    json["angle_error_sigma_arcmin"] = part.random_tilts.sigma_arcmin;
    json["angle_error_seed"] = part.random_tilts.seed;
  }
  add_texture(json, design.texture);
  if (part.edges.root_radius_mm > 0.0) json["root_radius_um"] = 1e3 * part.edges.root_radius_mm;
  if (part.edges.root_chamfer_mm > 0.0) json["root_chamfer_um"] = 1e3 * part.edges.root_chamfer_mm;
  if (part.edges.rim_radius_mm > 0.0) json["rim_radius_um"] = 1e3 * part.edges.rim_radius_mm;
  if (part.edges.rim_chamfer_mm > 0.0) json["rim_chamfer_um"] = 1e3 * part.edges.rim_chamfer_mm;
  if (!part.edges.is_sharp()) json["edge_chords"] = part.edges.chords;
  for (const geometry::Scratch& s : part.scratches)
    json["scratches"].push_back({{"facet", s.facet == 0 ? "-x" : "+x"},
                                 {"position_um", 1e3 * s.position_mm},
                                 {"width_um", 1e3 * s.width_mm},
                                 {"depth_um", 1e3 * s.depth_mm}});
  return json;
}

/// As the design file has it.
Json named_spectrum(const LightSpectrum& spectrum) {
  switch (spectrum.kind) {
    case LightSpectrum::Kind::illuminant_a:
      return "A";
    case LightSpectrum::Kind::illuminant_d65:
      return "D65";
    case LightSpectrum::Kind::file:
      return spectrum.name;
    case LightSpectrum::Kind::lines:
      break;
  }
  Json lines = Json::array();
  for (const LightSpectrum::Line& line : spectrum.lines) lines.push_back(Json::array({line.wavelength_nm, line.power}));
  return lines;
}

Json light_json(const Design& design) {
  Json json = Json::object();
  if (design.spectrum) {
    json["spectrum"] = named_spectrum(*design.spectrum);
    json["weighting"] = design.spectrum->photopic ? "photopic" : "radiant";
  } else {
    json["wavelength_nm"] = design.wavelength_nm;
  }
  json["polarisation"] = polarisation_json(design.polarisation);
  return json;
}

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
};

}  // namespace

namespace {

/// The tables that say what is designed.
void add_shape(Json& json, const Design& design) {
  std::visit(Overloaded{[&](const ElementArray& array) {
                          json["element"] = std::visit(ElementJson{}, array.part.element);
                          json["array"] = array_json(array);
                          if (array.part.base) json["base"] = base_json(*array.part.base);
                          if (array.facet_planes) json["part"] = {{"facets", array.facet_planes->name}};
                        },
                        [&](const PartMesh& mesh) {
                          json["part"] = {{"mesh", mesh.name}, {"allow_open", mesh.allow_open}};
                        },
                        [&](const Plate& plate) {
                          json["part"] = {{"plate_mm", plate.size_mm}};
                        },
                        [&](const raytrace::BallLayer& balls) {
                          json["element"] = ball_json(balls);
                          json["array"] = ball_array_json(balls);
                        }},
             design.shape);
}

Json front_json(const FrontFile& front) {
  Json json = {{front.is_mesh ? "mesh" : "turned", front.name}};
  if (front.is_mesh) json["mesh_side"] = front.mesh_bottom ? "bottom" : "top";
  if (front.centre_mm) json["centre_mm"] = *front.centre_mm;
  return json;
}

}  // namespace

nlohmann::ordered_json to_json(const Design& design) {
  Json body = Json::object();
  if (design.thickness_mm() > 0.0) body["thickness_mm"] = design.thickness_mm();
  body["material"] = design.material;
  if (design.refractive_index) body["refractive_index"] = *design.refractive_index;
  if (design.absorption_per_mm) body["absorption_per_mm"] = *design.absorption_per_mm;
  for (const auto& [wavelength_nm, per_mm] : design.absorption_by_wavelength)
    body["absorption_per_mm"].push_back(Json::array({wavelength_nm, per_mm}));
  if (design.aluminised_facets) body["facet_coating"] = "aluminium";
  if (design.back_index != 1.0) body["back_index"] = design.back_index;
  Json json = {{"source", design.source}};
  if (!design.title.empty()) json["title"] = design.title;
  add_shape(json, design);
  if (design.front) json["front"] = front_json(*design.front);
  json["body"] = body;
  json["light"] = light_json(design);
  json["detector"] = {{"acceptance_half_angle_deg", design.acceptance_half_angle_deg}};
  if (!design.balls()) json["surface"] = design.elements() ? surface_json(design) : texture_json(design.texture);
  json["idealisation"] = {{"facets", design.idealisation.mirror_facets ? "mirror" : "real"},
                          {"entrance", design.idealisation.lossless_entrance ? "lossless" : "real"}};
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
      Overloaded{[](const ElementArray& array) {
                   const std::string element = std::visit(ElementName{}, array.part.element);
                   return fmt::format("{}, {}", element, arrangement_name(array.part));
                 },
                 [](const PartMesh& mesh) { return mesh.name; },
                 [](const Plate& plate) {
                   return fmt::format("plate {} x {} mm", shortest(plate.size_mm[0]), shortest(plate.size_mm[1]));
                 },
                 [](const raytrace::BallLayer& balls) {
                   return fmt::format("{} {} mm", balls.pitch_mm ? "balls" : "ball", shortest(balls.diameter_mm));
                 }},
      design.shape);
}

}  // namespace retrace::studies

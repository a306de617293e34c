#include "design/io/design_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/schema/reader.h"
#include "core/sin_cos.h"
#include "design/entrance_form.h"
#include "design/io/design_document.h"
#include "design/io/design_format.h"
#include "design/io/entrance_reader.h"
#include "design/io/outline_reader.h"
#include "design/io/part_reader.h"
#include "design/io/zone_reader.h"
#include "design/step_faces.h"
#include "materials/io/index_record.h"

namespace retrace::design {
namespace fs = std::filesystem;
namespace {

using schema::Document;

std::array<double, 2> pair_of(const Document& document, std::string_view key) {
  const std::vector<double> given = document.numbers(key);
  return {given[0], given[1]};
}

PartMesh read_mesh(const Document& document) {
  const std::string_view key = document.has("part.solid") ? "part.solid" : "part.mesh";
  return {document.text(key), document.file(key), document.has("part.mesh") && document.flag("part.allow_open"),
          document.number_if("body.thickness_mm")};
}

ElementArray read_elements(const Document& document) {
  ElementArray array = {read_part(document), {}, {}, outline_keys(document)};
  if (constexpr std::string_view mask = "array.mask"; document.has(mask))
    array.mask = {document.text(mask), document.file(mask), document.number("array.mask_threshold")};
  if (constexpr std::string_view facets = "part.facets"; document.has(facets))
    array.facet_planes = {document.text(facets), document.file(facets)};
  if (const auto depth_nm = document.number_if("array.depth_spread_nm"))
    array.cell_spread = {*depth_nm, document.number("array.spacing_spread_nm")};
  return array;
}

Shape read_shape(const Document& document) {
  if (document.has("part.plate_mm"))
    return Plate{pair_of(document, "part.plate_mm"), document.number("body.thickness_mm")};
  if (document.has("part.mesh") || document.has("part.solid")) return read_mesh(document);
  if (has_zones(document)) return read_zones(document);
  if (has_elements(document)) return read_elements(document);
  return read_balls(document);
}

/// Reads the absorption coefficient of a body or a shell: a single number or a list of values by wavelength.
Absorption read_absorption(const Document& document, std::string_view key) {
  if (!document.is_list(key)) {
    const std::optional<double> per_mm = document.number_if(key);
    return per_mm ? Absorption(*per_mm) : Absorption();
  }
  std::vector<SpectralAbsorption> curve;
  for (const std::vector<double>& pair : document.rows(key)) curve.push_back({pair[0], pair[1]});
  return curve;
}

/// Reads the texture of models with rms heights. If all heights are 0, the facets are smooth.
SurfaceFinish read_heights(const Document& document, std::string_view model) {
  const double waviness_sq_nm = document.number("surface.waviness_sq_nm");
  const double waviness_length_um = document.number("surface.waviness_length_um");
  const double roughness_sq_nm = document.number("surface.roughness_sq_nm");
  if (model == "smooth" || !(roughness_sq_nm > 0.0 || waviness_sq_nm > 0.0)) return SmoothTexture();
  if (model == "microfacet")
    return MicrofacetTexture{waviness_sq_nm, waviness_length_um, document.text("surface.slope_distribution") == "ggx"};
  return HarveyShackTexture{roughness_sq_nm, document.number("surface.correlation_length_um"), waviness_sq_nm,
                            waviness_length_um, document.number_if("surface.correlation_length_down_um").value_or(0.0)};
}

SurfaceFinish read_texture(const Document& document) {
  const std::string model = document.text_if("surface.model");
  if (model == "abg")
    return AbgTexture{document.number("surface.abg_a"), document.number("surface.abg_b"),
                      document.number("surface.abg_g")};
  if (model == "height_map")
    return HeightMapTexture{document.text("surface.height_map"), document.file("surface.height_map"),
                            document.choice<HeightMapAxis>("surface.height_map_horizontal_axis"),
                            static_cast<int>(document.index("surface.height_map_form")) + 1};
  return read_heights(document, model);
}

std::vector<CoatingLayer> read_layers(const Document& document, std::string_view list) {
  std::vector<CoatingLayer> layers;
  for (std::size_t i = 0; i < document.count(list); ++i) {
    const std::string entry = schema::path_of_entry(list, i);
    CoatingLayer& layer = layers.emplace_back();
    layer.material = document.text_if(entry + ".material");
    layer.refractive_index = document.number_if(entry + ".refractive_index").value_or(1.0);
    layer.extinction_coefficient = document.number_if(entry + ".extinction_coefficient").value_or(0.0);
    layer.thickness_nm = document.number_if(entry + ".thickness_nm");
  }
  return layers;
}

Coating read_coating(const Document& document) {
  Coating coating = {read_layers(document, "coating.facets"), read_layers(document, "coating.entrance")};
  if (document.text("body.facet_coating") == "aluminium") coating.facets = {kPlainAluminium};
  return coating;
}

FormOfFacets read_form(const Document& document) {
  FormOfFacets form;
  if (!document.has("form")) return form;
  form.sink_um = document.number("form.sink_um");
  for (std::size_t i = 0; i < document.count("form.terms"); ++i) {
    const std::string entry = schema::path_of_entry("form.terms", i);
    const FormTerm term{static_cast<int>(document.number(entry + ".x_power")),
                        static_cast<int>(document.number(entry + ".y_power")), document.number(entry + ".height_um")};
    if (term.height_um != 0.0) form.terms.push_back(term);
  }
  if (document.has("form.map"))
    form.map = {document.text("form.map"), document.file("form.map"),
                document.choice<HeightMapAxis>("form.map_horizontal_axis"),
                static_cast<int>(document.number("form.map_degree"))};
  return form;
}

EntranceState read_entrance_face(const Document& document) {
  EntranceState face;
  if (!document.has("entrance")) return face;
  for (std::size_t i = 0; i < document.count("entrance.layers"); ++i) {
    const std::string entry = schema::path_of_entry("entrance.layers", i);
    face.layers.push_back({document.number(entry + ".refractive_index"), document.number(entry + ".thickness_um"),
                           document.number(entry + ".absorption_per_mm")});
  }
  face.film_coverage = document.number("entrance.film_coverage");
  face.water_index = document.number("entrance.water_index");
  face.drop_coverage = document.number("entrance.drop_coverage");
  face.drop_contact_angle_deg = document.number_if("entrance.drop_contact_angle_deg");
  face.dust_coverage = document.number("entrance.dust_coverage");
  face.dust_albedo = document.number_if("entrance.dust_albedo");
  face.dust_forward_fraction = document.number_if("entrance.dust_forward_fraction");
  face.scratch_coverage = document.number("entrance.scratch_coverage");
  face.scratch_spread_deg = document.number_if("entrance.scratch_spread_deg");
  face.scratch_azimuth_deg = document.number_if("entrance.scratch_azimuth_deg");
  face.haze = document.number("entrance.haze");
  face.haze_spread_deg = document.number_if("entrance.haze_spread_deg");
  face.roughness_sq_nm = document.number("entrance.roughness_sq_nm");
  face.correlation_length_um = document.number("entrance.correlation_length_um");
  return face;
}

Surface read_surface(const Document& document) {
  return {read_coating(document), read_entrance_face(document), document.text("surface.walls") == "absorbing",
          read_texture(document), read_form(document)};
}

std::variant<double, LightSpectrum> read_colour(const Document& document) {
  constexpr std::string_view key = "light.spectrum";
  if (!document.has(key)) return document.number("light.wavelength_nm");
  LightSpectrum spectrum;
  spectrum.photopic = document.text("light.weighting") == "photopic";
  if (document.is_list(key)) {
    spectrum.kind = LightSpectrum::Kind::lines;
    for (const std::vector<double>& line : document.rows(key)) spectrum.lines.push_back({line[0], line[1]});
    std::ranges::sort(spectrum.lines, {}, &LightSpectrum::Line::wavelength_nm);
    return spectrum;
  }
  const std::string word = document.text(key);
  spectrum.kind = word == "A"     ? LightSpectrum::Kind::illuminant_a
                  : word == "D65" ? LightSpectrum::Kind::illuminant_d65
                                  : LightSpectrum::Kind::file;
  if (spectrum.kind != LightSpectrum::Kind::file) return spectrum;
  spectrum.name = word;
  spectrum.file = document.file(key);
  return spectrum;
}

raytrace::Stokes read_polarisation(const Document& document) {
  constexpr std::string_view key = "light.polarisation";
  if (document.is_list(key)) {  // Stokes parameters, which are divided by i
    const std::vector<double> given = document.numbers(key);
    return {1.0, given[1] / given[0], given[2] / given[0], given[3] / given[0]};
  }
  const std::string word = document.text(key);
  if (word == "right_circular") return {1.0, 0.0, 0.0, 1.0};
  if (word == "left_circular") return {1.0, 0.0, 0.0, -1.0};
  if (word != "linear") return raytrace::kUnpolarised;
  const auto [sine, cosine] = sin_cos_deg(2.0 * document.number("light.polarisation_angle_deg"));
  return {1.0, cosine, sine, 0.0};
}

std::vector<double> read_acceptance(const Document& document) {
  std::vector<double> angles_deg = document.numbers("detector.acceptance_half_angle_deg");
  std::sort(angles_deg.begin(), angles_deg.end());
  angles_deg.erase(std::unique(angles_deg.begin(), angles_deg.end()), angles_deg.end());
  return angles_deg;
}

/// Reads the glass catalogue that contains the material. Returns nothing if the document has no such key.
std::optional<GlassCatalogueFile> read_catalogue(const Document& document) {
  if (!document.has("body.catalogue")) return std::nullopt;
  return GlassCatalogueFile{document.text("body.catalogue"), document.file("body.catalogue")};
}

/// Returns the name of the material. If the catalogue is a file with a single index record, the name of the file is
/// returned. The design then need not give the name of the material.
std::string read_material(const Document& document) {
  std::string material = document.text("body.material");
  if (!document.has("body.catalogue") || !materials::is_index_record(document.file("body.catalogue"))) return material;
  const std::string recorded = printable(document.file("body.catalogue").stem().string());
  if (document.has("body.material") && material != recorded)
    document.fail("body.material",
                  fmt::format("must be left out or be {}, the material in the file of body.catalogue, got {}",
                              in_quotes(recorded), in_quotes(material)));
  return recorded;
}

/// Reads the selection of wet elements. Returns nothing if the document has no table [wet_back].
std::optional<WetElements> read_wet_back(const Document& document) {
  if (!document.has("wet_back")) return std::nullopt;
  WetElements wet{document.number("wet_back.index"), {}};
  if (const auto share = document.number_if("wet_back.fraction")) {
    wet.where = geometry::RandomFraction{*share, static_cast<std::uint32_t>(document.number("wet_back.seed"))};
  } else if (document.has("wet_back.rectangle_mm")) {
    const std::vector<double> r = document.numbers("wet_back.rectangle_mm");
    wet.where = geometry::Rectangle{{r[0], r[1]}, {r[2], r[3]}};
  } else if (document.has("wet_back.disc_mm")) {
    const std::vector<double> d = document.numbers("wet_back.disc_mm");
    wet.where = geometry::Disc{{d[0], d[1]}, d[2]};
  } else {
    const std::vector<double> h = document.numbers("wet_back.half_plane");
    wet.where = geometry::HalfPlane{{h[0], h[1]}, h[2]};
  }
  return wet;
}

std::vector<OuterShell> read_shells(const Document& document) {
  std::vector<OuterShell> shells;
  for (std::size_t k = 0; k < document.count("shell"); ++k) {
    const auto key = [&](std::string_view name) { return schema::path_in(schema::path_of_entry("shell", k), name); };
    shells.push_back({.thickness_mm = document.number(key("thickness_mm")),
                      .gap_mm = document.number(key("gap_mm")),
                      .material = document.text(key("material")),
                      .refractive_index = document.number_if(key("refractive_index")),
                      .absorption_per_mm = read_absorption(document, key("absorption_per_mm")),
                      .outer_radius_mm = document.number_if(key("outer_radius_mm")),
                      .inner_radius_mm = document.number_if(key("inner_radius_mm")),
                      .wedge_deg = pair_of(document, key("wedge_deg")),
                      .tilt_deg = pair_of(document, key("tilt_deg"))});
  }
  return shells;
}

/// Returns the design of a document. Of the files that are named in the document, only DXF and STEP files are read.
Design resolved(std::shared_ptr<const Document> given) {
  const Document& document = *given;
  schema::check(document, design_format().root, "", &document);
  Design design;
  design.source = document.source();
  design.title = document.text_if("title");
  design.shape = read_shape(document);
  design.entrance = read_entrance(document);
  design.shells = read_shells(document);
  design.substance = {read_material(document),
                      read_catalogue(document),
                      document.number_if("body.refractive_index"),
                      document.number_if("body.temperature_c"),
                      read_absorption(document, "body.absorption_per_mm"),
                      document.number("body.back_index")};
  if (document.has("element.hollow") && document.flag("element.hollow")) {
    design.substance.is_hollow = true;
    design.substance.material = "air";
    design.substance.refractive_index = 1.0;
    design.substance.absorption_per_mm = 0.0;
  }
  design.wet_back = read_wet_back(document);
  design.surface = read_surface(document);
  design.light = {read_colour(document), read_polarisation(document)};
  design.detector.acceptance_half_angle_deg = read_acceptance(document);
  design.idealisation = {document.text("idealisation.facets") == "mirror",
                         document.text("idealisation.entrance") == "lossless"};
  design.document = std::move(given);
  find_pin_angle(design);
  read_step_faces(design);
  find_offset(design);
  return design;
}

}  // namespace

void set_where(Design& design, const std::string& key, InputLocation place) {
  auto changed =
      design.document ? std::make_shared<Document>(*design.document) : std::make_shared<Document>(design_format().root);
  changed->set(key, {}, std::move(place));
  design.document = std::move(changed);
}

Design parse_design(std::string_view text, const std::string& source_name, std::span<const std::string> overrides) {
  return resolved(std::make_shared<const Document>(
      schema::read_document(design_format(), text, source_name, kMaxDesignBytes, overrides)));
}

Design with(const Design& design, std::span<const std::string> overrides) {
  const bool is_of_file = design.document && !design.document->origin().text.empty();
  if (!is_of_file) return parse_design(design_text(design), design.source, overrides);
  Design changed =
      resolved(std::make_shared<const Document>(schema::with(design_format(), *design.document, overrides)));
  changed.source = design.source;
  return changed;
}

/// Keys whose values are names of files. A store of study results lists the files of a design in this order and is
/// valid only for this list. New keys must therefore be appended at the end.
constexpr std::array<std::string_view, 14> kFilesOfStores = {"part.mesh",
                                                             "array.mask",
                                                             "surface.height_map",
                                                             "part.facets",
                                                             "light.spectrum",
                                                             "entrance_surface.turned_part",
                                                             "entrance_surface.mesh",
                                                             "body.catalogue",
                                                             "form.map",
                                                             "outline.dxf",
                                                             "outline.file",
                                                             "entrance_surface.file",
                                                             "substrate.file",
                                                             "part.solid"};

std::vector<NamedFile> files_named(std::string_view text, const std::string& source_name,
                                   std::span<const std::string> overrides) {
  const Document document = schema::unchecked_names(design_format(), text, source_name, kMaxDesignBytes, overrides);
  std::vector<std::string> keys = document.keys_of_files();
  const auto rank = [](const std::string& key) { return std::ranges::find(kFilesOfStores, key); };
  std::stable_sort(keys.begin(), keys.end(),
                   [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  std::vector<NamedFile> files;
  for (const std::string& key : keys) files.push_back({document.file(key), key, document.where(key)});
  return files;
}

std::string read_toml_text(const fs::path& file) {
  return file == "-" ? read_standard_input(kMaxDesignBytes) : read_file(file, kMaxDesignBytes);
}

Design read_design(const fs::path& file, std::span<const std::string> overrides) {
  if (file != "-") return parse_design(read_toml_text(file), file.string(), overrides);
  Design design = parse_design(read_toml_text(file), "standard input", overrides);
  design.source = file.string();
  return design;
}

}  // namespace retrace::design

#include "design/optical_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>

#include "core/infinity.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "design/entrance_condition.h"
#include "design/entrance_of_design.h"
#include "design/form_of_design.h"
#include "design/light_and_index.h"
#include "design/part_of_design.h"
#include "design/shells_of_design.h"
#include "surface_models/form.h"

namespace retrace::design {

namespace {

constexpr double kMaxFringesPerStep = 0.5;
constexpr std::string_view kFacetLayers = "coating.facets";
constexpr std::string_view kEntranceLayers = "coating.entrance";

/// Returns the height map in the orientation of the facet, with its x axis horizontal and its form removed. Warnings
/// are appended.
surface_models::HeightMap levelled_map(const HeightMapTexture& t, const std::string& source, Warnings& warnings) {
  const surface_models::HeightMap level = facet_aligned_map(t.file, t.horizontal_axis, source, warnings);
  try {
    return surface_models::without_form(level, t.form_degree);
  } catch (const InputError& error) {
    throw InputError({t.file.string(), 0, ""}, error.what());
  }
}

/// Returns the measured height map of the facets, or nothing if their texture has another model. Warnings are appended.
std::optional<surface_models::HeightMap> facet_map(const Design& design, Warnings& warnings) {
  const auto* const texture = std::get_if<HeightMapTexture>(&design.surface.texture);
  if (texture == nullptr) return std::nullopt;
  try {
    return levelled_map(*texture, design.source_name(), warnings);
  } catch (const InputError& error) {
    throw InputError(design.where_texture(), error.what());  // adds the position of the key that names the file
  }
}

surface_models::ScatterModel height_map_model(const HeightMapTexture& t, const surface_models::HeightMap& map,
                                              double wavelength_nm) {
  try {
    return surface_models::HeightMapScatter(map, wavelength_nm);
  } catch (const InputError& error) {
    throw InputError({t.file.string(), 0, ""}, error.what());
  }
}

/// Returns the Harvey-Shack scatter model of a texture.
/// \param optics optical properties of the part, complete except for the texture
surface_models::ScatterModel harvey_shack_model(const HarveyShackTexture& t, const raytrace::Optics& optics) {
  const surface_models::Roughness heights = {t.roughness_sq_nm, t.correlation_length_um, t.waviness_sq_nm,
                                             t.waviness_length_um, t.down_correlation_length_um};
  if (optics.mirror_facets || !optics.facet_layers.layers.empty()) return surface_models::HarveyShack(heights);
  return surface_models::HarveyShack(heights, {optics.index, optics.back_index, optics.wavelength_nm});
}

/// Returns the scatter model of the facets' texture.
/// \param map result of facet_map()
/// \param optics optical properties of the part, complete except for the texture
surface_models::ScatterModel scatter_model(const Design& design, const std::optional<surface_models::HeightMap>& map,
                                           const raytrace::Optics& optics) {
  using surface_models::ScatterModel;
  using surface_models::SlopeShape;
  try {
    return std::visit(
        Overloaded{[](const SmoothTexture&) { return ScatterModel(surface_models::Smooth()); },
                   [&](const HarveyShackTexture& t) { return harvey_shack_model(t, optics); },
                   [](const AbgTexture& t) { return ScatterModel(surface_models::Abg(t.a, t.b, t.g)); },
                   [](const MicrofacetTexture& t) {
                     return ScatterModel(surface_models::Microfacet::of_waviness(
                         t.ggx ? SlopeShape::ggx : SlopeShape::beckmann, t.waviness_sq_nm, t.waviness_length_um));
                   },
                   [&](const HeightMapTexture& t) { return height_map_model(t, *map, optics.wavelength_nm); }},
        design.surface.texture);
  } catch (const InputError& error) {
    throw InputError(design.where_texture(), error.what());  // adds the position at which the values were given
  }
}

/// Returns the complex refractive index of a coating layer, relative to air.
/// \throw InputError at `where` if the material has no index at this wavelength
std::complex<double> index_of_layer(const Design& design, const materials::MaterialLibrary& library,
                                    const CoatingLayer& layer, const InputLocation& where, double wavelength_nm) {
  if (layer.material.empty()) return {layer.refractive_index, layer.extinction_coefficient};
  const double air = materials::refractive_index(library.air().dispersion, wavelength_nm);
  return std::visit(
      Overloaded{
          [&](const materials::Material* material) {
            // The power decreases as exp(-4 pi k / wavelength) per unit of length. The extinction coefficient k is
            // relative to air.
            const double extinction = materials::absorption_per_mm(*material, wavelength_nm) * 1e-6 * wavelength_nm /
                                      (4.0 * std::numbers::pi * air);
            return std::complex<double>(
                index_at_wavelength(design, *material, library.air(), wavelength_nm, material->temperature_c),
                extinction);
          },
          [&](const materials::Metal* metal) { return materials::complex_index(metal->model, wavelength_nm) / air; }},
      library.find_any(layer.material, where));
}

/// Returns the layers of a coating with their indices at one wavelength.
/// \param list key of the list of layers
materials::LayerStack stack_of(const Design& design, const materials::MaterialLibrary& library,
                               const std::vector<CoatingLayer>& layers, std::string_view list, double wavelength_nm) {
  const double air = materials::refractive_index(library.air().dispersion, wavelength_nm);
  materials::LayerStack stack;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string entry = schema::path_of_entry(list, i);
    const CoatingLayer& layer = layers[i];
    const std::complex<double> index =
        index_of_layer(design, library, layer, design.where(entry + ".material"), wavelength_nm);
    if (!layer.thickness_nm && !(index.imag() > 0.0))
      throw InputError(
          design.where(entry + ".thickness_nm"),
          fmt::format("is missing: it may be left out only for metals, but {} is not a metal", layer.material));
    stack.layers.push_back({index, layer.thickness_nm ? *layer.thickness_nm * air / wavelength_nm : kInfinity});
  }
  return stack;
}

/// Returns the optical properties of the part at one wavelength.
/// \param map result of facet_map()
raytrace::Optics optics_at(const Design& design, const materials::Material& material,
                           const materials::MaterialLibrary& library,
                           const std::optional<surface_models::HeightMap>& map, double wavelength_nm) {
  raytrace::Optics optics;
  optics.mirror_facets = design.idealisation.mirror_facets;
  optics.back_index = design.substance.back_index;
  const Coating& coating = design.surface.coating;
  optics.facet_layers = stack_of(design, library, coating.facets, kFacetLayers, wavelength_nm);
  optics.entrance_layers = stack_of(design, library, coating.entrance, kEntranceLayers, wavelength_nm);
  optics.absorbing_walls = design.surface.absorbing_walls;
  optics.wavelength_nm = wavelength_nm;
  optics.lossless_entrance = design.idealisation.lossless_entrance;
  optics.absorption_per_mm =
      absorption_at(design, design.substance.absorption_per_mm, "body.absorption_per_mm", material, wavelength_nm);
  optics.index = index_of_body(design, material, library.air(), wavelength_nm);
  optics.shells = shells_at(design, library, wavelength_nm);
  optics.entrance = condition_of(design, optics);
  optics.facet_scatter = scatter_model(design, map, optics);
  return optics;
}

bool is_valid_at(const materials::Metal& metal, double wavelength_nm) {
  return wavelength_nm >= metal.valid_from_nm && wavelength_nm <= metal.valid_to_nm;
}

/// Returns the interference order of a stack of layers at normal incidence, summed over all layers.
double orders_in(const materials::LayerStack& stack) {
  double orders = 0.0;
  for (const materials::ThinLayer& layer : stack.layers)
    if (std::isfinite(layer.thickness)) orders += 2.0 * layer.index.real() * layer.thickness;
  return orders;
}

/// Adds a warning if the index of a material or a metal is extrapolated beyond its data.
template <class Substance>
void warn_of_extrapolation(const Design& design, const Substance& substance, OpticalModel& model) {
  std::vector<double> outside_nm;
  double share = 0.0;
  for (const SpectralOptics& at : model.spectral) {
    if (is_valid_at(substance, at.wavelength_nm)) continue;
    outside_nm.push_back(at.wavelength_nm);
    share += at.weight;
  }
  if (outside_nm.empty()) return;
  const std::string data = fmt::format("{}: the data of {} cover {} to {} nm; its index ", design.source_name(),
                                       substance.name, substance.valid_from_nm, substance.valid_to_nm);
  model.warnings.push_back(
      {"index_extrapolated",
       model.spectral.size() == 1
           ? data + fmt::format("at {} nm is extrapolated", outside_nm.front())
           : data + fmt::format("is extrapolated for {:.2g} % of the light, at {} wavelengths from {:.0f} to {:.0f} nm",
                                100.0 * share, outside_nm.size(), outside_nm.front(), outside_nm.back())});
}

/// Adds warnings about coatings: indices that are extrapolated, and interference fringes that the few traced
/// wavelengths do not resolve. Each material causes at most one warning.
void add_coating_warnings(const Design& design, const materials::MaterialLibrary& library, OpticalModel& model) {
  std::vector<std::string> told = {design.substance.refractive_index ? "" : design.substance.material, ""};
  for (const auto* const layers : {&design.surface.coating.facets, &design.surface.coating.entrance})
    for (const CoatingLayer& layer : *layers) {
      if (std::ranges::count(told, layer.material) > 0) continue;
      told.push_back(layer.material);
      std::visit([&](const auto* substance) { warn_of_extrapolation(design, *substance, model); },
                 library.find_any(layer.material));
    }
  if (!design.light.spectrum() || design.light.spectrum()->kind == LightSpectrum::Kind::lines) return;
  for (const auto stack : {&raytrace::Optics::facet_layers, &raytrace::Optics::entrance_layers}) {
    double fringes = 0.0;  // maximum number of fringes between neighbouring traced wavelengths
    for (std::size_t k = 1; k < model.spectral.size(); ++k)
      fringes = std::max(fringes, std::abs(orders_in(model.spectral[k].optics.*stack) -
                                           orders_in(model.spectral[k - 1].optics.*stack)));
    if (fringes > kMaxFringesPerStep)
      model.warnings.push_back(
          {"unresolved_fringes",
           fmt::format(
               "{}: the layers have up to {:.1f} interference fringes between neighbouring wavelengths of the "
               "computation; the fringes are therefore not resolved, and averages over the spectrum may be inaccurate",
               design.source_name(), fringes)});
  }
}

/// Adds a warning if the index is extrapolated beyond the temperature range of the thermo-optic data.
void warn_of_temperature(const Design& design, const materials::Material& material, OpticalModel& model) {
  const double temperature_c = design.substance.temperature_c.value_or(material.temperature_c);
  if (temperature_c == material.temperature_c) return;
  const materials::ThermoOptic& data = *material.thermo_optic;
  if (temperature_c >= data.valid_from_c && temperature_c <= data.valid_to_c) return;
  model.warnings.push_back(
      {"thermo_optic_extrapolated",
       fmt::format("{}: the thermo-optic data of {} cover {} to {} C; its refractive index at {} C is extrapolated",
                   design.source_name(), material.name, shortest(data.valid_from_c), shortest(data.valid_to_c),
                   shortest(temperature_c))});
}

/// Adds the warnings of a texture's model about its range of validity. Only the first wavelength with warnings is
/// reported.
/// \param name beginning of the warnings
/// \param texture function that returns the texture of the face at one wavelength
/// \param behind function that returns the index of the medium on the other side of the face
/// \throw InputError at `where` if the texture is outside the range of every model
template <class Texture, class Behind>
void add_texture_warnings(const std::string& name, const InputLocation& where, const Texture& texture,
                          const Behind& behind, OpticalModel& model) {
  bool is_told = false;
  for (const SpectralOptics& at : model.spectral) {
    const double index = std::max(at.optics.index, behind(at.optics));
    try {
      surface_models::require_in_range(texture(at.optics), index, at.wavelength_nm);
    } catch (const InputError& error) {
      throw InputError(where, error.what());
    }
    if (is_told) continue;
    for (const Warning& warning : surface_models::warnings(texture(at.optics), index, at.wavelength_nm)) {
      model.warnings.push_back({warning.id, fmt::format("{}: {}", name, warning.text)});
      is_told = true;
    }
  }
}

void add_texture_warnings(const Design& design, OpticalModel& model) {
  using raytrace::Optics;
  add_texture_warnings(
      design.source_name(), design.where_texture(), [](const Optics& o) -> const auto& { return o.facet_scatter; },
      [](const Optics& o) { return o.back_index; }, model);
  add_texture_warnings(
      design.source_name() + ": entrance face", design.where("entrance.roughness_sq_nm"),
      [](const Optics& o) -> const auto& { return o.entrance.roughness; }, [](const Optics&) { return 1.0; }, model);
}

raytrace::Optics with_back_index(const Design& design, raytrace::Optics optics, double back_index) {
  optics.back_index = back_index;
  if (const auto* const texture = std::get_if<HarveyShackTexture>(&design.surface.texture))
    optics.facet_scatter = harvey_shack_model(*texture, optics);
  return optics;
}

/// Sets the index of the medium behind the selected elements of a design.
void wet(const Design& design, const std::shared_ptr<const geometry::ChosenElements>& chosen,
         raytrace::Optics& optics) {
  if (chosen->is_empty()) return;
  raytrace::Optics wet_optics = with_back_index(design, optics, design.wet_back->index);
  if (chosen->contains_all())
    optics = std::move(wet_optics);
  else
    optics.wet = std::make_shared<const raytrace::WetBack>(raytrace::WetBack{std::move(wet_optics), chosen});
}

/// Sets the selected wet elements in the model, at every wavelength.
void add_wet_back(const Design& design, OpticalModel& model) {
  model.wet_elements = std::make_shared<const geometry::ChosenElements>(model.part, design.wet_back->where);
  for (SpectralOptics& at : model.spectral) wet(design, model.wet_elements, at.optics);
  model.optics = model.spectral[model.nearest_wavelength()].optics;
}

}  // namespace

std::size_t OpticalModel::nearest_wavelength() const {
  const auto nearest =
      std::min_element(spectral.begin(), spectral.end(), [this](const SpectralOptics& a, const SpectralOptics& b) {
        return std::abs(a.wavelength_nm - wavelength_nm) < std::abs(b.wavelength_nm - wavelength_nm);
      });
  return static_cast<std::size_t>(nearest - spectral.begin());
}

OpticalModel make_model(const Design& design, const materials::MaterialLibrary& library) {
  require_supported(design, {.what = {}, .solids = true, .entrances = true, .shells = true, .wet_backs = true});
  OpticalModel model = make_light_model(design, library);
  model.part = part_of_design(design, &model.warnings);
  if (design.entrance) model.entrance = entrance_of_design(design, model.part);
  if (!design.shells.empty()) clearances_of_shells(design, model.optics.shells, model.part, model.entrance);
  if (design.wet_back) add_wet_back(design, model);
  return model;
}

struct OpticsOfDesign::Impl {
  const Design& design;
  const materials::MaterialLibrary& library;
  materials::Material material;
  std::optional<surface_models::HeightMap> map;
  surface_models::FacetForm form;
};

OpticsOfDesign::OpticsOfDesign(const Design& design, const materials::MaterialLibrary& library, Warnings& warnings) {
  materials::Material material = material_of(design, library);
  append(warnings, material.warnings);
  if (!design.substance.refractive_index) require_temperature(design, material);
  std::optional<surface_models::HeightMap> map = facet_map(design, warnings);
  impl_ = std::make_unique<const Impl>(
      Impl{design, library, std::move(material), std::move(map), form_of_design(design, warnings)});
}
OpticsOfDesign::~OpticsOfDesign() = default;

raytrace::Optics OpticsOfDesign::at(double wavelength_nm) const {
  const Impl& h = *impl_;
  raytrace::Optics optics = optics_at(h.design, h.material, h.library, h.map, wavelength_nm);
  optics.facet_form = h.form;
  return optics;
}

raytrace::Optics OpticsOfDesign::at(double wavelength_nm,
                                    const std::shared_ptr<const geometry::ChosenElements>& chosen) const {
  raytrace::Optics optics = at(wavelength_nm);
  if (chosen) wet(impl_->design, chosen, optics);
  return optics;
}

bool OpticsOfDesign::has_index_data_at(double wavelength_nm) const {
  return impl_->design.substance.refractive_index || is_valid_at(impl_->material, wavelength_nm);
}

const materials::Material& OpticsOfDesign::material() const {
  return impl_->material;
}

OpticalModel make_light_model(const Design& design, const materials::MaterialLibrary& library) {
  OpticalModel model;
  const materials::Spectrum light = wavelengths_to_trace(design);
  const OpticsOfDesign optics(design, library, model.warnings);
  for (std::size_t k = 0; k < light.size(); ++k)
    model.spectral.push_back({light.wavelengths_nm[k], light.weights[k], optics.at(light.wavelengths_nm[k])});
  model.wavelength_nm = light.centroid_nm();
  model.optics = model.spectral[model.nearest_wavelength()].optics;
  if (!design.substance.refractive_index) {
    warn_of_extrapolation(design, optics.material(), model);
    warn_of_temperature(design, optics.material(), model);
  }
  for (std::size_t k = 0; k < design.shells.size(); ++k)
    if (!design.shells[k].refractive_index && design.shells[k].material != design.substance.material)
      warn_of_extrapolation(design, material_of_shell(design, library, k), model);
  add_coating_warnings(design, library, model);
  add_texture_warnings(design, model);
  append(model.warnings, design.warnings());
  return model;
}

}  // namespace retrace::design

#include "studies/design/optical_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "surface_models/form.h"
#include "surface_models/io/height_map_reader.h"

namespace retrace::studies {

namespace {

constexpr double kMissingShareToTell = 0.05;

double index_at_wavelength(const Design& design, const materials::Material& material, const materials::Material& air) {
  try {
    return materials::index_relative_to_air(material, air, design.wavelength_nm);
  } catch (const InputError& error) {
    throw InputError(design.wavelength_location, error.what());  // which knows the number but not where it was given
  }
}

/// The map as it lies on a facet, x level. Warnings are appended.
surface_models::ScatterModel height_map_model(const FacetTexture& t, const std::string& source, double wavelength_nm,
                                              std::vector<std::string>& warnings) {
  using namespace surface_models;
  HeightMapOptions options;
  options.can_be_given = false;
  HeightMapFile file = read_height_map(t.height_map_file, options);
  const std::size_t points = file.map.heights_nm.size();
  const std::size_t missing = points - measured_points(file.map);
  if (static_cast<double>(missing) > kMissingShareToTell * static_cast<double>(points))
    file.warnings.push_back(fmt::format("{:.1f} % of the points are missing; they count as the mean height",
                                        100.0 * static_cast<double>(missing) / static_cast<double>(points)));
  const HeightMap level =
      t.height_map_level_axis == HeightMapAxis::x ? std::move(file.map) : turned_by_quarter(file.map);
  try {
    HeightMapScatter model(without_form(level, t.height_map_form_degree), wavelength_nm);
    for (const std::string& warning : file.warnings)
      warnings.push_back(fmt::format("{}: {}: {}", source, t.height_map_file.string(), warning));
    return model;
  } catch (const InputError& error) {
    throw InputError({t.height_map_file.string(), 0, ""}, error.what());
  }
}

surface_models::ScatterModel scatter_model(const Design& design, std::vector<std::string>& warnings) {
  using Model = FacetTexture::Model;
  const FacetTexture& t = design.texture;
  const auto shape = t.ggx ? surface_models::SlopeShape::ggx : surface_models::SlopeShape::beckmann;
  try {
    switch (t.model) {
      case Model::harvey_shack:
        return surface_models::HarveyShack(
            {t.roughness_sq_nm, t.correlation_length_um, t.waviness_sq_nm, t.waviness_length_um});
      case Model::abg:
        return surface_models::Abg(t.abg_a, t.abg_b, t.abg_g);
      case Model::microfacet:
        return surface_models::Microfacet::of_waviness(shape, t.waviness_sq_nm, t.waviness_length_um);
      case Model::height_map:
        return height_map_model(t, design.source_name(), design.wavelength_nm, warnings);
      case Model::smooth:
        break;
    }
    return surface_models::Smooth();
  } catch (const InputError& error) {
    throw InputError(t.location, error.what());  // which knows the values but not where they were given
  }
}

}  // namespace

raytrace::Optics make_optics(const Design& design, const materials::MaterialLibrary& library,
                             std::vector<std::string>& warnings) {
  const materials::Material& material = library.find(design.material, design.material_location);
  raytrace::Optics optics;
  optics.mirror_facets = design.idealisation.mirror_facets;
  optics.facet_scatter = scatter_model(design, warnings);
  optics.back_index = design.back_index;
  if (design.aluminised_facets)
    optics.coating_index = materials::complex_index(library.find_metal("aluminium").model, design.wavelength_nm) /
                           materials::refractive_index(library.air().dispersion, design.wavelength_nm);
  optics.absorbing_walls = design.texture.absorbing_walls;
  optics.wavelength_nm = design.wavelength_nm;
  optics.lossless_entrance = design.idealisation.lossless_entrance;
  optics.absorption_per_mm = design.absorption_per_mm.value_or(material.absorption_per_mm);
  if (design.refractive_index) {
    optics.index = *design.refractive_index;
    return optics;
  }
  optics.index = index_at_wavelength(design, material, library.air());
  if (!materials::is_valid_at(material, design.wavelength_nm))
    warnings.push_back(fmt::format("{}: the data of {} reach from {} to {} nm; its index at {} nm is extrapolated",
                                   design.source_name(), material.name, material.valid_from_nm, material.valid_to_nm,
                                   design.wavelength_nm));
  if (!(optics.index >= 1.0))
    throw InputError(design.material_location, fmt::format("the index of {} at {} nm must be >= 1, got {}",
                                                           material.name, design.wavelength_nm, optics.index));
  return optics;
}

namespace {

/// What the texture's model says of its range. \throw InputError beyond every model
void add_texture_warnings(const Design& design, OpticalModel& model) {
  const double index = std::max(model.optics.index, model.optics.back_index);
  const surface_models::ScatterModel& scatter = model.optics.facet_scatter;
  try {
    surface_models::require_in_range(scatter, index, design.wavelength_nm);
  } catch (const InputError& error) {
    throw InputError(design.texture.location, error.what());
  }
  for (const std::string& warning : surface_models::warnings(scatter, index, design.wavelength_nm))
    model.warnings.push_back(fmt::format("{}: {}", design.source_name(), warning));
}

}  // namespace

OpticalModel make_model(const Design& design, const materials::MaterialLibrary& library) {
  OpticalModel model;
  model.optics = make_optics(design, library, model.warnings);
  add_texture_warnings(design, model);
  model.part = geometry::build_part(design.part);
  return model;
}

}  // namespace retrace::studies

#include "studies/design/optical_model.h"

#include <fmt/format.h>

namespace retrace::studies {

namespace {

double index_at_wavelength(const Design& design, const materials::Material& material, const materials::Material& air) {
  try {
    return materials::index_relative_to_air(material, air, design.wavelength_nm);
  } catch (const InputError& error) {
    throw InputError(design.wavelength_location, error.what());  // which knows the number but not where it was given
  }
}

}  // namespace

raytrace::Optics make_optics(const Design& design, const materials::MaterialLibrary& library,
                             std::vector<std::string>& warnings) {
  const materials::Material& material = library.find(design.material, design.material_location);
  raytrace::Optics optics;
  optics.mirror_facets = design.idealisation.mirror_facets;
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

OpticalModel make_model(const Design& design, const materials::MaterialLibrary& library) {
  OpticalModel model;
  model.optics = make_optics(design, library, model.warnings);
  model.part = geometry::build_part(design.part);
  return model;
}

}  // namespace retrace::studies

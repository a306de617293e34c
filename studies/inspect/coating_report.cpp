#include "studies/inspect/coating_report.h"

namespace retrace::studies {
namespace {

/// Returns the report on the coating of a face, averaged over the wavelengths of the light.
/// \param at_wavelength function that returns the coefficients of the face at normal incidence
template <class Face>
CoatingReport report_of(const std::vector<design::CoatingLayer>& layers, const materials::LayerStack& stack,
                        const design::OpticalModel& model, const Face& at_wavelength) {
  CoatingReport report{layers, stack, 0.0, 0.0, 0.0};
  for (const design::SpectralOptics& light : model.spectral) {
    const materials::FresnelCoefficients f = at_wavelength(light.optics);
    report.reflectance += light.weight * std::norm(f.r_s);
    report.transmittance += light.weight * std::norm(f.t_s);
  }
  report.absorptance = stack.absorbs() ? 1.0 - report.reflectance - report.transmittance : 0.0;
  return report;
}

}  // namespace

CoatingReports report_coating(const design::Design& design, const design::OpticalModel& model) {
  const design::Coating& coating = design.surface.coating;
  CoatingReports reports;
  if (!coating.facets.empty() && !coating.has_only_aluminium_on_facets())
    reports.facets = report_of(coating.facets, model.optics.facet_layers, model, [&](const raytrace::Optics& optics) {
      const bool is_bowl = design.balls() && design.balls()->mirror_offset_mm > 0.0;
      return materials::fresnel_layers(optics.facet_layers, materials::StackSide::body,
                                       is_bowl ? optics.back_index : optics.index, optics.back_index, 1.0);
    });
  if (!coating.entrance.empty())
    reports.entrance =
        report_of(coating.entrance, model.optics.entrance_layers, model, [](const raytrace::Optics& optics) {
          return materials::fresnel_layers(optics.entrance_layers, materials::StackSide::outside, 1.0, optics.index,
                                           1.0);
        });
  return reports;
}

}  // namespace retrace::studies

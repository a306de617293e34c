#include "studies/inspect/entrance_state_report.h"

#include <numbers>

#include "raytrace/faces/contaminated_entrance.h"
#include "raytrace/light/light_setup.h"

namespace retrace::studies {
namespace {

/// Returns the mean reflectance for diffuse unpolarised light from the air, whose directions follow Lambert's law. The
/// integral over the cosine uses Simpson's rule.
double diffuse_reflectance(const raytrace::Optics& optics) {
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double cosine = static_cast<double>(k) / kSteps;
    const materials::FresnelCoefficients f = fresnel_at_entrance(optics, false, cosine);
    const double weight = k == 0 || k == kSteps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    sum += weight * 2.0 * cosine * 0.5 * (std::norm(f.r_s) + std::norm(f.r_p));
  }
  return sum / (3.0 * kSteps);
}

/// Returns the reflectance of dust and the face under it. It includes direct reflection by the dust, and light that
/// passes the dust two times, with all reflections between dust and face.
double dust_reflectance(const raytrace::Optics& optics) {
  const raytrace::Dust& dust = optics.entrance.dust;
  const double back = dust.albedo * (1.0 - dust.forward_fraction);
  const double forward = dust.albedo * dust.forward_fraction;
  const double face = diffuse_reflectance(optics);
  return dust.coverage * (back + forward * forward * face / (1.0 - back * face));
}

/// Returns the transmittance of the clean face, without light that its roughness scatters.
double specular_transmittance(const raytrace::Optics& optics, const materials::FresnelCoefficients& f) {
  if (!optics.entrance.is_rough()) return std::norm(f.t_s);
  const raytrace::Optics facet = entrance_as_facet(optics);
  return std::norm(mean_field(facet, false, 1.0, f).t_s) *
         mean_field_fraction(facet, false, 1.0, surface_models::Lobe::transmission);
}

}  // namespace

std::optional<EntranceStateReport> report_entrance_state(const design::Design& design,
                                                         const design::OpticalModel& model) {
  if (design.surface.entrance.is_clean()) return std::nullopt;
  EntranceStateReport report;
  const raytrace::EntranceCondition& face = model.optics.entrance;
  report.clean_fraction = 1.0 - face.covered_fraction();
  report.haze_fraction = face.haze.fraction;
  for (const design::SpectralOptics& at : model.spectral) {
    const materials::FresnelCoefficients f = fresnel_at_entrance(at.optics, false, 1.0);
    report.reflectance += at.weight * std::norm(f.r_s);
    report.transmittance += at.weight * std::norm(f.t_s);
    report.specular_transmittance +=
        at.weight * report.clean_fraction * (1.0 - report.haze_fraction) * specular_transmittance(at.optics, f);
    if (face.dust.coverage > 0.0)
      report.dust_cd_per_lx_m2 += at.weight * dust_reflectance(at.optics) / std::numbers::pi;
  }
  if (model.optics.entrance_absorbs()) report.absorptance = 1.0 - report.reflectance - report.transmittance;
  return report;
}

}  // namespace retrace::studies

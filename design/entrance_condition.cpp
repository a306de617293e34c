#include "design/entrance_condition.h"

#include <cmath>

#include "core/error.h"
#include "core/length_units.h"
#include "design/haze.h"

namespace retrace::design {
namespace {

double rad(double deg) {
  return Angle::from_deg(deg).rad();
}

surface_models::ScatterModel roughness_of(const Design& design, const raytrace::Optics& optics) {
  const EntranceState& face = design.surface.entrance;
  if (!(face.roughness_sq_nm > 0.0)) return surface_models::Smooth();
  try {
    const surface_models::Roughness heights = {face.roughness_sq_nm, face.correlation_length_um, 0.0, 0.0};
    if (!optics.entrance_layers.empty()) return surface_models::HarveyShack(heights);
    return surface_models::HarveyShack(heights, {optics.index, 1.0, optics.wavelength_nm});
  } catch (const InputError& error) {
    throw InputError(design.where("entrance.roughness_sq_nm"), error.what());
  }
}

}  // namespace

raytrace::EntranceCondition condition_of(const Design& design, const raytrace::Optics& optics) {
  const EntranceState& face = design.surface.entrance;
  raytrace::EntranceCondition condition;
  for (const ThickCoatingLayer& layer : face.layers)
    condition.layers.push_back({layer.refractive_index, kMmPerUm * layer.thickness_um, layer.absorption_per_mm});
  condition.film_coverage = face.film_coverage;
  condition.water_index = face.water_index;
  if (face.film_coverage > 0.0) condition.layers.push_back({face.water_index, 0.0, 0.0});
  if (face.drop_coverage > 0.0) condition.drops = {face.drop_coverage, rad(*face.drop_contact_angle_deg)};
  if (face.dust_coverage > 0.0) condition.dust = {face.dust_coverage, *face.dust_albedo, *face.dust_forward_fraction};
  if (face.scratch_coverage > 0.0) {
    condition.scratches = {face.scratch_coverage, std::sin(rad(*face.scratch_spread_deg)), {}};
    if (face.scratch_azimuth_deg) condition.scratches.azimuth_rad = rad(*face.scratch_azimuth_deg);
  }
  if (face.haze > 0.0)
    condition.haze = {std::min(1.0, face.haze / beyond_haze_angle(*face.haze_spread_deg)),
                      std::sin(rad(*face.haze_spread_deg))};
  condition.roughness = roughness_of(design, optics);
  return condition;
}

}  // namespace retrace::design

#include "surface_models/scatter/microfacet.h"

#include "core/error.h"
#include "core/number_format.h"
#include "surface_models/scatter/phase.h"

namespace retrace::surface_models {

Microfacet::Microfacet(SlopeShape shape, double rms_slope) : slopes_(shape, rms_slope) {
  if (!(rms_slope >= 0.0)) throw InputError({"", 0, "rms_slope"}, "must be >= 0, got " + shortest(rms_slope));
  require_slope_in_range(rms_slope, "facets");
}

Microfacet Microfacet::of_waviness(SlopeShape shape, double waviness_sq_nm, double waviness_length_um) {
  if (!(waviness_sq_nm >= 0.0))
    throw InputError({"", 0, "waviness_sq_nm"}, "must be >= 0, got " + shortest(waviness_sq_nm));
  if (waviness_sq_nm > 0.0 && !(waviness_length_um > 0.0))
    throw InputError({"", 0, "waviness_length_um"},
                     "must be > 0 if waviness_sq_nm is greater than 0, got " + shortest(waviness_length_um));
  Microfacet made(shape, waviness_rms_slope(waviness_sq_nm, waviness_length_um));
  made.waviness_sq_nm_ = waviness_sq_nm;
  return made;
}

Facet Microfacet::sample_facet(const ScatterEvent& event, RandomStream& random) const {
  return {slopes_.sample_visible_normal(-event.direction_in, random), true};
}

std::optional<Vec3> Microfacet::facet_towards(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const {
  if (!is_on_side(direction, lobe)) return std::nullopt;
  // The optical path does not change along the interface: n_to d_out - n_from d_in is parallel to the normal.
  Vec3 normal = event.index_of(lobe) * direction - event.index_from * event.direction_in;
  if (normal.squaredNorm() == 0.0) return std::nullopt;
  normal.normalize();
  if (normal.z() < 0.0) normal = -normal;
  const bool faces_light = normal.dot(event.direction_in) < 0.0;
  const bool faces_out = lobe == Lobe::reflection ? normal.dot(direction) > 0.0 : normal.dot(direction) < 0.0;
  if (!faces_light || !faces_out) return std::nullopt;
  return normal;
}

/// Returns the Jacobian of Walter et al., equations 14 and 17.
double Microfacet::jacobian(const ScatterEvent& event, Lobe lobe, const Vec3& direction, const Vec3& normal) const {
  const double cos_in = -event.direction_in.dot(normal);
  if (lobe == Lobe::reflection) return 1.0 / (4.0 * cos_in);
  const double cos_out = direction.dot(normal);
  const double path = event.index_from * cos_in + event.index_to * cos_out;
  return event.index_to * event.index_to * std::abs(cos_out) / (path * path);
}

double Microfacet::bsdf_per_sr(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const {
  const auto normal = facet_towards(event, lobe, direction);
  if (!normal) return 0.0;
  return slopes_.normal_density_per_sr(*normal) * slopes_.visible_fraction(event.direction_in) *
         slopes_.visible_fraction(direction) * -event.direction_in.dot(*normal) *
         jacobian(event, lobe, direction, *normal) / (event.cos_in() * std::abs(direction.z()));
}

double Microfacet::pdf_per_sr(const ScatterEvent& event, Lobe lobe, const Vec3& direction) const {
  const auto normal = facet_towards(event, lobe, direction);
  if (!normal) return 0.0;
  return slopes_.visible_normal_pdf_per_sr(-event.direction_in, *normal) * jacobian(event, lobe, direction, *normal);
}

Warnings Microfacet::warnings(double index, double wavelength_nm) const {
  Warnings found;
  if (slopes_.rms_slope() > kMaxSlopeWithoutWarning)
    found.push_back({"steep_facets", "the rms slope is " +
                                         fixed_apart(slopes_.rms_slope(), kMaxSlopeWithoutWarning, 3) +
                                         ", which is above " + shortest(kMaxSlopeWithoutWarning) +
                                         ": light that is reflected several times on the surface is not modelled"});
  const double phase = reflection_phase_rad(waviness_sq_nm_, index, 1.0, wavelength_nm);
  if (waviness_sq_nm_ > 0.0 && phase * phase < kSlopePhase2)
    found.push_back({"low_waviness", "a waviness of " + shortest(waviness_sq_nm_) +
                                         " nm is too low for the model microfacet, because this waviness diffracts "
                                         "light: use the model harvey_shack"});
  return found;
}

}  // namespace retrace::surface_models

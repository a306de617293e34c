#pragma once

// Interface of all scatter models for the tracers. It draws facets and directions, and returns specular fractions,
// BSDFs and ranges of validity.

#include <variant>

#include "core/warning.h"
#include "surface_models/scatter/abg.h"
#include "surface_models/scatter/harvey_shack.h"
#include "surface_models/scatter/height_map_scatter.h"
#include "surface_models/scatter/microfacet.h"
#include "surface_models/scatter/smooth.h"

namespace retrace::surface_models {

/// Model of the effect of a texture on light. Copies are cheap. All functions are const and may be called from any
/// thread. They allocate no memory unless stated.
///
/// An event in the tracer is processed as follows:
///
///     const Facet facet = sample_facet(model, event, random);
///     const auto f = materials::fresnel(event.index_from / event.index_to, -event.direction_in.dot(facet.normal));
///     // ... reflected and transmitted Stokes parameters at the facet, for both lobes or for one that is chosen
///     const auto out = sample(model, event, facet, Lobe::reflection, random);
///     // ... scale by out->weight; rotate the polarisation by the rotation from specular_direction to direction
using ScatterModel = std::variant<Smooth, HarveyShack, Abg, Microfacet, HeightMapScatter>;

/// Draws the surface element that the light hits.
Facet sample_facet(const ScatterModel& model, const ScatterEvent& event, RandomStream& random);

/// Draws the direction in which a facet sends the light of a lobe. Returns nothing in transmission under total
/// reflection, and if the direction is on the wrong side of the mean surface: that light is lost.
std::optional<ScatterSample> sample(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                    RandomStream& random);

/// Specular and scattered light of a lobe. The weight of each member includes its fraction of the lobe's power. A
/// member is not set if its light is lost to the wrong side.
struct ScatterSplit {
  std::optional<ScatterSample> specular;
  std::optional<ScatterSample> scattered;
};

/// Draws both the specular and the scattered light. This replaces sample() with equal expectation and lower variance.
/// Returns nothing if one of the fractions is below `min_fraction`, and for the models abg and microfacet, because they
/// cannot compute the fractions of an event quickly.
std::optional<ScatterSplit> sample_split(const ScatterModel& model, const ScatterEvent& event, const Facet& facet,
                                         Lobe lobe, double min_fraction, RandomStream& random);

/// Returns the model if it is a texture between dielectrics that uses first-order theory. For such a model, light that
/// is diffracted once belongs to both lobes. Returns null for other models.
const HarveyShack* first_order_model(const ScatterModel& model);

/// Returns the DiffractionMeans of an event.
/// \param fresnel coefficients at the facet
DiffractionMeans diffraction_means(const HarveyShack& model, const ScatterEvent& event, const Facet& facet,
                                   const materials::FresnelCoefficients& fresnel);

/// Draws light that is diffracted once. Returns nothing if it is on the wrong side of the mean surface.
/// \param s_axis normal to the light and to the facet's normal
/// \param coherency coherency of the incident light along s_axis and p, with the trace 1
/// \param unmasked set to the fraction of light that waviness does not mask
std::optional<DiffractedOnce> sample_diffracted_once(const HarveyShack& model, const ScatterEvent& event,
                                                     const Facet& facet, const Vec3& s_axis,
                                                     const Polarisation2& coherency, RandomStream& random,
                                                     double& unmasked);

/// Draws light of a lobe that is diffracted more than once. Otherwise works like sample().
std::optional<ScatterSample> sample_diffracted_again(const HarveyShack& model, const ScatterEvent& event,
                                                     const Facet& facet, Lobe lobe, RandomStream& random);

/// Returns the fraction of a lobe's power that leaves in the facet's specular direction, without masking. Returns 0 if
/// there is no such direction.
double specular_fraction(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe);

/// Returns the fraction of a lobe's power in the mean field over all realisations of the texture: light that is
/// specular relative to the mean surface. Tilted facets (microfacet) have less than 5e-5, which is treated as 0. For
/// abg this is a lower bound, the power that its BSDF does not scatter.
double mean_field_fraction(const ScatterModel& model, const ScatterEvent& event, Lobe lobe);

/// Returns true if a model determines the phase of light, so that fields can be added. This holds only for harvey_shack
/// without a lay (equal correlation lengths along x and y). The measured scatter of abg and the slopes of microfacet
/// contain no phases, and height_map supports only rays.
bool has_phases(const ScatterModel& model);

/// Returns the random phase of a lobe's light at the mean surface, even if the waves are high. The variance is 0 if
/// there is no such lobe.
/// \pre has_phases()
PhaseTexture phase_texture(const ScatterModel& model, const ScatterEvent& event, Lobe lobe);

/// Returns the BSDF of the scattered light of a lobe for a given facet, per sr, without the Fresnel factor and the
/// specular light. The cosine in the definition of the BSDF is that of the angle to the facet's normal. Some models use
/// quadrature, so this function is for tests and tables.
double evaluate(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe,
                const Vec3& direction);

/// Returns the density with which sample() draws `direction` as scattered light, per sr.
double pdf(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& direction);

/// Checks that a model applies to a texture. Most models check this in their constructor. For harvey_shack, the result
/// depends on the index and wavelength, because they determine which part of the roughness scatters.
/// \param index index of the denser side
/// \throw InputError if no model applies
void require_in_range(const ScatterModel& model, double index, double wavelength_nm);

/// Returns one sentence for each condition of the model that is violated. Allocates memory.
/// \param index index of the denser side
Warnings warnings(const ScatterModel& model, double index, double wavelength_nm);

}  // namespace retrace::surface_models

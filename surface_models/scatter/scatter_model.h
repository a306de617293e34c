#pragma once

// The interface of all scatter models to the tracers: draw a facet, draw a direction, tell specular shares, BSDF and
// range of validity.

#include <string>
#include <variant>
#include <vector>

#include "core/warning.h"
#include "surface_models/scatter/abg.h"
#include "surface_models/scatter/harvey_shack.h"
#include "surface_models/scatter/height_map_scatter.h"
#include "surface_models/scatter/microfacet.h"
#include "surface_models/scatter/smooth.h"

namespace retrace::surface_models {

/// What a texture does to light. Copies are cheap; all functions are const, safe to call from any thread and, but where
/// they say so, free of allocation.
///
/// One event in the tracer:
///
///     const Facet facet = sample_facet(model, event, random);
///     const auto f = materials::fresnel(event.index_from / event.index_to, -event.direction_in.dot(facet.normal));
///     // ... reflected and transmitted Stokes parameters at the facet, for both lobes or for one that is chosen
///     const auto out = sample(model, event, facet, Lobe::reflection, random);
///     // ... scale by out->weight; turn the polarisation as specular_direction turns into direction
using ScatterModel = std::variant<Smooth, HarveyShack, Abg, Microfacet, HeightMapScatter>;

/// Draws the piece of the surface that the light meets.
Facet sample_facet(const ScatterModel& model, const ScatterEvent& event, RandomStream& random);

/// Draws where a facet sends the light of a lobe. Nothing under total reflection in transmission, and where the
/// direction runs to the wrong side of the mean surface: that light is lost.
std::optional<ScatterSample> sample(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe,
                                    RandomStream& random);

/// The specular and the scattered light of a lobe, each with its share of the power in its weight. Nothing in place of
/// one that is lost to the wrong side.
struct ScatterSplit {
  std::optional<ScatterSample> specular;
  std::optional<ScatterSample> scattered;
};

/// Draws both at once, in place of sample(): the same on average, with less chance. Nothing where either share is below
/// `least_share`, and in models that cannot tell the shares of one event quickly (abg, microfacet).
std::optional<ScatterSplit> sample_split(const ScatterModel& model, const ScatterEvent& event, const Facet& facet,
                                         Lobe lobe, double least_share, RandomStream& random);

/// A texture between dielectrics whose light that is diffracted once belongs to no lobe alone; null for others.
const HarveyShack* first_order_model(const ScatterModel& model);

/// DiffractionMeans of an event. \param fresnel at the facet
DiffractionMeans diffraction_means(const HarveyShack& model, const ScatterEvent& event, const Facet& facet,
                                   const materials::FresnelCoefficients& fresnel);

/// Light that is diffracted once. Nothing where it runs to the wrong side of the mean surface. \param s_axis across the
/// light and the facet's normal \param coherency of the incident light along s_axis and p, of trace 1 \param
/// unmasked set to the share that waviness lets by
std::optional<DiffractedOnce> sample_diffracted_once(const HarveyShack& model, const ScatterEvent& event,
                                                     const Facet& facet, const Vec3& s_axis,
                                                     const Polarisation2& coherency, RandomStream& random,
                                                     double& unmasked);

/// Light of a lobe that is diffracted more than once, as sample().
std::optional<ScatterSample> sample_diffracted_again(const HarveyShack& model, const ScatterEvent& event,
                                                     const Facet& facet, Lobe lobe, RandomStream& random);

/// Share of a lobe's power that leaves in the facet's specular direction, masking aside; 0 without such a direction.
double specular_share(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe);

/// Share of a lobe's power that the mean field over all textures of a model keeps: light that is specular to the
/// mean surface. Facets that tilt (microfacet) keep less than 5e-5, and count as none; abg keeps at least what its
/// BSDF leaves.
double mean_field_share(const ScatterModel& model, const ScatterEvent& event, Lobe lobe);

/// Whether a model knows what its heights do to the phase of light, so that fields can be added up: harvey_shack alone.
/// The measured scatter of abg and the slopes of microfacet say nothing of phases; of height_map only rays are made.
bool has_phases(const ScatterModel& model);

/// Of a lobe's light at the mean surface, however high the waves are; none of its variance where there is no such lobe.
/// \pre has_phases()
PhaseTexture phase_texture(const ScatterModel& model, const ScatterEvent& event, Lobe lobe);

/// BSDF of the scattered light of a lobe given the facet, per sr, without Fresnel's factor and the specular light; its
/// cosine is that to the facet's normal. By quadrature in some models: for tests and tables.
double evaluate(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe,
                const Vec3& direction);

/// Density with which sample() draws `direction` as scattered light, per sr.
double pdf(const ScatterModel& model, const ScatterEvent& event, const Facet& facet, Lobe lobe, const Vec3& direction);

/// \throw InputError for a texture that no model holds for. Most are refused when they are made; harvey_shack needs to
/// know which of its roughness scatters. \param index of the denser side
void require_in_range(const ScatterModel& model, double index, double wavelength_nm);

/// What lies outside the range in which the model holds, one sentence each. Allocates.
/// \param index of the denser side
Warnings warnings(const ScatterModel& model, double index, double wavelength_nm);

}  // namespace retrace::surface_models

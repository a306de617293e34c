#pragma once

// The optical properties of a part at one wavelength, and the direction and polarization of the incident beam.

#include <memory>

#include "core/angle.h"
#include "materials/thin_film.h"
#include "raytrace/light/entrance_condition.h"
#include "raytrace/light/shells.h"
#include "raytrace/light/stokes.h"
#include "surface_models/facet_form.h"
#include "surface_models/scatter/scatter_model.h"

namespace retrace::geometry {
class ChosenElements;
}

namespace retrace::raytrace {

struct WetBack;

/// Optical properties of the body and the faces of a part, at one wavelength.
struct Optics {
  double index = 1.0;                     ///< refractive index of the body, relative to the air around it; >= 1
  double back_index = 1.0;                ///< refractive index of the medium behind the back, relative to the air
  double absorption_per_mm = 0.0;         ///< absorption coefficient of the power, base e
  bool mirror_facets = false;             ///< retro facets reflect all light
  materials::LayerStack facet_layers;     ///< layers on the retro facets; one of them may be opaque
  materials::LayerStack entrance_layers;  ///< layers on the entrance face; all of them transmit light
  EntranceCondition entrance;             ///< further properties of the entrance face
  bool lossless_entrance = false;         ///< entrance refracts with T = 1; light beyond the critical angle ends there
  bool absorbing_walls = false;           ///< walls of elements and of the border absorb all light
  surface_models::ScatterModel facet_scatter;  ///< scattering by the texture of retro facets
  surface_models::FacetForm facet_form;        ///< deviation of retro facets from their planes
  double wavelength_nm = 587.56;               ///< in vacuum; used only for scattering
  Shells shells;                               ///< separate lenses in front of the entrance face
  std::shared_ptr<const WetBack> wet;          ///< elements whose medium behind the back has another index than
                                               ///< `back_index`; null if there are none

  /// Returns the refractive index before a face of the back surface divided by the index after the face.
  double ratio_at_back(bool inside) const { return inside ? index / back_index : back_index / index; }
  /// Returns true if border walls, below z = 0, have other optical properties than the sides of the plate above them.
  bool border_walls_differ() const { return absorbing_walls || back_index != 1.0; }
  /// Returns true if facets do not scatter, so that a beam remains a beam at each facet.
  bool is_smooth() const { return std::holds_alternative<surface_models::Smooth>(facet_scatter); }
  /// Returns true if the medium behind all elements is the same.
  bool has_uniform_backing() const { return wet == nullptr; }
  /// Returns true if there are no layers on the entrance face.
  bool has_bare_entrance() const { return entrance_layers.empty() && entrance.layers.empty(); }
  bool entrance_absorbs() const { return entrance_layers.absorbs() || entrance.absorbs(); }
};

/// Elements that have another medium behind them, such as water, than the other elements of the part. The boundary
/// between the two media is not modelled. Light that travels behind the part from one element to another meets each
/// facet in the medium of that facet.
struct WetBack {
  Optics optics;  ///< optics of these elements; only `back_index` and values that depend on it differ from the other
                  ///< elements
  std::shared_ptr<const geometry::ChosenElements> elements;
};

/// Direction and polarization of the incident light. The source is in the direction (sin t cos p, sin t sin p, cos t)
/// of the part frame. t is the incidence angle, which may be negative, and p is the azimuth.
struct Illumination {
  Angle incidence;
  Angle azimuth;
  Stokes stokes = kUnpolarised;  ///< Stokes parameters of power 1, with source_axis() as first axis
};

}  // namespace retrace::raytrace

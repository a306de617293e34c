#pragma once

// The optical properties of a part at one wavelength, and the direction and polarisation of the incident beam.

#include "core/angle.h"
#include "materials/thin_film.h"
#include "raytrace/light/stokes.h"
#include "surface_models/facet_form.h"
#include "surface_models/scatter/scatter_model.h"

namespace retrace::raytrace {

/// What the part is made of and how its faces treat light, at one wavelength.
struct Optics {
  double index = 1.0;              ///< of the body, relative to the air around it; >= 1
  double back_index = 1.0;         ///< of what lies behind the back surface, likewise; air is in front and at the sides
  double absorption_per_mm = 0.0;  ///< Napierian, for power
  bool mirror_facets = false;      ///< retro facets reflect everything
  materials::LayerStack facet_layers;     ///< on the retro facets, one of which may be opaque
  materials::LayerStack entrance_layers;  ///< on the entrance face, all of which let light through
  bool lossless_entrance = false;         ///< entrance refracts with T = 1; light beyond the critical angle ends there
  bool absorbing_walls = false;           ///< walls of elements and of the border let no light go on
  surface_models::ScatterModel facet_scatter;  ///< what the texture of retro facets does
  surface_models::FacetForm facet_form;        ///< by which retro facets of elements depart from their planes
  double wavelength_nm = 587.56;               ///< in vacuum; matters to scatter alone

  /// Index before over index after, at a face of the back surface.
  double ratio_at_back(bool inside) const { return inside ? index / back_index : back_index / index; }
  /// Whether border walls, below z = 0, treat light otherwise than the plate's sides above them.
  bool border_walls_differ() const { return absorbing_walls || back_index != 1.0; }
  /// Whether every beam stays a beam at every face.
  bool is_smooth() const { return std::holds_alternative<surface_models::Smooth>(facet_scatter); }
  /// Whether retro facets do to light what planes do.
  bool has_plane_facets() const { return is_smooth() && facet_form.is_plane(); }
};

/// Where the light comes from: the source lies in direction (sin t cos p, sin t sin p, cos t) of the part frame, with
/// t the incidence angle (negative: the other side) and p the azimuth.
struct Illumination {
  Angle incidence;
  Angle azimuth;
  Stokes stokes = kUnpolarised;  ///< of power 1, along source_axis()
};

}  // namespace retrace::raytrace

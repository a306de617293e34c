#pragma once

// The optical properties of a part at one wavelength, and the direction and polarisation of the incident beam.

#include <memory>

#include "core/angle.h"
#include "materials/thin_film.h"
#include "raytrace/light/entrance_condition.h"
#include "raytrace/light/stokes.h"
#include "surface_models/facet_form.h"
#include "surface_models/scatter/scatter_model.h"

namespace retrace::geometry {
class ChosenElements;
}

namespace retrace::raytrace {

struct WetBack;

/// What the part is made of and how its faces treat light, at one wavelength.
struct Optics {
  double index = 1.0;              ///< of the body, relative to the air around it; >= 1
  double back_index = 1.0;         ///< of what lies behind the back surface, likewise; air is in front and at the sides
  double absorption_per_mm = 0.0;  ///< Napierian, for power
  bool mirror_facets = false;      ///< retro facets reflect everything
  materials::LayerStack facet_layers;     ///< on the retro facets, one of which may be opaque
  materials::LayerStack entrance_layers;  ///< on the entrance face, all of which let light through
  EntranceCondition entrance;             ///< what else the entrance face is like
  bool lossless_entrance = false;         ///< entrance refracts with T = 1; light beyond the critical angle ends there
  bool absorbing_walls = false;           ///< walls of elements and of the border let no light go on
  surface_models::ScatterModel facet_scatter;  ///< what the texture of retro facets does
  surface_models::FacetForm facet_form;        ///< by which retro facets of elements depart from their planes
  double wavelength_nm = 587.56;               ///< in vacuum; matters to scatter alone
  std::shared_ptr<const WetBack> wet;          ///< behind some elements; null: all backs are alike

  /// Index before over index after, at a face of the back surface.
  double ratio_at_back(bool inside) const { return inside ? index / back_index : back_index / index; }
  /// Whether border walls, below z = 0, treat light otherwise than the plate's sides above them.
  bool border_walls_differ() const { return absorbing_walls || back_index != 1.0; }
  /// Whether every beam stays a beam at the facets ...
  bool is_smooth() const { return std::holds_alternative<surface_models::Smooth>(facet_scatter); }
  /// ... where retro facets do to light what planes do ...
  bool has_plane_facets() const { return is_smooth() && facet_form.is_plane(); }
  /// ... where all backs are alike, as beams and cells know them ...
  bool has_one_back() const { return wet == nullptr; }
  /// ... and at every face of the part.
  bool keeps_beams() const { return has_plane_facets() && has_one_back() && !entrance.scatters(); }
  /// Whether nothing lies on the entrance face.
  bool has_bare_entrance() const { return entrance_layers.empty() && entrance.layers.empty(); }
  bool entrance_absorbs() const { return entrance_layers.absorbs() || entrance.absorbs(); }
};

/// Elements with another medium behind them. What ends the one medium and begins the other is not modelled: light on
/// its way from behind an element to another meets each facet from what lies behind that facet.
struct WetBack {
  Optics optics;  ///< of these elements: as those of the others but for the back's index and what follows from it
  std::shared_ptr<const geometry::ChosenElements> elements;
};

/// Where the light comes from: the source lies in direction (sin t cos p, sin t sin p, cos t) of the part frame, with
/// t the incidence angle (negative: the other side) and p the azimuth.
struct Illumination {
  Angle incidence;
  Angle azimuth;
  Stokes stokes = kUnpolarised;  ///< of power 1, along source_axis()
};

}  // namespace retrace::raytrace

#pragma once

// Prepares a design for tracing: its part, its refractive indices, and the wavelengths that represent its light.

#include <memory>
#include <optional>
#include <vector>

#include "core/warning.h"
#include "design/design.h"
#include "geometry/entrance/entrance_surface.h"
#include "geometry/part/chosen_elements.h"
#include "geometry/part/part.h"
#include "materials/io/material_library.h"
#include "raytrace/light/optics.h"

namespace retrace::design {

/// Optical properties at one wavelength of the design's light.
struct SpectralOptics {
  double wavelength_nm = 0.0;
  double weight = 1.0;  ///< fraction of the flux that the wavelength represents
  raytrace::Optics optics;
};

/// Design that is prepared for tracing.
struct OpticalModel {
  geometry::Part part;
  /// Elements with another medium behind them. Null if there are none. If only some elements are wet, `optics` refers
  /// to this object.
  std::shared_ptr<const geometry::ChosenElements> wet_elements;
  std::optional<geometry::Entrance> entrance;  ///< curved entrance face; if empty, the face is plane
  double wavelength_nm = 0.0;                  ///< wavelength of the light; for a spectrum, its centroid
  raytrace::Optics optics;                     ///< properties at the wavelength with the index nearest_wavelength()
  /// Properties at the traced wavelengths, in ascending order; the weights add up to 1.
  std::vector<SpectralOptics> spectral;
  Warnings warnings;  ///< warnings for the user, for example about an extrapolated index

  /// Returns the index in `spectral` of the wavelength that is nearest to `wavelength_nm`.
  /// \pre `spectral` is not empty
  std::size_t nearest_wavelength() const;
  /// Returns the curved entrance face as the tracers expect it, or null if the face is plane.
  const geometry::Entrance* curved_entrance() const { return entrance ? &*entrance : nullptr; }
};

/// Builds the part, finds the material and selects the wavelengths of the light.
/// \throw InputError that names file and line, for an unknown material, an invalid spectrum, or a wavelength without an
///     index, and for balls, which have no geometry::Part
OpticalModel make_model(const Design& design, const materials::MaterialLibrary& library);

/// Returns a model without a part, for tracers of balls.
/// \throw InputError under the same conditions as make_model()
OpticalModel make_light_model(const Design& design, const materials::MaterialLibrary& library);

/// Optical properties of a design at any wavelength.
class OpticsOfDesign {
 public:
  /// Reads all data that do not depend on the wavelength.
  /// \param warnings receives warnings for the user
  /// \pre `design` and `library` outlive this object
  /// \throw InputError under the same conditions as make_model()
  OpticsOfDesign(const Design& design, const materials::MaterialLibrary& library, Warnings& warnings);
  ~OpticsOfDesign();

  /// Returns the properties at a wavelength for a part without wet elements, which are elements with another medium
  /// behind them.
  /// \throw InputError if there are no data for this wavelength
  raytrace::Optics at(double wavelength_nm) const;
  /// Returns the properties at a wavelength, with another medium behind selected elements.
  /// \param chosen selected elements, for example OpticalModel::wet_elements
  raytrace::Optics at(double wavelength_nm, const std::shared_ptr<const geometry::ChosenElements>& chosen) const;
  /// Returns true if this wavelength is within the range of the index data of the body.
  bool has_index_data_at(double wavelength_nm) const;
  /// Returns the material of the body.
  const materials::Material& material() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace retrace::design

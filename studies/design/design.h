#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/part_spec.h"
#include "raytrace/stokes.h"

namespace retrace::studies {

/// The optical idealisations a design may ask for, to be checked against theory.
struct Idealisation {
  bool mirror_facets = false;  ///< retro facets reflect everything at every angle
  bool lossless_entrance =
      false;  ///< entrance face refracts with T = 1 both ways; beyond the critical angle light ends
};

/// Everything a design file says, checked and with its defaults filled in.
struct Design {
  std::string source;  ///< file name as given, "-" for standard input
  std::string title;   ///< empty if none was given
  geometry::PartSpec part;
  std::string material = "PMMA";
  InputLocation material_location;          ///< where the material was named, for whoever finds that it is not shipped
  std::optional<double> refractive_index;   ///< wins over the material; relative to air, >= 1
  std::optional<double> absorption_per_mm;  ///< Napierian, for power; wins over the material's; >= 0
  double wavelength_nm = 587.56;
  InputLocation wavelength_location;  ///< where it was given, for whoever finds no index there
  /// Of the incident light, along the axes of raytrace::source_axis(); i = 1.
  raytrace::Stokes polarisation = raytrace::kUnpolarised;
  std::vector<double> acceptance_half_angle_deg = {0.5};  ///< ascending, each in (0, 90]
  Idealisation idealisation;

  /// What messages call the source.
  std::string source_name() const { return source == "-" ? "standard input" : source; }
};

}  // namespace retrace::studies

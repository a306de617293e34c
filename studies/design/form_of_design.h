#pragma once

// The form of a design's facets: what `[form]` says, as a polynomial over a facet.

#include <string>
#include <vector>

#include "studies/design/design.h"
#include "surface_models/facet_form.h"
#include "surface_models/height_map.h"

namespace retrace::studies {

/// A measured map that a design names, with the axis that is level on a facet along x. Warnings are appended.
/// \param source of the design, for them \throw InputError naming the file
surface_models::HeightMap level_map_of(const std::filesystem::path& file, HeightMapAxis level_axis,
                                       const std::string& source, std::vector<std::string>& warnings);

/// The form that the retro facets have: that of the design's element without errors and cant. Warnings are appended.
/// \throw InputError naming file, line and key for a map that cannot be read or does not cover a facet, and for slopes
/// beyond 0.03
surface_models::FacetForm form_of_design(const Design& design, std::vector<std::string>& warnings);

/// What a form is like over a facet of the element without errors and cant.
struct FormReport {
  double radius_mm = 0.0;  ///< of the facet: from its middle to its farthest corner
  double lowest_um = 0.0;  ///< out of the body, from the plane
  double highest_um = 0.0;
  double rms_um = 0.0;     ///< about the plane that fits it best
  double tilt_mrad = 0.0;  ///< of that plane
  double steepest_mrad = 0.0;
};
/// \pre the design has elements
FormReport report_form(const Design& design, const surface_models::FacetForm& form);

}  // namespace retrace::studies

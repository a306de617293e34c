#pragma once

// Computes the form of a design's facets, which is their deviation from planes, as a polynomial over a facet. The table
// [form] of the design determines it.

#include <string>

#include "core/warning.h"
#include "design/design.h"
#include "surface_models/facet_form.h"
#include "surface_models/height_map.h"

namespace retrace::design {

/// Reads a measured map of a design. The axis of the map that is horizontal on a facet becomes the x axis. Warnings are
/// appended.
/// \param source name of the design, for messages
/// \throw InputError that names the file
surface_models::HeightMap facet_aligned_map(const std::filesystem::path& file, HeightMapAxis level_axis,
                                            const std::string& source, Warnings& warnings);

/// Returns the form of the retro facets. The facets are those of the design's element, without angle errors and cant.
/// Warnings are appended.
/// \throw InputError that names file, line and key if a map cannot be read or does not cover a facet, and for slopes
/// above 0.03
surface_models::FacetForm form_of_design(const Design& design, Warnings& warnings);

/// Characteristic values of a form over a facet. The facet is that of an element without angle errors and cant.
struct FormReport {
  double radius_mm = 0.0;  ///< distance from the centre of the facet to its farthest corner
  double lowest_um = 0.0;  ///< minimum height above the plane; positive is out of the body
  double highest_um = 0.0;
  double rms_um = 0.0;     ///< rms deviation from the best-fitting plane
  double tilt_mrad = 0.0;  ///< tilt of the best-fitting plane
  double steepest_mrad = 0.0;
};
/// Returns the characteristic values of a form.
/// \pre the design has elements
FormReport report_form(const Design& design, const surface_models::FacetForm& form);

}  // namespace retrace::design

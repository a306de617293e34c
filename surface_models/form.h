#pragma once

// Removes the form of a measured surface, a plane or a polynomial, before its texture is evaluated.

#include "surface_models/facet_form.h"
#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Maximum degree of a polynomial form.
inline constexpr int kMaxFormDegree = 8;

/// Returns the map minus a polynomial of the total degree `degree` in x and y, or in x only for a profile. The
/// polynomial is fitted to the measured points by least squares. Degree 1 is the plane (F-operation of ISO 25178-2). If
/// the points do not determine the polynomial, the solution with the smallest coefficients is used.
/// \pre 1 <= degree <= kMaxFormDegree; the map has a measured point
HeightMap without_form(const HeightMap& map, int degree);

/// Returns the polynomial that without_form() subtracts. The origin is the centre of the map, x is along its rows and y
/// along its columns.
/// \pre the conditions of without_form(); the map is areal
FacetForm fitted_form(const HeightMap& map, int degree);

}  // namespace retrace::surface_models

#pragma once

// Removes the form of a measured surface, a plane or a polynomial, before its texture is judged.

#include "surface_models/facet_form.h"
#include "surface_models/height_map.h"

namespace retrace::surface_models {

/// Highest degree of a polynomial form.
inline constexpr int kMostFormDegree = 8;

/// The map less the polynomial of total degree `degree` in x and y (in x alone for a profile) that is nearest to its
/// measured points in the sense of least squares; 1 is the plane (F-operation of ISO 25178-2). Where the points do not
/// determine the polynomial, the smallest one is taken. \pre 1 <= degree <= kMostFormDegree, a measured point
HeightMap without_form(const HeightMap& map, int degree);

/// That polynomial, about the middle of the map: x along its rows, y along its columns. \pre as without_form(), and an
/// areal map
FacetForm fitted_form(const HeightMap& map, int degree);

}  // namespace retrace::surface_models

#pragma once

// The chromaticity of the light that a part sends back, against the colour boundaries of its standard.

#include <optional>

#include "core/progress.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {

/// The request of one response: with the rays of a direction shared by the three. \param response x, y or z
PhotometryRequest request_of_response(const PhotometryRequest& request, std::size_t response);

/// Measures the colour where the standard asks for it, or at its first test point: the tristimulus values of the
/// returned light, each with wavelengths of its own. Nothing if it was cancelled.
/// \param photometer of the same design and request: whether it is exact holds here
/// \param v_deg where it is measured: one, or several of which the worst counts
/// \pre the light is a CIE illuminant, the programme has points
std::optional<PhotometricColour> measured_colour(const Design& design, const PhotometryRequest& request,
                                                 const Photometer& photometer, const std::vector<double>& v_deg,
                                                 const Cancellation* cancel);

}  // namespace retrace::studies

#pragma once

// Chromaticity of the returned light, compared with the colour boundaries of the standard.

#include <optional>

#include "core/progress.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {

/// Returns the request for measuring one of the three tristimulus values. The requested number of rays per direction is
/// divided evenly among the three measurements.
/// \param response index of the colour matching function: 0 for x, 1 for y, 2 for z
PhotometrySettings request_of_response(const PhotometrySettings& request, std::size_t response);

/// Measures the colour in the geometry for which the standard defines colour boundaries. If it defines none, the colour
/// is measured in the geometry of the first test point. The tristimulus values are measured separately, each with its
/// own wavelengths. Returns nothing if the measurement was cancelled.
/// \param photometer photometer that was made for `design` and `request`; its engine measures the colour
/// \param v_deg angles V at which the colour is measured; the result with the smallest margin is returned
/// \param progress object that receives the finished fraction; may be null
/// \pre the light is a CIE illuminant, and the test plan has points
std::optional<PhotometricColour> measured_colour(const design::Design& design, const PhotometrySettings& request,
                                                 const Photometer& photometer, const std::vector<double>& v_deg,
                                                 Progress* progress, const Cancellation* cancel);

}  // namespace retrace::studies

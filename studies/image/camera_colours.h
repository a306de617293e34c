#pragma once

// Colours of camera pictures.

#include <array>
#include <cstddef>
#include <vector>

#include "materials/chromaticity.h"
#include "raytrace/observers/camera.h"
#include "studies/photometry/photometer.h"

namespace retrace::studies {

/// Colours of a picture of a coloured part. The three values of a pixel are those of the functions x, y and z of the
/// CIE 1931 observer, each relative to the lamp: they are equal if the pixel has the chromaticity of the lamp.
struct CameraColours {
  std::vector<double> x;  ///< cd/m^2; the luminance of the picture is y
  std::vector<double> z;
  materials::Tristimulus lamp{};  ///< tristimulus values of the lamp, with Y = 1

  /// Returns the linear sRGB values of a pixel (IEC 61966-2-1), in cd/m^2. The lamp is white: its chromaticity is
  /// adapted to D65 (K. M. Lam 1985, "Bradford").
  std::array<double, 3> rgb(double y, std::size_t pixel) const;
};

/// Returns the tristimulus values of the light of a lamp, scaled to Y = 1.
/// \pre `light` is not the light of the design itself
materials::Tristimulus lamp_colour(PhotometricLight light);

/// Returns the colours of a picture. The responses are traced separately, and their noise would appear as colours. Each
/// pixel therefore gets the mean colour of its neighbourhood, whose size depends on the noise. This is hardly visible,
/// because the eye resolves colours less well than luminances.
/// \param responses pictures of the responses y, x and z, in this order
/// \param lamp tristimulus values of the lamp, with Y = 1
CameraColours colours_of(const std::vector<raytrace::CameraImage>& responses, const materials::Tristimulus& lamp);

}  // namespace retrace::studies

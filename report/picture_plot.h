#pragma once

#include <string>
#include <vector>

#include "report/image_plot.h"
#include "report/io/picture_file.h"
#include "studies/image/camera_study.h"
#include "studies/image/detector_study.h"

namespace retrace::report {

/// What leaves, and where it entered.
ImagePlot irradiance_plot(const studies::DetectorResult& result);
/// Around the direction back to the source, colours by decades.
ImagePlot angular_plot(const studies::DetectorResult& result);
/// Channels `leaving` and `entering`, with their standard errors where there are any.
FloatPicture irradiance_picture(const studies::DetectorResult& result);
FloatPicture angular_picture(const studies::DetectorResult& result);

/// Channels Y (cd/m^2), `std_error` and `coverage`.
FloatPicture luminance_picture(const studies::CameraResult& result);
/// The picture as the eye might see it, three bytes a pixel.
std::vector<unsigned char> tone_mapped_pixels(const std::vector<double>& luminance);
/// Luminance as colours by decades.
ImagePlot false_colour_plot(const studies::CameraResult& result);

}  // namespace retrace::report

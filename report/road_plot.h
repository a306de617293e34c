#pragma once

#include <string>

#include "report/io/picture_file.h"
#include "studies/image/road_study.h"

namespace retrace::report {

/// The views side by side as the driver sees them, all exposed alike, with distances and luminances. A PNG file.
/// \throw OutputError if it cannot be drawn
std::string road_png(const studies::RoadResult& result, double scale = 1.5);

/// The luminances of all views one beside the other, channel Y, and `reflected`: what of it the reflectors send.
FloatPicture road_picture(const studies::RoadResult& result);

}  // namespace retrace::report

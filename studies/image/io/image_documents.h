#pragma once

#include <string>

#include "studies/image/camera_study.h"
#include "studies/image/detector_study.h"

namespace retrace::studies {

/// The JSON documents `retrace.image/1` of the two kinds of picture: all but the pixels.
std::string detector_json(const DetectorResult& result);
std::string camera_json(const CameraResult& result);

/// For the terminal.
std::string detector_table(const DetectorResult& result);
std::string camera_table(const CameraResult& result);

}  // namespace retrace::studies

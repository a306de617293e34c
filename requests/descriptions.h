#pragma once

// Descriptions of all requests (requests/row.h).

#include "requests/image.h"
#include "requests/row.h"

namespace retrace::requests {

template <>
const Request& description<DetectorRequest>();
template <>
const Request& description<CameraRequest>();
template <>
const Request& description<RoadRequest>();

}  // namespace retrace::requests

#pragma once

// Descriptions of all requests (requests/row.h).

#include <tuple>

#include "requests/image.h"
#include "requests/row.h"

namespace retrace::requests {

/// All types of requests.
using AllRequests = std::tuple<DetectorRequest, CameraRequest, RoadRequest>;

template <>
const Request& description<DetectorRequest>();
template <>
const Request& description<CameraRequest>();
template <>
const Request& description<RoadRequest>();

}  // namespace retrace::requests

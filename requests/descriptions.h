#pragma once

// Declares the descriptions of all types of requests. Descriptions are explained in requests/row.h.

#include <tuple>

#include "requests/image.h"
#include "requests/inspect.h"
#include "requests/job.h"
#include "requests/metrology.h"
#include "requests/part.h"
#include "requests/photometry.h"
#include "requests/ranging.h"
#include "requests/rays.h"
#include "requests/roughness.h"
#include "requests/row.h"
#include "requests/rre.h"
#include "requests/study.h"
#include "requests/verify.h"

namespace retrace::requests {

/// Tuple of all types of requests, for templates that iterate over the types.
using AllRequests =
    std::tuple<DetectorRequest, CameraRequest, RoadRequest, InspectRequest, JobRequest, FabricationRequest,
               MetrologyRequest, SolidRequest, MaterialRequest, PhotometryRequest, RangingRequest, RaysRequest,
               TraceRequest, RoughnessRequest, RreRequest, StudyRequest, VerificationRequest>;

template <>
const Request& description<DetectorRequest>();
template <>
const Request& description<CameraRequest>();
template <>
const Request& description<RoadRequest>();
template <>
const Request& description<InspectRequest>();
template <>
const Request& description<JobRequest>();
template <>
const Request& description<FabricationRequest>();
template <>
const Request& description<MetrologyRequest>();
template <>
const Request& description<SolidRequest>();
template <>
const Request& description<MaterialRequest>();
template <>
const Request& description<PhotometryRequest>();
template <>
const Request& description<RangingRequest>();
template <>
const Request& description<RaysRequest>();
template <>
const Request& description<TraceRequest>();
template <>
const Request& description<RoughnessRequest>();
template <>
const Request& description<RreRequest>();
template <>
const Request& description<StudyRequest>();
template <>
const Request& description<VerificationRequest>();

/// Returns a description of MetrologyRequest that contains only the fields needed to read a height map. The command
/// `correct` uses this description.
const Request& height_map_reading();

}  // namespace retrace::requests

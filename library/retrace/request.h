#pragma once

// Sets fields of requests by name. Also returns a description of all requests, from which programs can generate forms,
// bindings or documentation.

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/api.h"
#include "requests/image.h"
#include "requests/inspect.h"
#include "requests/job.h"
#include "requests/metrology.h"
#include "requests/part.h"
#include "requests/photometry.h"
#include "requests/ranging.h"
#include "requests/rays.h"
#include "requests/rre.h"
#include "requests/study.h"
#include "requests/verify.h"

namespace retrace {

/// Value of a field. Whole numbers have the type double; words and file names have the type std::string. std::monostate
/// means the default of the field.
using FieldValue = std::variant<std::monostate, bool, double, std::string, std::vector<double>,
                                std::vector<std::vector<double>>, std::vector<std::string>>;

/// Sets a field of a request.
/// \param field name of the member, or "pixels" for the columns and rows of a camera picture
/// \throw InputError that names the field, if the request has no such field or the value is not allowed
RETRACE_API void assign(DetectorRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(CameraRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(RoadRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(InspectRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(JobRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(FabricationRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(MetrologyRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(SolidRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(MaterialRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(PhotometryRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(RangingRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(RaysRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(TraceRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(RreRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(StudyRequest& request, std::string_view field, const FieldValue& value);
RETRACE_API void assign(VerificationRequest& request, std::string_view field, const FieldValue& value);

/// Returns the description of all requests as JSON: fields, ranges, units, defaults, meanings, and the spelling on the
/// command line and in Python. It is the document of `retrace list requests --json -` without its header.
RETRACE_API std::string request_description();

/// Returns the Python keyword of a field. This function can be passed to Error::message() as the spelling.
/// \param field name of the field, as in Field::name (core/field.h)
RETRACE_API std::string python_keyword(std::string_view field);

}  // namespace retrace

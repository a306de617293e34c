#include "requests/descriptions.h"

#include "core/schema/access.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

constexpr NumberRange kRoughnessLengthUm{.low = 0.0, .low_included = false, .high = 1e6};
constexpr schema::Condition kRoughnessNoSamples[] = {schema::is_absent("samples")};
constexpr Need kRoughnessNeedNoSamples[] = {kRoughnessNoSamples};

constexpr Row kRoughnessRows[] = {{"sa_nm",
                                   NumberOrNumbers{{.low = 0.0, .high = 1e5}},
                                   "Sa values of the roughness; each curve has one point for each Sa value",
                                   access<&RoughnessRequest::sa_nm>,
                                   {.value = "LIST", .notation = Notation::number_list, .option = "--sa"}},
                                  {"correlation_length_um",
                                   NumberOrNumbers{kRoughnessLengthUm},
                                   "correlation lengths of the roughness; there is one curve for each length, and "
                                   "measured facets are computed with the first length",
                                   access<&RoughnessRequest::correlation_length_um>,
                                   {.value = "LIST", .notation = Notation::number_list}},
                                  {"waviness_length_um",
                                   Number{kRoughnessLengthUm},
                                   "period of the waviness of measured facets",
                                   access<&RoughnessRequest::waviness_length_um>,
                                   {.value = "L"}},
                                  {"incidence_deg",
                                   Number{kIncidence},
                                   "angle of incidence",
                                   access<&RoughnessRequest::incidence_deg>,
                                   {.value = "T", .option = "--incidence"}},
                                  {"azimuth_deg",
                                   Number{kAzimuth},
                                   "azimuth of the source",
                                   access<&RoughnessRequest::azimuth_deg>,
                                   {.value = "P", .option = "--azimuth"}},
                                  {"samples",
                                   Integer{kSamples},
                                   "number of rays for each point",
                                   access<&RoughnessRequest::samples>,
                                   {.value = "N", .otherwise = "until the target error is reached"}},
                                  {"target_error",
                                   Number{{.low = 0.0, .low_included = false, .high = 1.0, .high_included = false}},
                                   "standard error of RRE at which tracing ends, as a fraction",
                                   access<&RoughnessRequest::target_error>,
                                   {.value = "E"},
                                   kRoughnessNeedNoSamples},
                                  seed_row<RoughnessRequest>()};

}  // namespace

template <>
const Request& description<RoughnessRequest>() {
  static constexpr Request request{"roughness", "roughness", kRoughnessRows, initial_object<RoughnessRequest>};
  return request;
}

}  // namespace retrace::requests

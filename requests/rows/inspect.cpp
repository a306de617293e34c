#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

constexpr Row kInspectRows[] = {{"min_draft_deg",
                                 Number{{.low = 0.0, .high = 45.0}},
                                 "minimum draft of the faces of the part: faces with less draft are listed",
                                 access<&InspectRequest::min_draft_deg>,
                                 {.value = "D"}},
                                {"demould_tilt_deg",
                                 Number{{.low = 0.0, .high = 60.0}},
                                 "angle between z and the direction in which the part leaves the mould of its back",
                                 access<&InspectRequest::demould_tilt_deg>,
                                 {.value = "T"}},
                                {"demould_azimuth_deg",
                                 Number{{.low = -360.0, .high = 360.0}},
                                 "azimuth towards which this direction is tilted, from +x towards +y",
                                 access<&InspectRequest::demould_azimuth_deg>,
                                 {.value = "A"}}};

}  // namespace

template <>
const Request& description<InspectRequest>() {
  static constexpr Request request{"inspect", "inspect", kInspectRows, initial_object<InspectRequest>};
  return request;
}

}  // namespace retrace::requests

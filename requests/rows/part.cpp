#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

constexpr std::string_view kSolids[] = {"element", "array", "mould"};
constexpr schema::Condition kMould[] = {schema::is("what", schema::only(kSolids, "mould"))};
constexpr Need kNeedMould[] = {kMould};

constexpr Row kSolidRows[] = {{"what",
                               Word{kSolids},
                               "solid: element, array, or mould (the block behind the part's back)",
                               access<&SolidRequest::what>,
                               {.value = "WHAT"}},
                              {"block_mm",
                               Number{{.low = 0.0, .low_included = false, .high = 1e6}},
                               "thickness of the mould below its deepest point",
                               access<&SolidRequest::block_mm>,
                               {.value = "T", .otherwise = "the plate's thickness"},
                               kNeedMould},
                              {"surface_error_mm",
                               Number{{.low = 1e-6, .high = 10.0}},
                               "maximum distance along z between an exact entrance surface and the triangles that "
                               "approximate it",
                               access<&SolidRequest::surface_error_mm>,
                               {.value = "E", .otherwise = "0.001"}}};

constexpr NumberRange kDiscs{.low = 1.0, .high = 120.0};

constexpr Row kMaterialRows[] = {{"entrance_deg",
                                  Number{{.low = 1.0, .high = 40.0}},
                                  "largest entrance angle",
                                  access<&MaterialRequest::entrance_deg>,
                                  {.value = "B"}},
                                 {"window_deg",
                                  Number{{.low = 0.1, .high = 5.0}},
                                  "largest angle between view and source",
                                  access<&MaterialRequest::window_deg>,
                                  {.value = "W"}},
                                 {"source_arcmin",
                                  Number{kDiscs},
                                  "angular diameter of the source",
                                  access<&MaterialRequest::source_arcmin>,
                                  {.value = "D"}},
                                 {"receiver_arcmin",
                                  Number{kDiscs},
                                  "angular diameter of the receiver",
                                  access<&MaterialRequest::receiver_arcmin>,
                                  {.value = "D"}},
                                 {"error",
                                  Number{{.low = 0.001, .high = 0.5}},
                                  "relative error to reach",
                                  access<&MaterialRequest::error>,
                                  {.value = "E"}},
                                 {"max_directions",
                                  Integer{{.low = 64.0, .high = 10000.0}},
                                  "maximum number of directions of light that are computed",
                                  access<&MaterialRequest::max_directions>,
                                  {.value = "N", .former = "most_directions"}}};

}  // namespace

template <>
const Request& description<SolidRequest>() {
  static constexpr Request request{"solid", "export", kSolidRows, initial_object<SolidRequest>};
  return request;
}
template <>
const Request& description<MaterialRequest>() {
  static constexpr Request request{"material", "export", kMaterialRows, initial_object<MaterialRequest>};
  return request;
}

}  // namespace retrace::requests

#include <fmt/format.h>

#include "core/error.h"
#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

constexpr std::string_view kEmitters[] = {"lambertian", "gaussian", "collimated"};

constexpr NumberRange kFraction{.low = 0.0, .high = 1.0};

constexpr schema::Condition kEmitter[] = {schema::is_given("emitter")};
constexpr schema::Condition kNoEmitter[] = {schema::is_absent("emitter")};
constexpr schema::Condition kNoIncidence[] = {schema::is_absent("incidence_deg")};
constexpr schema::Condition kNoAzimuth[] = {schema::is_absent("azimuth_deg")};
constexpr schema::Condition kNoDistance[] = {schema::is_absent("distance_mm")};
constexpr schema::Condition kOut[] = {schema::is_given("out")};
constexpr Need kNeedEmitter[] = {kEmitter};
constexpr Need kNeedNoEmitter[] = {kNoEmitter};
constexpr Need kNeedNoAngles[] = {kNoIncidence, kNoAzimuth, kNoDistance};
constexpr Need kNeedOut[] = {kOut};

template <class Type>
constexpr Row split_row() {
  return {"split",
          Number{kFraction},
          "the reflected and the refracted branch are both followed if each has at least this fraction of the power of "
          "the launched ray; otherwise, one branch is chosen at random; 1: always one branch",
          access<&Type::split>,
          {.value = "W"}};
}

template <class Type>
constexpr Row cutoff_row() {
  return {"cutoff",
          Number{kFraction},
          "minimum power of a branch that is followed, as a fraction of the power of the launched ray",
          access<&Type::cutoff>,
          {.value = "W"}};
}

constexpr Row kRaysRows[] = {
    {"source",
     File{"a file of rays"},
     "file with the rays to trace: IES TM-25 (.tm25ray) or a table (.csv)",
     access<&RaysRequest::source>,
     {.value = "FILE", .otherwise = "rays of an emitter"},
     kNeedNoEmitter},
    {"emitter",
     Word{kEmitters},
     "light distribution of a disc that emits the rays: lambertian, gaussian or collimated",
     access<&RaysRequest::emitter>,
     {.value = "KIND", .otherwise = "rays of a file"}},
    {"rays",
     Integer{{.low = 1.0, .high = 0x1p40}},
     "emitter: number of rays",
     access<&RaysRequest::rays>,
     {.value = "N"},
     kNeedEmitter},
    {"disc_mm",
     Number{{.low = 0.0, .high = kFarthestMm}},
     "emitter: diameter of its disc",
     access<&RaysRequest::disc_mm>,
     {.value = "D", .otherwise = "0 (a point); collimated: the size of the part or of one period"},
     kNeedEmitter},
    {"half_angle_deg",
     Number{{.low = 0.0, .high = 90.0}},
     "emitter: half angle of its cone of light; gaussian: angle at which its intensity falls to exp(-2) of the maximum",
     access<&RaysRequest::half_angle_deg>,
     {.value = "A", .otherwise = "lambertian: 90, others: 0"},
     kNeedEmitter},
    {"power",
     Number{{.low = 0.0, .low_included = false, .high = 1e150}},
     "emitter: total power of its rays, in W, or in lm if the design's light is weighted by the luminous efficiency of "
     "the eye",
     access<&RaysRequest::power>,
     {.value = "P"},
     kNeedEmitter},
    {"incidence_deg",
     Number{kIncidence},
     "angle between the part's normal and the direction to the source; the source is aimed at the centre of the "
     "entrance face",
     access<&RaysRequest::incidence_deg>,
     {.value = "T", .option = "--incidence", .usual = "0"}},
    {"azimuth_deg",
     Number{kAzimuth},
     "azimuth of the source",
     access<&RaysRequest::azimuth_deg>,
     {.value = "P", .option = "--azimuth", .usual = "0"}},
    {"distance_mm",
     Number{{.low = 0.0, .low_included = false, .high = kFarthestMm}},
     "distance of the source from the centre of the entrance face",
     access<&RaysRequest::distance_mm>,
     {.value = "D", .usual = "10"}},
    {"at_mm",
     Numbers{3, kPlaceMm},
     "position of the source's origin in the part frame; it is given instead of angles and distance",
     access<&RaysRequest::at_mm>,
     {.value = "X,Y,Z", .notation = Notation::commas, .otherwise = "for a file of rays, the origin of the part"},
     kNeedNoAngles},
    {"aim_mm",
     Numbers{3, kPlaceMm},
     "point, in the part frame, at which the source's +z axis is aimed",
     access<&RaysRequest::aim_mm>,
     {.value = "X,Y,Z",
      .notation = Notation::commas,
      .otherwise = "for a file of rays, none: the +z axes of source and part are parallel"}},
    split_row<RaysRequest>(),
    cutoff_row<RaysRequest>(),
    {"stokes",
     Flag{},
     "write the polarisation of the rays, even if the source has none",
     access<&RaysRequest::stokes>,
     {},
     kNeedOut},
    {"keep_missed", Flag{}, "also write rays that miss the part", access<&RaysRequest::keep_missed>, {}, kNeedOut},
    {"out",
     File{"a file of rays"},
     "file for the rays that leave the part, .tm25ray or .csv",
     access<&RaysRequest::out>,
     {.value = "FILE", .otherwise = "rays are not written", .is_no_option = true}},
    seed_row<RaysRequest>()};

void check_rays(const void* object) {
  const auto& request = *static_cast<const RaysRequest*>(object);
  if (request.source.empty() && request.emitter.empty())
    throw InputError(Field{"source"},
                     fmt::format("either {} or {} must be given", reference({"source"}), reference({"emitter"})));
}

constexpr Row kTraceRows[] = {
    split_row<TraceRequest>(),
    cutoff_row<TraceRequest>(),
    {"keep_missed", Flag{}, "also return rays that miss the part", access<&TraceRequest::keep_missed>},
    seed_row<TraceRequest>()};

}  // namespace

template <>
const Request& description<RaysRequest>() {
  static constexpr Request request{"rays", "rays", kRaysRows, initial_object<RaysRequest>, check_rays};
  return request;
}
template <>
const Request& description<TraceRequest>() {
  static constexpr Request request{"trace", "", kTraceRows, initial_object<TraceRequest>};
  return request;
}

}  // namespace retrace::requests

#include "requests/descriptions.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/number_format.h"
#include "core/schema/access.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access, schema::access_by;

constexpr std::string_view kRreEngines[] = {"auto", "exact", "stochastic", "montecarlo", "cell", "embree"};
constexpr std::string_view kRreRayEngines[] = {"auto", "montecarlo", "cell", "embree"};
/// Engines that stop tracing light below a cut-off power.
constexpr std::string_view kRreCutoffEngines[] = {"auto", "exact", "montecarlo", "cell", "embree"};
/// Engines that use the target error even if the request also gives a cut-off power.
constexpr std::string_view kRreTargetEngines[] = {"auto", "stochastic", "montecarlo", "cell", "embree"};
constexpr std::string_view kRreSamplings[] = {"stratified", "plain"};

constexpr schema::Condition kRreByRays[] = {schema::is("engine", kRreRayEngines)};
constexpr schema::Condition kRreWithCutoff[] = {schema::is("engine", kRreCutoffEngines)};
// Condition of the field target_error. The exact engine cannot use it together with a cut-off power.
constexpr schema::Condition kRreWithTarget[] = {schema::is("engine", kRreTargetEngines), schema::is_absent("cutoff")};
constexpr schema::Condition kRreNoCutoffOrDerivatives[] = {schema::is_absent("cutoff"),
                                                           schema::is_absent("derivatives")};
constexpr schema::Condition kRreNoCutoffOrFootprint[] = {schema::is_absent("cutoff"), schema::is_absent("footprint")};
constexpr schema::Condition kRreNoCutoffOrFarField[] = {schema::is_absent("cutoff"), schema::is_absent("far_field")};
constexpr schema::Condition kRreNoSamples[] = {schema::is_absent("samples")};
constexpr schema::Condition kRreOut[] = {schema::is_given("out")};

constexpr Need kRreNeedRays[] = {kRreByRays};
constexpr Need kRreNeedCutoff[] = {kRreWithCutoff};
constexpr Need kRreNeedTarget[] = {kRreNoSamples, kRreWithTarget, kRreNoCutoffOrDerivatives, kRreNoCutoffOrFootprint,
                                   kRreNoCutoffOrFarField};
constexpr schema::Condition kRreNoFootprint[] = {schema::is_absent("footprint")};
constexpr schema::Condition kRreNoFarField[] = {schema::is_absent("far_field")};
constexpr Need kRreNeedGrid[] = {kRreNoFootprint, kRreNoFarField};
constexpr Need kRreNeedExactAndOut[] = {kIsExact, kRreOut};

schema::Value incidence_spans(const RreRequest& request) {
  std::vector<std::vector<double>> spans;
  for (const auto& [from, to] : request.incidence_spans_deg) spans.push_back({from, to});
  return spans;
}
void set_incidence_spans(RreRequest& request, const schema::Value& value) {
  request.incidence_spans_deg.clear();
  for (const std::vector<double>& span : std::get<std::vector<std::vector<double>>>(value))
    request.incidence_spans_deg.push_back({span[0], span[1]});
}

void check_rre(const void* object) {
  const auto& request = *static_cast<const RreRequest*>(object);
  for (const auto& [from, to] : request.incidence_spans_deg)
    if (!(from < to))
      throw InputError(Field{"incidence_spans_deg"},
                       fmt::format("a range must have start < stop, got {} and {}", shortest(from), shortest(to)));
}

constexpr Row kRreRows[] = {
    {"incidence_deg",
     NumberOrNumbers{.range = kIncidence, .may_be_empty = true},
     "angles of incidence",
     access<&RreRequest::incidence_deg>,
     {.value = "LIST",
      .notation = Notation::number_list,
      .option = "--incidence",
      .otherwise = "0, or no angles if ranges with automatically chosen angles are given; for maps 0:80:5",
      .is_no_option = true}},
    {"azimuth_deg",
     NumberOrNumbers{.range = kAzimuth, .may_be_empty = true},
     "azimuths of the source",
     access<&RreRequest::azimuth_deg>,
     {.value = "LIST", .notation = Notation::number_list, .option = "--azimuth", .otherwise = "0; for maps 0:350:10"}},
    {"incidence_spans_deg",
     NumberRows{.columns = 2, .range = kIncidence, .min_rows = 0, .max_rows = 100'000, .what = "ranges"},
     "ranges in which further angles of incidence are chosen automatically, as many as the curve requires",
     access_by<incidence_spans, set_incidence_spans>,
     {.value = "RANGES", .option = "--incidence", .is_no_option = true}},
    {"engine",
     Word{kRreEngines},
     "method of tracing: exact, stochastic, montecarlo (cell or embree), or auto: the fastest for each direction",
     access<&RreRequest::engine>,
     {.value = "ENGINE"}},
    {"target_error",
     Number{{.low = 0.0, .low_included = false, .high = 1.0, .high_included = false}},
     "standard error of RRE to reach, as a fraction; with exact, the maximum truncated power",
     access<&RreRequest::target_error>,
     {.value = "E", .otherwise = "0.0001; with exact: 1e-10"},
     kRreNeedTarget},
    {"samples",
     Integer{kSamples},
     "number of rays for each point",
     access<&RreRequest::samples>,
     {.value = "N", .otherwise = "until the target error is reached"},
     kRreNeedRays},
    {"cutoff",
     Number{{.low = 0.0, .high = 1.0, .high_included = false}},
     "minimum power of light that is followed, as a fraction of the incident power",
     access<&RreRequest::cutoff>,
     {.value = "W", .otherwise = "1e-10; exact: determined by the target error"},
     kRreNeedCutoff},
    {"sampling",
     Word{kRreSamplings},
     "method of sampling: stratified, or plain (random points without splitting, for comparison)",
     access<&RreRequest::sampling>,
     {.value = "KIND"},
     kRreNeedRays},
    {"derivatives",
     Flag{},
     "compute the derivatives of RRE with respect to the parameters of the design",
     access<&RreRequest::derivatives>,
     {},
     kNeedExact},
    {"footprint",
     Flag{},
     "compute the regions of the entrance face that return light, as polygons",
     access<&RreRequest::footprint>,
     {},
     kRreNeedExactAndOut},
    {"far_field",
     Flag{},
     "compute the directions in which light leaves the entrance face",
     access<&RreRequest::far_field>,
     {},
     kRreNeedExactAndOut},
    {"map",
     Flag{},
     "compute RRE over incidence and azimuth as a polar map",
     access<&RreRequest::map>,
     {},
     kRreNeedGrid},
    seed_row<RreRequest>()};

}  // namespace

template <>
const Request& description<RreRequest>() {
  static constexpr Request request{"rre", "rre", kRreRows, initial_object<RreRequest>, check_rre};
  return request;
}

}  // namespace retrace::requests

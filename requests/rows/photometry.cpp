#include <fmt/format.h>

#include "core/error.h"
#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

constexpr std::string_view kStandards[] = {"r150", "j594", "bicycle", "d4956", "iso20471", "stvzvo"};
constexpr NumberRange kApertureArcmin{.low = 0.0, .high = 300.0};
/// Allowed entrance angles of a map, as in limits files.
constexpr NumberRange kMapEntrance{.low = -85.0, .high = 85.0};
constexpr NumberRange kMapObservation{.low = 0.0, .high = 10.0};
constexpr NumberRange kMapPresentation{.low = -180.0, .high = 180.0};
/// Maximum number of angles in a list of a map.
constexpr std::size_t kMaxMapAngles = 1000;
constexpr schema::Condition kPhotometryMap[] = {schema::is_given("map")};
constexpr Need kPhotometryNeedMap[] = {kPhotometryMap};

void check_photometry(const void* object) {
  constexpr std::size_t most = 720;
  const auto& request = *static_cast<const PhotometryRequest*>(object);
  if (request.rotation_deg && request.rotation_deg->size() > most)
    throw InputError(Field{"photometry.rotation_deg"},
                     fmt::format("must be 1 to {} rotations, got {}", most, request.rotation_deg->size()));
}

constexpr Row kPhotometryRows[] = {
    {"standard",
     WordOrFile{kStandards, ".csv", "the name of a standard or a file with limits"},
     "standard of the test: r150, j594, bicycle, d4956, iso20471, stvzvo, or a file with limits",
     access<&PhotometryRequest::standard>,
     {.value = "NAME|FILE"},
     {},
     true},
    {"area_cm2",
     Number{{.low = 0.0, .low_included = false, .high = 1e6}},
     "area of the whole part in cm2; the design can describe a section of the part",
     access<&PhotometryRequest::area_cm2>,
     {.value = "A"},
     {},
     true},
    {"part_class",
     Text{},
     "class of the part in the standard, such as IA",
     access<&PhotometryRequest::part_class>,
     {.value = "CLASS",
      .option = "--class",
      .keyword = "class_",
      .otherwise = "required if the standard has several classes"}},
    {"colour",
     Text{},
     "colour of the part: white, amber, red, yellow and so on",
     access<&PhotometryRequest::colour>,
     {.value = "COLOUR", .otherwise = "required if the standard has several colours"}},
    {"rotation_deg",
     NumberOrNumbers{{.low = -360.0, .high = 360.0}},
     "rotations of the part about its normal; the smallest reading over all rotations is used",
     access<&PhotometryRequest::rotation_deg>,
     {.value = "LIST",
      .notation = Notation::number_list,
      .option = "--rotation",
      .otherwise = "the standard's",
      .qualified = "photometry.rotation_deg"}},
    {"dye",
     kDye,
     "dye of the part: none, red or amber (illustrative values), or a file with the absorption of a dye",
     access<&PhotometryRequest::dye>,
     {.value = "NAME|FILE",
      .otherwise = "red or amber if this is the colour, unless the design has a spectral absorption; otherwise none"}},
    {"source_arcmin",
     Number{kApertureArcmin},
     "angular diameter of the source",
     access<&PhotometryRequest::source_arcmin>,
     {.value = "D", .otherwise = "the standard's"}},
    {"receiver_arcmin",
     Number{kApertureArcmin},
     "angular diameter of the receiver",
     access<&PhotometryRequest::receiver_arcmin>,
     {.value = "D", .otherwise = "the standard's"}},
    {"window_deg",
     Number{{.low = 0.05, .high = 10.0}},
     "half angle of the computed far field",
     access<&PhotometryRequest::window_deg>,
     {.value = "W"}},
    {"light",
     Word{kPhotometricLights},
     "light: CIE illuminant a or d65, weighted by the luminous efficiency of the eye, or design for the light in the "
     "design file",
     access<&PhotometryRequest::light>,
     {.value = "LIGHT"}},
    {"engine",
     Word{kEnginesOfParts},
     "tracing method: exact (beams), montecarlo or embree (rays), or auto (beams if possible)",
     access<&PhotometryRequest::engine>,
     {.value = "ENGINE"}},
    {"samples",
     Integer{kSamples},
     "number of Monte Carlo rays for each direction of the incident light",
     access<&PhotometryRequest::samples>,
     {.value = "N", .usual = "1048576"},
     kNeedRays},
    {"cutoff",
     Number{kCutoff},
     "minimum power of a beam that is followed exactly, as a fraction of the light on one element (weaker beams are "
     "resampled with auto and truncated with exact)",
     access<&PhotometryRequest::cutoff>,
     {.value = "W", .otherwise = "1e-5; finite parts with resampling: see docs/commands/photometry.md"},
     kNeedExact},
    {"diffraction",
     Flag{},
     "add diffraction to the geometric far field",
     access<&PhotometryRequest::diffraction>,
     {.notation = Notation::absent}},
    {"window_power",
     Flag{},
     "integrate the power inside and outside of the far field's window, as a check",
     access<&PhotometryRequest::window_power>,
     {},
     kNeedExact},
    {"advice",
     Flag{},
     "search for a changed design that passes, if a test point fails",
     access<&PhotometryRequest::advice>,
     {.notation = Notation::absent}},
    {"map", Flag{}, "compute a map of R_A over entrance and observation angle, or of R_I if the standard limits R_I",
     access<&PhotometryRequest::map>},
    {"map_entrance_deg",
     NumberOrNumbers{.range = kMapEntrance, .max_count = kMaxMapAngles, .may_be_empty = true},
     "entrance angles of the map; at least two, from -85 to 85; negative angles are on the opposite side of the normal",
     access<&PhotometryRequest::map_entrance_deg>,
     {.value = "LIST", .notation = Notation::number_list, .option = "--map-entrance", .otherwise = "0:60:5"},
     kPhotometryNeedMap},
    {"map_observation_deg",
     NumberOrNumbers{.range = kMapObservation, .max_count = kMaxMapAngles, .may_be_empty = true},
     "observation angles of the map; at least two, from 0 to the half angle of the far field",
     access<&PhotometryRequest::map_observation_deg>,
     {.value = "LIST",
      .notation = Notation::number_list,
      .option = "--map-observation",
      .otherwise = "41 angles from 0 to the half angle of the far field"},
     kPhotometryNeedMap},
    {"map_presentation_deg",
     NumberOrNumbers{.range = kMapPresentation, .max_count = kMaxMapAngles, .may_be_empty = true},
     "presentation angles of the map; from -180 to 180; one map for each presentation angle and rotation; at 0, the "
     "observer is on the side of the normal, as seen from the source",
     access<&PhotometryRequest::map_presentation_deg>,
     {.value = "LIST", .notation = Notation::number_list, .option = "--map-presentation", .otherwise = "0"},
     kPhotometryNeedMap},
    {"pictures",
     Flag{},
     "compute the maps and curves for the drawings \"far_field\" and \"r_a\"",
     access<&PhotometryRequest::pictures>,
     {.is_no_option = true}},
    seed_row<PhotometryRequest>()};

}  // namespace

template <>
const Request& description<PhotometryRequest>() {
  static constexpr Request request{"photometry", "photometry", kPhotometryRows, initial_object<PhotometryRequest>,
                                   check_photometry};
  return request;
}

}  // namespace retrace::requests

#include <fmt/format.h>

#include "core/error.h"
#include "core/schema/access.h"
#include "requests/descriptions.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access;

constexpr std::string_view kSentPolarisations[] = {"design", "unpolarised", "linear", "right", "left"};
constexpr std::string_view kLinear[] = {"linear"};
constexpr NumberRange kLaserWavelength{.low = 100.0, .high = 20000.0};
constexpr NumberRange kArrayIncidence{.low = -180.0, .high = 180.0};
/// Allowed angles from the direction to the source. The far field is computed in the approximation of small angles.
constexpr NumberRange kSmallArcsec{.low = 0.0, .high = 36000.0};
constexpr NumberRange kSignedArcsec{.low = -36000.0, .high = 36000.0};
/// Allowed heights of orbits. The upper limit is far above the orbit of the Moon.
constexpr NumberRange kOrbitKm{.low = 0.0, .low_included = false, .high = 1e7};
constexpr std::size_t kMaxRangingValues = 1000;

constexpr schema::Condition kIsLinear[] = {schema::is("polarisation", kLinear)};
constexpr Need kNeedLinear[] = {kIsLinear};
constexpr schema::Condition kNoOrbit[] = {schema::is_absent("orbit_km")};
constexpr Need kNeedNoOrbit[] = {kNoOrbit};
constexpr schema::Condition kOrbit[] = {schema::is_given("orbit_km")};
constexpr Need kNeedOrbit[] = {kOrbit};
constexpr schema::Condition kCubes[] = {schema::is_given("cubes")};
constexpr Need kNeedCubes[] = {kCubes};

constexpr Row kRangingRows[] = {
    {"cubes",
     File{"a file of cubes"},
     "file with the positions and axes of the cubes of an array, .toml or .csv; every cube has the shape and the "
     "material of the design",
     access<&RangingRequest::cubes>,
     {.value = "FILE", .otherwise = "a single cube"}},
    {"wavelength_nm",
     NumberOrNumbers{.range = kLaserWavelength, .max_count = kMaxRangingValues, .may_be_empty = true},
     "wavelengths of the light in vacuum",
     access<&RangingRequest::wavelength_nm>,
     {.value = "LIST", .notation = Notation::number_list, .option = "--wavelength", .otherwise = "as in the design"}},
    {"incidence_deg",
     NumberOrNumbers{.range = kArrayIncidence, .max_count = kMaxRangingValues},
     "angles between +z and the direction to the source; without an array, > -90 and < 90",
     access<&RangingRequest::incidence_deg>,
     {.value = "LIST", .notation = Notation::number_list, .option = "--incidence"}},
    {"azimuth_deg",
     NumberOrNumbers{.range = kAzimuth, .max_count = kMaxRangingValues},
     "azimuths of the source",
     access<&RangingRequest::azimuth_deg>,
     {.value = "LIST", .notation = Notation::number_list, .option = "--azimuth"}},
    {"polarisation",
     Word{kSentPolarisations},
     "polarisation of the transmitted light: as in the design, or unpolarised, linear, right or left (circular)",
     access<&RangingRequest::polarisation>,
     {.value = "STATE"}},
    {"polarisation_deg",
     Number{{.low = -180.0, .high = 180.0}},
     "direction of linear polarisation, from the projection of +x, as seen from the source",
     access<&RangingRequest::polarisation_deg>,
     {.value = "A"},
     kNeedLinear},
    {"aberration_arcsec",
     Numbers{2, kSmallArcsec},
     "smallest and largest velocity aberration; cross sections are averaged over the annulus between these angles",
     access<&RangingRequest::aberration_arcsec>,
     {.value = "A,B", .notation = Notation::commas, .otherwise = "from the orbit, if it is given; otherwise none"},
     kNeedNoOrbit},
    {"orbit_km",
     Number{kOrbitKm},
     "height of a circular orbit around the Earth, from which the velocity aberration is computed",
     access<&RangingRequest::orbit_km>,
     {.value = "H", .otherwise = "none"}},
    {"elevation_deg",
     Number{{.low = 0.0, .high = 90.0}},
     "smallest elevation at which a station observes the satellite",
     access<&RangingRequest::elevation_deg>,
     {.value = "E"},
     kNeedOrbit},
    {"window_arcsec",
     Number{{.low = 0.0, .low_included = false, .high = 36000.0}},
     "half width of the map of the far field",
     access<&RangingRequest::window_arcsec>,
     {.value = "W", .option = "--window", .otherwise = "chosen so that the annulus and the spots are inside"}},
    {"map_points",
     Integer{{.low = 3.0, .high = 1001.0}},
     "number of points of the map along each axis",
     access<&RangingRequest::map_points>,
     {.value = "N"}},
    {"source_arcsec",
     Number{kSmallArcsec},
     "angular diameter of the source, as seen from the cube",
     access<&RangingRequest::source_arcsec>,
     {.value = "D"}},
    {"receiver_arcsec",
     Number{kSmallArcsec},
     "angular diameter of the receiver, as seen from the cube",
     access<&RangingRequest::receiver_arcsec>,
     {.value = "D"}},
    {"entrance_reflections", Flag{},
     "add the light that the entrance face reflects at its outer side, or at its inner side between two "
     "retroreflections",
     access<&RangingRequest::entrance_reflections>},
    {"pulse_ps",
     Number{{.low = 0.0, .low_included = false, .high = 1e9}},
     "duration of the Gaussian pulse (full width at half maximum)",
     access<&RangingRequest::pulse_ps>,
     {.value = "T", .otherwise = "continuous light"},
     kNeedCubes},
    {"shots",
     Integer{{.low = 0.0, .high = 1e6}},
     "number of single shots, in which the fields of the cubes are added with random phases",
     access<&RangingRequest::shots>,
     {.value = "N"},
     kNeedCubes},
    {"observation_arcsec",
     Numbers{2, kSignedArcsec},
     "direction of the receiver for single shots and for the pulse: angles to the right and up from the direction to "
     "the source",
     access<&RangingRequest::observation_arcsec>,
     {.value = "X,Y", .notation = Notation::commas, .otherwise = "to the right, in the middle of the annulus"},
     kNeedCubes},
    seed_row<RangingRequest>()};

void check_ranging(const void* object) {
  const auto& request = *static_cast<const RangingRequest*>(object);
  if (request.aberration_arcsec && request.aberration_arcsec->front() > request.aberration_arcsec->back())
    throw InputError(Field{"aberration_arcsec"}, "the first angle must be at most the second angle");
  if (!request.cubes.empty()) return;
  for (const double incidence_deg : request.incidence_deg)
    if (!(incidence_deg > kIncidence.low && incidence_deg < kIncidence.high))
      throw InputError(Field{"incidence_deg"},
                       fmt::format("must be > -90 and < 90 without {}, got {}", reference({"cubes"}), incidence_deg));
}

}  // namespace

template <>
const Request& description<RangingRequest>() {
  static constexpr Request request{"ranging", "ranging", kRangingRows, initial_object<RangingRequest>, check_ranging};
  return request;
}

}  // namespace retrace::requests

#include "requests/descriptions.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/schema/access.h"
#include "requests/rows/common.h"

namespace retrace::requests {
namespace {

using schema::access, schema::access_by;

constexpr std::string_view kTones[] = {"reinhard", "linear", "log"};
constexpr NumberRange kLampAim{.low = -45.0, .high = 45.0};
constexpr double kMaxPictureSide = 16384.0;
constexpr std::size_t kMaxPixels = std::size_t{1} << 26U;
// Pictures of a road are kept in memory with all their channels.
constexpr std::size_t kMaxRoadPixels = std::size_t{1} << 24U;

constexpr Row kDetectorRows[] = {
    {"incidence_deg",
     Number{kIncidence},
     "angle of incidence",
     access<&DetectorRequest::incidence_deg>,
     {.value = "T", .option = "--incidence"}},
    {"azimuth_deg",
     Number{kAzimuth},
     "azimuth of the source",
     access<&DetectorRequest::azimuth_deg>,
     {.value = "P", .option = "--azimuth"}},
    {"pixels",
     Integer{{.low = 1.0, .high = 8192.0}},
     "pixels along the longer side of the face",
     access<&DetectorRequest::pixels>,
     {.value = "N"}},
    {"angle_pixels",
     Integer{{.low = 1.0, .high = 2049.0}},
     "pixels along each side of the angular map",
     access<&DetectorRequest::angle_pixels>,
     {.value = "N"}},
    {"window_deg",
     Number{{.low = 0.0, .low_included = false, .high = 90.0}},
     "half width of the angular map",
     access<&DetectorRequest::window_deg>,
     {.value = "W",
      .otherwise = "such that it contains 99.9 % of the light that returns near the "
                   "source"}},
    {"engine",
     Word{kEnginesOfParts},
     "method of tracing: beams (exact), rays (montecarlo or embree, which are the same "
     "here), or auto: exact if possible",
     access<&DetectorRequest::engine>,
     {.value = "ENGINE"}},
    {"cutoff",
     Number{kCutoff},
     "minimum power of a beam that is followed, as a fraction of the incident power",
     access<&DetectorRequest::cutoff>,
     {.value = "W", .otherwise = "such that at most 1e-5 of the power is truncated"},
     kNeedExact},
    {"samples",
     Integer{kSamples},
     "number of Monte Carlo rays",
     access<&DetectorRequest::samples>,
     {.value = "N", .otherwise = "4194304, increased to at most 33554432 until the bins are small"},
     kNeedRays},
    {"bin_error",
     Number{{.low = 0.0, .high = 1.0, .high_included = false}},
     "maximum relative standard error of a bin with light; pixels are merged into bins until it "
     "is reached; 0: pixels are not merged",
     access<&DetectorRequest::bin_error>,
     {.value = "E"},
     kNeedRays},
    seed_row<DetectorRequest>()};

// Rows of the options that camera pictures and road pictures have in common.

template <class Type>
schema::Value pixels_of(const Type& request) {
  return std::vector<double>{static_cast<double>(request.columns), static_cast<double>(request.rows)};
}
template <class Type>
void set_pixels(Type& request, const schema::Value& value) {
  const auto& numbers = std::get<std::vector<double>>(value);
  request.columns = static_cast<std::size_t>(numbers[0]);
  request.rows = static_cast<std::size_t>(numbers[1]);
}
template <class Type>
constexpr Row pixels_row() {
  return {"pixels",
          Numbers{2, {.low = 1.0, .high = kMaxPictureSide}, "numbers", true},
          "columns and rows of the picture",
          access_by<pixels_of<Type>, set_pixels<Type>>,
          {.value = "CxR", .notation = Notation::by_x}};
}
template <class Type>
constexpr Row exposure_row() {
  return {"exposure_ev",
          Number{{.low = -30.0, .high = 40.0}},
          "exposure of the PNG file as an exposure value at ISO 100 (EV100); luminances of 1.2 x 2^EV cd/m2 are white",
          access<&Type::exposure_ev>,
          {.value = "EV", .otherwise = "such that the brightest thousandth of the pixels is white"}};
}
template <class Type>
constexpr Row tone_row() {
  return {"tone",
          Word{kTones},
          "tone curve of the PNG file: reinhard (adaptation of the eye), linear, or log (four decades)",
          access<&Type::tone>,
          {.value = "CURVE"}};
}

/// Checks the total number of pixels of one or more pictures of the same size.
template <class Type>
void check_pixels(const Type& request, std::size_t pictures, std::size_t max_pixels) {
  if (request.columns * request.rows * pictures > max_pixels)
    throw InputError(Field{"pixels"},
                     fmt::format("must be at most {} pixels in total, got {}x{}{}", max_pixels, request.columns,
                                 request.rows, pictures > 1 ? fmt::format(" for each of {} distances", pictures) : ""));
}

void check_camera(const void* object) {
  check_pixels(*static_cast<const CameraRequest*>(object), 1, kMaxPixels);
}

constexpr NumberRange kLampAngle{.low = -90.0, .low_included = false, .high = 90.0, .high_included = false};

constexpr schema::Condition kNoEye[] = {schema::is_absent("eye_mm")};
constexpr schema::Condition kNoEyeOrNoLamp[] = {schema::is_absent("eye_mm"), schema::is_absent("lamp_mm")};
constexpr schema::Condition kNoLampFile[] = {schema::is_absent("lamp")};
constexpr schema::Condition kLampFile[] = {schema::is_given("lamp")};
constexpr schema::Condition kNoNoise[] = {schema::is_absent("noise")};
constexpr Need kNeedNoEye[] = {kNoEye};
constexpr Need kNeedNoEyeOrNoLamp[] = {kNoEyeOrNoLamp};
constexpr Need kNeedNoLampFile[] = {kNoLampFile};
constexpr Need kNeedLampFile[] = {kLampFile};
constexpr Need kNeedNoNoise[] = {kNoNoise};

constexpr Row kCameraRows[] = {
    {"distance_m",
     Number{{.low = 0.0, .low_included = false, .high = 1e6}},
     "distance of the lamp and the eye from the part",
     access<&CameraRequest::distance_m>,
     {.value = "D"},
     kNeedNoEyeOrNoLamp},
    {"observation_deg",
     Number{{.low = 0.0, .high = 180.0, .high_included = false}},
     "observation angle; the eye is above the lamp",
     access<&CameraRequest::observation_deg>,
     {.value = "A"},
     kNeedNoEye},
    {"v_deg", Number{kLampAngle}, "vertical angle of the lamp", access<&CameraRequest::v_deg>, {.value = "V"}},
    {"h_deg", Number{kLampAngle}, "horizontal angle of the lamp", access<&CameraRequest::h_deg>, {.value = "H"}},
    {"rotation_deg",
     Number{{.low = -360.0, .high = 360.0}},
     "rotation of the part about its normal",
     access<&CameraRequest::rotation_deg>,
     {.value = "E", .option = "--rotation-deg"}},
    {"eye_mm",
     Numbers{3, kPlaceMm},
     "position of the eye",
     access<&CameraRequest::eye_mm>,
     {.value = "X,Y,Z", .notation = Notation::commas, .otherwise = "from distance and angles"}},
    {"lamp_mm",
     Numbers{3, kPlaceMm},
     "position of the lamp",
     access<&CameraRequest::lamp_mm>,
     {.value = "X,Y,Z", .notation = Notation::commas, .otherwise = "from distance and angles"}},
    {"lamp_arcmin",
     Number{{.low = 0.0, .low_included = false, .high = 600.0}},
     "angular diameter of the lamp",
     access<&CameraRequest::lamp_arcmin>,
     {.value = "D"}},
    {"pupil_arcmin",
     Number{{.low = 0.0, .high = 600.0}},
     "angular diameter of the eye's pupil",
     access<&CameraRequest::pupil_arcmin>,
     {.value = "D"}},
    {"illuminance_lx",
     Number{{.low = 0.0}},
     "illuminance by the lamp at the part, on a plane normal to the light",
     access<&CameraRequest::illuminance_lx>,
     {.value = "E"},
     kNeedNoLampFile},
    {"ambient_lx",
     Number{{.low = 0.0}},
     "illuminance of the face by uniform light from the front",
     access<&CameraRequest::ambient_lx>,
     {.value = "E"}},
    {"backlight_lx",
     Number{{.low = 0.0}},
     "illuminance by uniform light from behind and around the part",
     access<&CameraRequest::backlight_lx>,
     {.value = "E"}},
    pixels_row<CameraRequest>(),
    {"field_mm",
     Number{{.low = 0.0, .low_included = false}},
     "width of the field of view at the part",
     access<&CameraRequest::field_mm>,
     {.value = "W", .otherwise = "the part and a margin"}},
    {"film_mm",
     Numbers{2, {.low = 0.0, .low_included = false, .high = 1e5}},
     "width and height of the sheet that shows an infinite design",
     access<&CameraRequest::film_mm>,
     {.value = "WxH", .notation = Notation::by_x, .usual = "100x100"}},
    {"cylinder_mm",
     Number{kPlaceMm},
     "radius of the cylinder around which the sheet is bent; negative: the sheet is on the inside of the cylinder",
     access<&CameraRequest::cylinder_mm>,
     {.value = "R", .otherwise = "plane"}},
    {"noise",
     Number{{.low = 0.0, .low_included = false, .high = 1.0, .high_included = false}},
     "relative noise of the pixels at which the computation of the picture ends",
     access<&CameraRequest::noise>,
     {.value = "E"}},
    {"passes",
     Integer{{.low = 2.0, .high = 65536.0}},
     "number of passes, each with four light paths per pixel; not together with the noise",
     access<&CameraRequest::passes>,
     {.value = "N", .otherwise = "as many as the noise requires"},
     kNeedNoNoise},
    {"lamp",
     File{"an IES or EULUMDAT file"},
     "IES or EULUMDAT file (.ies, .ldt) of the lamp or headlamps",
     access<&CameraRequest::lamp>,
     {.value = "FILE", .otherwise = "the same intensity in all directions"}},
    {"lamp_aim_deg",
     Number{kLampAim},
     "downward tilt of the axis of a lamp from a file",
     access<&CameraRequest::lamp_aim_deg>,
     {.value = "D"},
     kNeedLampFile},
    {"light",
     Word{kPhotometricLights},
     "light of the lamp and the surroundings: CIE illuminant a or d65, weighted by the luminous efficiency of the eye, "
     "or design for the light in the design file",
     access<&CameraRequest::light>,
     {.value = "LIGHT"}},
    {"dye",
     kDye,
     "dye of the part: none, red, amber (illustrative) or a file; none keeps the absorption in the design",
     access<&CameraRequest::dye>,
     {.value = "NAME|FILE"}},
    {"diffraction",
     Flag{},
     "add diffraction to the light of geometrical optics",
     access<&CameraRequest::diffraction>,
     {.notation = Notation::absent}},
    exposure_row<CameraRequest>(),
    tone_row<CameraRequest>(),
    {"background",
     File{"a picture"},
     "picture behind the part in the PNG file: a photograph (PNG, JPEG; white is the white of the exposure), or "
     "OpenEXR in cd/m2",
     access<&CameraRequest::background>,
     {.value = "FILE", .otherwise = "black"}},
    seed_row<CameraRequest>()};

constexpr std::string_view kMounts[] = {"car", "sign"};
constexpr std::string_view kOutlines[] = {"auto", "rectangle", "ellipse", "triangle", "octagon"};
constexpr std::string_view kSymbols[] = {"arrow", "none"};
constexpr schema::Condition kSign[] = {schema::is("mount", schema::only(kMounts, "sign"))};
constexpr Need kNeedSign[] = {kSign};

void check_road(const void* object) {
  constexpr std::size_t most = 6;
  const auto& request = *static_cast<const RoadRequest*>(object);
  const std::size_t count = request.distance_m.size();
  if (count > most)
    throw InputError(Field{"road.distance_m"}, fmt::format("must be 1 to {} distances, got {}", most, count));
  check_pixels(request, std::max<std::size_t>(count, 1), kMaxRoadPixels);
}

constexpr Row kRoadRows[] = {
    {"distance_m",
     NumberOrNumbers{{.low = 5.0, .high = 1000.0}},
     "distances from the headlamps to the reflectors, along the road; 1 to 6 distances, each from 5 to 1000 m",
     access<&RoadRequest::distance_m>,
     {.value = "LIST",
      .notation = Notation::number_list,
      .option = "--road-distance-m",
      .qualified = "road.distance_m"}},
    {"mount",
     Word{kMounts},
     "object that carries the reflectors: car (two reflectors at the rear) or sign (on a mast)",
     access<&RoadRequest::mount>,
     {.value = "OBJECT"}},
    {"reflector_mm",
     Numbers{2, {.low = 0.0, .low_included = false, .high = 5000.0}},
     "width and height of each reflector or of the sign; each > 0 and <= 5000",
     access<&RoadRequest::reflector_mm>,
     {.value = "WxH",
      .notation = Notation::by_x,
      .otherwise = "the size of a finite design; for an infinite design, 120x25 on a car and 600x600 on a sign"}},
    {"outline",
     Word{kOutlines},
     "outline of each reflector or of the sign: rectangle, ellipse, triangle, octagon or auto; auto is the outline of "
     "a finite design; for an infinite design, it is a rectangle on a car and an ellipse on a sign",
     access<&RoadRequest::outline>,
     {.value = "SHAPE"}},
    {"reflector_height_m",
     Number{{.low = 0.0, .low_included = false, .high = 20.0}},
     "height of the centre of the reflectors or of the sign above the road",
     access<&RoadRequest::reflector_height_m>,
     {.value = "H", .otherwise = "0.6 on a car, 2.2 on a sign"}},
    {"lateral_m",
     Number{{.low = -20.0, .high = 20.0}},
     "lateral distance of each reflector from the centre of the car, or of the sign from the centre of the driver's "
     "lane; positive to the right",
     access<&RoadRequest::lateral_m>,
     {.value = "X", .otherwise = "0.72 on a car, 4 on a sign"}},
    {"mast_m",
     Number{{.low = 0.0, .low_included = false, .high = 25.0}},
     "height of the mast of a sign; at least the height of the sign's centre",
     access<&RoadRequest::mast_m>,
     {.value = "H", .otherwise = "up to the upper edge of the sign"},
     kNeedSign},
    {"symbol",
     Word{kSymbols},
     "opaque black symbol on a sign: arrow or none",
     access<&RoadRequest::symbol>,
     {.value = "SYMBOL"},
     kNeedSign},
    {"lamp_cd",
     Number{{.low = 0.0, .low_included = false, .high = 1e6}},
     "intensity of each headlamp, the same in all directions ahead",
     access<&RoadRequest::lamp_cd>,
     {.value = "I"},
     kNeedNoLampFile},
    {"lamp",
     File{"an IES or EULUMDAT file"},
     "IES or EULUMDAT file (.ies, .ldt) of the lamp or headlamps",
     access<&RoadRequest::lamp>,
     {.value = "FILE", .otherwise = "the same intensity in all directions"}},
    {"lamp_height_m",
     Number{{.low = 0.2, .high = 3.0}},
     "height of the centres of the headlamps",
     access<&RoadRequest::lamp_height_m>,
     {.value = "H"}},
    {"lamp_aim_deg",
     Number{kLampAim},
     "downward tilt of the axis of a lamp from a file",
     access<&RoadRequest::lamp_aim_deg>,
     {.value = "D"},
     kNeedLampFile},
    {"eye_height_m",
     Number{{.low = 0.3, .high = 5.0}},
     "height of the driver's eyes above the road",
     access<&RoadRequest::eye_height_m>,
     {.value = "H"}},
    {"asphalt_mcd",
     Number{{.low = 0.0, .high = 1000.0}},
     "coefficient of retroreflected luminance R_L of the asphalt in the 30 m geometry, in mcd/(lx m2); the default is "
     "illustrative",
     access<&RoadRequest::asphalt_mcd>,
     {.value = "RL"}},
    {"marking_mcd",
     Number{{.low = 0.0, .high = 5000.0}},
     "coefficient of retroreflected luminance R_L of the markings in the 30 m geometry, in mcd/(lx m2); the default is "
     "illustrative",
     access<&RoadRequest::marking_mcd>,
     {.value = "RL"}},
    {"dye",
     kDye,
     "dye of the reflectors: none, red, amber (illustrative) or a file",
     access<&RoadRequest::dye>,
     {.value = "NAME|FILE"}},
    pixels_row<RoadRequest>(),
    {"field_deg",
     Number{{.low = 1.0, .high = 90.0}},
     "horizontal field of view of the picture",
     access<&RoadRequest::field_deg>,
     {.value = "W"}},
    exposure_row<RoadRequest>(),
    tone_row<RoadRequest>(),
    seed_row<RoadRequest>()};

}  // namespace

template <>
const Request& description<DetectorRequest>() {
  static constexpr Request request{"detector", "image", kDetectorRows, initial_object<DetectorRequest>};
  return request;
}
template <>
const Request& description<CameraRequest>() {
  static constexpr Request request{"camera", "image", kCameraRows, initial_object<CameraRequest>, check_camera};
  return request;
}
template <>
const Request& description<RoadRequest>() {
  static constexpr Request request{"road", "image", kRoadRows, initial_object<RoadRequest>, check_road};
  return request;
}

}  // namespace retrace::requests

#include "app/image_options.h"

#include "app/shared_arguments.h"

namespace retrace::app {
namespace {

constexpr std::uint64_t kMostWhole = std::numeric_limits<std::uint32_t>::max();

std::vector<Argument> detector_arguments(ImageOptions& o) {
  return {
      {"--detector", "maps of the light that comes back, by place and by direction", &o.detector},
      {"--incidence T", "detector: angle of incidence in degrees", &o.incidence_deg},
      {"--azimuth P", "detector: azimuth of the source in degrees", &o.azimuth_deg},
      engine_argument(o.engine, "detector: exact, montecarlo (embree), or auto: exact where it serves"),
      {"--cutoff W",
       "detector, exact: least power that is followed, as a share of the incident [what leaves 1e-5 truncated]",
       &o.cutoff},
      {"--samples N", "detector: rays, by Monte Carlo", &o.samples, whole(0, kMostWhole)},
      {"--window-deg W", "detector: half width of the angular map", &o.window_deg},
      {"--angle-pixels N", "detector: pixels along a side of the angular map", &o.angle_pixels, whole(0, kMostWhole)}};
}

std::vector<Argument> camera_arguments(ImageOptions& o) {
  return {{"--camera", "the part in the light of a lamp, as a camera sees it", &o.camera},
          {"--distance-m D", "camera: distance of lamp and eye", &o.distance_m},
          {"--observation-deg A", "camera: angle by which the eye is above the lamp", &o.observation_deg},
          {"--v-deg V", "camera: vertical angle of the lamp", &o.v_deg},
          {"--h-deg H", "camera: horizontal angle of the lamp", &o.h_deg},
          {"--rotation-deg E", "camera: turn of the part about its normal", &o.rotation_deg},
          {"--eye-mm X,Y,Z", "camera: place of the eye [by distance and angles]", &o.eye_mm},
          {"--lamp-mm X,Y,Z", "camera: place of the lamp [by distance and angles]", &o.lamp_mm},
          {"--lamp-arcmin D", "camera: diameter of the lamp's disc", &o.lamp_arcmin},
          {"--pupil-arcmin D", "camera: diameter of the eye's disc", &o.pupil_arcmin},
          {"--illuminance-lx E", "camera: of the lamp, across its beam at the part", &o.illuminance_lx},
          {"--ambient-lx E", "camera: even light from in front, on the face", &o.ambient_lx},
          {"--backlight-lx E", "camera: even light from behind and round the part", &o.backlight_lx},
          {"--field-mm W", "camera: width shown at the part [the part and a margin]", &o.field_mm},
          {"--film-mm WxH", "camera: size of the sheet that an endless design is seen as", &o.film_mm},
          {"--cylinder-mm R", "camera: radius of the cylinder that the sheet is bent over; negative: inside it [plane]",
           &o.cylinder_mm},
          {"--noise E", "camera: relative noise of pixels to reach", &o.noise},
          {"--passes N", "camera: passes of four paths a pixel, in place of --noise", &o.passes, whole(0, kMostWhole)},
          {"--false-colour", "camera: luminance as colours too", &o.false_colour}};
}

std::vector<Argument> road_arguments(ImageOptions& o) {
  return {{"--road", "two such reflectors on a car ahead at night, from a driver's eye", &o.road},
          {"--road-distance-m LIST", "road: distances of the car ahead", &o.road_distance_m},
          {"--lamp-cd I", "road: intensity of each headlamp towards the reflectors", &o.lamp_cd},
          dye_argument(o.dye, "road: none, red, amber (illustrative) or a file")};
}

}  // namespace

std::vector<Argument> image_arguments(ImageOptions& options) {
  std::vector<Argument> all = {
      design_argument(options.design),
      {"--pixels N|CxR", "detector: along the longer side of the face [400]; camera: columns and rows [400x300]",
       &options.pixels}};
  for (const auto& some : {detector_arguments(options), camera_arguments(options), road_arguments(options)})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace retrace::app

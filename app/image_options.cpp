#include "app/image_options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>

namespace retrace::app {
namespace {

/// Refuses what is no number in the C locale.
template <class Number>
CLI::Validator number(const char* what) {
  const auto check = [what](const std::string& text) -> std::string {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size()) return {};
    return std::string("must be ") + what + ", got " + text;
  };
  return {check, "", "NUMBER"};
}

template <class Value>
void real(CLI::App& command, const char* name, Value& value, const char* type, const char* what) {
  CLI::Option* const option = command.add_option(name, value, what)->type_name(type)->check(number<double>("a number"));
  if constexpr (std::is_same_v<Value, double>) option->capture_default_str();
}

template <class Value>
void whole(CLI::App& command, const char* name, Value& value, const char* type, const char* what) {
  CLI::Option* const option =
      command.add_option(name, value, what)->type_name(type)->check(number<std::uint32_t>("a whole number"));
  if constexpr (!std::is_same_v<Value, std::optional<std::uint32_t>>) option->capture_default_str();
}

void add_detector(CLI::App& command, ImageOptions& image) {
  command.add_flag("--detector", image.detector, "maps of the light that comes back, by place and by direction");
  real(command, "--incidence", image.incidence_deg, "T", "detector: angle of incidence in degrees");
  real(command, "--azimuth", image.azimuth_deg, "P", "detector: azimuth of the source in degrees");
  command.add_option("--engine", image.engine, "detector: exact, montecarlo (embree), or auto: exact where it serves")
      ->type_name("ENGINE")
      ->capture_default_str();
  real(command, "--cutoff", image.cutoff, "W",
       "detector, exact: least power that is followed, as a share of the incident [what leaves 1e-5 truncated]");
  whole(command, "--samples", image.samples, "N", "detector: rays, by Monte Carlo");
  real(command, "--window-deg", image.window_deg, "W", "detector: half width of the angular map");
  whole(command, "--angle-pixels", image.angle_pixels, "N", "detector: pixels along a side of the angular map");
}

void add_camera(CLI::App& command, ImageOptions& image) {
  command.add_flag("--camera", image.camera, "the part in the light of a lamp, as a camera sees it");
  real(command, "--distance-m", image.distance_m, "D", "camera: distance of lamp and eye");
  real(command, "--observation-deg", image.observation_deg, "A", "camera: angle by which the eye is above the lamp");
  real(command, "--v-deg", image.v_deg, "V", "camera: vertical angle of the lamp");
  real(command, "--h-deg", image.h_deg, "H", "camera: horizontal angle of the lamp");
  real(command, "--rotation-deg", image.rotation_deg, "E", "camera: turn of the part about its normal");
  command.add_option("--eye-mm", image.eye_mm, "camera: place of the eye [by distance and angles]")->type_name("X,Y,Z");
  command.add_option("--lamp-mm", image.lamp_mm, "camera: place of the lamp [by distance and angles]")
      ->type_name("X,Y,Z");
  real(command, "--lamp-arcmin", image.lamp_arcmin, "D", "camera: diameter of the lamp's disc");
  real(command, "--pupil-arcmin", image.pupil_arcmin, "D", "camera: diameter of the eye's disc");
  real(command, "--illuminance-lx", image.illuminance_lx, "E", "camera: of the lamp, across its beam at the part");
  real(command, "--ambient-lx", image.ambient_lx, "E", "camera: even light from in front, on the face");
  real(command, "--backlight-lx", image.backlight_lx, "E", "camera: even light from behind and round the part");
  real(command, "--field-mm", image.field_mm, "W", "camera: width shown at the part [the part and a margin]");
  command.add_option("--film-mm", image.film_mm, "camera: size of the sheet that an endless design is seen as")
      ->type_name("WxH")
      ->capture_default_str();
  real(command, "--cylinder-mm", image.cylinder_mm, "R",
       "camera: radius of the cylinder that the sheet is bent over; negative: inside it [plane]");
  real(command, "--noise", image.noise, "E", "camera: relative noise of pixels to reach");
  whole(command, "--passes", image.passes, "N", "camera: passes of four paths a pixel, in place of --noise");
  command.add_flag("--false-colour", image.false_colour, "camera: luminance as colours too");
}

void add_road(CLI::App& command, ImageOptions& image) {
  command.add_flag("--road", image.road, "two such reflectors on a car ahead at night, from a driver's eye");
  command.add_option("--road-distance-m", image.road_distance_m, "road: distances of the car ahead")
      ->type_name("LIST")
      ->capture_default_str();
  real(command, "--lamp-cd", image.lamp_cd, "I", "road: intensity of each headlamp towards the reflectors");
  command.add_option("--dye", image.dye, "road: none, red, amber (illustrative) or a file")
      ->type_name("NAME|FILE")
      ->capture_default_str();
}

}  // namespace

void add_image(CLI::App& app, ImageOptions& image) {
  CLI::App* const command = app.add_subcommand("image", "pictures: what a detector or a camera sees");
  command->add_option("DESIGN", image.design, "design file; - is standard input")
      ->required()
      ->check([](const std::string& text) { return text.empty() ? "must not be empty" : ""; });
  command
      ->add_option("--pixels", image.pixels,
                   "detector: along the longer side of the face [400]; camera: columns and rows [400x300]")
      ->type_name("N|CxR");
  add_detector(*command, image);
  add_camera(*command, image);
  add_road(*command, image);
}

}  // namespace retrace::app

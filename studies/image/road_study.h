#pragma once

// Reflectors of a car as seen at night by the driver behind it. `retrace image` runs this study if a road is requested.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "design/design.h"
#include "materials/spectrum.h"
#include "requests/image.h"
#include "studies/image/image_result.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Two cars on a road at night. The front car has two reflectors on its rear, which the headlamps of the other car
/// illuminate. Lengths are in m. x is to the right and y up as seen by the driver, and z points from the reflectors to
/// the driver.
struct RoadScene {
  double lamp_height = 0.65;   ///< height of the headlamps' centres, unless the request changes it
  double lamp_half_gap = 0.6;  ///< distance of each headlamp from the centre of the car
  double lamp_diameter = 0.15;
  double eye_height = 1.2;
  double eye_right = -0.35;  ///< x of the eyes from the centre of the car; negative if the driver is on the left side
  double eye_behind = 1.8;   ///< distance of the eyes behind the headlamps
  double pupil_diameter = 0.007;
  double reflector_height = 0.6, reflector_half_gap = 0.72;
  double reflector_width = 0.12, reflector_tall = 0.025;
  double car_width = 1.75, car_tall = 1.42;

  double lamp_cd = 10'000.0;            ///< intensity of each dipped headlamp; not used with `lamp`
  std::optional<PhotometricLamp> lamp;  ///< photometric data of each headlamp
  double lamp_aim_deg = 0.0;            ///< angle by which the axis of `lamp` is tilted downwards from the horizontal
  std::string dye;                      ///< name or file of the reflectors' dye; empty: no dye

  std::size_t columns = 480;  ///< number of pixels of each picture
  std::size_t rows = 330;
  double field_deg = 13.0;  ///< angular width of each picture; 1 to 90
};

/// Reflector that is illuminated by both headlamps.
struct RoadReflector {
  double observation_deg[2] = {0.0, 0.0};  ///< observation angles for the left and the right headlamp
  double r_a[2] = {0.0, 0.0};              ///< cd/(lx m^2)
  double illuminance_lx[2] = {0.0, 0.0};   ///< illuminance of a plane perpendicular to the light
  double luminance = 0.0;                  ///< luminance of the reflector as seen by the driver, in cd/m^2
};

/// Picture of the front car as the driver sees it from one distance.
struct RoadView {
  double distance_m = 0.0;
  std::array<RoadReflector, 2> reflectors;  ///< left, right
  std::vector<double> luminance;            ///< luminance of the pixels in cd/m^2, row by row from the top
  std::vector<double> coloured;             ///< part of the luminance that comes from the reflectors
};

struct RoadResult : ImageResultBase {
  RoadRequest request;
  RoadScene scene;
  std::vector<RoadView> views;
};

/// Study of a checked request, ready to run.
class RoadStudy {
 public:
  /// \throw InputError for numbers out of range, and for designs that Photometer does not support
  RoadStudy(design::Design design, RoadRequest request);

  RoadResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

 private:
  design::Design design_;
  RoadRequest request_;
  RoadScene scene_;
  materials::SpectralCurve dye_absorption_per_mm_;
};

/// Computes the luminances of a view.
/// \param view view whose reflectors have been measured
void draw_road(const RoadScene& scene, RoadView& view);

}  // namespace retrace::studies

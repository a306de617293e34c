#pragma once

// Reflectors of a car as the driver behind it sees them at night: `retrace image` on a road.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "materials/spectrum.h"
#include "studies/design/design.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Two cars on a road at night: the one in front carries two reflectors on its rear, the one behind lights them.
/// Lengths in m; x to the right and y up as its driver sees it, z from the reflectors towards him.
struct RoadScene {
  double lamp_height = 0.65;   ///< of the headlamps' middles, unless the request says otherwise
  double lamp_half_gap = 0.6;  ///< of each from the middle of the car
  double lamp_diameter = 0.15;
  double eye_height = 1.2;
  double eye_right = -0.35;  ///< negative: the driver sits on the left
  double eye_behind = 1.8;   ///< the headlamps
  double pupil_diameter = 0.007;
  double reflector_height = 0.6, reflector_half_gap = 0.72;
  double reflector_width = 0.12, reflector_tall = 0.025;
  double car_width = 1.75, car_tall = 1.42;
};

struct RoadRequest {
  std::vector<double> distance_m = {10.0, 30.0, 100.0};  ///< of reflectors and headlamps; 1 to 6 of 5 to 1000
  double lamp_cd = 10'000.0;  ///< intensity of each headlamp towards the reflectors, dipped; > 0; without a lamp
  std::optional<PhotometricLamp> lamp;  ///< what each headlamp is
  double lamp_height_m = 0.65;          ///< of the headlamps' middles; 0.2 to 3
  double lamp_aim_deg = 0.0;            ///< by which a lamp's axis is turned down; -45 to 45
  std::string dye;                      ///< what the reflectors' dye is called: red, amber or another; empty: none
  materials::SpectralCurve dye_absorption_per_mm;
  std::size_t columns = 480;  ///< of each view
  std::size_t rows = 330;
  double field_deg = 13.0;  ///< width of each view; 1 to 90
};

/// One reflector, in the light of both headlamps.
struct RoadReflector {
  double observation_deg[2] = {0.0, 0.0};  ///< of the left and the right headlamp
  double r_a[2] = {0.0, 0.0};              ///< cd/(lx m^2)
  double illuminance_lx[2] = {0.0, 0.0};   ///< across the beam
  double luminance = 0.0;                  ///< cd/m^2, towards the eye
};

/// What the driver sees from one distance.
struct RoadView {
  double distance_m = 0.0;
  std::array<RoadReflector, 2> reflectors;  ///< left, right
  std::vector<double> luminance;            ///< cd/m^2, row by row from above
  std::vector<double> coloured;             ///< that part of it which comes from the reflectors
};

struct RoadResult {
  Design design;
  RoadRequest request;
  RoadScene scene;
  std::string engine;
  std::vector<RoadView> views;
  double elapsed_s = 0.0;
  std::vector<std::string> warnings;
  bool complete = true;
};

/// A checked request, ready to run.
class RoadStudy {
 public:
  /// \throw InputError for numbers out of range and all that photometry refuses
  RoadStudy(Design design, RoadRequest request, std::uint32_t seed = 1);

  RoadResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr) const;

 private:
  Design design_;
  RoadRequest request_;
  std::uint32_t seed_;
};

/// The luminances alone. \param views with their reflectors measured
void draw_road(const RoadScene& scene, const RoadRequest& request, RoadView& view);

}  // namespace retrace::studies

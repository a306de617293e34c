#pragma once

// Road at night with reflectors on a car or on a sign: positions, sizes and surfaces.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/vec.h"
#include "requests/image.h"
#include "studies/image/lamp.h"

namespace retrace::studies {

/// Object that carries the reflectors.
enum class RoadMount { car, sign };

/// A driver behind two headlamps, and reflectors ahead: two on the rear of another car, or a sign on a mast. Lengths
/// are in m. x is to the right and y up as seen by the driver, and z points from the reflectors to the driver. The road
/// is the plane y = 0. x = 0 is the centre of the driver's lane and of both cars.
struct RoadScene {
  RoadMount mount = RoadMount::car;

  double lamp_height = 0.65;   ///< height of the headlamps' centres
  double lamp_half_gap = 0.6;  ///< distance of each headlamp from the centre of the car
  double lamp_diameter = 0.15;
  double eye_height = 1.2;
  double eye_right = -0.35;  ///< x of the eyes; negative if the driver is on the left side
  double eye_behind = 1.8;   ///< distance of the eyes behind the headlamps
  double pupil_diameter = 0.007;

  std::vector<geometry::Vec3> reflectors = {{-0.72, 0.6, 0.0}, {0.72, 0.6, 0.0}};  ///< centres
  /// Outline of each reflector or of the sign, relative to the centre of the outline; convex, counter-clockwise. For
  /// reflectors with notches or holes, it is the convex hull.
  geometry::Polygon outline = {{-0.06, -0.0125}, {0.06, -0.0125}, {0.06, 0.0125}, {-0.06, 0.0125}};
  /// Convex polygons that make up a reflector with notches or holes; empty for other reflectors.
  std::vector<geometry::Polygon> pieces = {};
  /// `black`: black areas within the outline of a sign. `windows`: retroreflective areas within the black areas. The
  /// first black area minus the first window is the black line along the border. The other black areas are in the first
  /// window and form the symbol.
  std::vector<geometry::Polygon> black, windows;
  double mast_height = 0.0;
  double mast_width = 0.08;
  double car_width = 1.75, car_tall = 1.42;  ///< width and height of the car with the reflectors

  double lane_width = 3.5, line_width = 0.12;
  double dash_length = 4.0, dash_period = 12.0;  ///< length and period of the dashes left of the driver's lane
  double shoulder_width = 0.5;                   ///< width of the asphalt outside of the edge lines
  double asphalt_r_l = 0.015;                    ///< R_L in the 30 m geometry, cd/(lx m^2)
  double marking_r_l = 0.15;

  double lamp_cd = 10'000.0;            ///< intensity of each headlamp in all directions ahead; not used with `lamp`
  std::optional<PhotometricLamp> lamp;  ///< photometric data of each headlamp
  double lamp_aim_deg = 0.0;            ///< angle by which the axis of `lamp` is tilted downwards from the horizontal
  std::string dye;                      ///< name or file of the reflectors' dye; empty: no dye
  /// Colour of the light from the reflectors: linear sRGB with the luminance 1. The lamp is white.
  std::array<double, 3> tint = {1.0, 1.0, 1.0};

  std::size_t columns = 640;  ///< number of pixels of each picture
  std::size_t rows = 440;
  double field_deg = 13.0;  ///< angular width of each picture; 1 to 90

  /// Returns the convex polygons that make up a reflector or the sign.
  std::vector<geometry::Polygon> face() const {
    return pieces.empty() ? std::vector<geometry::Polygon>{outline} : pieces;
  }
  /// Returns the size of the bounding rectangle of a reflector or a sign, in m.
  geometry::Vec2 size() const;
  /// Returns the retroreflective area of one reflector or of the sign, in m^2.
  double area() const;
};

/// Returns the scene of a request, without the photometric data of the lamp, the dye and the tint.
/// \param design_face_mm convex polygons that make up the face of a finite design; empty for an infinite design
/// \throw InputError at the field of the request if a reflector is too large for the car, outside of the car or below
///     the road, if two reflectors overlap, if the mast does not reach the sign, or if a sign has notches or holes
RoadScene scene_of(const RoadRequest& request, const std::vector<geometry::Polygon>& design_face_mm);

/// Returns the positions of the left and the right headlamp.
/// \param distance_m distance from the headlamps to the reflectors, along the road
std::array<geometry::Vec3, 2> lamps_at(const RoadScene& scene, double distance_m);
geometry::Vec3 eye_at(const RoadScene& scene, double distance_m);

/// Returns the intensity of a headlamp towards a point, in cd.
double intensity(const RoadScene& scene, const geometry::Vec3& lamp, const geometry::Vec3& at);

/// Returns the illuminance by a headlamp on a plane perpendicular to the light, in lx.
double illuminance(const RoadScene& scene, const geometry::Vec3& lamp, const geometry::Vec3& at);

/// Returns the luminance of the road in the light of one headlamp, in cd/m^2, by the law of Lommel and Seeliger
/// (docs/theory/images.md).
/// \param r_l coefficient of retroreflected luminance in the 30 m geometry, in cd/(lx m^2)
double road_luminance(const RoadScene& scene, const geometry::Vec3& lamp, const geometry::Vec3& eye,
                      const geometry::Vec3& at, double r_l);

}  // namespace retrace::studies

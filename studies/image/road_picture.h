#pragma once

// Pictures of a road at night: luminances as seen by the driver.

#include <array>
#include <cstddef>
#include <vector>

#include "studies/image/road_scene.h"

namespace retrace::studies {

/// Reflector that is illuminated by both headlamps.
struct RoadReflector {
  double observation_deg[2] = {0.0, 0.0};  ///< observation angles for the left and the right headlamp
  double entrance_deg[2] = {0.0, 0.0};     ///< angles between the light and the normal of the reflector
  double r_a[2] = {0.0, 0.0};              ///< cd/(lx m^2)
  double illuminance_lx[2] = {0.0, 0.0};   ///< illuminance of a plane perpendicular to the light
  double luminance = 0.0;                  ///< luminance of the reflector as seen by the driver, in cd/m^2
  double intensity_cd = 0.0;               ///< luminous intensity of the reflector towards the driver
};

/// Pinhole camera at the eye of the driver. Positions in the picture are in pixels, x to the right and y downwards from
/// the upper left corner.
struct RoadCamera {
  geometry::Vec3 eye = geometry::Vec3::Zero();
  geometry::Vec3 forward = -geometry::Vec3::UnitZ();
  geometry::Vec3 right = geometry::Vec3::UnitX();
  geometry::Vec3 up = geometry::Vec3::UnitY();
  double pixel = 0.0;                             ///< width of a pixel on a plane at the distance 1
  geometry::Vec2 ahead = geometry::Vec2::Zero();  ///< position of the direction `forward` in the picture
  std::size_t columns = 0;
  std::size_t rows = 0;

  geometry::Vec2 position_of(const geometry::Vec3& point) const;
  /// Returns the direction, as a unit vector, in which a position of the picture is seen.
  geometry::Vec3 direction_at(const geometry::Vec2& position) const;
  /// Returns the direction from the eye through the centre of a pixel.
  /// \param k index of the pixel, row by row from the top
  geometry::Vec3 direction_of(std::size_t k) const;
  /// Returns the solid angle of a pixel, in sr.
  /// \param k index of the pixel, row by row from the top
  double solid_angle(std::size_t k) const;
};

/// Returns the camera of a picture. It is aimed horizontally and, if the reflectors are in the field of view, at the
/// centre of the lane at the distance of the reflectors. Otherwise it is rotated until they are in the field of view.
/// The horizon is at 42 % of the height, or lower if a sign would be outside of the picture.
RoadCamera camera_at(const RoadScene& scene, double distance_m);

/// Luminances of the pixels, row by row from the top, in cd/m^2.
struct RoadPixels {
  std::vector<double> luminance;
  std::vector<double> reflected;           ///< part of the luminance that comes directly from the reflectors
  std::vector<double> veil;                ///< part of the luminance that comes from light scattered in the eye
  std::vector<std::array<double, 3>> rgb;  ///< linear sRGB; the lamp is white
};

/// Picture as the driver sees it from one distance.
struct RoadView {
  double distance_m = 0.0;
  std::vector<RoadReflector> reflectors;  ///< in the order of RoadScene::reflectors
  RoadCamera camera;
  RoadPixels picture;
  RoadCamera inset_camera;  ///< camera that enlarges the last reflector
  RoadPixels inset;
};

/// Returns the name of a reflector in tables and captions: "left", "right" or "sign".
/// \param k index of the reflector
const char* reflector_name(const RoadView& view, std::size_t k);

/// Computes the pictures of a view.
/// \param view view whose distance is set and whose reflectors have been measured
void draw_road(const RoadScene& scene, RoadView& view);

}  // namespace retrace::studies

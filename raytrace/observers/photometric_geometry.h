#pragma once

// The goniometer angles of photometric standards, and their conversion into directions in the part frame.

#include "core/angle.h"
#include "geometry/vec.h"
#include "raytrace/observers/return_frame.h"

namespace retrace::raytrace {

/// The goniometer system of CIE 54.2 and ASTM E808: the source stands still, the observer lies `alpha` above it; the
/// part turns by `beta1` about the horizontal first axis, then by `beta2` about the second axis, which moves with it,
/// then by `epsilon` about its own normal.
///
/// The part's datum mark is its +y axis, which points upwards at epsilon = 0; beta1 > 0 tilts the normal towards the
/// observer, beta2 > 0 towards +x; epsilon > 0 turns the part counter-clockwise as seen from the source.
struct PhotometricGeometry {
  Angle alpha;    ///< observation angle, 0 to 180 degrees
  Angle beta1;    ///< -180 to 180 degrees
  Angle beta2;    ///< -90 to 90 degrees
  Angle epsilon;  ///< -180 to 180 degrees
};

/// Directions from the part to source and observer, in the part frame; unit vectors.
struct PhotometricDirections {
  geometry::Vec3 to_source = geometry::Vec3::UnitZ();
  geometry::Vec3 to_observer = geometry::Vec3::UnitZ();
};

/// How UN regulations and SAE standards give the entrance angle: V > 0 is light from above, H > 0 light from +x, the
/// right as seen from the light. beta1 = -V, beta2 = -H.
struct EntranceAngles {
  Angle v;
  Angle h;
};

/// How this project gives the direction to the source.
struct SourceAngles {
  Angle incidence;  ///< 0 to 180 degrees
  Angle azimuth;    ///< -180 to 180 degrees; 0 at normal incidence
};

PhotometricGeometry geometry_from(const EntranceAngles& entrance, Angle alpha, Angle epsilon);
EntranceAngles entrance_angles(const PhotometricGeometry& geometry);

PhotometricDirections directions_of(const PhotometricGeometry& geometry);
/// The inverse. Where it is not unique: at alpha = 0 the observation half plane is taken through the datum mark, so
/// that epsilon is 0 where the normal allows.
PhotometricGeometry geometry_of(const PhotometricDirections& directions);

SourceAngles source_angles(const geometry::Vec3& to_source);

/// Directions around the return as the observer's half plane orders them: `up` is where the observer lies.
ReturnFrame return_frame(const PhotometricGeometry& geometry);

/// Viewing angle nu, between the normal and the observation axis.
Angle viewing_angle(const PhotometricGeometry& geometry);

}  // namespace retrace::raytrace

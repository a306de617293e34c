#pragma once

// The goniometer angles of photometric standards, and their conversion into directions in the part frame.

#include "core/angle.h"
#include "geometry/vec.h"
#include "raytrace/light/return_frame.h"

namespace retrace::raytrace {

/// The goniometer system of CIE 54.2 and ASTM E808. The source is fixed, and the direction to the observer is at the
/// angle `alpha` above the direction to the source. The part is rotated by `beta1` about the horizontal first axis,
/// then by `beta2` about the second axis, which moves with the part, and then by `epsilon` about its normal.
///
/// The part's datum mark is its +y axis, which points upwards at epsilon = 0. A positive beta1 tilts the normal towards
/// the observer, and a positive beta2 tilts it towards +x. A positive epsilon rotates the part counter-clockwise as
/// seen from the source.
struct PhotometricGeometry {
  Angle alpha;    ///< observation angle, 0 to 180 degrees
  Angle beta1;    ///< -180 to 180 degrees
  Angle beta2;    ///< -90 to 90 degrees
  Angle epsilon;  ///< -180 to 180 degrees
};

/// Unit vectors from the part to source and observer, in the part frame.
struct PhotometricDirections {
  geometry::Vec3 to_source = geometry::Vec3::UnitZ();
  geometry::Vec3 to_observer = geometry::Vec3::UnitZ();
};

/// Entrance angles of UN regulations and SAE standards. V > 0 means light from above. H > 0 means light from +x, which
/// is to the right as seen from the light. beta1 = -V, beta2 = -H.
struct EntranceAngles {
  Angle v;
  Angle h;
};

/// Direction to the source, given by the same two angles as in design files.
struct SourceAngles {
  Angle incidence;  ///< 0 to 180 degrees
  Angle azimuth;    ///< -180 to 180 degrees; 0 at normal incidence
};

PhotometricGeometry geometry_from(const EntranceAngles& entrance, Angle alpha, Angle epsilon);
EntranceAngles entrance_angles(const PhotometricGeometry& geometry);

PhotometricDirections directions_of(const PhotometricGeometry& geometry);
/// Returns the inverse of directions_of(). The observation half-plane starts at the line to the source and contains the
/// observer. At alpha = 0, the directions do not determine the half-plane. It is then chosen to contain the datum mark,
/// so that epsilon is 0 if possible.
PhotometricGeometry geometry_of(const PhotometricDirections& directions);

SourceAngles source_angles(const geometry::Vec3& to_source);

/// Returns the axes around the direction to the source for this observer: `up` points towards the observer.
ReturnFrame return_frame(const PhotometricGeometry& geometry);

// The functions above assume that the reference axis of the part is +z. This is not the case for a part with an
// inclined entrance face. The following functions convert between the part frame and the frame of the goniometer, whose
// z axis is the reference axis. The rotation from one frame to the other is about a horizontal axis of the part. If the
// reference axis is z, nothing is rotated.

/// Converts directions from the frame of the goniometer to the part frame.
PhotometricDirections in_part_frame(const PhotometricDirections& directions, const geometry::Vec3& reference_axis);
ReturnFrame in_part_frame(const ReturnFrame& frame, const geometry::Vec3& reference_axis);
/// Converts directions from the part frame to the frame of the goniometer.
PhotometricDirections in_reference_frame(const PhotometricDirections& directions, const geometry::Vec3& reference_axis);

/// Returns the viewing angle nu between the z axis of the part and the observation axis.
Angle viewing_angle(const PhotometricGeometry& geometry,
                    const geometry::Vec3& reference_axis = geometry::Vec3::UnitZ());

}  // namespace retrace::raytrace

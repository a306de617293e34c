#pragma once

// Poses of the rotary axes that bring a facet to the tool, and the section across the element's root that the tool sees
// in them.

#include <cstdint>
#include <string>

#include "core/angle.h"
#include "core/error.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// A facet of an element, as a pose can present it to the tool. Facet 1 of a prism faces -Y of the workpiece frame (for
/// a rotated element -X), facet 2 the other way (docs/theory/cutting.md). Facets 1 to 3 of a cube corner lie between
/// its dihedral edges k and k + 1 (docs/theory/micro_chiseling.md).
struct FacetChoice {
  bool rotated = false;
  int facet = 1;
  std::size_t zone = 0;  ///< index of the zone in the job; 0 without zones
};

/// What the tool sees of an element in a pose: the section across the root line at its middle, in words of the linear
/// axes relative to the root. The wall is the facet that is plunged, the floor the other one.
struct Section {
  double wall_y = -1.0;            ///< Y of the wall for each mm that stays on it
  geometry::Vec2 floor_normal;     ///< (Y, Z) parts; floor_normal . (y, z) = what stays on the floor
  geometry::Vec2 floor_direction;  ///< along the floor away from the wall, of length 1 mm
  geometry::Vec2 bisector;         ///< between wall and floor, of length 1 mm
  geometry::Vec2 face_normal;      ///< face_normal . (y, z) = depth + start + height above the blank's face
  double depth_mm = 0.0;           ///< of the root below the element's rims
  double stock_mm = 0.0;           ///< by which the blank's face stands over them
  double start_mm = 0.0;           ///< likewise, for a start that keeps the clearance from it
  double lift_mm = 0.0;            ///< by which the tool stays up so that the deeper end of its edge touches the floor
  double edge_mm = 0.0;            ///< the floor's distance that the edge's radius asks of the reference point
  Angle apex;
  Angle rake;              ///< angle between the wall and the rake face
  Nanometres step_nm = 1;  ///< positions are whole multiples of it

  double floor_z(double y, double left_mm) const {
    return (left_mm + edge_mm - floor_normal.x() * y) / floor_normal.y() + lift_mm;
  }
  /// Z at a height above the blank's face, measured normal to it.
  double face_z(double y, double height_mm) const {
    return (depth_mm + start_mm + height_mm - face_normal.x() * y) / face_normal.y();
  }
};

/// A pose of the rotary axes in which one facet of the elements of one orientation is plunged.
struct CuttingPose {
  FacetChoice facet;
  std::int32_t orientation = 0;                        ///< of the elements that are cut in it
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< theirs
  /// Micro chiseling: the cube corner that is cut, as oriented at C = 0.
  CubeCorner corner;
  RotaryUnits a = 0;  ///< as written, after rounding
  RotaryUnits c = 0;
  RotaryPose rounded;   ///< the same in degrees: what positions are computed from
  Angle root_tilt;      ///< of the root line against the tool's edge
  geometry::Vec3 root;  ///< direction of the root line that lies on machine +X, in the workpiece frame
  Section section;
  /// Normal of the cut facet in words of the linear axes, along which positions are rounded to the least error; 0: each
  /// word is rounded by itself.
  geometry::Vec3 rounded_along = geometry::Vec3::Zero();
};

/// Outward normals of facets 1 and 2 of an element as it is cut, in the workpiece frame.
geometry::Vec3 facet_normal(const geometry::RtpElement& element, const FacetChoice& facet);
/// Direction of the root line that lies on machine +X when the facet is plunged.
geometry::Vec3 root_direction(const FacetChoice& facet);
/// Depth of the root below the blank's face.
double root_depth_mm(const geometry::RtpElement& element);

/// The turn of C by whole revolutions that lies within the limits, nearest to where C was; as it is if others are no
/// nearer. \throw InputError at `where`
double nearest_c_deg(const Machine& machine, double c_deg, double previous_c_deg, const InputLocation& where,
                     const std::string& who = "");
/// That the axis that tilts may go there. \throw InputError at `where`, whose text begins with `who`
void check_tilt(const Machine& machine, double tilt_deg, const InputLocation& where, const std::string& who = "");

/// Elements that a pose cuts: how they are turned on their base, and how far the blank stands over their rims.
struct Stance {
  std::int32_t orientation = 0;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  std::size_t zone = 0;
  double stock_mm = 0.0;
  double start_mm = 0.0;      ///< the same for a start that keeps the clearance
  std::int64_t element = -1;  ///< one of them, for messages; -1: they stand on a flat blank

  /// What a message about the pose begins with; nothing on a flat blank.
  std::string who() const;
};

/// The pose, with C as near to `previous_c_deg` as its limits let it.
/// \throw InputError naming axis and limits if the machine cannot take it
CuttingPose cutting_pose(const Job& job, const Machine& machine, const FacetChoice& facet, double previous_c_deg,
                         const Stance& stance = {});

}  // namespace retrace::fabrication

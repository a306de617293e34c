#pragma once

// Computes the rotary poses in which facets are cut, and the cross-section of the element in each pose.

#include <cstdint>
#include <string>

#include "core/angle.h"
#include "core/error.h"
#include "fabrication/job/cube_corner.h"
#include "fabrication/job/job.h"
#include "fabrication/machine/machine.h"
#include "fabrication/program/program.h"

namespace retrace::fabrication {

/// Facet that is cut in a pose. For a prism, the normal of facet 1 points towards -Y of the workpiece frame (-X for a
/// rotated element), and the normal of facet 2 points in the opposite direction (docs/theory/cutting.md). For a cube
/// corner, facet k = 1, 2, 3 is between the dihedral edges k and k + 1 (docs/theory/micro_chiseling.md).
struct FacetChoice {
  bool rotated = false;
  int facet = 1;
  std::size_t zone = 0;  ///< index of the zone in the job; 0 without zones
};

/// Cross-section of an element in a pose, perpendicular to the root at its centre. Coordinates are positions of the Y
/// and Z axes relative to the root. The wall is the facet that is plunged, and the floor is the other facet.
struct Section {
  double wall_y = -1.0;            ///< change of Y, in mm, per mm of material that is left on the wall
  geometry::Vec2 floor_normal;     ///< unit normal of the floor; floor_normal . (y, z) is the height above the floor
  geometry::Vec2 floor_direction;  ///< unit vector along the floor, away from the wall
  geometry::Vec2 bisector;         ///< direction of the bisector of wall and floor
  geometry::Vec2 face_normal;      ///< normal of the face; face_normal . (y, z) = depth_mm + height above the rims
  double depth_mm = 0.0;           ///< depth of the root below the element's rims
  double stock_mm = 0.0;           ///< height of the blank's face above the rims
  double start_mm = 0.0;           ///< height above the rims from which the clearance is measured at the start of a cut
  /// Distance by which the tool is raised so that only the deeper end of a tilted edge touches the floor.
  double lift_mm = 0.0;
  double edge_mm = 0.0;  ///< distance of the reference point from the floor due to the edge radius
  Angle apex;
  Angle rake;              ///< angle between the wall and the rake face
  Nanometres step_nm = 1;  ///< increment of the positions

  double floor_z(double y, double left_mm) const {
    return (left_mm + edge_mm - floor_normal.x() * y) / floor_normal.y() + lift_mm;
  }
  /// Returns the Z position of a point at height `height_mm` above the start level. The start level is `start_mm` above
  /// the rims. Heights are measured along the face's normal.
  double face_z(double y, double height_mm) const {
    return (depth_mm + start_mm + height_mm - face_normal.x() * y) / face_normal.y();
  }
};

/// Pose of the rotary axes in which one facet of all elements of one orientation is cut.
struct CuttingPose {
  FacetChoice facet;
  std::int32_t orientation = 0;                                          ///< CutElement::orientation of the elements
  Eigen::Matrix3d workpiece_from_element = Eigen::Matrix3d::Identity();  ///< CutElement::workpiece_from_element
  /// Cube corner that is cut by micro chiseling, in its orientation at C = 0.
  CubeCorner corner;
  RotaryUnits a = 0;    ///< position of the tilting axis, rounded, as written in programs
  RotaryUnits c = 0;    ///< position of C, rounded, as written in programs
  RotaryPose rounded;   ///< rounded pose in degrees, from which all positions are computed
  Angle root_tilt;      ///< angle between the root line and the tool's edge
  geometry::Vec3 root;  ///< direction of the root line in the workpiece frame; this pose rotates it to machine +X
  Section section;
  /// Direction, in coordinates of the linear axes, along which the rounding error of positions is minimized. It is the
  /// normal of the cut facet. Zero: each position is rounded to the nearest increment.
  geometry::Vec3 rounded_along = geometry::Vec3::Zero();
};

/// Returns the outward normal of facet 1 or 2 of a prism as it is cut, in the workpiece frame.
geometry::Vec3 facet_normal(const geometry::RtpElement& element, const FacetChoice& facet);
/// Returns the direction of the root line, in the workpiece frame. The pose in which the facet is plunged rotates this
/// direction to machine +X.
geometry::Vec3 root_direction(const FacetChoice& facet);
/// Returns the depth of the root below the rims.
double root_depth_mm(const geometry::RtpElement& element);

/// Sets the positions of the rotary axes of a pose, and the angle between the root line and the tool's edge. Of all
/// equivalent angles C, it uses the one that is closest to `previous_c_deg` within the limits of the axis.
/// \param normal normal of the facet
/// \param near nominal positions of the axes
/// \param who beginning of the error message
/// \pre the direction of the root line is set
/// \throw InputError at `where` if the machine cannot reach the pose
void set_rotary_pose(CuttingPose& pose, const Machine& machine, const geometry::Vec3& normal, const RotaryPose& near,
                     double previous_c_deg, const InputLocation& where, const std::string& who);

/// Orientation of the elements that a pose cuts, and height of the blank above their rims.
struct ElementPose {
  std::int32_t orientation = 0;                                          ///< CutElement::orientation of the elements
  Eigen::Matrix3d workpiece_from_element = Eigen::Matrix3d::Identity();  ///< CutElement::workpiece_from_element
  std::size_t zone = 0;
  double stock_mm = 0.0;      ///< height of the blank's face above the rims
  double start_mm = 0.0;      ///< height above the rims from which the clearance is measured at the start of a cut
  std::int64_t element = -1;  ///< one of the elements, for error messages; -1 on a flat blank

  /// Returns the beginning of an error message about the pose. It is empty on a flat blank.
  std::string who() const;
};

/// Returns the rotary pose in which a facet of a prism is plunged. Of all equivalent angles C, it uses the one that is
/// closest to `previous_c_deg` within the limits of the axis.
/// \throw InputError naming axis and limits if the machine cannot reach the pose
CuttingPose cutting_pose(const Job& job, const Machine& machine, const FacetChoice& facet, double previous_c_deg,
                         const ElementPose& stance = {});

}  // namespace retrace::fabrication

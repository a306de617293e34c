#pragma once

// Kinematics of five-axis machines with a tilting table or a tilting head: axes with limits and speeds, forward and
// inverse transformation, and the poses in which a facet is cut.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/angle.h"
#include "core/warning.h"
#include "fabrication/machine/control.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Origin of a value of a machine.
enum class Basis {
  measured,  ///< measured; `source` names the publication or measurement
  assumed    ///< assumed; `source` gives the reason
};

/// Value and its origin.
template <class Value>
struct Sourced {
  Value value{};
  Basis basis = Basis::assumed;
  std::string source;
};

struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool contains(double value) const { return value >= low && value <= high; }
};

/// Default jerk limit of an axis: no limit. The acceleration may then change instantaneously.
inline const Sourced<double> kNoJerkLimit = {std::numeric_limits<double>::infinity(), Basis::assumed,
                                             "no jerk limit is given"};

/// Linear axis. Increasing positions move the tool along `direction` relative to the workpiece.
struct LinearAxis {
  Sourced<geometry::Vec3> direction;  ///< unit vector, in the workpiece frame at A = C = 0
  Sourced<Interval> limits_mm;
  Sourced<double> max_feed_mm_per_min;
  Sourced<double> rapid_mm_per_min;
  Sourced<double> acceleration_mm_per_s2;
  Sourced<double> jerk_mm_per_s3 = kNoJerkLimit;
};

/// Rotary axis, given as a line in space at A = C = 0.
struct RotaryAxis {
  /// Point on the axis, in the workpiece frame.
  Sourced<geometry::Vec3> point_mm = {geometry::Vec3::Zero(), Basis::assumed,
                                      "the origin of the workpiece, because no point is given"};
  Sourced<geometry::Vec3> direction;  ///< unit vector along the axis
  /// 1 if positive angles rotate the workpiece about `direction` by the right-hand rule; -1 for the opposite sense.
  Sourced<double> sign = {1.0, Basis::assumed, "positive positions rotate the workpiece by the right-hand rule"};
  Sourced<Interval> limits_deg;
  Sourced<double> speed_deg_per_s;
  Sourced<double> acceleration_deg_per_s2;
  Sourced<double> jerk_deg_per_s3 = kNoJerkLimit;
};

/// Part of the machine with which a body moves.
enum class KinematicLink {
  workpiece,  ///< moves with the table (A and C); points are in the workpiece frame
  /// Moves with A but not with C; points are in the workpiece frame at A = 0. On a machine with a tilting head, it does
  /// not move.
  cradle,
  tool  ///< moves with the spindle; points are relative to the tool reference point
};

/// Convex body of a machine, for collision checks. It is the convex hull of its points.
struct MachineBody {
  std::string name;
  KinematicLink link = KinematicLink::workpiece;
  Sourced<std::vector<geometry::Vec3>> points_mm;  ///< at least four points, which are not in one plane
};

/// Deviation of the mounted tool from its nominal position and orientation, as determined by a set-up or a calibration.
struct ToolMount {
  /// Displacement of the tool reference point from its assumed position, along the axes of the machine. For a tilting
  /// head, it applies at B = 0.
  Sourced<geometry::Vec3> offset_mm = {geometry::Vec3::Zero(), Basis::assumed, "the tool is touched off"};
  /// Rotation vector of the mounted tool about its reference point. The tool is touched off after mounting. A rotation
  /// about X changes the clearance angle, one about Y tilts the edge from the horizontal, and one about Z rotates the
  /// edge away from X.
  Sourced<geometry::Vec3> rotation_deg = {geometry::Vec3::Zero(), Basis::assumed, "the tool is aligned"};
};

/// Part of the machine that the tilting axis rotates.
enum class Tilt {
  table,  ///< axis A tilts the table, including C
  head    ///< axis B tilts the tool; only C rotates the workpiece
};

/// Machine with three linear axes, a tilting axis, and a table that rotates about C.
///
/// For a tilting table, the kinematic chain from the workpiece W to the linear axes M is
///
///   P_M = b3 b2 R_A b1 R_C b0 P_W
///
/// (Hamilton et al., Right triangular prism retroreflectors, eq. 6; docs/theory/kinematics.md), with every axis
/// given by a point and a direction. At A = C = 0, P_M = P_W. The axis positions X, Y, Z are then the position of the
/// tool reference point in the workpiece frame.
///
/// For a tilting head, points are given in the frame of the tool, which B rotates relative to the linear axes:
/// P_T = p + R_B^T (R_C P_W - p), where p is a point of axis B relative to the tool reference point at B = 0. In this
/// frame, the tool has a constant orientation, as on a machine with a tilting table. "Machine frame" means this frame
/// for machines with a tilting head.
struct Machine {
  std::string name;
  std::string title;
  LinearAxis x;
  LinearAxis y;
  LinearAxis z;
  Tilt tilt = Tilt::table;
  RotaryAxis a;  ///< tilting axis: A, or B with its point relative to the tool reference point at B = 0
  RotaryAxis c;
  ToolMount mount;
  std::vector<MachineBody> bodies;
  /// Minimum Z position of the first move of a program. At this position, the tool is clear of the part for all
  /// positions of the other axes. If the value is above the upper limit of Z, the limit is used.
  Sourced<double> safe_z_mm = {1e9, Basis::assumed, "the upper limit of Z, because no height is given"};
  /// Time that the control waits at every exact stop until the axes have settled.
  Sourced<double> settling_s = {0.0, Basis::assumed, "no settling time is given"};
  /// Time that the axes must move before the first cut of a program or after a stop.
  Sourced<double> warm_up_s = {0.0, Basis::assumed, "no warm-up time is given"};
  Control control;
  Increments increments;  ///< increments to which planned positions are rounded
  /// Letters of the rotary axes that take the shortest path to a programmed angle in the dialect of the programs.
  std::string shortest_axes;
  Warnings warnings;  ///< warnings about the file of the machine

  double first_z_mm() const { return std::min(safe_z_mm.value, z.limits_mm.value.high); }

  /// Returns the letter of the tilting axis.
  char tilt_letter() const { return tilt == Tilt::table ? 'A' : 'B'; }
};

/// Positions of all axes. A machine has either A or B.
struct AxisPositions {
  double x_mm = 0.0, y_mm = 0.0, z_mm = 0.0;
  double a_deg = 0.0, c_deg = 0.0, b_deg = 0.0;
};

/// Positions of the two rotary axes.
struct RotaryPose {
  double a_deg = 0.0;  ///< position of the tilting axis, A or B
  double c_deg = 0.0;
};

/// Returns the positions of the rotary axes that the machine has.
RotaryPose rotary_pose(const Machine& machine, const AxisPositions& axes);

/// Rigid motion p -> rotation * p + translation.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  geometry::Vec3 translation_mm = geometry::Vec3::Zero();

  geometry::Vec3 point(const geometry::Vec3& p) const { return rotation * p + translation_mm; }
  geometry::Vec3 direction(const geometry::Vec3& d) const { return rotation * d; }
  RigidMotion inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation_mm)}; }
};

/// Position and orientation of the tool in the workpiece frame.
struct ToolPose {
  geometry::Vec3 reference_mm = geometry::Vec3::Zero();  ///< tool reference point, in the workpiece frame
  /// Rotation of directions from the machine frame to the workpiece frame.
  Eigen::Matrix3d workpiece_from_machine = Eigen::Matrix3d::Identity();
};

/// Returns the right-handed rotation about a unit vector (Rodrigues' formula).
/// \pre axis has length 1
Eigen::Matrix3d rotation_about(const geometry::Vec3& axis, Angle angle);

/// Returns the transformation from the workpiece frame to the machine frame in a pose.
RigidMotion machine_from_workpiece(const Machine& machine, const RotaryPose& pose);

/// Computes the pose of the tool from axis positions.
ToolPose forward(const Machine& machine, const AxisPositions& axes);

/// Computes the axis positions that move the tool reference point to a point of the workpiece. forward() returns this
/// point with an error of at most 1e-12 mm within 200 mm of the origin. Limits of the axes are not checked.
AxisPositions inverse(const Machine& machine, const geometry::Vec3& reference_mm, const RotaryPose& pose);

/// Returns the position of the tool reference point in the machine frame. It equals the positions of X, Y and Z if the
/// linear axes are orthogonal, the tool has no offset, and a tilting head is at B = 0.
geometry::Vec3 machine_point(const Machine& machine, const AxisPositions& axes);
/// Returns the positions of X, Y and Z for a point of the machine frame. It is the inverse of machine_point().
std::array<double, 3> linear_words(const Machine& machine, const geometry::Vec3& machine_point_mm,
                                   const RotaryPose& pose = {});
/// Returns the change of the positions of X, Y and Z for a displacement in the machine frame.
std::array<double, 3> axis_change_along(const Machine& machine, const geometry::Vec3& direction,
                                        const RotaryPose& pose = {});

/// Returns the rotation from the nominal orientation of the tool to its orientation as mounted.
Eigen::Matrix3d tool_rotation(const Machine& machine);
/// Returns the unit vector along a chisel's edge, in the machine frame. It is X, apart from the rotation of the mounted
/// tool.
geometry::Vec3 edge_direction(const Machine& machine);

/// Returns the normal, in the machine frame, that a facet must have when the tool plunges it. On a machine with a
/// tilting table, it is the normal of the plane that the tool's edge sweeps when Z moves, and points to the side of -Y.
/// On a machine with a tilting head, it is the normal of the tool's plane of Y and Z, and points to the side of -X.
geometry::Vec3 plunged_normal(const Machine& machine);
/// Returns the direction, in the machine frame, that the horizontal line of a facet should have during a plunge. It is
/// the direction of the edge, or Y of the tool on a machine with a tilting head.
geometry::Vec3 horizontal_direction(const Machine& machine);

/// Rotary pose in which the tool plunges a facet.
struct PlungePose {
  RotaryPose pose;
  /// Remaining rotation about the facet's outward normal (right-handed), from horizontal_direction() to the root line.
  /// Two rotary axes can align the normal, but not the root line as well.
  Angle root_tilt;
};

/// Computes the pose closest to `near` in which a facet can be plunged (closed form in docs/theory/kinematics.md). The
/// direction of the facet's normal determines both rotary axes. The remaining rotation about the normal is `root_tilt`.
/// Limits of the axes are not checked.
/// \param facet_normal unit normal outward from the material, in the workpiece frame
/// \param root direction of the facet's root, or of another horizontal line of the facet, which should become
///        horizontal_direction()
/// \throw InputError if the machine has no such pose
PlungePose solve_plunge_pose(const Machine& machine, const geometry::Vec3& facet_normal, const geometry::Vec3& root,
                             const RotaryPose& near);

/// Axis whose position is outside of its limits.
struct LimitExcess {
  char axis = 'X';
  double position = 0.0;  ///< position of the axis, in mm or degrees
  Interval limits;
};
/// Returns all axes whose position is outside of the limits, in the order X, Y, Z, A or B, C.
std::vector<LimitExcess> limit_excesses(const Machine& machine, const AxisPositions& axes);

}  // namespace retrace::fabrication

#pragma once

// The kinematics of five-axis machines whose table or head tilts: axes with limits and speeds, forward and inverse
// transformation, and poses that bring a facet to the tool.

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/angle.h"
#include "fabrication/machine/control.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Where a value of a machine comes from.
enum class Basis {
  measured,  ///< `source` names the publication or measurement
  assumed    ///< `source` says why
};

/// A value with where it comes from.
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

/// Of axes that have their whole acceleration at once.
inline const Sourced<double> kNoJerkLimit = {std::numeric_limits<double>::infinity(), Basis::assumed,
                                             "acceleration begins at once, as for every axis that names no jerk"};

/// A linear axis. Positive words move the tool along `direction`, as seen from the workpiece.
struct LinearAxis {
  Sourced<geometry::Vec3> direction;  ///< of length 1, in the frame of the workpiece at A = C = 0
  Sourced<Interval> limits_mm;
  Sourced<double> max_feed_mm_per_min;
  Sourced<double> rapid_mm_per_min;
  Sourced<double> acceleration_mm_per_s2;
  Sourced<double> jerk_mm_per_s3 = kNoJerkLimit;
};

/// A rotary axis: a line in space at A = C = 0.
struct RotaryAxis {
  /// On the axis, in the frame of the workpiece.
  Sourced<geometry::Vec3> point_mm = {geometry::Vec3::Zero(), Basis::assumed,
                                      "the origin of the workpiece, as for every machine that names none"};
  Sourced<geometry::Vec3> direction;  ///< of length 1
  /// 1: positive words turn the workpiece by the right hand about `direction`; or -1.
  Sourced<double> sign = {1.0, Basis::assumed, "positive words turn the workpiece by the right hand"};
  Sourced<Interval> limits_deg;
  Sourced<double> speed_deg_per_s;
  Sourced<double> acceleration_deg_per_s2;
  Sourced<double> jerk_deg_per_s3 = kNoJerkLimit;
};

/// What a body of a machine moves with.
enum class Carrier {
  workpiece,  ///< the table that A and C turn, in the frame of the workpiece
  cradle,     ///< what C does not turn, in the same frame at A = 0; where the head tilts: what stands still
  tool        ///< spindle and holder, relative to the tool reference point
};

/// A convex body of a machine, for collisions: the hull of its points.
struct MachineBody {
  std::string name;
  Carrier carrier = Carrier::workpiece;
  Sourced<std::vector<geometry::Vec3>> points_mm;  ///< at least 4, not in one plane
};

/// How the tool stands in the machine, against how it should: where a set-up left it, or a calibration found it.
struct ToolMount {
  /// Of the tool reference point, from where programs take it, along the axes of the machine. Of a head: at B = 0.
  Sourced<geometry::Vec3> offset_mm = {geometry::Vec3::Zero(), Basis::assumed, "the tool is touched off"};
  /// Rotation vector of the mounted tool about its reference point. The tool is touched off after mounting. A rotation
  /// about X changes the clearance angle, one about Y tilts the edge from the horizontal, and one about Z rotates the
  /// edge away from X.
  Sourced<geometry::Vec3> turn_deg = {geometry::Vec3::Zero(), Basis::assumed, "the tool is aligned"};
};

/// What the axis that tilts turns.
enum class Tilt {
  table,  ///< A: the table, and C with it
  head    ///< B: the tool; C alone turns the workpiece
};

/// A machine with three linear axes, an axis that tilts, and a table that turns about C.
///
/// Where the table tilts, its kinematic chain from the workpiece W to the linear axes M is
///
///   P_M = b3 b2 R_A b1 R_C b0 P_W
///
/// (Hamilton et al., Right triangular prism retroreflectors, eq. 6; docs/theory/kinematics.md), with every axis
/// given by a point and a direction. At A = C = 0 P_M = P_W, so the words of a program are the position of the tool
/// reference point in the workpiece frame when nothing is turned.
///
/// Where the head tilts, points are told in the frame of the tool, which B turns against the linear axes, so that the
/// tool stands in it as it does where the table tilts: P_T = p + R_B^T (R_C P_W - p), p a point on B from the tool
/// reference point at B = 0. "The frame of the machine" means the tool's for such machines.
struct Machine {
  std::string name;
  std::string title;
  LinearAxis x;
  LinearAxis y;
  LinearAxis z;
  Tilt tilt = Tilt::table;
  RotaryAxis a;  ///< the axis that tilts: A, or B of a head, whose point is told from the tool reference point at B = 0
  RotaryAxis c;
  ToolMount mount;
  std::vector<MachineBody> bodies;
  /// Least Z to which the first move of a program goes, away from the part wherever the other axes stand; above the
  /// limit of Z: that limit.
  Sourced<double> safe_z_mm = {1e9, Basis::assumed, "the upper limit of Z, as for every machine that names none"};
  /// That a control waits at every exact stop until the axes stand still.
  Sourced<double> settling_s = {0.0, Basis::assumed, "axes arrive at once, as for every machine that names none"};
  /// For how long axes must move before a first cut, of a program or behind a stop.
  Sourced<double> warm_up_s = {0.0, Basis::assumed, "cuts may begin cold, as for every machine that names none"};
  Control control;
  Increments increments;  ///< to which positions are rounded when programs are planned
  /// Letters of the rotary axes that take the shortest path to a programmed angle, in the chosen dialect.
  std::string shortest_axes;

  double first_z_mm() const { return std::min(safe_z_mm.value, z.limits_mm.value.high); }

  /// Letter of the axis that tilts.
  char tilt_letter() const { return tilt == Tilt::table ? 'A' : 'B'; }
};

/// Words of a program: positions of the axes. A machine has A or B.
struct AxisPositions {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double z_mm = 0.0;
  double a_deg = 0.0;
  double c_deg = 0.0;
  double b_deg = 0.0;
};

/// Positions of the two rotary axes.
struct RotaryPose {
  double a_deg = 0.0;  ///< of the axis that tilts, A or B
  double c_deg = 0.0;
};

/// Those of the two that the machine has.
RotaryPose rotary_pose(const Machine& machine, const AxisPositions& axes);

/// A rigid motion: p -> rotation p + translation.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  geometry::Vec3 translation_mm = geometry::Vec3::Zero();

  geometry::Vec3 point(const geometry::Vec3& p) const { return rotation * p + translation_mm; }
  geometry::Vec3 direction(const geometry::Vec3& d) const { return rotation * d; }
  RigidMotion inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation_mm)}; }
};

/// Where a machine puts the tool: as a frame in the workpiece.
struct ToolPose {
  geometry::Vec3 reference_mm = geometry::Vec3::Zero();  ///< tool reference point, in the workpiece frame
  /// Turns directions of the machine into those of the workpiece: a chisel's edge lies along edge_direction().
  Eigen::Matrix3d workpiece_from_machine = Eigen::Matrix3d::Identity();
};

/// Right-handed rotation about a unit vector (Rodrigues). \pre axis has length 1
Eigen::Matrix3d rotation_about(const geometry::Vec3& axis, Angle angle);

/// How a pose moves points of the workpiece: frame of the workpiece -> frame of the machine.
RigidMotion machine_from_workpiece(const Machine& machine, const RotaryPose& pose);

/// Where the tool is when the axes are there.
ToolPose forward(const Machine& machine, const AxisPositions& axes);

/// Axis positions that put the tool reference point on a point of the workpiece. Forward and back agree to 1e-12 mm
/// within 200 mm of the origin. Limits are not looked at.
AxisPositions inverse(const Machine& machine, const geometry::Vec3& reference_mm, const RotaryPose& pose);

/// Where the tool reference point is in the machine frame, and back; the same numbers as the words if the linear axes
/// are square, the tool stands where it should and the head, if it is what tilts, at B = 0.
geometry::Vec3 machine_point(const Machine& machine, const AxisPositions& axes);
std::array<double, 3> linear_words(const Machine& machine, const geometry::Vec3& machine_point_mm,
                                   const RotaryPose& pose = {});
/// By how much words change along a direction of the machine frame.
std::array<double, 3> words_along(const Machine& machine, const geometry::Vec3& direction, const RotaryPose& pose = {});

/// Turns directions of a tool that stands as it should into those of the tool as it is mounted.
Eigen::Matrix3d tool_turn(const Machine& machine);
/// Along a chisel's edge, in the machine frame: X, but for how the tool is mounted.
geometry::Vec3 edge_direction(const Machine& machine);

/// The normal, in the machine frame, that a facet has when the tool can cut it. Where the table tilts: of the plane
/// that the tool's edge sweeps when Z moves, on the side of -Y. Where the head tilts: of the plane of Y and Z of the
/// tool, on the side of -X.
geometry::Vec3 plunged_normal(const Machine& machine);
/// The direction of the machine that a facet's level line then has: the edge's, or Y of the tool where the head tilts.
geometry::Vec3 level_direction(const Machine& machine);

/// A pose that lets the tool plunge a facet.
struct PlungePose {
  RotaryPose pose;
  /// Rotation that is left about the facet's normal (right-handed about the outward normal), from level_direction() to
  /// the root line: two directions are matched, and the third angle of a rotation is what the two axes give.
  Angle root_tilt;
};

/// The pose nearest to `near` in which a facet of the workpiece stands as the tool plunges it (closed form in
/// docs/theory/kinematics.md). A facet's normal fixes two of the three angles of the workpiece; what is left is
/// `root_tilt`. Limits are not looked at.
/// \param facet_normal outward from the material, of length 1, in the workpiece frame
/// \param root along the facet's root, or another level line of it, to the side that lies on level_direction() when the
/// facet is plunged
/// \throw InputError if no pose of this machine does that
PlungePose solve_plunge_pose(const Machine& machine, const geometry::Vec3& facet_normal, const geometry::Vec3& root,
                             const RotaryPose& near);

/// An axis that a position leaves the limits of.
struct LimitExcess {
  char axis = 'X';
  double position = 0.0;  ///< mm or degrees
  Interval limits;
};
/// All of them, in the order X, Y, Z, A or B, C.
std::vector<LimitExcess> limit_excesses(const Machine& machine, const AxisPositions& axes);

}  // namespace retrace::fabrication

#include "fabrication/machine/setup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/length_units.h"

namespace retrace::fabrication {
namespace {

using Eigen::Matrix3d;
using geometry::Vec3;

constexpr SetupQuantity kOfC[] = {{"c_x_um", "centre of C along X", SetupPart::c_point, 0},
                                  {"c_y_um", "centre of C along Y", SetupPart::c_point, 1},
                                  {"c_lean_x_arcsec", "lean of C towards X", SetupPart::c_direction, 0},
                                  {"c_lean_y_arcsec", "lean of C towards Y", SetupPart::c_direction, 1}};
constexpr SetupQuantity kOfA[] = {{"a_y_um", "axis A along Y", SetupPart::tilt_point, 1},
                                  {"a_z_um", "height of A", SetupPart::tilt_point, 2},
                                  {"a_lean_y_arcsec", "lean of A towards Y", SetupPart::tilt_direction, 1},
                                  {"a_lean_z_arcsec", "lean of A towards Z", SetupPart::tilt_direction, 2}};
constexpr SetupQuantity kOfB[] = {{"b_x_um", "pivot of B from the tip along X", SetupPart::tilt_point, 0},
                                  {"b_z_um", "length from the tip to the pivot of B", SetupPart::tilt_point, 2},
                                  {"b_lean_x_arcsec", "lean of B towards X", SetupPart::tilt_direction, 0},
                                  {"b_lean_z_arcsec", "lean of B towards Z", SetupPart::tilt_direction, 2}};
constexpr SetupQuantity kOfSlides[] = {{"y_lean_x_arcsec", "Y out of square towards X", SetupPart::y_direction, 0},
                                       {"y_lean_z_arcsec", "Y out of square towards Z", SetupPart::y_direction, 2},
                                       {"z_lean_x_arcsec", "Z out of square towards X", SetupPart::z_direction, 0}};
constexpr SetupQuantity kOfTool[] = {{"tool_x_um", "touch-off of the tool along X", SetupPart::tool_offset, 0},
                                     {"tool_y_um", "touch-off of the tool along Y", SetupPart::tool_offset, 1},
                                     {"tool_z_um", "touch-off of the tool along Z", SetupPart::tool_offset, 2},
                                     {"tool_rotation_x_arcsec", "tool rotated about X", SetupPart::tool_rotation, 0},
                                     {"tool_rotation_y_arcsec", "tool rotated about Y", SetupPart::tool_rotation, 1},
                                     {"tool_rotation_z_arcsec", "tool rotated about Z", SetupPart::tool_rotation, 2}};

constexpr std::size_t kQuantities = std::size(kOfC) + std::size(kOfA) + std::size(kOfSlides) + std::size(kOfTool);

constexpr std::array<SetupQuantity, kQuantities> all_with(std::span<const SetupQuantity> of_tilt) {
  std::array<SetupQuantity, kQuantities> all;
  std::size_t k = 0;
  for (const std::span<const SetupQuantity> some :
       {std::span<const SetupQuantity>(kOfC), of_tilt, std::span<const SetupQuantity>(kOfSlides),
        std::span<const SetupQuantity>(kOfTool)})
    for (const SetupQuantity& quantity : some) all[k++] = quantity;
  return all;
}
constexpr auto kOfTables = all_with(kOfA);
constexpr auto kOfHeads = all_with(kOfB);

/// Returns the direction or point of the machine that a quantity changes.
Vec3& value_of(Machine& machine, SetupPart part) {
  switch (part) {
    case SetupPart::c_point: return machine.c.point_mm.value;
    case SetupPart::tilt_point: return machine.a.point_mm.value;
    case SetupPart::c_direction: return machine.c.direction.value;
    case SetupPart::tilt_direction: return machine.a.direction.value;
    case SetupPart::y_direction: return machine.y.direction.value;
    case SetupPart::z_direction: return machine.z.direction.value;
    case SetupPart::tool_offset: return machine.mount.offset_mm.value;
    case SetupPart::tool_rotation: break;
  }
  return machine.mount.rotation_deg.value;
}

bool is_direction(SetupPart part) {
  return part == SetupPart::c_direction || part == SetupPart::tilt_direction || part == SetupPart::y_direction ||
         part == SetupPart::z_direction;
}

/// Returns the derivative of a unit direction with respect to its component `axis`. The direction remains a unit
/// vector.
Vec3 gain(const Vec3& direction, int axis) {
  return Vec3::Unit(axis) - direction * direction[axis];
}

Matrix3d cross_matrix(const Vec3& v) {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Returns the derivative of a rotation with respect to its rotation vector, as small rotations in the rotated frame.
/// It is the left Jacobian of SO(3) (J. Solà et al., A micro Lie theory, arXiv:1812.01537, eq. 145).
Matrix3d turn_gain(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  const Matrix3d cross = cross_matrix(rotation_vector);
  constexpr double kSmall = 1e-4;  // below this angle, the leading terms of the series are used
  const double a = angle < kSmall ? 0.5 : (1.0 - std::cos(angle)) / (angle * angle);
  const double b = angle < kSmall ? 1.0 / 6.0 : (angle - std::sin(angle)) / (angle * angle * angle);
  return Matrix3d::Identity() + a * cross + b * cross * cross;
}

/// Geometry of a cut, and its derivatives with respect to a quantity of the set-up, per mm or rad.
class CutMotion {
 public:
  CutMotion(const Machine& machine, const EdgeCut& cut)
      : machine_(machine),
        cut_(cut),
        pose_(rotary_pose(machine, cut.at)),
        c_(machine_from_workpiece(machine, {0.0, pose_.c_deg}).rotation),
        both_(machine_from_workpiece(machine, pose_)),
        tilt_(both_.rotation * c_.transpose()),
        slides_(machine.tilt == Tilt::table ? Matrix3d(Matrix3d::Identity()) : tilt_) {
    directions_ << machine.x.direction.value, machine.y.direction.value, machine.z.direction.value;
    at_words_ = {cut.at.x_mm, cut.at.y_mm, cut.at.z_mm};
    edge_ = cutting_edge(machine, cut.edge_rise);
    travel_ = slides_ * directions_ * cut.travel_mm;
    tip_ = machine_point(machine, cut.at) + edge_frame(machine) * cut.tip_mm;
    point_ = both_.inverse().point(tip_);
  }

  void change(const SetupQuantity& quantity) {
    const Vec3 unit = Vec3::Unit(quantity.axis);
    switch (quantity.part) {
      case SetupPart::c_point: shift_ = unit - c_.transpose() * unit; break;
      case SetupPart::tilt_point: shift_ = c_.transpose() * (unit - tilt_.transpose() * unit); break;
      case SetupPart::c_direction: lean_c(quantity.axis); break;
      case SetupPart::tilt_direction: lean_tilt(quantity.axis); break;
      case SetupPart::y_direction: lean_slide(1, quantity.axis); break;
      case SetupPart::z_direction: lean_slide(2, quantity.axis); break;
      case SetupPart::tool_offset: shift_ = both_.rotation.transpose() * unit; break;
      case SetupPart::tool_rotation: turn_tool(quantity.axis); break;
    }
  }

  /// Returns the derivatives of the plane's point and of its unit normal, which is on the side of `outward`.
  PlaneChange of_plane(const Vec3& outward) const {
    const Matrix3d back = both_.rotation.transpose();
    const Vec3 edge = back * edge_;
    const Vec3 travel = back * travel_;
    const Vec3 edge_change = turn_.cross(edge) + back * edge_change_;
    const Vec3 travel_change = turn_.cross(travel) + back * travel_change_;
    const Vec3 normal = edge.cross(travel);
    const Vec3 change = edge_change.cross(travel) + edge.cross(travel_change);
    const double side = normal.dot(outward) < 0.0 ? -1.0 : 1.0;
    const Vec3 along = normal.normalized();
    return {shift_, side * (change - along * along.dot(change)) / normal.norm()};
  }

 private:
  /// Sets the derivatives for a small rotation about a point of an axis. Such a rotation occurs if the axis is
  /// inclined.
  /// \param from_axis vector from this point to the tip
  void turn_about(const Vec3& turn, const Vec3& from_axis) {
    turn_ = turn;
    shift_ = turn.cross(from_axis);
  }

  void lean_c(int axis) {
    const Vec3& direction = machine_.c.direction.value;
    const Vec3 lean = direction.cross(gain(direction, axis));
    turn_about(lean - c_.transpose() * lean, point_ - machine_.c.point_mm.value);
  }

  void lean_tilt(int axis) {
    const Vec3& direction = machine_.a.direction.value;
    const Vec3 lean = direction.cross(gain(direction, axis));
    // Vector from the axis to the tip, before the rotation of the tilting axis.
    const Vec3 from_axis = tilt_.transpose() * (tip_ - machine_.a.point_mm.value);
    turn_about(c_.transpose() * (lean - tilt_.transpose() * lean), c_.transpose() * from_axis);
    if (machine_.tilt == Tilt::table) return;
    // In the frame of a tilting head, the directions of the linear axes rotate.
    const Vec3 of_slides = lean - tilt_ * lean;
    travel_change_ = of_slides.cross(travel_);
    shift_ += both_.rotation.transpose() * of_slides.cross(slides_ * directions_ * at_words_);
  }

  void lean_slide(int slide, int axis) {
    const Vec3 lean = gain(directions_.col(slide), axis);
    travel_change_ = slides_ * lean * cut_.travel_mm[slide];
    shift_ = both_.rotation.transpose() * slides_ * lean * at_words_[slide];
    // A tool on a tilting head is aligned with Y and Z. Its edge therefore changes its direction if one of these axes
    // is inclined.
    if (machine_.tilt == Tilt::head)
      edge_change_ = v_edge_change(slide, lean);
    else if (slide == 2)
      shift_ += both_.rotation.transpose() * tip_change(Vec3::Zero(), lean);
  }

  /// Returns the first-order change of the vector edge_frame() * tip of a chisel, if the direction of the edge changes
  /// by `edge_change` and the direction of Z by `z_change`.
  Vec3 tip_change(const Vec3& edge_change, const Vec3& z_change) const {
    const Vec3 edge = edge_direction(machine_);
    const Vec3 z = directions_.col(2);
    const Vec3 square = z - edge * edge.dot(z);
    const Vec3 up = square.normalized();
    const Vec3 square_change = z_change - edge_change * edge.dot(z) - edge * (edge_change.dot(z) + edge.dot(z_change));
    const Vec3 up_change = (square_change - up * up.dot(square_change)) / square.norm();
    const Vec3 across_change = up_change.cross(edge) + up.cross(edge_change);
    return edge_change * cut_.tip_mm.x() + across_change * cut_.tip_mm.y() + up_change * cut_.tip_mm.z();
  }

  Vec3 v_edge_change(int slide, const Vec3& lean) const {
    const Vec3& y = machine_.y.direction.value;
    const Vec3& z = machine_.z.direction.value;
    const Vec3 across = z.cross(y);
    const Vec3 across_change = slide == 1 ? z.cross(lean) : lean.cross(y);
    const Vec3 normal = across.normalized();
    const Vec3 normal_change = (across_change - normal * normal.dot(across_change)) / across.norm();
    const Vec3 level_change = slide == 1 ? lean : Vec3(Vec3::Zero());
    const Vec3 up_change = level_change.cross(normal) + y.cross(normal_change);
    const double rise = cut_.edge_rise.rad();
    return tool_rotation(machine_) * (std::cos(rise) * level_change + std::sin(rise) * up_change);
  }

  void turn_tool(int axis) {
    const Vec3 turn_rad = machine_.mount.rotation_deg.value * (std::numbers::pi / 180.0);
    const Vec3 turn = turn_gain(turn_rad) * Vec3::Unit(axis);
    edge_change_ = turn.cross(edge_);
    const bool is_chisel = machine_.tilt == Tilt::table;
    const Vec3 of_tip = is_chisel ? tip_change(turn.cross(edge_direction(machine_)), Vec3::Zero())
                                  : Vec3(turn.cross(edge_frame(machine_) * cut_.tip_mm));
    shift_ = both_.rotation.transpose() * of_tip;
  }

  const Machine& machine_;
  const EdgeCut& cut_;
  RotaryPose pose_;
  Matrix3d c_;        ///< rotation of C
  RigidMotion both_;  ///< transformation from the workpiece frame to the machine frame
  Matrix3d tilt_;     ///< rotation of the tilting axis, towards the machine frame
  Matrix3d slides_;   ///< rotation from the directions of the linear axes to the machine frame
  Matrix3d directions_;
  Vec3 at_words_, edge_, travel_, tip_, point_;

  // Derivatives. The rotation of the whole tool (`turn_`) and the displacement of its tip (`shift_`) are in the
  // workpiece frame. The changes of the edge and of the travel are in the machine frame.
  Vec3 turn_ = Vec3::Zero();
  Vec3 shift_ = Vec3::Zero();
  Vec3 edge_change_ = Vec3::Zero();
  Vec3 travel_change_ = Vec3::Zero();
};

}  // namespace

double SetupQuantity::per_unit() const {
  return is_angle() ? kRadPerArcsec : kMmPerUm;
}

std::span<const SetupQuantity> setup_quantities(Tilt tilt) {
  return tilt == Tilt::table ? kOfTables : kOfHeads;
}

const SetupQuantity* setup_quantity(Tilt tilt, std::string_view key) {
  const auto all = setup_quantities(tilt);
  const auto found = std::find_if(all.begin(), all.end(), [&](const SetupQuantity& q) { return q.key == key; });
  return found == all.end() ? nullptr : &*found;
}

Machine with_error(Machine machine, const SetupQuantity& quantity, double amount) {
  Vec3& value = value_of(machine, quantity.part);
  const bool is_turn = quantity.part == SetupPart::tool_rotation;
  value[quantity.axis] += is_turn ? amount / 3600.0 : amount * quantity.per_unit();
  if (is_direction(quantity.part)) value.normalize();
  return machine;
}

Machine with_errors(Machine machine, std::span<const double> amounts) {
  const auto all = setup_quantities(machine.tilt);
  for (std::size_t k = 0; k < all.size(); ++k) machine = with_error(std::move(machine), all[k], amounts[k]);
  return machine;
}

double PlaneChange::height_mm(const CutPlane& plane, const Vec3& over_mm, const Vec3& along) const {
  const double facing = plane.normal.dot(along);
  const double changed = normal.dot(plane.point_mm - over_mm) + plane.normal.dot(point_mm);
  return (changed - plane.height_mm(over_mm, along) * normal.dot(along)) / facing;
}

PlaneChange plane_change(const Machine& machine, const EdgeCut& cut, const SetupQuantity& quantity,
                         const Vec3& outward) {
  CutMotion motion(machine, cut);
  motion.change(quantity);
  PlaneChange change = motion.of_plane(outward);
  change.point_mm *= quantity.per_unit();
  change.normal *= quantity.per_unit();
  return change;
}

}  // namespace retrace::fabrication

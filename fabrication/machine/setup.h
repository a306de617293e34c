#pragma once

// Uncertain quantities of a machine's set-up: positions and tilts of the axes, and position and orientation of the
// tool. Also computes how each quantity changes the plane of a cut.

#include <span>
#include <string_view>

#include "fabrication/machine/edge_cut.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Part of the machine that a quantity describes.
enum class SetupPart {
  c_point,         ///< position of the axis of C
  tilt_point,      ///< position of the tilting axis (A or B)
  c_direction,     ///< direction of the axis of C
  tilt_direction,  ///< direction of the tilting axis (A or B)
  y_direction,     ///< squareness of Y
  z_direction,     ///< squareness of Z
  tool_offset,     ///< position of the tool after touching off
  tool_rotation    ///< orientation of the tool
};

/// Quantity of the set-up. Its value is the deviation of the real machine from the machine that programs assume, in um
/// or arcsec. The reference frame is defined by X, by the plane of X and Z, and by C at 0. A rotation or displacement
/// of this whole frame is not an error of the machine, but belongs to the pose of the blank.
struct SetupQuantity {
  std::string_view key;          ///< key in files, with its unit, such as "c_x_um"
  std::string_view description;  ///< description in messages, such as "centre of C along X"
  SetupPart part = SetupPart::c_point;
  int axis = 0;  ///< 0, 1, 2: axis X, Y, Z of the displacement or rotation

  bool is_angle() const {
    return part != SetupPart::c_point && part != SetupPart::tilt_point && part != SetupPart::tool_offset;
  }
  std::string_view unit() const { return is_angle() ? "arcsec" : "um"; }
  /// Returns one unit of the quantity in mm or radians.
  double per_unit() const;
};

/// Returns the quantities of a kind of machine, always in the same order.
std::span<const SetupQuantity> setup_quantities(Tilt tilt);
/// Returns the quantity with the given key, or null if this kind of machine does not have it.
const SetupQuantity* setup_quantity(Tilt tilt, std::string_view key);

/// Returns the machine with an error of one quantity.
/// \param amount value of the error, in um or arcsec
Machine with_error(Machine machine, const SetupQuantity& quantity, double amount);
/// Returns the machine with errors of all quantities.
/// \param amounts values in um or arcsec, in the order of setup_quantities()
/// \pre `amounts` contains one value for each quantity of setup_quantities()
Machine with_errors(Machine machine, std::span<const double> amounts);

/// Derivative of the plane of a cut with respect to a quantity, per um or arcsec (docs/theory/kinematics.md).
struct PlaneChange {
  geometry::Vec3 point_mm = geometry::Vec3::Zero();
  geometry::Vec3 normal = geometry::Vec3::Zero();

  /// Returns the derivative of CutPlane::height_mm().
  double height_mm(const CutPlane& plane, const geometry::Vec3& over_mm, const geometry::Vec3& along) const;
};
/// Computes the derivative of the plane of a cut with respect to a quantity.
/// \param outward direction in the workpiece frame that determines the side of the normal
PlaneChange plane_change(const Machine& machine, const EdgeCut& cut, const SetupQuantity& quantity,
                         const geometry::Vec3& outward);

}  // namespace retrace::fabrication

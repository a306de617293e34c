#pragma once

// What a set-up leaves uncertain - where the axes are, how they lean, how the tool stands - under the names of the
// set-up, and what a unit of each does to the plane of a cut.

#include <span>
#include <string>
#include <string_view>

#include "fabrication/machine/edge_cut.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// What of a machine a quantity belongs to.
enum class SetupPart {
  c_point,         ///< where the line lies about which C turns
  tilt_point,      ///< the same of A, or of B of a head
  c_direction,     ///< how C leans
  tilt_direction,  ///< how A leans, or B
  y_direction,     ///< Y out of square
  z_direction,     ///< Z out of square
  tool_offset,     ///< where the tool was touched off
  tool_turn        ///< how it is aligned
};

/// A quantity of the set-up. Its value is by how much the machine differs from what programs take it for, in um or
/// arcsec. The frame is fixed by X, by the plane of X and Z, and by C at 0: what turns or shifts all of that is no
/// error of the machine but the pose of the blank.
struct SetupQuantity {
  std::string_view key;    ///< with its unit: "c_x_um"
  std::string_view words;  ///< "centre of C along X"
  SetupPart part = SetupPart::c_point;
  int axis = 0;  ///< 0, 1, 2: along X, Y, Z; of a turn about them

  bool is_angle() const {
    return part != SetupPart::c_point && part != SetupPart::tilt_point && part != SetupPart::tool_offset;
  }
  std::string_view unit() const { return is_angle() ? "arcsec" : "um"; }
  /// Millimetres or radians to its unit.
  double per_unit() const;
};

/// Those of a machine, always in the same order.
std::span<const SetupQuantity> setup_quantities(Tilt tilt);
/// That of a key; null if the machine has none of that name.
const SetupQuantity* setup_quantity(Tilt tilt, std::string_view key);

/// The machine that differs by so much. \param amount um or arcsec
Machine with_error(Machine machine, const SetupQuantity& quantity, double amount);
/// The machine that differs by so much of each. \pre as many as setup_quantities()
Machine with_errors(Machine machine, std::span<const double> amounts);

/// How the plane of a cut changes with a quantity, per um or arcsec (docs/theory/kinematics.md).
struct PlaneChange {
  geometry::Vec3 point_mm = geometry::Vec3::Zero();
  geometry::Vec3 normal = geometry::Vec3::Zero();

  /// Of CutPlane::height_mm().
  double height_mm(const CutPlane& plane, const geometry::Vec3& over_mm, const geometry::Vec3& along) const;
};
/// \param outward as of cut_plane()
PlaneChange plane_change(const Machine& machine, const EdgeCut& cut, const SetupQuantity& quantity,
                         const geometry::Vec3& outward);

}  // namespace retrace::fabrication

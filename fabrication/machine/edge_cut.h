#pragma once

// Computes the plane that a straight cut produces in the workpiece. The machine on which the cut is made may differ
// from the machine for which the axis positions were planned.

#include "fabrication/machine/machine.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// Straight move of the edge while the rotary axes do not move.
struct EdgeCut {
  AxisPositions at;                                     ///< axis positions at the end of the move
  geometry::Vec3 travel_mm = -geometry::Vec3::UnitZ();  ///< direction of the move in X, Y and Z; any length > 0
  /// Point of the edge that produces the plane, relative to the tool reference point, in the axes of edge_frame().
  geometry::Vec3 tip_mm = geometry::Vec3::Zero();
  Angle edge_rise;  ///< angle between the cutting edge and the horizontal line of the facet; 0 for a chisel
};

/// Plane in the workpiece frame.
struct CutPlane {
  geometry::Vec3 point_mm = geometry::Vec3::Zero();  ///< point of the plane: position of the tip
  geometry::Vec3 normal = geometry::Vec3::UnitZ();   ///< unit normal

  /// Returns the height of the plane above a point, along a direction out of the material.
  double height_mm(const geometry::Vec3& over_mm, const geometry::Vec3& along) const {
    return normal.dot(point_mm - over_mm) / normal.dot(along);
  }
};

/// Returns the coordinate axes of the mounted tool as columns, in the machine frame. Points of the tool are given in
/// these coordinates, relative to its reference point. The axes of a chisel are its edge, the direction across the
/// edge, and the upward direction in the plane of plunging. The tool is touched off after mounting. A rotation of the
/// tool about its edge therefore does not change these axes.
Eigen::Matrix3d edge_frame(const Machine& machine);

/// Returns the change of the clearance angle due to the mounting of the tool. A chisel may be mounted with a rotation
/// about its edge, relative to the plane of plunging. The angle of this rotation is the result.
Angle clearance_change(const Machine& machine);

/// Returns the unit vector along the cutting edge, in the machine frame.
/// \param edge_rise angle between the cutting edge and the horizontal line of the facet
geometry::Vec3 cutting_edge(const Machine& machine, Angle edge_rise);

/// Returns the plane that the edge sweeps.
/// \param outward direction in the workpiece frame that determines the side of the normal
/// \pre the edge does not move along itself
CutPlane cut_plane(const Machine& machine, const EdgeCut& cut, const geometry::Vec3& outward);

}  // namespace retrace::fabrication

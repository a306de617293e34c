#pragma once

// A straight cut of the tool's edge in the words of a program, and the plane that it leaves in the workpiece on a
// machine: the words may have been made for another one.

#include "fabrication/machine/machine.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// A straight move of the edge while the rotary axes stand.
struct EdgeCut {
  AxisPositions at;                                     ///< where the move ends
  geometry::Vec3 travel_mm = -geometry::Vec3::UnitZ();  ///< words of X, Y and Z along the move, of any length above 0
  /// What cuts the plane, from the tool reference point, while the tool stands as it should.
  geometry::Vec3 tip_mm = geometry::Vec3::Zero();
  Angle edge_rise;  ///< of the cutting edge over the level line of a standing facet, in it: 0 of a chisel
};

/// A plane in the workpiece frame.
struct CutPlane {
  geometry::Vec3 point_mm = geometry::Vec3::Zero();  ///< on it: where the tip stands
  geometry::Vec3 normal = geometry::Vec3::UnitZ();   ///< of length 1, on the side of -Y or -X of a standing facet

  /// Height of the plane over a point, along a direction that leaves the material.
  double height_mm(const geometry::Vec3& over_mm, const geometry::Vec3& along) const {
    return normal.dot(point_mm - over_mm) / normal.dot(along);
  }
};

/// Returns the axes of the mounted tool, as columns, in the machine frame. Points of the tool are given in these axes
/// relative to its reference point. The axes of a chisel are the edge, the direction across the edge, and the upward
/// direction in the plane of plunging. A rotation of the tool about its edge does not change these axes, because the
/// tool is touched off after mounting.
Eigen::Matrix3d edge_frame(const Machine& machine);

/// Returns the change of the clearance angle due to the mount: the rotation of a chisel about its edge relative to the
/// plane of plunging.
Angle clearance_change(const Machine& machine);

/// Along the edge that cuts, in the machine frame and of length 1.
geometry::Vec3 cutting_edge(const Machine& machine, Angle edge_rise);

/// The plane that the edge sweeps. \param outward the normal's side, a direction of the workpiece
/// \pre the edge does not move along itself
CutPlane cut_plane(const Machine& machine, const EdgeCut& cut, const geometry::Vec3& outward);

}  // namespace retrace::fabrication

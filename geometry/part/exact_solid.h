#pragma once

// Solids whose entrance face is an exact curved surface and whose other faces are planes, as CAD formats store them.

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/part/faceted_solid.h"
#include "geometry/surface/spline_patch.h"

namespace retrace::geometry {

struct ExactPlane {
  Vec3 origin_mm = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit vector, out of the solid
};

struct ExactCylinder {
  Vec3 origin_mm = Vec3::Zero();  ///< point on the axis
  Vec3 axis = Vec3::UnitY();      ///< unit vector
  Vec3 towards = Vec3::UnitZ();   ///< unit vector from the axis towards the middle of the face, perpendicular to it
  double radius_mm = 1.0;         ///< > 0
  bool is_convex = true;          ///< true: the solid is on the side of the axis
};

struct ExactSphere {
  Vec3 centre_mm = Vec3::Zero();
  Vec3 towards = Vec3::UnitZ();  ///< unit vector from the centre towards the middle of the face
  double radius_mm = 1.0;        ///< > 0
  bool is_convex = true;         ///< true: the solid is on the side of the centre
};

/// Surface of a face. Plane, cylinder and sphere are exact. A bicubic patch approximates other surfaces.
using FaceSurface = std::variant<ExactPlane, ExactCylinder, ExactSphere, SplinePatch>;

/// Edge on a bicubic patch above a straight line in plan. Its parameter runs from 0 at the vertex `from` to 1 at the
/// vertex `to`; x and y are linear in the parameter.
struct PatchEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  SplineAxis axis;
  std::vector<double> heights_mm;  ///< B-spline coefficients of z
};

/// Entrance face of a solid on a curved surface.
struct CurvedFace {
  FaceSurface surface;
  std::vector<PatchEdge> edges;  ///< all edges of the face, if the surface is a bicubic patch; otherwise empty
};

/// Solid for CAD formats. Faces with the role `entrance` are on the curved surface if there is one; their edges are the
/// lines in which vertical planes cut this surface. All other faces are planes.
struct ExactSolid {
  FacetedSolid faces;
  std::optional<CurvedFace> entrance;
};

}  // namespace retrace::geometry

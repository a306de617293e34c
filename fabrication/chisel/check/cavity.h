#pragma once

// Geometry of the designed elements of a job: grooves of prisms and cavities of cube corners, in the workpiece frame.
// Also finds the element at a given point.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <variant>
#include <vector>

#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// A facet as designed, in the workpiece frame. A point p of the facet has normal . p = offset_mm.
struct DesignFacet {
  geometry::Vec3 normal = geometry::Vec3::UnitZ();  ///< unit normal, outward from the material
  double offset_mm = 0.0;
  geometry::Vec3 up_slope = geometry::Vec3::UnitZ();  ///< unit vector in the facet, from the root towards the rim
  /// Unit vector across the facet. Prism: parallel to the root. Cube corner: from the first dihedral edge of the facet
  /// towards its second dihedral edge.
  geometry::Vec3 along = geometry::Vec3::UnitX();

  /// Returns the signed distance of a point from the facet plane; negative inside the material.
  double height_mm(const geometry::Vec3& p) const { return normal.dot(p) - offset_mm; }
};

/// An element as designed, in the workpiece frame: the properties that grooves of prisms and cavities of cube corners
/// have in common.
struct DesignElement {
  geometry::Vec3 axis = geometry::Vec3::UnitZ();  ///< unit vector out of the blank
  /// Position of the blank's face along the axis: the face is the plane axis . p = face_mm. On a curved blank, it is a
  /// plane above which the blank has no material within the opening of the element. On a flat blank, it is z_w = 0.
  double face_mm = 0.0;
  double depth_mm = 0.0;  ///< depth of the root or apex below the rims
  double stock_mm = 0.0;  ///< height of the face above the rims

  geometry::Vec3 root_mm = geometry::Vec3::Zero();  ///< centre of the root line, or the apex
  std::vector<DesignFacet> facets;                  ///< two facets of a prism, or three facets of a cube corner
  /// Length of a facet from the root to the rim. Cube corner: length of a dihedral edge from the apex to the plane of
  /// the rims, without angle errors.
  double facet_length_mm = 0.0;
  std::size_t zone = 0;  ///< index of the zone in the job; 0 without zones

  /// Returns the height of a point above the blank's face.
  double height_over_face_mm(const geometry::Vec3& p) const { return axis.dot(p) - face_mm; }
  /// Returns the distance from a point to the blank's face along a direction.
  double to_face_mm(const geometry::Vec3& p, const geometry::Vec3& direction) const {
    return -height_over_face_mm(p) / axis.dot(direction);
  }
};

/// Groove of a prism. The normal of the first facet points towards -y_w, and the normal of the second facet towards
/// +y_w. In a rotated element, they point towards -x_w and +x_w.
struct PrismGroove : DesignElement {
  geometry::Vec3 root_direction = geometry::Vec3::UnitX();
  double half_width_mm = 0.0;  ///< half of the length along the root
  double half_base_mm = 0.0;   ///< half of the length across the root

  /// Returns the coordinate of a point along the root, measured from the centre of the root.
  double along_mm(const geometry::Vec3& p) const { return root_direction.dot(p - root_mm); }
};

/// Cavity of a cube corner. facets[k] is between edges[k] and edges[(k + 1) % 3].
struct CubeCavity : DesignElement {
  /// Unit vectors along the three dihedral edges, from the apex. The first edge points towards -y_w (rotated element:
  /// +y_w).
  std::array<geometry::Vec3, 3> edges = {geometry::Vec3::UnitZ(), geometry::Vec3::UnitZ(), geometry::Vec3::UnitZ()};
  double radius_mm = 0.0;     ///< radius of the aperture, from its centre to its corners
  bool is_hexagonal = false;  ///< true: hexagonal aperture, which is smaller than the triangular cavity
  /// Distance along the axis between the nominal apex and the apex of a layer, per mm of material that the layer leaves
  /// on each facet.
  double layer_rise = 0.0;

  /// Returns the length of a dihedral edge from the apex to the plane of the rims.
  double edge_length_mm(std::size_t edge) const { return depth_mm / axis.dot(edges[edge]); }
  /// Returns the z coordinate of the cavity's surface at a point of the plane z = 0. Outside of the cavity, the result
  /// is positive.
  /// \pre the blank is flat
  double height_mm(const geometry::Vec2& point) const;
};

/// An element as designed, in the workpiece frame.
using Cavity = std::variant<PrismGroove, CubeCavity>;

/// Returns the properties that both kinds of elements have.
inline const DesignElement& common(const Cavity& groove) {
  return std::visit([](const DesignElement& element) -> const DesignElement& { return element; }, groove);
}
/// Returns half of the longer side of a prism's aperture, or the radius of a cube corner's aperture.
double half_size_mm(const Cavity& groove);
/// Returns the corners of a facet, in the workpiece frame.
std::vector<geometry::Vec3> facet_corners(const Cavity& groove, std::size_t facet);
/// Returns the mean of the corners of a facet, in the workpiece frame.
geometry::Vec3 facet_centre(const Cavity& groove, std::size_t facet);

/// Returns the groove of a prism as designed, in the workpiece frame.
/// \param stock_mm height of the blank's face above the element's rims
PrismGroove groove_of(const CutElement& element, const geometry::RtpElement& size, double stock_mm = 0.0);
/// Returns the cavity of a cube corner as designed, in the workpiece frame.
/// \pre `size` is a cube corner
CubeCavity cavity_of(const CutElement& element, const geometry::Element& size, const geometry::AngleErrors& errors = {},
                     double stock_mm = 0.0);
/// Returns the groove or cavity of one element of a job.
Cavity groove_of(const CutElement& element, const Job& job, double stock_mm = 0.0);
/// Returns all elements of a job, in the order of cut_elements(), for a blank whose face is at the height of the rims.
std::vector<Cavity> designed_cavities(const Job& job);

/// Finds the element whose aperture contains a point of the blank's face. For cube corners, it finds the element with
/// the nearest apex, if the distance is at most the radius of the aperture.
class CavityMap {
 public:
  explicit CavityMap(const std::vector<Cavity>& grooves);
  /// Returns the element at a point of the blank's face. Returns nothing outside of the array, and in flat areas
  /// between the elements.
  std::optional<std::size_t> at(double x_mm, double y_mm) const { return at(geometry::Vec3(x_mm, y_mm, 0.0)); }
  /// Returns the element whose aperture contains a point that is projected along the element's axis.
  std::optional<std::size_t> at(const geometry::Vec3& p) const;
  /// Returns the element with the deepest design surface at a point. It is usually the element that at() returns. It
  /// can be a neighbour of this element, because the cavity of a cube corner may extend beyond its aperture. Returns
  /// nothing where the face is not cut.
  std::optional<std::size_t> deepest(double x_mm, double y_mm) const;

 private:
  using Cell = std::int64_t;
  Cell cell_of(double x_mm, double y_mm, int dx, int dy) const;

  const std::vector<Cavity>& cavities_;
  int cells_around_ = 1;  ///< number of neighbouring cells to search, because an inclined axis displaces an element
  double cell_mm_ = 1.0;
  std::unordered_multimap<Cell, std::size_t> cells_;
};

}  // namespace retrace::fabrication

#pragma once

// The elements that a job asks for, as grooves and cavities of the blank in the workpiece frame, and which of them a
// point belongs to.

#include <array>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

inline constexpr double kNmPerMm = 1e6;

/// A facet as designed, in the workpiece frame: normal . p = offset_mm on it, more outside of the material.
struct DesignFacet {
  geometry::Vec3 normal = geometry::Vec3::UnitZ();  ///< outward from the material, of length 1
  double offset_mm = 0.0;
  geometry::Vec3 up_slope = geometry::Vec3::UnitZ();  ///< in the facet, from the root towards the rim, of length 1

  /// How far a point stands off the facet; negative: within the material.
  double height_mm(const geometry::Vec3& p) const { return normal.dot(p) - offset_mm; }
};

/// An element as designed, in the frame of the blank: the groove of a prism or the cavity of a cube corner.
struct Groove {
  /// Where the blank begins, seen from the element: a plane across its axis that no part of the blank stands over
  /// within what its cut opens. On a flat blank the blank's face, z_w = 0.
  geometry::Vec3 axis = geometry::Vec3::UnitZ();  ///< out of the blank, of length 1
  double face_mm = 0.0;                           ///< axis . p there
  double depth_mm = 0.0;                          ///< of the root or apex below the rims
  double stock_mm = 0.0;                          ///< by which the face stands over them

  geometry::Vec3 root_mm = geometry::Vec3::Zero();  ///< middle of the root line, or the apex
  geometry::Vec3 root_direction = geometry::Vec3::UnitX();
  /// Of a prism: facet 1 faces -y_w (of a turned element -x_w), facet 2 the other way. Of a cube corner: facet k lies
  /// between dihedral edges k - 1 and k, of which edge 0 lies along -y_w (of a turned element +y_w).
  std::vector<DesignFacet> facets;
  double half_width_mm = 0.0;  ///< along the root; of a cube corner the radius of its aperture
  double half_base_mm = 0.0;   ///< across the root; of a cube corner the radius of its aperture
  /// Length of a facet from the root to the rim. Cube corner: length of a dihedral edge from the apex to the plane of
  /// the rims, without errors of angle.
  double facet_length_mm = 0.0;
  /// Index in Workpiece3d::predictions; elements of equal shape and orientation have the same index.
  std::size_t group = 0;
  std::size_t zone = 0;  ///< index of the zone in the job; 0 without zones
  /// Of a cube corner: the three dihedral edges, of length 1, from the apex. Facet k lies between k - 1 and k.
  std::vector<geometry::Vec3> edges;
  /// Cube corner: distance along its axis between the nominal apex and the apex of a layer, per mm of material that the
  /// layer leaves on each facet.
  double layer_rise = 0.0;

  bool is_cube() const { return !edges.empty(); }

  /// Over the plane where the blank begins.
  double over_face_mm(const geometry::Vec3& p) const { return axis.dot(p) - face_mm; }
  /// From a point along a direction to that plane.
  double to_face_mm(const geometry::Vec3& p, const geometry::Vec3& direction) const {
    return -over_face_mm(p) / axis.dot(direction);
  }
  /// Returns the length of a dihedral edge of a cube corner from the apex to the plane of the rims.
  double edge_length_mm(std::size_t edge) const { return depth_mm / axis.dot(edges[edge]); }
  /// Returns the height above a point of the plane z = 0, along z, at which the deepest facet plane of a cube corner on
  /// a flat blank is located. The point may be outside of the aperture.
  double cavity_height_mm(const geometry::Vec2& place) const;
  /// Along the root, from its middle.
  double along_mm(const geometry::Vec3& p) const { return root_direction.dot(p - root_mm); }
  /// Along a facet's level line, of length 1: of a prism along its root.
  geometry::Vec3 level_of(std::size_t facet) const;
  /// Of a facet in the plane of its rim or, of a cube corner, at the ends of its dihedral edges.
  std::vector<geometry::Vec3> facet_corners(std::size_t facet) const;
  /// Their mean.
  geometry::Vec3 facet_middle(std::size_t facet) const;
};

/// \param stock_mm by which the blank stands over the element's rims
Groove groove_of(const CutElement& element, const geometry::RtpElement& size, double stock_mm = 0.0);
/// The cavity of a cube corner. \pre size is one
Groove cavity_of(const CutElement& element, const geometry::Element& size, const geometry::AngleErrors& errors = {},
                 double stock_mm = 0.0);
/// Returns the groove or cavity of one element of a job.
Groove groove_of(const CutElement& element, const Job& job, double stock_mm = 0.0);
/// All elements of a job on blanks that do not stand over their rims, in the order of cut_elements().
std::vector<Groove> designed_grooves(const Job& job);

/// Finds the element whose aperture a point of the blank's face lies in; of cube corners the nearest within the radius
/// of their apertures.
class GrooveMap {
 public:
  explicit GrooveMap(const std::vector<Groove>& grooves);
  /// The element under the point; nothing on flat land or beyond the array.
  std::optional<std::size_t> at(double x_mm, double y_mm) const { return at(geometry::Vec3(x_mm, y_mm, 0.0)); }
  /// The element whose aperture the point lies over or under, seen along the element's axis.
  std::optional<std::size_t> at(const geometry::Vec3& p) const;
  /// The element whose design lies deepest under the point: that of at(), or of cube corners the one whose cavity takes
  /// the point, beyond its aperture too. Nothing where the face stays.
  std::optional<std::size_t> deepest(double x_mm, double y_mm) const;

 private:
  using Cell = std::int64_t;
  Cell cell_of(double x_mm, double y_mm, int dx, int dy) const;

  const std::vector<Groove>& grooves_;
  int cells_around_ = 1;  ///< in which an element may be whose axis leans
  double cell_mm_ = 1.0;
  std::unordered_multimap<Cell, std::size_t> cells_;
};

}  // namespace retrace::fabrication

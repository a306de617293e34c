#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "fabrication/job/job.h"
#include "geometry/vec.h"

namespace retrace::fabrication {

/// A facet as designed, in the workpiece frame: normal . p = offset_mm on it, more outside of the material.
struct DesignFacet {
  geometry::Vec3 normal = geometry::Vec3::UnitZ();  ///< outward from the material, of length 1
  double offset_mm = 0.0;
  geometry::Vec3 up_slope = geometry::Vec3::UnitZ();  ///< in the facet, from the root towards the rim, of length 1

  /// How far a point stands off the facet; negative: within the material.
  double height_mm(const geometry::Vec3& p) const { return normal.dot(p) - offset_mm; }
};

/// An element as designed, in the blank's face z_w = 0: the groove of a prism, or the cavity of a cube corner.
struct Groove {
  geometry::Vec3 root_mm = geometry::Vec3::Zero();  ///< middle of the root line, or the apex
  geometry::Vec3 root_direction = geometry::Vec3::UnitX();
  /// Of a prism: facet 1 faces -y_w (of a turned element -x_w), facet 2 the other way. Of a cube corner: facet k lies
  /// between dihedral edges k - 1 and k, of which edge 0 lies along -y_w (of a turned element +y_w).
  std::vector<DesignFacet> facets;
  double half_width_mm = 0.0;    ///< along the root; of a cube corner the radius of its aperture
  double half_base_mm = 0.0;     ///< likewise
  double facet_length_mm = 0.0;  ///< from the root to the rim; of a cube corner from the apex along a dihedral edge
  bool turned = false;
  /// Of a cube corner: the three dihedral edges, of length 1, from the apex. Facet k lies between k - 1 and k.
  std::vector<geometry::Vec3> edges;

  bool is_cube() const { return !edges.empty(); }

  /// Along the root, from its middle.
  double along_mm(const geometry::Vec3& p) const { return root_direction.dot(p - root_mm); }
};

Groove groove_of(const CutElement& element, const geometry::RtpElement& size);
/// The cavity of a cube corner. \pre size is one
Groove cavity_of(const CutElement& element, const geometry::Element& size);

/// Finds the element whose aperture a point of the blank's face lies in; of cube corners the nearest within the radius
/// of their apertures.
class GrooveMap {
 public:
  explicit GrooveMap(const std::vector<Groove>& grooves);
  /// The element under the point; nothing on flat land or beyond the array.
  std::optional<std::size_t> at(double x_mm, double y_mm) const;
  /// The element whose design lies deepest under the point: that of at(), or of cube corners the one whose cavity takes
  /// the point, beyond its aperture too. Nothing where the face stays.
  std::optional<std::size_t> deepest(double x_mm, double y_mm) const;

 private:
  using Cell = std::int64_t;
  Cell cell_of(double x_mm, double y_mm, int dx, int dy) const;

  const std::vector<Groove>& grooves_;
  double cell_mm_ = 1.0;
  std::unordered_multimap<Cell, std::size_t> cells_;
};

}  // namespace retrace::fabrication

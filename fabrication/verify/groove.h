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

/// An element as designed: a groove in the blank's face z_w = 0.
struct Groove {
  geometry::Vec3 root_mm = geometry::Vec3::Zero();  ///< middle of the root line
  geometry::Vec3 root_direction = geometry::Vec3::UnitX();
  std::array<DesignFacet, 2> facets;  ///< facet 1 faces -y_w (of a turned element -x_w), facet 2 the other way
  double half_width_mm = 0.0;         ///< along the root
  double half_base_mm = 0.0;
  double facet_length_mm = 0.0;  ///< from the root to the rim

  /// Along the root, from its middle.
  double along_mm(const geometry::Vec3& p) const { return root_direction.dot(p - root_mm); }
};

Groove groove_of(const CutElement& element, const geometry::RtpElement& size);

/// Finds the element whose aperture a point of the blank's face lies in.
class GrooveMap {
 public:
  explicit GrooveMap(const std::vector<Groove>& grooves);
  /// The element under the point; nothing on flat land or beyond the array.
  std::optional<std::size_t> at(double x_mm, double y_mm) const;

 private:
  using Cell = std::int64_t;
  Cell cell_of(double x_mm, double y_mm, int dx, int dy) const;

  const std::vector<Groove>& grooves_;
  double cell_mm_ = 1.0;
  std::unordered_multimap<Cell, std::size_t> cells_;
};

}  // namespace retrace::fabrication

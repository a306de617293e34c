#pragma once

// Builds parts with zones. A zone is a set of regions, or of cells, of a plate. Each zone has its own kind of elements.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/outline/plan_region.h"
#include "geometry/part/part.h"

namespace retrace::geometry {

/// Cell of an array in the part frame: an element, or land (flat surface) between elements. If the cells of two arrays
/// have the same positions, they also have the same numbers, even if the elements differ.
struct ArrayCell {
  std::uint32_t number = 0;
  Polygon outline;  ///< complete outline, even if it crosses the border
  bool is_element = true;
};
struct ArrayPlan {
  std::vector<ArrayCell> cells;    ///< all cells that overlap the block, sorted by number
  Rectangle block_mm;              ///< area that the cells fill
  std::vector<Rectangle> land_mm;  ///< flat areas between the block and the border
};
/// Returns the cells and the land of an array.
/// \pre the array is finite, on the plane z = 0 and not `single`
/// \throw InputError if the array is smaller than one element
ArrayPlan plan_of_array(const PartSpec& spec);

/// Regions of the plate that are filled with the same kind of elements, or a set of cells of an array that covers the
/// plate.
/// A region is filled as follows. Without a rotation, the array has the lengths of the region's bounding box and is
/// placed in this box. With a rotation, a larger array is rotated about the centre of the bounding box such that it
/// covers the region.
struct PartZone {
  std::vector<Polygon> regions;  ///< in the part frame; they may extend beyond the outline of the plate
  /// Rotation of the elements in the plane, counter-clockwise as seen from +z. If the zone consists of cells, each
  /// element is rotated about its own centroid.
  double rotation_deg = 0.0;
  PartSpec elements;                      ///< lengths, margins and plate data are ignored
  std::vector<std::uint32_t> cells = {};  ///< used instead of regions: numbers of cells of the plate's array, ascending
};

/// A plate with zones that cover it.
struct ZonedSpec {
  Vec2 size_mm = Vec2::Zero();  ///< size of the rectangular plate, or of the bounding box of its outline
  double thickness_mm = 0.0;
  std::vector<PartZone> zones;
  /// true if zones consist of cells instead of regions; the land then belongs to the first zone
  bool is_by_cell = false;
  /// Outline of a plate that is not a rectangle, or null. It cuts the regions and the elements of the zones.
  std::shared_ptr<const PlanRegion> outline = {};

  double area_mm2() const { return outline ? outline->area_mm2() : size_mm.prod(); }
  /// Returns the outline that cuts the zones, or null if the plate is a rectangle without a flat margin.
  const PlanRegion* cutting_outline() const;
};

/// Returns the array whose cells a zone uses. It has the element of the zone and the size of the plate.
PartSpec array_of_cells(const ZonedSpec& spec, const PartZone& zone);

/// Reason why zones do not cover the plate correctly.
struct ZoneFault {
  enum class Subject { zone, elements, rotation };
  std::size_t zone = 0;
  std::string text;  ///< such as "reaches beyond the part" or "overlaps zone 1"
  Subject subject = Subject::zone;
};
/// Returns the portions of a region that are inside the plate, as convex polygons.
std::vector<Polygon> within_plate(const ZonedSpec& spec, const Polygon& region);

/// Checks the zones. Returns the first fault, or nothing if there is none. The zones must cover the area of the plate
/// inside its outline without overlap. If zones consist of cells, three more conditions apply. In the array of each
/// zone, the cells must have the same positions as in the first array. The rotation of a zone must map the outline of
/// each element to itself. Each zone must contain an element.
std::optional<ZoneFault> fault_of_zones(const ZonedSpec& spec);

/// Returns the approximate number of elements in all zones.
double element_estimate(const ZonedSpec& spec);

/// Position and rotation of a complete element in the part.
struct ElementPlacement {
  Vec2 apex_mm = Vec2::Zero();  ///< in the part frame
  /// Rotation of the element's zone. 180 degrees are added for an element that is rotated within the array of the zone.
  double rotation_deg = 0.0;
};
/// Returns the complete elements of each zone. Partial elements are omitted.
/// \pre the preconditions of build_part() hold; all elements are cube corners
std::vector<std::vector<ElementPlacement>> whole_elements(const ZonedSpec& spec);

/// Adds the zones to a part. For use by build_part() only.
void add_zones(Part& part, const ZonedSpec& spec);

/// Builds the part. Vertical walls are added where neighbouring elements differ in height. The back is a single patch.
/// \pre fault_of_zones() returns nothing; arrays are finite, on the plane z = 0, without margins and not `single`
/// \throw InputError if a region is smaller than one element, or if a rim reaches the entrance face
Part build_part(const ZonedSpec& spec);

}  // namespace retrace::geometry

#pragma once

// Parts of zones: regions of one plate, each with elements of its own.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::geometry {

/// A cell of an array, in the part frame: an element or the land beside one. Those of arrays that differ in what their
/// cells are like, not in where they are, have the same numbers.
struct ArrayCell {
  std::uint32_t number = 0;
  Polygon outline;  ///< whole, even where it reaches over the border
  bool is_element = true;
};
struct ArrayPlan {
  std::vector<ArrayCell> cells;    ///< by number; all that reach into the block
  Rectangle block_mm;              ///< that they fill
  std::vector<Rectangle> land_mm;  ///< beside the block
};
/// \pre a finite array on the plane z = 0, not `single` \throw InputError where it is smaller than one element
ArrayPlan plan_of_array(const PartSpec& spec);

/// Regions, or elements of one array all over the plate, that are filled alike. What fills a region that is not turned
/// is the array that a design with the lengths of the region's box has, in that box; turned, it is that of a box that
/// holds the region, about the region's middle.
struct PartZone {
  std::vector<Polygon> regions;  ///< in the part frame
  /// Of the elements in the plane, counter-clockwise seen from +z; of single cells each about its centroid.
  double rotation_deg = 0.0;
  PartSpec elements;                      ///< lengths, margins and the plate do not count
  std::vector<std::uint32_t> cells = {};  ///< in place of regions: numbers of cells of the plate's array, rising
};

/// A rectangular plate with zones that cover it.
struct ZonedSpec {
  Vec2 size_mm = Vec2::Zero();
  double thickness_mm = 0.0;
  std::vector<PartZone> zones;
  bool is_by_cell = false;  ///< zones have cells in place of regions; the land beside them is the first one's

  double area_mm2() const { return size_mm.prod(); }
};

/// The array that a zone by cell has its cells of.
PartSpec array_of_cells(const ZonedSpec& spec, const PartZone& zone);

/// What keeps zones from covering the plate.
struct ZoneFault {
  enum class Of { zone, elements, rotation };
  std::size_t zone = 0;
  std::string text;  ///< "reaches beyond the part", "overlaps zone 1"
  Of what = Of::zone;
};
/// Returns the first fault of the zones, or nothing. The zones must cover the plate without overlap. If zones consist
/// of cells, three more conditions hold. The array of each zone must have its cells at the positions of the first
/// array's cells. The rotation of a zone must map the outline of each element to itself. Each zone must have elements.
std::optional<ZoneFault> fault_of_zones(const ZonedSpec& spec);

/// About how many elements its zones have.
double element_estimate(const ZonedSpec& spec);

/// Position and rotation of a complete element in the part.
struct StandingElement {
  Vec2 apex_mm = Vec2::Zero();  ///< in the part frame
  /// Rotation of its zone, plus 180 for an element that is rotated within the array of the zone.
  double rotation_deg = 0.0;
};
/// Returns the complete elements of each zone. Partial elements are omitted.
/// \pre as of build_part(); all elements are cube corners
std::vector<std::vector<StandingElement>> whole_elements(const ZonedSpec& spec);

/// Internal to geometry: adds what build_part() takes of zones.
void add_zones(Part& part, const ZonedSpec& spec);

/// Builds the part: where unlike elements meet, upright walls close what differs. Its back is one patch.
/// \pre fault_of_zones() finds none; arrays are finite, on the plane z = 0, without margins and not `single`
/// \throw InputError where a region is smaller than one element, or a rim reaches the entrance face
Part build_part(const ZonedSpec& spec);

}  // namespace retrace::geometry

#pragma once

// Parts of zones: regions of one plate, each with elements of its own.

#include <optional>
#include <string>
#include <vector>

#include "geometry/part/part.h"

namespace retrace::geometry {

/// Regions that are filled alike. What fills a region that is not turned is the array that a design with the lengths of
/// the region's box has, in that box; turned, it is that of a box that holds the region, about the region's middle.
struct PartZone {
  std::vector<Polygon> regions;  ///< in the part frame
  double rotation_deg = 0.0;     ///< of the elements in the plane, counter-clockwise seen from +z
  PartSpec elements;             ///< lengths, margins and the plate do not count
};

/// A rectangular plate with zones that cover it.
struct ZonedSpec {
  Vec2 size_mm = Vec2::Zero();
  double thickness_mm = 0.0;
  std::vector<PartZone> zones;

  double area_mm2() const { return size_mm.prod(); }
};

/// The area of a zone's regions.
double area(const PartZone& zone);

/// What keeps zones from covering the plate.
struct ZoneFault {
  std::size_t zone = 0;
  std::string text;  ///< "reaches beyond the part", "overlaps zone 1"
};
/// The first fault of zones that do not cover the plate, or cover a part of it twice; none if they are well.
std::optional<ZoneFault> fault_of_zones(const ZonedSpec& spec);

/// About how many elements its zones have.
double element_estimate(const ZonedSpec& spec);

/// Internal to geometry: adds what build_part() takes of zones.
void add_zones(Part& part, const ZonedSpec& spec);

/// Builds the part: where unlike elements meet, upright walls close what differs. Its back is one patch.
/// \pre fault_of_zones() finds none; arrays are finite, on the plane z = 0, without margins and not `single`
/// \throw InputError where a region is smaller than one element, or a rim reaches the entrance face
Part build_part(const ZonedSpec& spec);

}  // namespace retrace::geometry

#pragma once

// Height maps of a part: where they lie on it, and what they say of its facets.

#include <optional>
#include <string>
#include <vector>

#include "studies/calibration/facet_marks.h"
#include "studies/calibration/measured_facets.h"
#include "surface_models/height_map.h"

namespace retrace::studies {

/// A measured piece of a part's surface. Its rows lie along x of the workpiece and follow each other along y, but for
/// the turn; it lies askew as it may.
struct FacetMap {
  std::string file;  ///< for messages
  surface_models::HeightMap heights;
  geometry::Vec2 middle_mm = geometry::Vec2::Zero();  ///< of the map in the workpiece frame, within half an element
  double turn_deg = 0.0;                              ///< about z, within 2
};

/// A registered map: turned and shifted so that it lies on the design as well as it can.
struct RegisteredMap {
  fabrication::RigidMotion part_from_map;  ///< from the map's middle
  double rms_nm = 0.0;                     ///< of what then lies off the design
  std::vector<Measurement> figures;        ///< of every facet that it shows: distance and both tilts
  std::optional<FaceFigures> face;         ///< none: it shows too little of the blank's face
  std::vector<FacetRest> rests;            ///< of the facets that figures are of: what these leave
};

/// Marks of chips and scratches are left out of figures.
/// \param plan of the programs that cut the part
/// \throw InputError for a map that lies nowhere on the design, or shows no facet
RegisteredMap registered(const FacetMap& map, const FabricationResult& plan);

}  // namespace retrace::studies

#pragma once

// Registers height maps of a part to its design, and measures the facets in them.

#include <optional>
#include <string>
#include <vector>

#include "studies/calibration/facet_marks.h"
#include "studies/calibration/measured_facets.h"
#include "surface_models/height_map.h"

namespace retrace::studies {

/// Height map of a region of a part's surface. Its rows are parallel to x of the workpiece and follow each other along
/// y, except for a rotation about z and an unknown small tilt.
struct FacetMap {
  std::string file;  ///< name of the file, for messages
  surface_models::HeightMap heights;
  /// Centre of the map in the workpiece frame, accurate to half an element.
  geometry::Vec2 centre_mm = geometry::Vec2::Zero();
  double rotation_deg = 0.0;  ///< rotation about z, accurate to 2 degrees
};

/// Registered map: the rotation and translation that fit it best to the design.
struct RegisteredMap {
  fabrication::RigidMotion part_from_map;  ///< transformation of points relative to the centre of the map
  double rms_nm = 0.0;                     ///< rms deviation from the design after registration
  std::vector<Measurement> figures;        ///< distance and both tilts of every facet that the map shows
  /// Height and tilts of the blank's face. None if the map shows too little of the face.
  std::optional<FaceFigures> face;
  std::vector<FacetResiduals> residuals;  ///< waves and marks of the measured facets
};

/// Registers a map to the design and measures its facets. Points on marks of chips and scratches are ignored.
/// \param plan plan of the programs that cut the part
/// \throw InputError for a map that fits no position on the design, or shows no facet
RegisteredMap registered(const FacetMap& map, const FabricationResult& plan);

}  // namespace retrace::studies

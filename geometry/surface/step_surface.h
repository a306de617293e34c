#pragma once

// Surfaces that were read from STEP files.

#include <algorithm>
#include <string>
#include <vector>

#include "geometry/surface/patch_surface.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Edge at which the normals of two faces differ.
struct TangentBreak {
  double angle_deg = 0.0;     ///< maximum angle between the normals along the edge
  Vec3 at_mm = Vec3::Zero();  ///< position of this maximum in the frame of the file
};

/// Returns the distance by which a part may extend beyond the border of the faces.
/// \param size_mm size of the bounding box of all faces
inline double step_margin_mm(const Vec2& size_mm) {
  return std::max(1e-3 * size_mm.maxCoeff(), 0.02);
}

/// Surface that was read from a STEP file.
struct StepSurface {
  PatchSurface patches;           ///< heights relative to `origin_mm`, in the rotated frame of the file
  Vec3 origin_mm = Vec3::Zero();  ///< origin of the surface in the frame of the file
  Vec2 size_mm = Vec2::Zero();    ///< size of the bounding box in plan
  std::string unit = {};          ///< unit of length of the file
  double deviation_mm = 0.0;      ///< maximum difference between the patches and the surfaces of the file, along z
  double deviation_arcsec = 0.0;  ///< maximum angle between their normals
  double gap_mm = 0.0;            ///< maximum width of a gap that was closed between two faces
  std::vector<TangentBreak> breaks = {};  ///< sorted by descending angle
};

}  // namespace retrace::geometry

#pragma once

// Faces of STEP files as surfaces z(x, y): their selection and placement, and the surface that is read from the file.

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/surface/patch_surface.h"
#include "geometry/vec.h"

namespace retrace::geometry {

/// Edge at which the normals of two faces differ.
struct TangentBreak {
  double angle_deg = 0.0;          ///< maximum angle between the normals along the edge
  Vec3 at_mm = Vec3::Zero();  ///< position of this maximum in the frame of the file
};

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

/// Selection and placement of faces in a STEP file.
struct StepChoice {
  std::filesystem::path file;  ///< relative to the working directory
  /// Name, colour (#rrggbb) or number of the face, "largest", or "towards +z" for all faces whose normals point upwards.
  std::string face = "largest";
  double sew_mm = 0.01;  ///< maximum width of gaps between faces that are joined
  /// Point of the file that becomes the origin of the surface. If empty, the origin is the point of the surface at the
  /// centre of its bounding box in plan.
  std::optional<std::array<double, 3>> origin_mm = {};
  std::array<double, 3> rotation_deg = {};  ///< rotations of the file about its x axis, then y, then z
};

/// Faces of a STEP file that form a surface of a design.
struct StepFace {
  std::string name;  ///< name of the file, as given in the design
  StepChoice choice;
  std::shared_ptr<const StepSurface> surface = {};  ///< null until the file has been read
};

/// Returns the heights of a face, or null if its file has not been read.
inline std::shared_ptr<const PatchSurface> patches_of(const StepFace& face) {
  return face.surface ? std::shared_ptr<const PatchSurface>(face.surface, &face.surface->patches) : nullptr;
}

}  // namespace retrace::geometry

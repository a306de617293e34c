#pragma once

// Selection and placement of faces of STEP files, which form surfaces z(x, y) of a design.

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace retrace::geometry {

class PatchSurface;
struct StepSurface;

/// Selection and placement of faces in a STEP file.
struct StepChoice {
  std::filesystem::path file;  ///< relative to the working directory
  /// Name, colour (#rrggbb) or number of the face, "largest", or "towards +z" for all faces whose normals point
  /// upwards.
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
  std::shared_ptr<const StepSurface> surface = {};  ///< null until the file has been read (step_surface.h)
};

/// Returns the heights of a face, or null if its file has not been read.
std::shared_ptr<const PatchSurface> patches_of(const StepFace& face);

}  // namespace retrace::geometry

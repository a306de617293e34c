#pragma once

// Writes files for other programs: elements, parts and moulds as closed solids, and materials that reflect light in the
// same way as a part.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/part.h"
#include "retrace/design.h"
#include "retrace/running.h"

namespace retrace {

/// Kind of a face of a part, see CONVENTIONS.md.
enum class FaceKind { entrance, retro_facet, flat_back, inner_wall, border_wall, side };

/// A closed triangle mesh in the part's frame (CONVENTIONS.md), in mm.
struct Mesh {
  std::vector<std::array<double, 3>> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::vector<FaceKind> kinds;                          ///< one per triangle
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;
  bool is_manifold = true;  ///< true if the solid does not touch itself along an edge
  Warnings warnings;
};

/// Returns the mesh of a solid.
/// \throw InputError if the array is infinite, unless `request.what` is "element"; also if there are too many elements
RETRACE_API Mesh mesh(const Design& design, const SolidRequest& request = {});

struct ExportResult {
  Warnings warnings;
  std::string json;   ///< JSON document retrace.export/2
  std::string table;  ///< summary as text
};

/// Writes a solid as STL, OBJ, glTF or STEP. The extension of the file name selects the format.
/// \throw InputError for an unknown extension; also in the same cases as mesh()
/// \throw OutputError
RETRACE_API ExportResult export_solid(const Design& design, const std::filesystem::path& file,
                                      const SolidRequest& request = {});

struct MaterialResult {
  Warnings warnings;
  bool complete = true;  ///< false if the computation was cancelled; nothing is written then
  std::string json;      ///< JSON document retrace.export/2
  std::string table;     ///< summary as text
};

/// Computes how a part reflects light and writes the result as a material. The extension of the file name selects the
/// format: a table (.json, with its values in a .csv file in the same folder), a BSDF of Radiance (.xml) or lobes in a
/// shader (.glsl).
/// \throw InputError for other extensions, for settings out of range, and for designs that the exact engine cannot
/// trace
/// \throw OutputError
RETRACE_API MaterialResult export_material(const Design& design, const std::filesystem::path& file,
                                           const MaterialRequest& request = {}, const Running& running = {});

}  // namespace retrace

#pragma once

// Elements, parts and moulds as closed solids.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "retrace/design.h"

namespace retrace {

/// Which solid of a design.
struct SolidRequest {
  std::string what = "array";           ///< element, array, or mould: the block behind the part's back
  std::optional<double> block_mm = {};  ///< of a mould, below its deepest point; by default the plate's thickness
};

/// What a face of a part is.
enum class FaceKind { entrance, retro_facet, flat_back, inner_wall, border_wall, side };

/// A closed triangle mesh in the part's frame (CONVENTIONS.md), in mm.
struct Mesh {
  std::vector<std::array<double, 3>> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  std::vector<FaceKind> kinds;                          ///< one a triangle
  double volume_mm3 = 0.0;
  double area_mm2 = 0.0;
  bool is_manifold = true;  ///< it touches itself along no edge
  std::vector<std::string> warnings;
};

/// \throw InputError for an infinite array (an element of it is allowed), or too many elements
RETRACE_API Mesh mesh(const Design& design, const SolidRequest& request = {});

struct ExportResult {
  std::vector<std::string> warnings;
  std::string json;   ///< document retrace.export/1
  std::string table;  ///< for people
};

/// Writes it as STL, OBJ, glTF or STEP, by the ending of the file's name. \throw InputError likewise, OutputError
RETRACE_API ExportResult export_solid(const Design& design, const std::filesystem::path& file,
                                      const SolidRequest& request = {});

}  // namespace retrace

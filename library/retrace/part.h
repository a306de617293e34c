#pragma once

// Elements, parts and moulds as closed solids; a part's reflection as a material.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/running.h"

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
  Warnings warnings;
};

/// \throw InputError for an infinite array (an element of it is allowed), or too many elements
RETRACE_API Mesh mesh(const Design& design, const SolidRequest& request = {});

struct ExportResult {
  Warnings warnings;
  std::string json;   ///< document retrace.export/1
  std::string table;  ///< for people
};

/// Writes it as STL, OBJ, glTF or STEP, by the ending of the file's name. \throw InputError likewise, OutputError
RETRACE_API ExportResult export_solid(const Design& design, const std::filesystem::path& file,
                                      const SolidRequest& request = {});

/// A table of the light that a part sends back, or what is made of it (docs/theory/appearance.md).
struct MaterialRequest {
  double entrance_deg = 20.0;           ///< the largest entrance angle; 1 to 40
  double window_deg = 1.0;              ///< how far views lie from the source at most; 0.1 to 5
  double source_arcmin = 10.0;          ///< diameter of the source that values are means over
  double receiver_arcmin = 10.0;        ///< likewise of the receiver
  double error = 0.02;                  ///< relative, that is aimed at; 0.001 to 0.5
  std::uint64_t most_directions = 400;  ///< of light that are computed, at most; 64 to 10000
};

struct MaterialResult {
  Warnings warnings;
  bool complete = true;  ///< else it was cancelled, and nothing was written
  std::string json;      ///< document retrace.export/1
  std::string table;     ///< for people
};

/// Writes how a part sends light back as a material, by the ending of the file's name: a table (.json, with its values
/// in a .csv beside it), a BSDF of Radiance (.xml) or lobes in a shader (.glsl).
/// \throw InputError for other endings, numbers out of range and designs that the exact engine does not take,
/// OutputError
RETRACE_API MaterialResult export_material(const Design& design, const std::filesystem::path& file,
                                           const MaterialRequest& request = {}, const Running& running = {});

}  // namespace retrace

#pragma once

// Reads outlines of parts from DXF files.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/outline/outline.h"

namespace retrace::geometry {

inline constexpr std::size_t kMaxDxfBytes = 16U << 20;

/// Selection of the entities of a DXF file, and the unit of their coordinates.
struct DxfSelection {
  std::string layer;            ///< layer whose entities form the outline; empty: all layers
  std::optional<double> scale;  ///< length of one unit in mm; empty: from $INSUNITS of the file, or else 1
};

/// Reads the outline from an ASCII DXF file. The entities LINE, ARC, CIRCLE and LWPOLYLINE are joined to closed loops.
/// Ends of entities are joined if their distance is at most 1e-5 of the size of the outline.
/// \param name name of the file in error messages
/// \return the loops, in mm, in the order of their first entities
/// \throw InputError if the text is not an ASCII DXF file, if it contains other entities, or if the entities do not
///     form closed loops. The message names the line of the file.
std::vector<OutlineLoop> parse_dxf_outline(std::string_view text, const std::string& name,
                                           const DxfSelection& selection);

}  // namespace retrace::geometry

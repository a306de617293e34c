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
  std::optional<double> scale;  ///< length of a unit of the file in mm; empty: as in the file ($INSUNITS), or 1
};

/// Joins the entities LINE, ARC, CIRCLE and LWPOLYLINE of an ASCII DXF file to closed loops. Ends of entities are
/// joined if their distance is at most 1e-5 of the size of the outline. \param name name of the file for messages
/// \return the loops, in mm, in the order of their first entities
/// \throw InputError with the line of the file if it is not such a file, if it has other entities, or if entities do
/// not
///     form closed loops
std::vector<OutlineLoop> parse_dxf_outline(std::string_view text, const std::string& name,
                                           const DxfSelection& selection);

}  // namespace retrace::geometry

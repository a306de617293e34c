#pragma once

// Writes boundary meshes as binary glTF, for renderers and viewers.

#include <optional>
#include <string>
#include <string_view>

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// Largest file: its head tells the length in 32 bits.
inline constexpr std::size_t kMostGltfBytes = 0xffff'ffff;

/// The mesh as glTF 2.0 in one file (.glb): a node and a mesh named after each role of its faces (kFaceGroups), without
/// normals, so that facets are shaded flat. Vertices are in mm of the part frame, in single precision; a node above
/// them turns z, which the entrance face looks along, to glTF's y and makes metres of millimetres.
/// \param refractive_index the solid is clear (KHR_materials_transmission, _volume and _ior); none: it is of metal
/// \param absorption_per_mm of what is clear, Napierian, >= 0 \throw InputError if the file would be too long
std::string gltf_text(const BoundaryMesh& mesh, std::string_view title, std::optional<double> refractive_index,
                      double absorption_per_mm);

}  // namespace retrace::geometry

#pragma once

// Writes boundary meshes as binary glTF, for renderers and viewers.

#include <optional>
#include <string>
#include <string_view>

#include "geometry/part/closed_boundary.h"

namespace retrace::geometry {

/// Maximum size of a file in bytes. The header stores the size in 32 bits.
inline constexpr std::size_t kMaxGltfBytes = 0xffff'ffff;

/// Returns the mesh as glTF 2.0 in one file (.glb). There is a node and a mesh for each role of its faces, named by
/// kFaceGroups. Normals are not stored, so that facets are shaded flat. Vertices are in mm of the part frame, in single
/// precision. A parent node converts to metres. It also rotates the z axis, in whose direction the entrance face
/// points, to the y axis of glTF.
/// \param refractive_index index of a transparent solid (KHR_materials_transmission, _volume and _ior); not set: the
/// solid is made of metal
/// \param absorption_per_mm Napierian absorption of a transparent solid, >= 0
/// \throw InputError if the file would be too large
std::string gltf_text(const BoundaryMesh& mesh, std::string_view title, std::optional<double> refractive_index,
                      double absorption_per_mm);

}  // namespace retrace::geometry

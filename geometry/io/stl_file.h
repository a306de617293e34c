#pragma once

// Reads and writes triangle meshes as STL.

#include <cstddef>
#include <string>
#include <string_view>

#include "geometry/part/closed_boundary.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Most triangles that are read: 10 million, 500 MB of binary STL.
inline constexpr std::size_t kMostStlTriangles = 10'000'000;

/// The mesh as binary STL: millimetres in single precision, normals from the triangles. \param title goes into the
/// header, up to 80 bytes
std::string stl_text(const BoundaryMesh& mesh, std::string_view title);

/// Reads binary and ASCII STL, told apart by the length that a binary file's count of triangles asks for. Normals are
/// passed over: the order of the vertices says which side is out. Vertices with equal coordinates become one, triangles
/// of which two corners are one are dropped.
/// \param name stands for the file in messages
/// \throw InputError for text that is neither, coordinates that are no finite number below 1e6, no triangle, or more
/// than kMostStlTriangles
TriangleMesh parse_stl(std::string_view text, const std::string& name);

}  // namespace retrace::geometry

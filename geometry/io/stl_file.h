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

/// Reads binary and ASCII STL. A file whose length fits the number of triangles that a binary file gives is binary,
/// whatever its header begins with. Words of ASCII files may have capitals. Normals are passed over: the order of the
/// vertices says which side is out. Vertices with equal coordinates become one, triangles of which two corners are one
/// are dropped.
/// \param name stands for the file in messages
/// \param scale factor from the unit of the file to mm
/// \throw InputError for text that is neither, coordinates that are no finite number below 1e6 mm, no triangle, or more
/// than kMostStlTriangles. The message shows no text of a file that does not begin as STL does.
TriangleMesh parse_stl(std::string_view text, const std::string& name, double scale = 1.0);

}  // namespace retrace::geometry

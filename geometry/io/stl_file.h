#pragma once

// Reads and writes triangle meshes as STL.

#include <cstddef>
#include <filesystem>
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

/// Reads binary and ASCII STL. A file counts as binary if its length matches the number of triangles stored after its
/// header, whatever the header begins with. Keywords of ASCII files may be in upper or lower case. Normals are ignored:
/// the vertices of a triangle are counter-clockwise as seen from outside. Vertices with equal coordinates are merged,
/// and triangles with two equal corners are dropped. \param name name of the file, for messages \param scale factor
/// from the unit of the file to mm \throw InputError if the text is neither binary nor ASCII STL, if a coordinate is
/// not a finite number below 1e6 mm, or if there is no triangle or more than kMostStlTriangles. If the file does not
/// begin like an STL file, the message contains no text of the file.
TriangleMesh parse_stl(std::string_view text, const std::string& name, double scale = 1.0);

/// Reads an STL file as parse_stl() reads its text. If the number of triangles in the header of a binary file is above
/// kMostStlTriangles, or does not fit the length of the file, the file is refused before its triangles are read.
/// \throw InputError as parse_stl(), or if the file cannot be read
TriangleMesh read_stl(const std::filesystem::path& file, double scale = 1.0);

}  // namespace retrace::geometry

#pragma once

// Reads and writes triangle meshes as STL.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/part/closed_boundary.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Maximum number of triangles in a file: 10 million, 500 MB of binary STL.
inline constexpr std::size_t kMaxStlTriangles = 10'000'000;

/// Returns a mesh as binary STL. Coordinates are in mm in single precision. Normals are computed from the triangles.
/// \param title text for the header; at most 80 bytes are used
std::string stl_text(const BoundaryMesh& mesh, std::string_view title);

/// Reads binary and ASCII STL. A file is binary if its length matches the number of triangles that is stored after its
/// header, whatever the header contains. Keywords of ASCII files may be in upper or lower case.
/// The stored normals are ignored. The order of vertices defines the outside: it is counter-clockwise as seen from
/// outside. Vertices with equal coordinates are merged. Triangles with two equal vertices are removed.
/// \param name name of the file, for messages
/// \param scale factor from the unit of the file to mm
/// \param trailing_bytes receives the number of bytes after the last triangle of a binary file. If it is null, a file
///     with such bytes is refused.
/// \throw InputError if the text is not STL, if a coordinate is not a finite number below 1e6 mm, or if there are no
///        triangles or more than kMaxStlTriangles. The message quotes the file only if it begins like an STL file.
TriangleMesh parse_stl(std::string_view text, const std::string& name, double scale = 1.0,
                       std::size_t* trailing_bytes = nullptr);

/// Reads an STL file as parse_stl() does. A binary file may be refused before its triangles are read. This happens if
/// the stored number of triangles is above kMaxStlTriangles or does not match the length of the file.
/// \throw InputError in the same cases as parse_stl(), and if the file cannot be read
TriangleMesh read_stl(const std::filesystem::path& file, double scale = 1.0, std::size_t* trailing_bytes = nullptr);

}  // namespace retrace::geometry

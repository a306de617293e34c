#pragma once

// Reads triangle meshes from STL or OBJ files, and merges vertices that are near each other.

#include <cstddef>
#include <filesystem>

#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Mesh that was read from a file.
struct MeshOfFile {
  TriangleMesh mesh;
  std::size_t trailing_bytes = 0;  ///< number of bytes after the last triangle of a binary STL file
};

/// Reads an OBJ file if the name ends in .obj, otherwise an STL file. Vertices with equal coordinates are merged.
/// \param scale factor from the unit of the file to mm
/// \throw InputError if the file cannot be read or has another format
MeshOfFile read_mesh_file(const std::filesystem::path& file, double scale);

/// Returns a mesh in which vertices are merged if their distance is at most `tolerance_mm`. Triangles with two merged
/// corners are removed. A chain of vertices is merged to its first vertex.
TriangleMesh welded(const TriangleMesh& mesh, double tolerance_mm);

}  // namespace retrace::geometry

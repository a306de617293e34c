#pragma once

// Reads and writes triangle meshes as Wavefront OBJ.

#include <string>
#include <string_view>

#include "geometry/part/closed_boundary.h"
#include "geometry/part/triangle_mesh.h"

namespace retrace::geometry {

/// Returns the mesh as Wavefront OBJ in mm and double precision, with one group for each role of its faces.
/// \param title one line of text for a comment
std::string obj_text(const BoundaryMesh& mesh, std::string_view title);

/// Reads the vertices and faces of Wavefront OBJ. Faces with more than three corners are divided into triangles.
/// Groups, materials, normals and texture coordinates are ignored. Vertices are not merged. \param name name of the
/// file, for messages \param scale factor from the unit of the file to mm \throw InputError with the line, if the text
/// is not OBJ, contains free-form surfaces, refers to missing vertices, has
///     a coordinate that is not a finite number below 1e6 mm, or has no faces or more than kMaxStlTriangles triangles
TriangleMesh parse_obj(std::string_view text, const std::string& name, double scale = 1.0);

}  // namespace retrace::geometry

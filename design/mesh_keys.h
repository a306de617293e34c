#pragma once

// Keys of [part] that describe the file of a mesh or a solid, and its position.

#include <array>
#include <string_view>

#include "design/design.h"

namespace retrace::design {

/// Description of the file from which a part is read.
struct MeshKeys {
  bool is_solid = false;                  ///< true: a STEP file with a solid; false: a triangle mesh
  double scale = 1.0;                     ///< factor from the unit of a mesh to mm
  std::array<double, 3> rotate_deg = {};  ///< rotations about x, then y, then z
  bool faces_down = false;                ///< true: after these rotations, the entrance face points towards -z
  double weld_mm = 0.0;                   ///< maximum distance of vertices of a mesh that are merged
  double chord_mm = 0.001;                ///< maximum distance between curved faces of a solid and their triangles
};

/// \pre the part of the design is a mesh or a solid
MeshKeys mesh_keys_of(const Design& design);

/// Returns the key that names the file: "part.mesh" or "part.solid".
/// \pre the part of the design is a mesh or a solid
std::string_view mesh_file_key(const Design& design);

}  // namespace retrace::design

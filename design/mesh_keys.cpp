#include "design/mesh_keys.h"

#include <vector>

namespace retrace::design {

MeshKeys mesh_keys_of(const Design& design) {
  MeshKeys keys;
  if (!design.document) return keys;
  const schema::Document& document = *design.document;
  keys.is_solid = document.has("part.solid");
  keys.scale = document.number_if("part.scale").value_or(keys.scale);
  keys.weld_mm = document.number_if("part.weld_mm").value_or(keys.weld_mm);
  keys.chord_mm = document.number_if("part.chord_mm").value_or(keys.chord_mm);
  keys.faces_down = document.has("part.facing") && document.text("part.facing") == "down";
  if (document.has("part.rotate_deg")) {
    const std::vector<double> given = document.numbers("part.rotate_deg");
    keys.rotate_deg = {given[0], given[1], given[2]};
  }
  return keys;
}

std::string_view mesh_file_key(const Design& design) {
  return mesh_keys_of(design).is_solid ? "part.solid" : "part.mesh";
}

}  // namespace retrace::design

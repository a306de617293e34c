#include "design/io/step_choice_reader.h"

#include <string>
#include <vector>

#include "core/schema/schema.h"

namespace retrace::design {

geometry::StepFace read_step_face(const schema::Document& document, std::string_view table) {
  const auto key = [&](std::string_view name) { return schema::path_in(table, name); };
  const auto triple = [&](std::string_view name) {
    const std::vector<double> given = document.numbers(key(name));
    return std::array{given[0], given[1], given[2]};
  };
  geometry::StepFace face;
  face.name = document.text(key("file"));
  face.choice.file = document.file(key("file"));
  face.choice.face = document.text(key("face"));
  face.choice.sew_mm = document.number(key("sew_mm"));
  if (document.has(key("origin_mm"))) face.choice.origin_mm = triple("origin_mm");
  face.choice.rotation_deg = triple("rotation_deg");
  return face;
}

}  // namespace retrace::design

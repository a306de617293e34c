#include "design/step_faces.h"

#include <string_view>

#include "core/named_file.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/io/step_reader.h"

namespace retrace::design {
namespace {

void read_face(const Design& design, geometry::StepFace& face, std::string_view key) {
  face.surface = read_named(design.where(key), [&] { return geometry::read_step_surface(face.choice); });
}

}  // namespace

void read_step_faces(Design& design) {
  EntranceForm* const form = design.entrance ? std::get_if<EntranceForm>(&design.entrance->surface) : nullptr;
  if (form != nullptr)
    if (auto* const face = std::get_if<geometry::StepFace>(&form->shape))
      read_face(design, *face, "entrance_surface.file");
  if (!design.elements() || !design.part().substrate) return;
  auto* const face = std::get_if<geometry::StepFace>(&design.part().substrate->shape);
  if (face == nullptr) return;
  read_face(design, *face, "substrate.file");
  read_named(design.where("substrate.file"), [&] { return geometry::check_substrate(design.part()); });
}

}  // namespace retrace::design

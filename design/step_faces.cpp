#include "design/step_faces.h"

#include <fmt/format.h>

#include <string_view>

#include "core/named_file.h"
#include "core/number_format.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/io/step_reader.h"
#include "geometry/outline/plan_region.h"
#include "geometry/surface/step_surface.h"

namespace retrace::design {
namespace {

void read_face(const Design& design, geometry::StepFace& face, std::string_view key) {
  face.surface = read_named(design.where(key), [&] { return geometry::read_step_surface(face.choice); });
}

/// Checks that the face of a substrate covers the array.
void check_cover(const geometry::StepFace& face, const geometry::ArrayLayout& array) {
  const geometry::Vec2 half_mm = 0.5 * geometry::Vec2(array.x_length_mm, array.y_length_mm);
  const geometry::Polygon outline =
      array.outline ? array.outline->hull : geometry::to_polygon({geometry::Vec2::Zero(), 2.0 * half_mm});
  for (const geometry::Vec2& corner : outline) require_cover(face, corner - half_mm, corner);
}

}  // namespace

void require_cover(const geometry::StepFace& face, const geometry::Vec2& at_mm, const geometry::Vec2& point_mm) {
  const geometry::Vec2& size_mm = face.surface->size_mm;
  if (face.surface->patches.covers(at_mm, geometry::step_margin_mm(size_mm))) return;
  throw InputError(
      {face.choice.file.string(), 0, ""},
      fmt::format("must have faces that cover the whole part, but they do not cover x = {}, y = {} mm of "
                  "the part: they are {} x {} mm large",
                  fixed(point_mm.x(), 4), fixed(point_mm.y(), 4), fixed(size_mm.x(), 4), fixed(size_mm.y(), 4)));
}

void read_step_faces(Design& design) {
  EntranceForm* const form = design.entrance ? std::get_if<EntranceForm>(&design.entrance->surface) : nullptr;
  if (form != nullptr)
    if (auto* const face = std::get_if<geometry::StepFace>(&form->shape))
      read_face(design, *face, "entrance_surface.file");
  if (!design.elements() || !design.part().substrate) return;
  auto* const face = std::get_if<geometry::StepFace>(&design.part().substrate->shape);
  if (face == nullptr) return;
  read_face(design, *face, "substrate.file");
  read_named(design.where("substrate.file"), [&] {
    check_cover(*face, design.part().array);
    return geometry::check_substrate(design.part());
  });
}

}  // namespace retrace::design

#include "design/entrance_of_design.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include "core/named_file.h"
#include "core/number_format.h"
#include "design/entrance_file.h"
#include "design/entrance_form.h"
#include "design/step_faces.h"
#include "geometry/elements/substrate_checks.h"

namespace retrace::design {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Checks that a face of a STEP file covers a part.
void check_cover(const geometry::StepFace& face, const geometry::EntranceSurface& surface,
                 const geometry::Polygon& outline) {
  constexpr int kPointsOfEdge = 64;
  for (std::size_t k = 0; k < outline.size(); ++k)
    for (int i = 0; i < kPointsOfEdge; ++i) {
      const double fraction = static_cast<double>(i) / kPointsOfEdge;
      const Vec2 p = outline[k] + fraction * (outline[(k + 1) % outline.size()] - outline[k]);
      require_cover(face, surface.surface_position(p).value_or(Vec2::Constant(NAN)), p);
    }
}

geometry::Entrance formed_entrance(const EntranceForm& form, const geometry::Part& part, const Vec3& origin_mm) {
  auto surface = surface_of(form, origin_mm);
  geometry::check_folds(*surface, part.outline);
  if (const auto* const face = std::get_if<geometry::StepFace>(&form.shape)) check_cover(*face, *surface, part.outline);
  return surface;
}

/// Returns the height of the entrance face's origin. Usually, it is the thickness of the part. For a substrate below
/// the entrance face, the height is chosen such that the lowest point of the substrate is at z = 0.
double origin_height_mm(const geometry::Part& part) {
  const std::optional<geometry::Substrate>& substrate = part.spec.substrate;
  if (!substrate || !std::holds_alternative<geometry::OffsetSubstrate>(substrate->shape)) return part.thickness_mm;
  const Vec2 half_mm = 0.5 * Vec2(part.spec.array.x_length_mm, part.spec.array.y_length_mm);
  return -geometry::measure_substrate(geometry::substrate_surface_of(part.spec), half_mm).lowest_mm;
}

Vec3 origin_of(const CurvedEntrance& entrance, const geometry::Part& part) {
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  Vec2 centre = 0.5 * (box.lower + box.upper);
  if (entrance.centre_mm) centre = {(*entrance.centre_mm)[0], (*entrance.centre_mm)[1]};
  return {centre.x(), centre.y(), origin_height_mm(part)};
}

geometry::Entrance placed_entrance(const Design& design, const geometry::Part& part) {
  const CurvedEntrance& entrance = *design.entrance;
  const Vec3 origin_mm = origin_of(entrance, part);
  if (entrance.form() != nullptr) return formed_entrance(*entrance.form(), part, origin_mm);
  return entrance_of_file(design, part, origin_mm);
}

/// Checks that the entrance face is above the back of the part. An exact surface must be above the back at each point.
/// A mesh must be above the highest point of the back.
/// \throw InputError if the face is not above the back
void require_room(const geometry::Entrance& entrance, const geometry::Part& part) {
  const geometry::EntranceRange range = geometry::entrance_range(entrance, part.outline);
  if (range.lowest_mm > part.top_mm) return;
  const auto* const surface = std::get_if<std::shared_ptr<const geometry::EntranceSurface>>(&entrance);
  if (surface == nullptr)
    throw InputError(
        fmt::format("must be above the back of the part, whose highest point is at z = {} mm, but its lowest point is "
                    "at z = {} mm (x = {}, y = {} mm): increase body.thickness_mm",
                    fixed(part.top_mm, 4), fixed(range.lowest_mm, 4), fixed(range.lowest_at_mm.x(), 4),
                    fixed(range.lowest_at_mm.y(), 4)));
  const std::optional<geometry::EntranceContact> contact = geometry::find_contact(**surface, part);
  if (contact)
    throw InputError(
        fmt::format("must be above the back of the part, but at x = {}, y = {} mm it is at z = {} mm and the back is "
                    "at z = {} mm: increase body.thickness_mm",
                    fixed(contact->position_mm.x(), 4), fixed(contact->position_mm.y(), 4),
                    fixed(contact->entrance_mm, 4), fixed(contact->back_mm, 4)));
}

/// Calls require_room(). Adds the file name `name` to the error message unless it is empty.
void check_room(const geometry::Entrance& entrance, const geometry::Part& part, const std::string& name) {
  try {
    require_room(entrance, part);
  } catch (const InputError& error) {
    throw InputError({name, 0, ""}, error.what());
  }
}

}  // namespace

geometry::Entrance entrance_of_design(const Design& design, const geometry::Part& part) {
  const EntranceFile* const file = design.entrance->file();
  return read_named(design.where(design.entrance_key()), [&] {
    const geometry::Entrance entrance = placed_entrance(design, part);
    check_room(entrance, part, file != nullptr ? file->file.string() : std::string());
    return entrance;
  });
}

std::optional<geometry::FaceSurface> closed_form_of_entrance(const Design& design, const geometry::Part& part) {
  const EntranceForm* const form = design.entrance->form();
  if (form == nullptr) return std::nullopt;
  return closed_form_of(*form, origin_of(*design.entrance, part));
}

}  // namespace retrace::design

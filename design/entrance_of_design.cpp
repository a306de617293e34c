#include "design/entrance_of_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/atomic_file.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "design/entrance_form.h"
#include "design/file_names.h"
#include "geometry/elements/substrate_checks.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/io/stl_file.h"
#include "geometry/io/surface_tables.h"

namespace retrace::design {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Returns points on the edges of the outline, including its corners, in the frame of the file.
std::vector<Vec2> border_points(const geometry::Polygon& outline, const Vec2& origin_mm) {
  constexpr int kPointsOfEdge = 64;
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < outline.size(); ++k)
    for (int i = 0; i < kPointsOfEdge; ++i)
      points.push_back(outline[k] +
                       (static_cast<double>(i) / kPointsOfEdge) * (outline[(k + 1) % outline.size()] - outline[k]) -
                       origin_mm);
  return points;
}

/// Checks that the turned surface covers the whole part, without extrapolation of the design surface.
void check_region(const geometry::TurnedEntrance& front, const std::vector<Vec2>& border) {
  constexpr double kRoom = 1.0 + 1e-9;
  const auto is_turned = [&](const Vec2& p) {
    if (front.is_round) return p.norm() <= kRoom * front.radius_mm;
    return (2.0 * p.cwiseAbs().array() <= kRoom * front.size_mm.array()).all();
  };
  const auto place = [](const Vec2& p) {
    return fmt::format("the point x = {}, y = {} mm of its frame is outside", fixed(p.x(), 4), fixed(p.y(), 4));
  };
  for (const Vec2& p : border) {
    if (!is_turned(p))
      throw InputError(fmt::format(
          "must be turned over the whole part, but its path {}: {}",
          front.is_round ? fmt::format("has a radius of {} mm", shortest(front.radius_mm))
                         : fmt::format("covers {} x {} mm", shortest(front.size_mm.x()), shortest(front.size_mm.y())),
          place(p)));
    const auto& beyond = front.surface.extrapolation();
    if (beyond && !beyond->boundary.contains(p.x() / kRoom, p.y() / kRoom))
      throw InputError("must have a boundary that encloses the whole part: " + place(p));
  }
}

geometry::Entrance turned_entrance(const EntranceFile& file, const geometry::Part& part, const Vec3& origin_mm) {
  const std::string name = file.file.string();
  geometry::TurnedEntrance front = geometry::parse_turned_entrance(read_file(file.file), name);
  try {
    check_region(front, border_points(part.outline, origin_mm.head<2>()));
  } catch (const InputError& error) {
    throw InputError({name, 0, ""}, error.what());
  }
  return std::make_shared<const geometry::EntranceSurface>(std::move(front.surface), origin_mm);
}

geometry::Entrance mesh_entrance(const EntranceFile& file, double scale, const geometry::Part& part,
                                 const Vec3& origin_mm) {
  const std::string name = file.file.string();
  const geometry::TriangleMesh mesh = geometry::read_stl(file.file, scale);
  return read_named({name, 0, ""}, [&] {
    return std::make_shared<const geometry::SurfacePatch>(geometry::entrance_of_mesh(
        mesh, file.mesh_bottom ? geometry::MeshSide::bottom : geometry::MeshSide::top, origin_mm, part.outline));
  });
}

geometry::Entrance formed_entrance(const EntranceForm& form, const geometry::Part& part, const Vec3& origin_mm) {
  auto surface = surface_of(form, origin_mm);
  geometry::check_folds(*surface, part.outline);
  return surface;
}

/// Returns the height of the origin of the entrance face. If the elements are placed below the face, z = 0 is the
/// highest point of the surface at the distance of the wall below the face.
double origin_height_mm(const geometry::Part& part) {
  const std::optional<geometry::Substrate>& substrate = part.spec.substrate;
  if (!substrate || !std::holds_alternative<geometry::OffsetSubstrate>(substrate->shape)) return part.thickness_mm;
  const Vec2 half_mm = 0.5 * Vec2(part.spec.array.x_length_mm, part.spec.array.y_length_mm);
  return -geometry::measure_substrate(geometry::substrate_surface_of(part.spec), half_mm).highest_mm;
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
  const EntranceFile& file = *entrance.file();
  return file.is_mesh ? mesh_entrance(file, mesh_scale(design, "entrance_surface"), part, origin_mm)
                      : turned_entrance(file, part, origin_mm);
}

/// Checks that the entrance face is above the back: above the highest point of the back or, for exact surfaces, above
/// the back at each point of the part.
/// \throw InputError if it is not
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

/// Calls require_room(), and adds the name of the file to its error message unless the name is empty.
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

}  // namespace retrace::design

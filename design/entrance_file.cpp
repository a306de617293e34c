#include "design/entrance_file.h"

#include <fmt/format.h>

#include <utility>

#include "core/atomic_file.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "design/file_names.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/io/stl_file.h"
#include "geometry/io/surface_tables.h"

namespace retrace::design {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Returns points on the edges of the outline, including its corners. The coordinates are those of the file that
/// contains the entrance face.
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

/// Checks that the turned region of the surface covers the whole part. Outside of this region, the surface would have
/// to be extrapolated.
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

}  // namespace

geometry::Entrance entrance_of_file(const Design& design, const geometry::Part& part, const geometry::Vec3& origin_mm) {
  const EntranceFile& file = *design.entrance->file();
  return file.is_mesh ? mesh_entrance(file, mesh_scale(design, "entrance_surface"), part, origin_mm)
                      : turned_entrance(file, part, origin_mm);
}

}  // namespace retrace::design

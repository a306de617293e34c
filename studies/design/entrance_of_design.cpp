#include "studies/design/entrance_of_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/atomic_file.h"
#include "core/number_format.h"
#include "fabrication/turning/io/part_files.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/io/stl_file.h"

namespace retrace::studies {
namespace {

namespace turning = fabrication::turning;
using geometry::Vec2;
using geometry::Vec3;

/// The design surface of a turned part, moved into the frame of an optical part.
class TurnedEntrance : public geometry::EntranceSurface {
 public:
  TurnedEntrance(turning::TurnedSurface surface, const Vec3& origin_mm)
      : surface_(std::move(surface)), origin_mm_(origin_mm) {
    for (const turning::Lenslet& lenslet : surface_.lenslets())
      finest_mm_ = std::min(finest_mm_, lenslet.outer.least_mm);
  }

  Place at(const Vec2& p) const override {
    const Vec2 place = p - origin_mm_.head<2>();
    const turning::Gradient z = surface_.gradient(place.x(), place.y());
    if (std::isfinite(z.x) && std::isfinite(z.y)) return {origin_mm_.z() + z.value, {z.x, z.y}};
    return {origin_mm_.z() + surface_.height_mm(place.x(), place.y()), slope_across(place)};
  }
  double finest_mm() const override { return finest_mm_; }

 private:
  /// A formula of r has no slope at the very centre, though its surface may be smooth there: from both sides.
  Vec2 slope_across(const Vec2& p) const {
    constexpr double kStep = 1e-5;
    return Vec2(surface_.height_mm(p.x() + kStep, p.y()) - surface_.height_mm(p.x() - kStep, p.y()),
                surface_.height_mm(p.x(), p.y() + kStep) - surface_.height_mm(p.x(), p.y() - kStep)) /
           (2.0 * kStep);
  }

  turning::TurnedSurface surface_;
  Vec3 origin_mm_;
  double finest_mm_ = std::numeric_limits<double>::infinity();
};

/// Corners of the outline and points of its edges, in the frame of the file.
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

/// What of the part lies beyond what is turned, or where the design's surface is only extrapolated.
void check_region(const turning::TurnedPart& part, const std::vector<Vec2>& border) {
  constexpr double kRoom = 1.0 + 1e-9;
  const turning::PathOptions& path = part.path;
  const bool is_round = path.strategy == turning::Strategy::spiral;
  const auto is_turned = [&](const Vec2& p) {
    if (is_round) return p.norm() <= kRoom * path.radius_mm;
    return 2.0 * std::abs(p.x()) <= kRoom * path.height_mm && 2.0 * std::abs(p.y()) <= kRoom * path.width_mm;
  };
  const auto place = [](const Vec2& p) {
    return fmt::format("x = {}, y = {} mm of its frame lies outside", fixed(p.x(), 4), fixed(p.y(), 4));
  };
  for (const Vec2& p : border) {
    if (!is_turned(p))
      throw InputError(
          fmt::format("must be turned all over the part, its path {}, {}",
                      is_round ? fmt::format("has a radius of {} mm", shortest(path.radius_mm))
                               : fmt::format("covers {} x {} mm", shortest(path.height_mm), shortest(path.width_mm)),
                      place(p)));
    const auto& beyond = part.surface.extrapolation();
    if (beyond && !beyond->boundary.contains(p.x() / kRoom, p.y() / kRoom))
      throw InputError("must have a boundary round the whole part, " + place(p));
  }
}

geometry::Entrance turned_entrance(const Design& design, const geometry::Part& part, const Vec3& origin_mm,
                                   std::vector<std::string>* warnings) {
  const std::string name = design.entrance->file.string();
  turning::TurnedPart turned = turning::parse_turned_part(read_file(design.entrance->file), name);
  try {
    check_region(turned, border_points(part.outline, origin_mm.head<2>()));
  } catch (const InputError& error) {
    throw InputError({name, 0, ""}, error.what());
  }
  if (warnings != nullptr)
    for (const std::string& warning : turned.warnings)
      warnings->push_back(fmt::format("{}: {}: {}", design.source_name(), name, warning));
  return std::make_shared<const TurnedEntrance>(std::move(turned.surface), origin_mm);
}

geometry::Entrance mesh_entrance(const EntranceFile& file, const geometry::Part& part, const Vec3& origin_mm) {
  const std::string name = file.file.string();
  const geometry::TriangleMesh mesh = geometry::parse_stl(read_file(file.file, kMostDataBytes), name);
  try {
    return std::make_shared<const geometry::SurfacePatch>(geometry::entrance_of_mesh(
        mesh, file.mesh_bottom ? geometry::MeshSide::bottom : geometry::MeshSide::top, origin_mm, part.outline));
  } catch (const InputError& error) {
    throw InputError({name, 0, ""}, error.what());
  }
}

Vec3 origin_of(const EntranceFile& file, const geometry::Part& part) {
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  Vec2 centre = 0.5 * (box.lower + box.upper);
  if (file.centre_mm) centre = {(*file.centre_mm)[0], (*file.centre_mm)[1]};
  return {centre.x(), centre.y(), part.thickness_mm};
}

/// \throw InputError unless it lies above the highest place of the back
void check_room(const geometry::Entrance& entrance, const geometry::Part& part, const std::string& name) {
  try {
    const geometry::EntranceRange range = geometry::entrance_range(entrance, part.outline);
    if (range.lowest_mm > part.top_mm) return;
    throw InputError(
        fmt::format("must lie above the part's back, whose highest place is z = {}, it comes down to {} mm at x = {}, "
                    "y = {} mm: give "
                    "more body.thickness_mm",
                    fixed(part.top_mm, 4), fixed(range.lowest_mm, 4), fixed(range.lowest_at_mm.x(), 4),
                    fixed(range.lowest_at_mm.y(), 4)));
  } catch (const InputError& error) {
    throw InputError({name, 0, ""}, error.what());
  }
}

}  // namespace

geometry::Entrance entrance_of_design(const Design& design, const geometry::Part& part,
                                      std::vector<std::string>* warnings) {
  const EntranceFile& file = *design.entrance;
  try {
    const Vec3 origin_mm = origin_of(file, part);
    const geometry::Entrance entrance =
        file.is_mesh ? mesh_entrance(file, part, origin_mm) : turned_entrance(design, part, origin_mm, warnings);
    check_room(entrance, part, file.file.string());
    return entrance;
  } catch (const InputError& error) {
    throw InputError(design.where(design.entrance_key()), error.what());  // which does not know who named the file
  }
}

}  // namespace retrace::studies

#include "geometry/part/element_excerpt.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace retrace::geometry {
namespace {

// Maximum distance between two corners of an element that are regarded as one point, as a fraction of the element's
// size.
constexpr double kSameCorner = 1e-9;
// Minimum distance between facets of an excerpt and its entrance face, as a fraction of the element's size.
constexpr double kMinFacetRoom = 1e-6;
// Distance between the outline of an excerpt and all its facets, as a fraction of the element's size.
constexpr double kExcerptMargin = 0.25;
// Sides of the original part are moved outwards by this distance, as a fraction of the element's size. Walls of cut
// elements are in the planes of the sides. Because of the displacement, light meets these walls before it meets the
// sides.
constexpr double kBehindCells = 1e-9;

Vec3 shift_of(const Placement& placement) {
  return {placement.offset_mm.x(), placement.offset_mm.y(), placement.height_mm};
}

Vec3 corner_of(const SurfacePatch& patch, const PatchFacet& facet, std::uint32_t k) {
  return patch.vertices[patch.corners[facet.first_corner + k]];
}

/// Corner of an element and the number of retro facets that share this corner.
struct CountedCorner {
  Vec3 at_mm;
  int facets = 0;
};

void count_corner(std::vector<CountedCorner>& corners, const Vec3& at_mm, double same_mm, bool is_retro) {
  for (CountedCorner& known : corners)
    if ((known.at_mm - at_mm).norm() <= same_mm) {
      known.facets += is_retro ? 1 : 0;
      return;
    }
  corners.push_back({at_mm, is_retro ? 1 : 0});
}

/// Sets apex, corners and bounding box of an element from its facets. Returns false if it has no retro facet.
bool find_points(const Part& part, PartElement& element) {
  const Placement& placement = part.placements[element.placement];
  const SurfacePatch& patch = part.patches[placement.patch];
  std::vector<CountedCorner> corners;
  for (const std::uint32_t c : element.cells)
    for (std::uint32_t f = 0; f < patch.cells[c].facet_count; ++f) {
      const PatchFacet& facet = patch.facets[patch.cells[c].first_facet + f];
      for (std::uint32_t k = 0; k < facet.corner_count; ++k)
        count_corner(corners, corner_of(patch, facet, k) + shift_of(placement), kSameCorner * part.size_mm,
                     facet.role == FacetRole::retro_facet);
    }
  int most = 0;
  for (const CountedCorner& c : corners) most = std::max(most, c.facets);
  if (most == 0) return false;
  double count = 0.0;
  element.lower_mm.setConstant(INFINITY);
  element.upper_mm.setConstant(-INFINITY);
  for (const CountedCorner& c : corners) {
    element.corners_mm.push_back(c.at_mm);
    element.lower_mm = element.lower_mm.cwiseMin(c.at_mm);
    element.upper_mm = element.upper_mm.cwiseMax(c.at_mm);
    if (c.facets != most) continue;
    element.apex_mm += c.at_mm;
    count += 1.0;
  }
  element.apex_mm /= count;
  return true;
}

/// Collects facets in the frame of an excerpt.
class ExcerptBuilder {
 public:
  ExcerptBuilder(const Part& part, const Eigen::Isometry3d& frame_from_part, double thickness_mm)
      : part_(part), frame_from_part_(frame_from_part), thickness_mm_(thickness_mm) {}

  /// Adds the cells of an element, or a single cell that belongs to no element. Adds nothing if one of their facets
  /// reaches the entrance face.
  void add(const Placement& placement, const std::vector<std::uint32_t>& cells, ExcerptCell kind) {
    const SurfacePatch& patch = part_.patches[placement.patch];
    const Vec3 shift = shift_of(placement);
    for (const std::uint32_t c : cells)
      for (std::uint32_t f = 0; f < patch.cells[c].facet_count; ++f) {
        const PatchFacet& facet = patch.facets[patch.cells[c].first_facet + f];
        for (std::uint32_t k = 0; k < facet.corner_count; ++k)
          if ((frame_from_part_ * (corner_of(patch, facet, k) + shift)).z() >
              thickness_mm_ - kMinFacetRoom * part_.size_mm)
            return;
      }
    const auto first = static_cast<std::uint32_t>(own().cells.size());
    for (const std::uint32_t c : cells) {
      begin_cell(first, kind);
      for (std::uint32_t f = 0; f < patch.cells[c].facet_count; ++f)
        add_facet(patch, patch.facets[patch.cells[c].first_facet + f], shift);
      end_cell();
    }
  }

  /// Adds a rectangular face that belongs to a side of the original part.
  /// \param corners_mm corners in the part frame, counter-clockwise as seen from outside
  void add_side(const std::vector<Vec3>& corners_mm, const Vec3& normal, FacetRole role) {
    begin_cell(static_cast<std::uint32_t>(own().cells.size()), ExcerptCell::side);
    std::vector<Vec3> moved;
    for (const Vec3& p : corners_mm) moved.push_back(frame_from_part_ * p);
    push_facet(moved, frame_from_part_.linear() * normal, moved.front(), role);
    end_cell();
  }

  ElementExcerpt finish() {
    Part& made = excerpt_.part;
    made.thickness_mm = thickness_mm_;
    made.size_mm = part_.size_mm;
    Vec3 lower = Vec3::Constant(INFINITY);
    Vec3 upper = Vec3::Constant(-INFINITY);
    for (const Vec3& p : own().vertices) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    const Vec2 margin = Vec2::Constant(kExcerptMargin * part_.size_mm);
    made.outline = to_polygon({lower.head<2>() - margin, upper.head<2>() + margin});
    made.element_depth_mm = -lower.z();
    made.top_mm = std::min(thickness_mm_, upper.z());
    made.entrance_area_mm2 = area(made.outline);
    made.elements_full = 1;
    made.placements.push_back({0, Vec2::Zero(), 0.0});
    return std::move(excerpt_);
  }

 private:
  SurfacePatch& own() {
    if (excerpt_.part.patches.empty()) excerpt_.part.patches.emplace_back();
    return excerpt_.part.patches.front();
  }

  void begin_cell(std::uint32_t first_of_element, ExcerptCell kind) {
    PatchCell cell;
    cell.first_facet = static_cast<std::uint32_t>(own().facets.size());
    cell.lower.setConstant(INFINITY);
    cell.upper.setConstant(-INFINITY);
    cell.first_of_element = first_of_element;
    own().cells.push_back(cell);
    excerpt_.cells.push_back(kind);
  }
  void end_cell() {
    PatchCell& cell = own().cells.back();
    cell.facet_count = static_cast<std::uint32_t>(own().facets.size()) - cell.first_facet;
  }

  void add_facet(const SurfacePatch& patch, const PatchFacet& facet, const Vec3& shift) {
    std::vector<Vec3> moved;
    for (std::uint32_t k = 0; k < facet.corner_count; ++k)
      moved.push_back(frame_from_part_ * (corner_of(patch, facet, k) + shift));
    const Vec3 on_plane = frame_from_part_ * (facet.offset_mm * facet.normal + shift);
    push_facet(moved, frame_from_part_.linear() * facet.normal, on_plane, facet.role);
    if (!facet.centroid_mm || !(std::abs(facet.normal.z()) > 0.0)) return;
    const Vec2& plan = *facet.centroid_mm;
    const Vec3 at(plan.x(), plan.y(), (facet.offset_mm - facet.normal.head<2>().dot(plan)) / facet.normal.z());
    own().facets.back().centroid_mm = (frame_from_part_ * (at + shift)).head<2>();
  }

  void push_facet(const std::vector<Vec3>& corners, const Vec3& normal, const Vec3& on_plane, FacetRole role) {
    SurfacePatch& patch = own();
    PatchFacet made;
    made.normal = normal;
    made.offset_mm = normal.dot(on_plane);
    made.role = role;
    made.first_corner = static_cast<std::uint32_t>(patch.corners.size());
    made.corner_count = static_cast<std::uint32_t>(corners.size());
    PatchCell& cell = patch.cells.back();
    for (const Vec3& p : corners) {
      patch.corners.push_back(static_cast<std::uint32_t>(patch.vertices.size()));
      patch.vertices.push_back(p);
      cell.lower = cell.lower.cwiseMin(p);
      cell.upper = cell.upper.cwiseMax(p);
    }
    patch.facets.push_back(made);
  }

  const Part& part_;
  const Eigen::Isometry3d& frame_from_part_;
  double thickness_mm_;
  ElementExcerpt excerpt_;
};

/// Returns the range of a segment from `a` to `b` that is within a rectangle, as two fractions of the segment's length.
/// The range is empty if the first fraction is not below the second one.
std::pair<double, double> range_within(const Vec2& a, const Vec2& b, const Rectangle& box) {
  double from = 0.0;
  double to = 1.0;
  const Vec2 along = b - a;
  for (const Eigen::Index axis : {0, 1}) {
    if (along[axis] == 0.0) {
      if (a[axis] < box.lower[axis] || a[axis] > box.upper[axis]) return {0.0, 0.0};
      continue;
    }
    const double first = (box.lower[axis] - a[axis]) / along[axis];
    const double last = (box.upper[axis] - a[axis]) / along[axis];
    from = std::max(from, std::min(first, last));
    to = std::min(to, std::max(first, last));
  }
  return {from, to};
}

/// Adds the sides of the original part that are within a rectangle. A side is a vertical wall that extends from below
/// the back up to the entrance face. The portion of a side below z = 0 is a border wall.
void add_sides(const Part& part, const Rectangle& box, const Eigen::Isometry3d& frame_from_part, double thickness_mm,
               ExcerptBuilder& builder) {
  const Vec3 up = frame_from_part.linear() * Vec3::UnitZ();
  const auto top_at = [&](const Vec2& p) {
    const Vec3 at = frame_from_part * Vec3(p.x(), p.y(), 0.0);
    return (thickness_mm - at.z()) / up.z();
  };
  const double bottom_mm = -1.01 * part.element_depth_mm;
  for (std::size_t k = 0; k < part.outline.size(); ++k) {
    const Vec2& a = part.outline[k];
    const Vec2& b = part.outline[(k + 1) % part.outline.size()];
    const auto [from, to] = range_within(a, b, box);
    if (!(from < to)) continue;
    const Vec2 p = a + from * (b - a);
    const Vec2 q = a + to * (b - a);
    const Vec2 along = (b - a).normalized();
    const Vec3 normal(along.y(), -along.x(), 0.0);
    const auto wall = [&](double low, double high_p, double high_q, FacetRole role) {
      if (!(high_p > low && high_q > low)) return;
      std::vector<Vec3> corners = {
          {p.x(), p.y(), low}, {q.x(), q.y(), low}, {q.x(), q.y(), high_q}, {p.x(), p.y(), high_p}};
      for (Vec3& corner : corners) corner += kBehindCells * part.size_mm * normal;
      builder.add_side(corners, normal, role);
    };
    wall(bottom_mm, 0.0, 0.0, FacetRole::border_wall);
    wall(0.0, top_at(p), top_at(q), FacetRole::side);
  }
}

/// Returns true if, in plan, the bounding boxes of a cell and an element are at most `reach_mm` apart along both axes.
bool is_within_reach(const Vec3& lower, const Vec3& upper, const PartElement& element, double reach_mm) {
  return ((lower - element.upper_mm).head<2>().array() <= reach_mm).all() &&
         ((element.lower_mm - upper).head<2>().array() <= reach_mm).all();
}

}  // namespace

std::vector<PartElement> part_elements(const Part& part) {
  std::vector<PartElement> elements;
  for (std::uint32_t p = 0; p < part.placements.size(); ++p) {
    const SurfacePatch& patch = part.patches[part.placements[p].patch];
    std::map<std::uint64_t, PartElement> by_id;
    for (std::uint32_t c = 0; c < patch.cells.size(); ++c) {
      PartElement& element = by_id[part.element_id(patch, patch.cells[c])];
      element.placement = p;
      element.cells.push_back(c);
    }
    for (auto& [id, element] : by_id)
      if (find_points(part, element)) elements.push_back(std::move(element));
  }
  return elements;
}

ElementExcerpt excerpt_around(const Part& part, const PartElement& element, const Eigen::Isometry3d& frame_from_part,
                              double thickness_mm, double reach_mm) {
  ExcerptBuilder builder(part, frame_from_part, thickness_mm);
  builder.add(part.placements[element.placement], element.cells, ExcerptCell::own_element);
  for (std::uint32_t p = 0; p < part.placements.size(); ++p) {
    const Placement& placement = part.placements[p];
    const SurfacePatch& patch = part.patches[placement.patch];
    const Vec3 shift = shift_of(placement);
    std::map<std::uint64_t, std::vector<std::uint32_t>> near;
    for (std::uint32_t c = 0; c < patch.cells.size(); ++c)
      if (is_within_reach(patch.cells[c].lower + shift, patch.cells[c].upper + shift, element, reach_mm))
        near[part.element_id(patch, patch.cells[c])].push_back(c);
    for (const auto& [id, cells] : near) {
      if (p == element.placement && cells.front() == element.cells.front()) continue;
      bool is_element = false;
      for (const std::uint32_t c : cells)
        for (std::uint32_t f = 0; f < patch.cells[c].facet_count; ++f)
          is_element = is_element || patch.facets[patch.cells[c].first_facet + f].role == FacetRole::retro_facet;
      builder.add(placement, cells, is_element ? ExcerptCell::other_element : ExcerptCell::land);
    }
  }
  const Vec2 reach = Vec2::Constant(reach_mm + part.size_mm);
  add_sides(part, {element.lower_mm.head<2>() - reach, element.upper_mm.head<2>() + reach}, frame_from_part,
            thickness_mm, builder);
  return builder.finish();
}

}  // namespace retrace::geometry

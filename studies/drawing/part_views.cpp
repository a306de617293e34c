#include "studies/drawing/part_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace retrace::studies {
namespace {

using geometry::Part, geometry::PatchFacet, geometry::Placement, geometry::Rectangle, geometry::SurfacePatch,
    geometry::Vec2, geometry::Vec3;

// Vertical component of the unit normal below which faces count as walls, which a plan shows as lines.
constexpr double kMaxWallNormalZ = 1e-6;
// Tolerance of lengths, as a fraction of an element. Shorter lines are omitted, and closer lines are merged.
constexpr double kSame = 1e-7;
// Tolerance of the cosine between normals. Within it, neighbours are one face, for example triangles of a mesh.
constexpr double kSameNormal = 1e-9;
// Number of intervals into which the profile of a curved entrance face is divided in a section.
constexpr int kProfilePoints = 400;

Rectangle box_of(const SurfacePatch& patch) {
  Rectangle box{Vec2::Constant(INFINITY), Vec2::Constant(-INFINITY)};
  for (const Vec3& v : patch.vertices) {
    box.lower = box.lower.cwiseMin(v.head<2>());
    box.upper = box.upper.cwiseMax(v.head<2>());
  }
  return box;
}

bool overlap(const Rectangle& a, const Rectangle& b) {
  return (a.lower.array() < b.upper.array()).all() && (b.lower.array() < a.upper.array()).all();
}

std::vector<Rectangle> boxes_of(const Part& part) {
  std::vector<Rectangle> boxes;
  for (const SurfacePatch& patch : part.patches) boxes.push_back(box_of(patch));
  return boxes;
}

/// Clips a line to a rectangle (Liang and Barsky 1984). Returns nothing if no part is inside.
std::optional<PlanLine> clipped(const PlanLine& line, const Rectangle& window) {
  const Vec2 along = line.second - line.first;
  double from = 0.0;
  double to = 1.0;
  for (const Eigen::Index axis : {0, 1})
    for (const double side : {-1.0, 1.0}) {
      const double towards = side * along[axis];
      const double room = side * ((side < 0.0 ? window.lower : window.upper)[axis] - line.first[axis]);
      if (towards == 0.0 && room < 0.0) return std::nullopt;
      if (towards < 0.0) from = std::max(from, room / towards);
      if (towards > 0.0) to = std::min(to, room / towards);
    }
  if (!(from < to)) return std::nullopt;
  return PlanLine{line.first + from * along, line.first + to * along};
}

double azimuth_deg(const Vec3& normal) {
  const double deg = std::atan2(normal.y(), normal.x()) * 180.0 / std::numbers::pi;
  return deg < 0.0 ? deg + 360.0 : deg;
}

/// Set of lines without duplicates.
class LineSet {
 public:
  LineSet(const Rectangle& window, double same_mm) : window_(window), same_mm_(same_mm) {}

  void add(const Vec2& a, const Vec2& b, std::vector<PlanLine>& lines) {
    const std::array<std::int64_t, 4> key = key_of(a, b);
    if (!known_.insert(key).second) return;
    if (const auto line = clipped({a, b}, window_)) lines.push_back(*line);
  }

 private:
  std::array<std::int64_t, 4> key_of(const Vec2& a, const Vec2& b) const {
    const auto whole = [&](double mm) { return std::llround(mm / (10.0 * same_mm_)); };
    std::array<std::int64_t, 2> p{whole(a.x()), whole(a.y())};
    std::array<std::int64_t, 2> q{whole(b.x()), whole(b.y())};
    if (q < p) std::swap(p, q);
    return {p[0], p[1], q[0], q[1]};
  }

  Rectangle window_;
  double same_mm_;
  std::set<std::array<std::int64_t, 4>> known_;
};

/// Adds the faces and lines of one cell of a SurfacePatch.
class CellDrawer {
 public:
  CellDrawer(const SurfacePatch& patch, const geometry::PatchCell& cell, const Vec2& offset,
             std::optional<std::size_t> zone)
      : patch_(patch), cell_(cell), offset_(offset), zone_(zone) {}

  void draw(PlanView& view, LineSet& lines, double tolerance_mm) const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> normals;
    for_each_level_facet([&](const PatchFacet& facet) {
      for (std::uint32_t k = 0; k < facet.corner_count; ++k) normals[edge(facet, k)] = facet.normal;
    });
    for_each_level_facet([&](const PatchFacet& facet) {
      PlanFace face{{}, facet.role, azimuth_deg(facet.normal), zone_};
      for (std::uint32_t k = facet.corner_count; k-- > 0;) face.outline_mm.push_back(at(edge(facet, k).first));
      face.outline_mm = geometry::clip(face.outline_mm, view.window_mm, tolerance_mm);
      if (!face.outline_mm.empty()) view.faces.push_back(std::move(face));
      for (std::uint32_t k = 0; k < facet.corner_count; ++k) {
        // Flat back faces have no edges of their own, because they are all in one plane.
        if (facet.role == geometry::FacetRole::flat_back) break;
        const auto [a, b] = edge(facet, k);
        const auto beside = normals.find({b, a});
        if (beside == normals.end())
          lines.add(at(a), at(b), view.rims_mm);
        else if (facet.normal.dot(beside->second) < 1.0 - kSameNormal)
          lines.add(at(a), at(b), view.roots_mm);
      }
    });
  }

 private:
  template <class Action>
  void for_each_level_facet(const Action& action) const {
    for (std::uint32_t f = 0; f < cell_.facet_count; ++f) {
      const PatchFacet& facet = patch_.facets[cell_.first_facet + f];
      if (std::abs(facet.normal.z()) > kMaxWallNormalZ) action(facet);
    }
  }
  std::pair<std::uint32_t, std::uint32_t> edge(const PatchFacet& facet, std::uint32_t k) const {
    return {patch_.corners[facet.first_corner + k], patch_.corners[facet.first_corner + (k + 1) % facet.corner_count]};
  }
  Vec2 at(std::uint32_t vertex) const { return patch_.vertices[vertex].head<2>() + offset_; }

  const SurfacePatch& patch_;
  const geometry::PatchCell& cell_;
  Vec2 offset_;
  std::optional<std::size_t> zone_;
};

/// Returns the zone of each cell of a part with zones, whose cells are stored zone by zone in one patch.
std::vector<std::optional<std::size_t>> zones_of_cells(const Part& part, std::size_t cells) {
  std::vector<std::optional<std::size_t>> zones;
  for (std::size_t zone = 0; zone < part.zones.size(); ++zone) zones.insert(zones.end(), part.zones[zone].cells, zone);
  zones.resize(cells);
  return zones;
}

/// Segment of the section's lower border, from left to right.
struct DesignExcerpt {
  Vec2 left;
  Vec2 right;
};

/// Returns the intersection of a facet with the plane at `y`. Heights are those of the facet's plane.
std::optional<DesignExcerpt> cut_of(const SurfacePatch& patch, const PatchFacet& facet, const Vec2& offset, double y) {
  double low = INFINITY;
  double high = -INFINITY;
  for (std::uint32_t k = 0; k < facet.corner_count; ++k) {
    const Vec3& a = patch.vertices[patch.corners[facet.first_corner + k]];
    const Vec3& b = patch.vertices[patch.corners[facet.first_corner + (k + 1) % facet.corner_count]];
    const double above_a = a.y() + offset.y() - y;
    const double above_b = b.y() + offset.y() - y;
    if ((above_a < 0.0) == (above_b < 0.0)) continue;
    const double x = a.x() + above_a / (above_a - above_b) * (b.x() - a.x());
    low = std::min(low, x);
    high = std::max(high, x);
  }
  if (!(high > low)) return std::nullopt;
  const auto height = [&](double x) {
    return (facet.offset_mm - facet.normal.x() * x - facet.normal.y() * (y - offset.y())) / facet.normal.z();
  };
  return DesignExcerpt{{low + offset.x(), height(low)}, {high + offset.x(), height(high)}};
}

DesignExcerpt within(const DesignExcerpt& piece, double from, double to) {
  const auto at = [&](double x) {
    const double share = (x - piece.left.x()) / (piece.right.x() - piece.left.x());
    return Vec2(x, piece.left.y() + share * (piece.right.y() - piece.left.y()));
  };
  return {piece.left.x() < from ? at(from) : piece.left, piece.right.x() > to ? at(to) : piece.right};
}

/// Returns the intersection of the back surface with the plane between two values of x, from left to right.
std::vector<DesignExcerpt> pieces_of(const Part& part, double y_mm, double from, double to) {
  const std::vector<Rectangle> boxes = boxes_of(part);
  std::vector<DesignExcerpt> pieces;
  for (const Placement& placement : part.placements) {
    const SurfacePatch& patch = part.patches[placement.patch];
    if (!overlap(moved(boxes[placement.patch], placement.offset_mm), {{from, y_mm}, {to, y_mm}})) continue;
    for (const PatchFacet& facet : patch.facets) {
      if (std::abs(facet.normal.z()) <= kMaxWallNormalZ) continue;
      const auto piece = cut_of(patch, facet, placement.offset_mm, y_mm);
      if (!piece || piece->right.x() <= from || piece->left.x() >= to) continue;
      pieces.push_back(within(*piece, from, to));
    }
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const DesignExcerpt& a, const DesignExcerpt& b) { return a.left.x() < b.left.x(); });
  return pieces;
}

/// Adds the profile of a curved entrance face to the outline of a section, beginning at the right.
void add_profile(SectionView& view, const geometry::EntranceHeights& entrance_height) {
  for (int k = kProfilePoints; k >= 0; --k) {
    const double share = static_cast<double>(k) / kProfilePoints;
    const double x_mm = view.x_from_mm + share * (view.x_to_mm - view.x_from_mm);
    // Points are moved inwards slightly, because a face that ends at the outline may have no height there.
    const double middle_mm = 0.5 * (view.x_from_mm + view.x_to_mm);
    const double z_mm = entrance_height({middle_mm + (1.0 - 1e-7) * (x_mm - middle_mm), view.y_mm});
    if (std::isfinite(z_mm)) view.outline_mm.emplace_back(x_mm, z_mm);
  }
}

}  // namespace

PlanView plan_view(const Part& part, const Rectangle& window_mm) {
  PlanView view;
  view.window_mm = window_mm;
  const double same_mm = kSame * part.size_mm;
  LineSet lines(window_mm, same_mm);
  const std::vector<Rectangle> boxes = boxes_of(part);
  for (const Placement& placement : part.placements) {
    if (!overlap(moved(boxes[placement.patch], placement.offset_mm), window_mm)) continue;
    const SurfacePatch& patch = part.patches[placement.patch];
    const std::vector<std::optional<std::size_t>> zones = zones_of_cells(part, patch.cells.size());
    for (std::size_t k = 0; k < patch.cells.size(); ++k) {
      const geometry::PatchCell& cell = patch.cells[k];
      const Rectangle box = moved(Rectangle{cell.lower.head<2>(), cell.upper.head<2>()}, placement.offset_mm);
      if (overlap(box, window_mm)) CellDrawer(patch, cell, placement.offset_mm, zones[k]).draw(view, lines, same_mm);
    }
  }
  return view;
}

std::size_t faces_near(const Part& part, const Rectangle& window_mm) {
  const std::vector<Rectangle> boxes = boxes_of(part);
  std::size_t faces = 0;
  for (const Placement& placement : part.placements)
    if (overlap(moved(boxes[placement.patch], placement.offset_mm), window_mm))
      faces += part.patches[placement.patch].facets.size();
  return faces;
}

std::vector<Vec2> SectionView::entrance_mm() const {
  return {outline_mm.end() - static_cast<std::ptrdiff_t>(entrance_corners), outline_mm.end()};
}

std::optional<SectionView> section_view(const Part& part, double y_mm, double x_from_mm, double x_to_mm,
                                        const geometry::EntranceHeights& entrance_height) {
  const double same_mm = kSame * part.size_mm;
  // The section is shifted a little from the borders of facets, so that each facet is either hit or missed.
  const std::vector<DesignExcerpt> pieces = pieces_of(part, y_mm + 0.1 * same_mm, x_from_mm, x_to_mm);
  if (pieces.empty()) return std::nullopt;
  SectionView view{y_mm, pieces.front().left.x(), pieces.back().right.x(), {}};
  const auto add = [&](const Vec2& p) {
    if (view.outline_mm.empty() || (p - view.outline_mm.back()).norm() > 2.0 * same_mm) view.outline_mm.push_back(p);
  };
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const bool joins = k == 0 || std::abs(pieces[k].left.x() - pieces[k - 1].right.x()) < 1e-3 * part.size_mm;
    if (!joins) return std::nullopt;
    add(pieces[k].left);
    add(pieces[k].right);
  }
  const std::size_t on_back = view.outline_mm.size();
  if (entrance_height) {
    add_profile(view, entrance_height);
  } else {
    add({view.x_to_mm, part.thickness_mm});
    add({view.x_from_mm, part.thickness_mm});
  }
  view.entrance_corners = view.outline_mm.size() - on_back;
  return view;
}

}  // namespace retrace::studies

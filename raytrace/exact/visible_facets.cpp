#include "raytrace/exact/visible_facets.h"

#include <algorithm>
#include <span>

#include "geometry/centroid.h"

namespace retrace::raytrace {
namespace {

using geometry::FacetRole, geometry::PatchCell, geometry::PatchFacet, geometry::SurfacePatch;

// Measured work of clipping two polygons. The unit is one test of a bounding box (BeamWalk::work()).
constexpr std::uint64_t kWorkOfCut = 30;

PlanBox plan_box_of(const FlatPolygon& points) {
  PlanBox box;
  for (const Vec2& p : points) box.include(p);
  return box;
}

}  // namespace

/// A beam for which facets are searched.
struct VisibleFacets::Search {
  const Beam& beam;
  const Frame& frame;
  const FlatPolygon& whole;
  PlanBox box;       ///< bounding box of `whole`
  const Plane* far;  ///< plane at the horizon; null if the beam meets no facets beyond it
};

void VisibleFacets::find(const Beam& beam, const Frame& frame, const FlatPolygon& whole, const Horizon& horizon) {
  candidates_.clear();
  if (horizon.t <= 0.0) return;
  const PlanBox plan = sweep_in_layer(scene_, beam, horizon);
  // Candidates are cut at the horizon, because facets beyond it may be hidden by other facets that were not searched.
  const Plane there = plane_at(horizon, beam);
  const Plane far{-there.normal, -there.offset_mm};
  const Search search{beam, frame, whole, plan_box_of(whole), horizon.limited ? &far : nullptr};
  scene_.cells.visit(plan.lower, plan.upper,
                     [&](const SurfacePatch& patch, const PatchCell& cell, const Vec2& offset, double height_mm) {
                       const CellInstance place = scene_.symmetry != nullptr
                                                      ? scene_.symmetry->instance_of(patch, cell, offset)
                                                      : CellInstance{scene_.part.element_id(patch, cell), offset};
                       const Vec3 shift(offset.x(), offset.y(), height_mm);
                       for (std::uint32_t f = cell.first_facet; f < cell.first_facet + cell.facet_count; ++f)
                         consider(search, patch, patch.facets[f], shift, place);
                     });
}

/// Adds a facet to the candidates if it may block the beam.
void VisibleFacets::consider(const Search& search, const SurfacePatch& patch, const PatchFacet& facet,
                             const Vec3& shift, const CellInstance& cell) {
  const Beam& beam = search.beam;
  ++work_;
  const double towards = facet.normal.dot(beam.direction);
  if (beam.inside ? towards <= kMinIncidenceCosine : towards >= -kMinIncidenceCosine) return;
  Corners corners;
  PlanBox own;
  bool all_ahead = true;
  for (std::uint32_t c = 0; c < facet.corner_count; ++c) {
    corners.push_back(patch.vertices[patch.corners[facet.first_corner + c]] + shift);
    own.include(search.frame.across(corners.back()));
    all_ahead = all_ahead && beam.start.height(corners.back()) >= 0.0;
  }
  if (!own.overlaps(search.box)) return;
  work_ += kWorkOfCut;
  if (!all_ahead) corners = cut(corners, beam.start);
  if (search.far != nullptr) corners = cut(corners, *search.far);
  if (corners.empty()) return;
  const Plane plane{facet.normal, facet.offset_mm + facet.normal.dot(shift)};
  const FlatPolygon seen = flattened(corners, search.frame, scene_.merge_mm);
  if (seen.size() < 3) return;
  FlatPolygon piece = intersection(search.whole, seen, scene_.merge_mm);
  make_convex(piece);
  if (piece.size() < 3 || area(piece) <= scene_.min_area) return;
  const PlanBox piece_box = plan_box_of(piece);
  candidates_.push_back({plane, facet.role, cell, Distance(search.frame, plane), std::move(piece), piece_box});
  if (facet.centroid_mm) candidates_.back().centroid_mm.emplace(*facet.centroid_mm + shift.head<2>());
}

/// Returns true if, along the beam, the whole polygon of `own` is nearer than the plane of `other`.
bool VisibleFacets::is_nearer(const Candidate& own, const Candidate& other) const {
  const auto is_before = [&](const Vec2& p) { return own.distance.at(p) < other.distance.at(p) - scene_.merge_mm; };
  return std::all_of(own.overlap.begin(), own.overlap.end(), is_before);
}

/// Returns the parts of a candidate's polygon that no nearer candidate covers.
FlatPolygons VisibleFacets::visible_polygons(std::size_t k) {
  const Candidate& own = candidates_[k];
  FlatPolygons visible;
  visible.push_back(own.overlap);
  for (std::size_t j = 0; j < candidates_.size() && !visible.empty(); ++j) {
    const Candidate& other = candidates_[j];
    if (j == k || !own.box.overlaps(other.box) || is_nearer(own, other)) continue;
    work_ += kWorkOfCut;
    const FlatPolygon common = intersection(own.overlap, other.overlap, scene_.merge_mm);
    if (common.size() < 3 || area(common) <= scene_.min_area) continue;
    const Vec2 at = geometry::centroid(std::span<const Vec2>(common.data(), common.size()));
    const double behind = own.distance.at(at) - other.distance.at(at);
    // If both candidates are at the same distance, the candidate with the lower index is visible.
    if (behind < 0.0 || (behind == 0.0 && k < j)) continue;
    FlatPolygons left;
    work_ += kWorkOfCut * visible.size();
    for (const FlatPolygon& piece : visible) subtract(piece, other.overlap, scene_.min_area, scene_.merge_mm, left);
    visible = std::move(left);
  }
  return visible;
}

FlatPolygons VisibleFacets::take_visible_on_plane_of(std::size_t k) {
  FlatPolygons visible;
  if (candidates_[k].is_processed) return visible;
  const Plane plane = candidates_[k].plane;
  const FacetRole role = candidates_[k].role;
  const CellInstance cell = candidates_[k].cell;
  for (std::size_t j = k; j < candidates_.size(); ++j) {
    Candidate& other = candidates_[j];
    const bool is_one_plane = other.role == role && other.plane.normal.isApprox(plane.normal, 1e-14) &&
                              std::abs(other.plane.offset_mm - plane.offset_mm) <= scene_.merge_mm &&
                              (!scene_.policy.separate_cells || other.cell == cell);
    if (other.is_processed || !is_one_plane) continue;
    other.is_processed = true;
    for (FlatPolygon& piece : visible_polygons(j)) visible.push_back(std::move(piece));
  }
  join(visible);
  return visible;
}

FlatPolygons VisibleFacets::unblocked(const FlatPolygon& whole) {
  FlatPolygons rest;
  rest.push_back(whole);
  for (const Candidate& candidate : candidates_) {
    FlatPolygons left;
    work_ += kWorkOfCut * rest.size();
    for (const FlatPolygon& piece : rest) subtract(piece, candidate.overlap, scene_.min_area, scene_.merge_mm, left);
    rest = std::move(left);
  }
  join(rest);
  return rest;
}

/// Joins polygons whose union is convex.
void VisibleFacets::join(FlatPolygons& pieces) {
  if (pieces.size() > 1) work_ += kWorkOfCut * pieces.size() * (pieces.size() - 1) / 4;
  join_convex(pieces, scene_.join_area);
}

}  // namespace retrace::raytrace

#include "studies/inspect/tool_report.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/angle.h"
#include "geometry/direction.h"
#include "geometry/outline/convex_decomposition.h"

namespace retrace::studies {
namespace {

using geometry::FacetRole, geometry::Part, geometry::PatchFacet, geometry::SurfacePatch, geometry::Vec2, geometry::Vec3;

// Draft above which a face counts as parallel to the demoulding direction in spite of rounding errors.
constexpr double kParallel_deg = 1e-7;
// Maximum difference of the normals of facets that are in one plane.
constexpr double kSameNormal = 1e-6;
// Elements with a smaller fraction of the largest area in plan have no axis.
constexpr double kMinFractionOfElement = 0.5;

/// Sums up the draft of faces.
class DraftSum {
 public:
  DraftSum(const Vec3& demoulding, double min_draft_deg) : demoulding_(demoulding), min_draft_deg_(min_draft_deg) {}

  /// \param outward normal of the face, out of the part
  void add(FacetRole role, const Vec3& outward, double area_mm2, const Vec3& centroid_mm) {
    const double draft_deg = draft_of(role, outward);
    DraftOfFaces& sum = sums_[role];
    sum.role = role;
    ++sum.faces;
    sum.area_mm2 += area_mm2;
    sum.min_draft_deg = std::min(sum.min_draft_deg, draft_deg);
    if (draft_deg < 0.0) {
      ++sum.undercuts;
      sum.undercut_mm2 += area_mm2;
    }
    if (draft_deg >= min_draft_deg_) return;
    ++sum.below_limit;
    steep_.push_back({role, centroid_mm, area_mm2, draft_deg});
    if (steep_.size() >= 2 * kMaxSteepFaces) sort_steep();
  }

  std::vector<DraftOfFaces> sums() const {
    std::vector<DraftOfFaces> all;
    for (const auto& [role, sum] : sums_) all.push_back(sum);
    return all;
  }
  std::vector<SteepFace> steep_faces() {
    sort_steep();
    return std::move(steep_);
  }

 private:
  /// The back is made by one half of the mould, and the entrance face by the other half. Sides may belong to any half.
  double draft_of(FacetRole role, const Vec3& outward) const {
    const double sine = outward.dot(demoulding_);
    const bool is_side = role == FacetRole::side || role == FacetRole::border_wall;
    const double facing = role == FacetRole::entrance ? sine : is_side ? std::abs(sine) : -sine;
    const double draft_deg = Angle::from_rad(std::asin(std::clamp(facing, -1.0, 1.0))).deg();
    return std::abs(draft_deg) < kParallel_deg ? 0.0 : draft_deg;
  }

  void sort_steep() {
    std::stable_sort(steep_.begin(), steep_.end(),
                     [](const SteepFace& a, const SteepFace& b) { return a.draft_deg < b.draft_deg; });
    if (steep_.size() > kMaxSteepFaces) steep_.resize(kMaxSteepFaces);
  }

  Vec3 demoulding_;
  double min_draft_deg_;
  std::map<FacetRole, DraftOfFaces> sums_;
  std::vector<SteepFace> steep_;
};

Vec3 centroid_of(const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  double twice_area = 0.0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const double area = (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).norm();
    sum += area / 3.0 * (corners[0] + corners[k] + corners[k + 1]);
    twice_area += area;
  }
  return twice_area > 0.0 ? Vec3(sum / twice_area) : corners.front();
}

std::vector<Vec3> corners_of(const SurfacePatch& patch, const PatchFacet& facet) {
  std::vector<Vec3> corners;
  for (std::uint32_t k = 0; k < facet.corner_count; ++k)
    corners.push_back(patch.vertices[patch.corners[facet.first_corner + k]]);
  return corners;
}

Vec3 translation_of(const geometry::Placement& at) {
  return {at.offset_mm.x(), at.offset_mm.y(), at.height_mm};
}

/// Returns the area of a plane polygon times its unit normal.
Vec3 area_vector(const std::vector<Vec3>& corners) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    twice += (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
  return 0.5 * twice;
}

void add_back(DraftSum& draft, const Part& part) {
  for (const SurfacePatch& patch : part.patches) {
    const auto number = static_cast<std::size_t>(&patch - part.patches.data());
    for (const PatchFacet& facet : patch.facets) {
      const Vec3 centroid = centroid_of(corners_of(patch, facet));
      const double area_mm2 = geometry::facet_area(patch, facet);
      for (const geometry::Placement& at : part.placements)
        if (at.patch == number) draft.add(facet.role, facet.normal, area_mm2, centroid + translation_of(at));
    }
    for (const auto& ring : patch.border_walls) {
      std::vector<Vec3> corners;
      for (const std::uint32_t v : ring) corners.push_back(patch.vertices[v]);
      const Vec3 area = area_vector(corners);
      if (!(area.norm() > 0.0)) continue;
      for (const geometry::Placement& at : part.placements)
        if (at.patch == number)
          draft.add(FacetRole::border_wall, area.normalized(), area.norm(), centroid_of(corners) + translation_of(at));
    }
  }
}

/// Adds the sides of the plate. Sides of notches and holes are facets of the back.
void add_sides(DraftSum& draft, const Part& part, const std::optional<geometry::Entrance>& entrance) {
  for (std::size_t k = 0; k < part.outline.size(); ++k) {
    const Vec2& from = part.outline[k];
    const Vec2& to = part.outline[(k + 1) % part.outline.size()];
    const Vec2 along = (to - from).normalized();
    const Vec2 middle = 0.5 * (from + to);
    const double height_mm = entrance ? geometry::height_mm(*entrance, middle) : part.thickness_mm;
    draft.add(FacetRole::side, {along.y(), -along.x(), 0.0}, height_mm * (to - from).norm(),
              {middle.x(), middle.y(), 0.5 * height_mm});
  }
}

/// Adds the entrance face. The draft of a curved face is its smallest draft at the points of a grid and at the corners.
void add_entrance(DraftSum& draft, const Part& part, const std::optional<geometry::Entrance>& entrance,
                  const Vec3& demoulding) {
  const Vec2 centre = geometry::bounding_box(part.outline).centre();
  if (!entrance) {
    draft.add(FacetRole::entrance, Vec3::UnitZ(), part.entrance_area_mm2, {centre.x(), centre.y(), part.thickness_mm});
    return;
  }
  if (const auto* const mesh = std::get_if<std::shared_ptr<const SurfacePatch>>(&*entrance)) {
    for (const PatchFacet& facet : (*mesh)->facets)
      draft.add(FacetRole::entrance, facet.normal, geometry::facet_area(**mesh, facet),
                centroid_of(corners_of(**mesh, facet)));
    return;
  }
  constexpr int kCells = 200;
  const geometry::EntranceSurface& surface =
      **std::get_if<std::shared_ptr<const geometry::EntranceSurface>>(&*entrance);
  const geometry::Rectangle box = geometry::bounding_box(part.outline);
  Vec3 steepest = Vec3::UnitZ();
  Vec3 steepest_at = Vec3::Zero();
  double least_sine = 2.0;
  const auto visit = [&](const Vec2& at) {
    const auto sample = surface.at(at);
    const Vec3 normal = Vec3(-sample.slope.x(), -sample.slope.y(), 1.0).normalized();
    if (normal.dot(demoulding) >= least_sine) return;
    least_sine = normal.dot(demoulding);
    steepest = normal;
    steepest_at = {at.x(), at.y(), sample.height_mm};
  };
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      const Vec2 at = box.lower + Vec2(i, j).cwiseProduct(box.size()) / kCells;
      if (geometry::contains(part.outline, at)) visit(at);
    }
  for (const Vec2& corner : part.outline) visit(corner);
  draft.add(FacetRole::entrance, steepest, part.entrance_area_mm2, steepest_at);
}

double optical_fraction(const Part& part) {
  double optical_mm2 = 0.0;
  for (const geometry::Placement& at : part.placements) {
    const SurfacePatch& patch = part.patches[at.patch];
    for (const PatchFacet& facet : patch.facets)
      if (facet.role == FacetRole::retro_facet)
        optical_mm2 += std::abs(facet.normal.z()) * geometry::facet_area(patch, facet);
  }
  return optical_mm2 / part.entrance_area_mm2;
}

/// Facets of one element, in the frame of their patch.
struct ElementFacets {
  std::vector<Vec3> normals;  ///< different normals of the retro facets
  std::vector<Vec2> points;   ///< corners of the retro facets in plan
  double plan_mm2 = 0.0;
};

/// Returns the elements of a patch.
std::vector<ElementFacets> elements_of(const Part& part, const SurfacePatch& patch) {
  std::map<std::uint64_t, ElementFacets> elements;
  for (const geometry::PatchCell& cell : patch.cells) {
    ElementFacets& element = elements[part.element_id(patch, cell)];
    for (std::uint32_t k = 0; k < cell.facet_count; ++k) {
      const PatchFacet& facet = patch.facets[cell.first_facet + k];
      if (facet.role != FacetRole::retro_facet) continue;
      const bool is_known = std::any_of(element.normals.begin(), element.normals.end(),
                                        [&](const Vec3& n) { return (n - facet.normal).norm() < kSameNormal; });
      if (!is_known) element.normals.push_back(facet.normal);
      element.plan_mm2 += std::abs(facet.normal.z()) * geometry::facet_area(patch, facet);
      for (const Vec3& p : corners_of(patch, facet)) element.points.push_back(p.head<2>());
    }
  }
  std::vector<ElementFacets> all;
  for (auto& [id, element] : elements)
    if (element.normals.size() >= 2) all.push_back(std::move(element));
  return all;
}

Vec3 entrance_normal(const geometry::Entrance& entrance, const Vec2& at_mm) {
  if (const auto* const surface = std::get_if<std::shared_ptr<const geometry::EntranceSurface>>(&entrance)) {
    const Vec2 slope = (*surface)->at(at_mm).slope;
    return Vec3(-slope.x(), -slope.y(), 1.0).normalized();
  }
  const SurfacePatch& mesh = *std::get<1>(entrance);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    geometry::Polygon triangle;
    for (const std::uint32_t v : mesh.triangles[t]) triangle.push_back(mesh.vertices[v].head<2>());
    if (geometry::contains(triangle, at_mm)) return mesh.facets[mesh.triangle_facet[t]].normal;
  }
  return Vec3::UnitZ();
}

std::vector<PinAxis> pin_axes_of(const Part& part, const geometry::Entrance& entrance) {
  std::vector<std::vector<ElementFacets>> elements;
  double largest_mm2 = 0.0;
  for (const SurfacePatch& patch : part.patches) {
    elements.push_back(elements_of(part, patch));
    for (const ElementFacets& element : elements.back()) largest_mm2 = std::max(largest_mm2, element.plan_mm2);
  }
  std::vector<PinAxis> axes;
  for (const geometry::Placement& at : part.placements)
    for (const ElementFacets& element : elements[at.patch]) {
      if (element.plan_mm2 < kMinFractionOfElement * largest_mm2) continue;
      PinAxis pin;
      pin.outline_mm = geometry::moved(geometry::convex_hull(element.points), at.offset_mm);
      pin.centre_mm = geometry::centroid(pin.outline_mm);
      Vec3 sum = Vec3::Zero();
      for (const Vec3& normal : element.normals) sum -= normal;
      pin.axis = sum.normalized();
      pin.normal = entrance_normal(entrance, pin.centre_mm);
      axes.push_back(std::move(pin));
    }
  return axes;
}

}  // namespace

double PinAxis::angle_deg() const {
  return Angle::from_rad(std::atan2(axis.cross(normal).norm(), axis.dot(normal))).deg();
}

double PinAxis::azimuth_deg() const {
  const Vec2 apart = (axis - normal).head<2>();
  return apart.norm() < 1e-12 ? 0.0 : Angle::from_rad(std::atan2(apart.y(), apart.x())).deg();
}

double ToolReport::min_draft_deg() const {
  double least = 90.0;
  for (const DraftOfFaces& of : draft) least = std::min(least, of.min_draft_deg);
  return least;
}

std::int64_t ToolReport::below_limit() const {
  std::int64_t sum = 0;
  for (const DraftOfFaces& of : draft) sum += of.below_limit;
  return sum;
}

std::int64_t ToolReport::undercuts() const {
  std::int64_t sum = 0;
  for (const DraftOfFaces& of : draft) sum += of.undercuts;
  return sum;
}

ToolReport report_tool(const Part& part, const std::optional<geometry::Entrance>& entrance,
                       const InspectRequest& request) {
  ToolReport report;
  report.demoulding =
      geometry::direction_at(Angle::from_deg(request.demould_tilt_deg), Angle::from_deg(request.demould_azimuth_deg));
  report.wall = smallest_wall(part, entrance);
  DraftSum draft(report.demoulding, request.min_draft_deg);
  add_entrance(draft, part, entrance, report.demoulding);
  add_back(draft, part);
  add_sides(draft, part, entrance);
  report.draft = draft.sums();
  report.steep_faces = draft.steep_faces();
  report.optical_area_fraction = optical_fraction(part);
  if (entrance) report.pin_axes = pin_axes_of(part, *entrance);
  return report;
}

}  // namespace retrace::studies

#include "studies/scene/design_excerpt.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/elements/array_sheet.h"
#include "geometry/elements/element_cells.h"
#include "geometry/entrance/curved_boundary.h"
#include "geometry/part/faceted_solid.h"
#include "raytrace/light/light_setup.h"

namespace retrace::studies {
namespace {

constexpr int kGrid = 24;                    // number of entry points along an element
constexpr std::size_t kPathsEach = 3;        // number of kinds of paths that are shown for each direction of light
constexpr std::size_t kMaxTriangles = 4000;  // maximum number of triangles of a mesh that is shown
// Maximum number of triangles of the back of a part with a curved entrance face. If it is exceeded, the back is shown
// as a plane.
constexpr std::size_t kMaxBackTriangles = 20'000;
// Maximum distance between a curved entrance face and the displayed triangles, as a fraction of the part's size.
constexpr double kShownError = 1e-4;

geometry::Rectangle element_box(const geometry::Element& element) {
  return geometry::bounding_box(geometry::aperture_outline(element));
}

struct FewElements {
  design::Design design;
  std::vector<std::string> remarks;  ///< differences from the given design, for the user
  bool is_cut = false;               ///< true: the elements are part of a larger array
};

/// Returns a design with a few elements of the given design, without features that are not shown.
/// \param elements maximum number of elements along a side of an array
FewElements few_elements(const design::Design& design, double elements) {
  FewElements few{design, {}};
  auto& [small, remarks, is_cut] = few;
  small.surface.texture = {};
  small.surface.form = {};
  small.wet_back.reset();
  if (small.light.spectrum() != nullptr) small.light.colour = design::Light{}.colour;
  if (design.mask()) remarks.push_back("the mask is not shown");
  if (!design.surface.is_smooth()) remarks.push_back("facets are shown smooth");
  if (!design.surface.form.is_plane()) remarks.push_back("facets are shown plane");
  if (design.wet_back) remarks.push_back("wet elements are shown dry");
  small.surface.entrance = {};
  small.shells.clear();
  if (!design.shells.empty()) remarks.push_back("the shells in front of the part are not shown");
  if (!design.surface.entrance.is_clean()) remarks.push_back("the entrance face is shown clean");
  if (design.facet_planes()) remarks.push_back("facets are shown as designed");
  if (!design.elements()) return few;
  small.shape = design::ElementArray{design.part(), {}, {}};
  if (design.entrance) return few;  // the face extends over the whole part, so that all elements are shown
  geometry::PartSpec& spec = small.part();
  const geometry::Vec2 size = element_box(spec.element).size();
  if (spec.array.arrangement != geometry::Arrangement::single) {
    const geometry::Vec2 wanted = elements * (size + geometry::Vec2(spec.array.x_gap_mm, spec.array.y_gap_mm));
    const bool is_larger = spec.array.extent == geometry::Extent::infinite ||
                           spec.array.x_length_mm > 1.01 * wanted.x() || spec.array.y_length_mm > 1.01 * wanted.y();
    if (is_larger) {
      spec.array.extent = geometry::Extent::finite;
      spec.array.outline.reset();
      spec.array.x_length_mm = spec.array.x_length_mm > 0.0 ? std::min(spec.array.x_length_mm, wanted.x()) : wanted.x();
      spec.array.y_length_mm = spec.array.y_length_mm > 0.0 ? std::min(spec.array.y_length_mm, wanted.y()) : wanted.y();
      spec.array.x_offset_mm = spec.array.y_offset_mm = 0.0;
      is_cut = true;
      remarks.push_back("only a few elements of the array are shown");
    }
  }
  const double top_mm = geometry::element_top_mm(spec.element, spec.angle_errors);
  const double plate_mm = std::max(1.5 * top_mm, 0.7 * size.maxCoeff());
  if (spec.thickness_mm > 2.0 * plate_mm && !spec.substrate) {
    spec.thickness_mm = plate_mm;
    remarks.push_back("the plate is drawn thinner");
  }
  return few;
}

/// Returns the edges between triangles that are in different planes. Edges within the entrance face are omitted,
/// because a curved face is smooth.
std::vector<std::array<std::uint32_t, 2>> sharp_edges(const geometry::BoundaryMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  if (!geometry::is_closed_manifold(mesh)) return edges;
  const auto normal = [&](std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return geometry::Vec3(
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized());
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k];
      const std::uint32_t b = mesh.triangles[t][(k + 1) % 3];
      const auto [it, is_new] = first.try_emplace(std::minmax(a, b), t);
      if (!is_new && mesh.roles[t] == geometry::FacetRole::entrance && mesh.roles[it->second] == mesh.roles[t])
        continue;
      if (!is_new && normal(t).dot(normal(it->second)) < 1.0 - 1e-6) edges.push_back({a, b});
    }
  return edges;
}

/// Returns the boundary of the part. For a part that is read from a mesh, returns its back surface and its entrance
/// face.
geometry::BoundaryMesh boundary_of_part(const geometry::Part& part) {
  if (!part.patches[part.placements[0].patch].border_rim.empty()) return geometry::closed_boundary(part);
  const geometry::SurfacePatch& patch = part.patches[0];
  geometry::BoundaryMesh mesh;
  mesh.vertices = patch.vertices;
  mesh.triangles = patch.triangles;
  for (const std::uint32_t facet : patch.triangle_facet) mesh.roles.push_back(patch.facets[facet].role);
  // Only the entrance face is added; the sides remain open.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const geometry::Vec2& p : part.outline) mesh.vertices.emplace_back(p.x(), p.y(), part.thickness_mm);
  for (std::uint32_t k = 1; k + 1 < part.outline.size(); ++k) {
    mesh.triangles.push_back({first, first + k, first + k + 1});
    mesh.roles.push_back(geometry::FacetRole::entrance);
  }
  return mesh;
}

/// Returns a copy of a part in which the back is replaced by the plane z = 0.
geometry::Part with_plane_back(const geometry::Part& part) {
  geometry::SurfacePatch back;
  for (const geometry::Vec2& p : part.outline) back.vertices.emplace_back(p.x(), p.y(), 0.0);
  for (std::uint32_t k = 1; k + 1 < part.outline.size(); ++k) {
    back.triangles.push_back({0, k + 1, k});
    back.triangle_facet.push_back(0);
  }
  geometry::PatchFacet facet;
  facet.role = geometry::FacetRole::flat_back;
  back.facets.push_back(facet);
  geometry::Part plane = part;
  plane.patches = {back};
  plane.placements = {{}};
  return plane;
}

/// Returns the boundary to be shown for a part with a curved entrance face.
/// \param remarks descriptions of the differences between the displayed part and the design are added here
geometry::BoundaryMesh boundary_of_curved_part(const design::OpticalModel& model, std::vector<std::string>& remarks) {
  const geometry::Part& part = model.part;
  const double error_mm = kShownError * geometry::bounding_box(part.outline).size().maxCoeff();
  const bool is_small = part.placements.size() == 1 && part.patches[0].triangles.size() <= kMaxBackTriangles;
  if (!is_small) remarks.push_back("the elements are not shown, because there are too many");
  return geometry::curved_boundary(is_small ? part : with_plane_back(part), *model.entrance, error_mm).mesh;
}

/// Sequence of events along a path and of the facets on which they happen. Paths with equal sequences are of one kind.
using EventSequence = std::vector<std::pair<raytrace::PathEvent, geometry::FacetRole>>;

EventSequence story_of(const raytrace::LightPath& path) {
  EventSequence story;
  for (const raytrace::PathStep& step : path.steps) story.emplace_back(step.event, step.role);
  return story;
}

raytrace::Illumination illumination_of(const SceneLight& light) {
  raytrace::Illumination from;
  from.incidence = Angle::from_deg(light.incidence_deg);
  from.azimuth = Angle::from_deg(light.azimuth_deg);
  return from;
}

}  // namespace

DesignExcerpt::DesignExcerpt(const design::Design& design, const materials::MaterialLibrary& library, double elements)
    : design_thickness_mm_(design.thickness_mm()), cone_deg_(design.detector.acceptance_half_angle_deg.back()) {
  FewElements few = few_elements(design, elements);
  model_ = design::make_model(few.design, library);
  remarks_ = std::move(few.remarks);
  if (design_thickness_mm_ == 0.0) design_thickness_mm_ = model_.part.thickness_mm;
  mesh_ = model_.entrance ? boundary_of_curved_part(model_, remarks_) : boundary_of_part(model_.part);
  if (!model_.entrance && mesh_.triangles.size() > kMaxTriangles) {
    mesh_.triangles.resize(kMaxTriangles);
    mesh_.roles.resize(kMaxTriangles);
    remarks_.push_back("only a part of the mesh is shown");
  }
  edges_ = sharp_edges(mesh_);
  centre_mm_ = geometry::bounding_box(model_.part.outline).centre();
  surface_.emplace(model_.part, centre_mm_);
  if (model_.entrance) entrance_face_ = raytrace::make_entrance_face(*model_.entrance, model_.part, centre_mm_);
  if (few.is_cut && !design.part().substrate) find_lattice(design.part(), few.design.part());
}

void DesignExcerpt::find_lattice(const geometry::PartSpec& whole, const geometry::PartSpec& piece) {
  const geometry::ArraySheet of_whole(whole);
  const geometry::ArraySheet of_piece(piece);
  lattice_ = {of_piece.anchor_mm - of_whole.anchor_mm, of_piece.lattice.period_mm};
}

geometry::Vec2 DesignExcerpt::equivalent_position(const geometry::Vec2& at_mm) const {
  if (!lattice_) return at_mm;
  const geometry::Vec2 at = at_mm + lattice_->from_design_mm;
  const geometry::Vec2 periods = (centre_mm_ - at).cwiseQuotient(lattice_->period_mm).array().round();
  return at + periods.cwiseProduct(lattice_->period_mm);
}

geometry::Vec2 DesignExcerpt::entry_of(const SceneLight& light, const geometry::Vec2& at_mm) const {
  const raytrace::LightSetup setup(model_.part, centre_mm_, model_.optics, illumination_of(light), {cone_deg_});
  const geometry::Vec3& direction = setup.entry.direction;
  const geometry::Vec2 drift = direction.head<2>() / -direction.z();  // horizontal distance per depth
  return equivalent_position(at_mm + design_thickness_mm_ * drift) - model_.part.thickness_mm * drift;
}

raytrace::LightPath DesignExcerpt::path(const SceneLight& light, const geometry::Vec2& entry_mm) const {
  const auto first_hit = [this](const raytrace::SurfaceRay& ray) { return surface_->first_hit(ray); };
  return raytrace::strongest_path(model_.part, first_hit, centre_mm_, model_.optics, illumination_of(light), cone_deg_,
                                  entry_mm, entrance_face_.get());
}

std::vector<ScenePath> DesignExcerpt::typical_paths(const SceneLight& light) const {
  const geometry::Rectangle box = geometry::bounding_box(model_.part.outline);
  const geometry::Vec2 window = box.size().cwiseMin(geometry::Vec2::Constant(model_.part.size_mm));
  std::map<EventSequence, std::vector<raytrace::LightPath>> stories;
  std::size_t count = 0;
  for (int j = 0; j < kGrid; ++j)
    for (int i = 0; i < kGrid; ++i) {
      // The grid points are shifted off the lines of symmetry, because light on these lines would hit edges.
      const geometry::Vec2 at((i + 0.43) / kGrid - 0.5, (j + 0.47) / kGrid - 0.5);
      const geometry::Vec2 entry = centre_mm_ + at.cwiseProduct(window);
      if (!model_.part.period_mm && !geometry::contains(model_.part.outline, entry, 0.0)) continue;
      ++count;
      raytrace::LightPath path = this->path(light, entry);
      stories[story_of(path)].push_back(std::move(path));
    }
  std::vector<std::vector<raytrace::LightPath>> found;
  for (auto& [story, paths] : stories) found.push_back(std::move(paths));
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<ScenePath> chosen;
  for (std::size_t k = 0; k < std::min(found.size(), kPathsEach); ++k)
    chosen.push_back({found[k][found[k].size() / 3], light.incidence_deg, light.azimuth_deg,
                      static_cast<double>(found[k].size()) / static_cast<double>(count)});
  return chosen;
}

}  // namespace retrace::studies

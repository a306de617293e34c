#include "studies/closed_loop/part_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <system_error>

#include "design/io/design_reader.h"
#include "fabrication/job/substrate_cells.h"
#include "geometry/elements/element_cells.h"
#include "geometry/outline/plan_region.h"

namespace retrace::studies {
namespace {

namespace fs = std::filesystem;
using namespace fabrication;
using geometry::Vec3;

/// Transforms points of a mould's blank to the frame of the part that is moulded in it.
class PartFrame {
 public:
  explicit PartFrame(const Job& job) : scale_(1.0 / blank_scale(job.workpiece)) {
    const geometry::Vec2 extent_w = scale_ * blank_extent_mm(job);
    corner_ = {0.5 * extent_w.y(), 0.5 * extent_w.x(), 0.0};
  }
  Vec3 point(const Vec3& p) const { return corner_ + scale_ * direction(p); }
  static Vec3 direction(const Vec3& d) { return {-d.y(), d.x(), d.z()}; }

 private:
  double scale_ = 1.0;
  Vec3 corner_ = Vec3::Zero();
};

/// Returns a plane in the part frame, with its height at `centre`.
geometry::HeightPlane height_plane(const PartFrame& frame, const CutPlane& cut, const geometry::Vec2& centre) {
  const Vec3 normal = PartFrame::direction(cut.normal);
  const Vec3 point = frame.point(cut.point_mm);
  geometry::HeightPlane plane;
  plane.slope = -normal.head<2>() / normal.z();
  plane.height_mm = point.z() + plane.slope.dot(centre - point.head<2>());
  return plane;
}

/// Returns the planes of an element. The height of each plane is given at the centre of the element's aperture, which
/// is on the blank's face or on its base.
geometry::ElementPlanes planes_of(const PartFrame& frame, const CutElement& element, const ElementCutPlanes& cuts,
                                  bool is_prism) {
  geometry::ElementPlanes planes;
  planes.centre_mm = frame.point(element.origin_mm).head<2>();
  planes.planes.resize(cuts.size());
  for (std::size_t f = 0; f < cuts.size(); ++f) {
    const geometry::HeightPlane plane = height_plane(frame, cuts[f], planes.centre_mm);
    planes.planes[!is_prism ? f : plane.slope[element.rotated ? 1 : 0] < 0.0 ? 0U : 1U] = plane;
  }
  return planes;
}

}  // namespace

design::Substance MachinedBody::substance() const {
  design::Substance substance;
  substance.material = material;
  substance.catalogue = catalogue;
  substance.refractive_index = refractive_index;
  substance.temperature_c = temperature_c;
  substance.absorption_per_mm = absorption_per_mm;
  return substance;
}

std::optional<design::Design> design_of_job(const Job& job, const fs::path& job_file) {
  const fs::path file = job_file.parent_path() / job.design;
  std::error_code error;
  if (job.design.empty() || !fs::is_regular_file(file, error)) return std::nullopt;
  return design::read_design(file);
}

MachinedBody machined_body(const Job& job, const fs::path& job_file, Warnings& warnings) {
  if (const std::optional<design::Design> design = design_of_job(job, job_file))
    return {design->thickness_mm(),
            design->substance.material,
            design::with_absolute_path(design->substance.catalogue),
            design->substance.refractive_index,
            design->substance.temperature_c,
            design->substance.absorption_per_mm};
  warnings.push_back(
      {"design_not_found",
       "the job's design does not exist at the path that the job gives: the as-machined part is described with a "
       "plate of 2 mm of PMMA"});
  return {};
}

namespace {

/// Returns true if the borders of two outlines are equal apart from rounding errors.
bool has_same_borders(const geometry::PlanRegion& a, const geometry::PlanRegion& b) {
  constexpr double kSameFraction = 1e-9;
  const double near_mm = kSameFraction * a.box_mm.size().norm();
  const auto is_near = [&](const geometry::Vec2& p, const geometry::Vec2& q) { return (p - q).norm() <= near_mm; };
  return std::ranges::equal(a.whole.borders, b.whole.borders, [&](const auto& one, const auto& other) {
    return std::ranges::equal(one, other, is_near);
  });
}

}  // namespace

design::OutlineKeys outline_of_job(const Job& job, const fs::path& job_file) {
  const geometry::PlanRegion& plan = *job.array.outline;
  const std::optional<design::Design> design = design_of_job(job, job_file);
  const design::ElementArray* const array = design ? design->elements() : nullptr;
  if (array != nullptr && array->part.array.outline && has_same_borders(*array->part.array.outline, plan))
    return design::with_absolute_path(array->outline);
  for (std::size_t k = 1; k < plan.outline.loops.size(); ++k)
    if (!geometry::is_circle(plan.outline.loops[k]))
      throw InputError(
          Field{"as_machined"},
          "a design can contain holes that are not round only as a DXF file, which is taken from the job's "
          "design, but the design does not exist at the path that the job gives, or has another outline");
  return {};
}

geometry::PartSpec machined_elements(const Job& job, bool has_planes) {
  geometry::PartSpec part = part_on_substrate(job);
  // Margins of a design are flat, but the machined cavities of cube corners extend into them. If cube corners have
  // individual facet planes, cells of the array therefore cover the margins as well. The table of planes determines
  // which cells are elements, and which are land with cuts of neighbouring cavities.
  if (!has_planes || cuts_prisms(job)) {
    part.array.x_offset_mm = job.array.x_offset_mm;
    part.array.y_offset_mm = job.array.y_offset_mm;
  } else if (part.array.outline) {
    part.array.x_offset_mm = part.array.y_offset_mm = 0.0;
    part.array.outline = std::make_shared<const geometry::PlanRegion>(geometry::without_margin(*part.array.outline));
  }
  if (cuts_prisms(job) && !job.substrate && !part.array.outline &&
      part.array.arrangement != geometry::Arrangement::offset)
    part.array.partial_elements = geometry::PartialElements::cut;
  return part;
}

geometry::FacetPlanes part_planes(const Job& job, const std::vector<ElementCutPlanes>& elements) {
  const std::vector<CutElement> places = cut_elements(job);
  const PartFrame frame(job);
  std::vector<geometry::ElementPlanes> planes;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!elements[i].empty()) planes.push_back(planes_of(frame, places[i], elements[i], cuts_prisms(job)));
  if (cuts_prisms(job)) return {std::move(planes), std::min(prism_of(job).base_mm, prism_of(job).width_mm)};
  if (const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&job.element))
    geometry::add_flares(planes, 0.5 * hexagonal->aperture_mm);
  return {std::move(planes), geometry::cube_spacing_mm(job.element)};
}

}  // namespace retrace::studies

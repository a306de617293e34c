#include "fabrication/job/job.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "fabrication/job/substrate_cells.h"
#include "fabrication/job/zone_cells.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/whole_elements.h"
#include "geometry/outline/plan_region.h"

namespace retrace::fabrication {
double blank_scale(const Workpiece& workpiece) {
  return 1.0 + 0.01 * workpiece.shrinkage_percent;
}

InputLocation Job::where(std::string_view key) const {
  return document ? document->where(key) : InputLocation{source, 0, std::string(key)};
}

JobOutline job_outline(const geometry::PlanRegion& plan) {
  JobOutline outline{plan.tolerance_mm, {}};
  for (const geometry::OutlineLoop& loop : plan.outline.loops) outline.borders.push_back({loop});
  return outline;
}

geometry::PlanRegion plan_of_outline(const Job& job, std::optional<geometry::OutlineFault>& fault) {
  std::vector<geometry::OutlineLoop> loops;
  for (const JobBorder& border : job.outline->borders) loops.push_back(border.sides);
  return geometry::plan_region(geometry::oriented(std::move(loops)), job.array.x_offset_mm, job.outline->tolerance_mm,
                               fault);
}

bool cuts_prisms(const Job& job) {
  return std::holds_alternative<geometry::RtpElement>(job.element);
}

bool has_finishing_cuts(const Job& job) {
  return job.strategy == Strategy::two_step || job.strategy == Strategy::dmc;
}

const geometry::RtpElement& prism_of(const Job& job) {
  const auto* const prism = std::get_if<geometry::RtpElement>(&job.element);
  if (prism == nullptr) throw InputError(job.where("element.kind"), "must be \"rtp\"");
  return *prism;
}

geometry::RtpElement& prism_of(Job& job) {
  return const_cast<geometry::RtpElement&>(prism_of(std::as_const(job)));
}

std::size_t zone_count(const Job& job) {
  return std::max<std::size_t>(1, job.zones.size());
}

geometry::Element blank_element(const Job& job, std::size_t zone) {
  const auto aperture_mm = [&](double own_mm) {
    return blank_scale(job.workpiece) * (job.zones.empty() ? own_mm : job.zones[zone].aperture_mm.value_or(own_mm));
  };
  if (const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&job.element))
    return geometry::HexagonalCube{aperture_mm(hexagonal->aperture_mm), {}};
  if (const auto* const triangular = std::get_if<geometry::TriangularCube>(&job.element))
    return geometry::TriangularCube{aperture_mm(triangular->aperture_mm), {}};
  return blank_prism(job);
}

geometry::AngleErrors angle_errors_of(const Job& job, std::size_t zone) {
  geometry::AngleErrors errors = job.angle_errors;
  if (job.zones.empty()) return errors;
  const CutZone& own = job.zones[zone];
  errors.dihedral_error_arcmin = own.dihedral_error_arcmin.value_or(errors.dihedral_error_arcmin);
  errors.facet_tilt_arcmin = own.facet_tilt_arcmin.value_or(errors.facet_tilt_arcmin);
  return errors;
}

geometry::RtpElement blank_prism(const Job& job) {
  geometry::RtpElement element = prism_of(job);
  element.base_mm *= blank_scale(job.workpiece);
  element.width_mm *= blank_scale(job.workpiece);
  return element;
}

geometry::Vec2 blank_extent_mm(const Job& job) {
  geometry::Vec2 part_mm(job.array.x_length_mm, job.array.y_length_mm);
  if (job.array.arrangement == geometry::Arrangement::single) {
    const geometry::Rectangle box = geometry::bounding_box(geometry::aperture_outline(job.element));
    part_mm = box.upper - box.lower;
  }
  return blank_scale(job.workpiece) * geometry::Vec2(part_mm.y(), part_mm.x());
}

namespace {

/// Returns the elements of an array on a flat blank. For a workpiece that is cut directly, the array is mirrored and
/// the columns are counted from the opposite side.
std::vector<CutElement> cut_flat(const Job& job) {
  const bool is_mirrored = job.workpiece.kind == WorkpieceKind::direct;
  const double scale = blank_scale(job.workpiece);
  const auto cut = [&](const geometry::WholeElement& at, std::int32_t column) {
    CutElement element;
    element.centre_mm = scale * geometry::Vec2(at.centre_mm.y(), is_mirrored ? at.centre_mm.x() : -at.centre_mm.x());
    element.row = at.row;
    element.column = column;
    element.rotated = at.is_rotated;
    return element;
  };
  const std::vector<geometry::WholeElement> whole = geometry::whole_elements(job.array, job.element);
  std::vector<CutElement> elements;
  elements.reserve(whole.size());
  for (std::size_t first = 0, end = 0; first < whole.size(); first = end) {
    while (end < whole.size() && whole[end].row == whole[first].row) ++end;
    for (std::size_t k = first; k < end; ++k) {
      const geometry::WholeElement& at = whole[is_mirrored ? first + end - 1 - k : k];
      if (at.is_there) elements.push_back(cut(at, static_cast<std::int32_t>(k - first)));
    }
  }
  return elements;
}

}  // namespace

std::vector<CutElement> cut_elements(const Job& job) {
  if (job.substrate) return elements_on_substrate(job);
  std::vector<CutElement> elements = job.zones.empty() ? cut_flat(job) : elements_of_zones(job);
  for (CutElement& element : elements) element.origin_mm = {element.centre_mm.x(), element.centre_mm.y(), 0.0};
  return elements;
}

}  // namespace retrace::fabrication

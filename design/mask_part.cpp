#include "design/mask_part.h"

#include <algorithm>
#include <vector>

#include "geometry/elements/whole_elements.h"
#include "geometry/io/mask_image.h"

namespace retrace::design {
namespace {

using geometry::PartSpec;
using geometry::RtpElement;
using geometry::Vec2;

/// Returns the planes of the nominal element whose lower left corner is at `corner`.
geometry::ElementPlanes element_at(const PartSpec& spec, const Vec2& corner, bool rotated) {
  const auto& element = std::get<RtpElement>(spec.element);
  const geometry::Cell cell = geometry::rtp_cell(element, spec.angle_errors, corner, rotated);
  geometry::ElementPlanes planes;
  planes.centre_mm = corner + 0.5 * Vec2(element.base_mm, element.width_mm);
  for (const std::size_t k : {0U, 1U}) {
    planes.planes[k] = cell.facets[k].plane;
    planes.planes[k].height_mm += planes.planes[k].slope.dot(planes.centre_mm);
  }
  return planes;
}

}  // namespace

geometry::FacetPlanes elements_of_mask(const Design& design) {
  const PartSpec& spec = design.part();
  if (spec.random_tilts.sigma_arcmin > 0.0)
    throw InputError(design.where("array.mask"), "not allowed together with surface.angle_error_sigma_arcmin");
  const auto& element = std::get<RtpElement>(spec.element);
  geometry::ArrayLayout array = spec.array;
  const geometry::PrismBlock block = geometry::prism_block(array, element);
  array.pattern =
      geometry::mask_pattern(design.mask()->file, design.mask()->threshold, block.counts, design.where("array.mask"));
  std::vector<geometry::ElementPlanes> elements;
  for (const geometry::WholeElement& at : geometry::whole_elements(array, spec.element))
    if (at.is_there) elements.push_back(element_at(spec, block.corner_mm(at.row, at.column), at.is_rotated));
  if (elements.empty()) throw InputError(design.where("array.mask"), "the mask leaves no whole element");
  return {std::move(elements), std::min(element.base_mm, element.width_mm)};
}

}  // namespace retrace::design

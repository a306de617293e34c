#include "studies/design/mask_part.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fabrication/job/io/mask_image.h"

namespace retrace::studies {
namespace {

using geometry::PartSpec;
using geometry::RtpElement;
using geometry::Vec2;

// Lengths this close (relative) to a whole number of elements are whole.
constexpr double kWhole = 1e-9;

std::int64_t whole_count(double length_mm, double offset_mm, double gap_mm, double size_mm) {
  const double count = (length_mm - 2.0 * offset_mm + gap_mm) / (size_mm + gap_mm);
  return static_cast<std::int64_t>(std::floor(count + kWhole * std::max(1.0, count)));
}

bool is_shifted(const PartSpec& spec, std::int64_t row, std::int64_t rows) {
  if (spec.arrangement != geometry::Arrangement::offset || rows < 2) return false;
  return ((row + 1) % 2 == 1) == (spec.shifted_rows == geometry::RowParity::odd);
}

/// The nominal element with its lower left corner there.
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
  const fabrication::CellCounts cells{whole_count(spec.x_length_mm, spec.x_offset_mm, spec.x_gap_mm, element.base_mm),
                                      whole_count(spec.y_length_mm, spec.y_offset_mm, spec.y_gap_mm, element.width_mm)};
  const std::vector<std::string> pattern =
      fabrication::mask_pattern(design.mask()->file, design.mask()->threshold, cells, design.where("array.mask"));
  const Vec2 gap(spec.x_gap_mm, spec.y_gap_mm);
  const Vec2 pitch = Vec2(element.base_mm, element.width_mm) + gap;
  const Vec2 filled =
      pitch.cwiseProduct(Vec2(static_cast<double>(cells.columns), static_cast<double>(cells.rows))) - gap;
  const Vec2 first = 0.5 * (Vec2(spec.x_length_mm, spec.y_length_mm) - filled);
  std::vector<geometry::ElementPlanes> elements;
  for (std::int64_t row = 0; row < cells.rows; ++row) {
    const double shift_mm = is_shifted(spec, row, cells.rows) ? 0.01 * spec.overlap_percent * element.base_mm : 0.0;
    const std::int64_t whole = shift_mm > 0.0 ? cells.columns - 1 : cells.columns;
    for (std::int64_t column = 0; column < whole; ++column) {
      // Row 0 of the picture is that of the largest y.
      if (pattern[static_cast<std::size_t>(cells.rows - 1 - row)][static_cast<std::size_t>(column)] != '#') continue;
      const Vec2 corner =
          first + Vec2(shift_mm, 0.0) + pitch.cwiseProduct(Vec2(static_cast<double>(column), static_cast<double>(row)));
      const bool rotated = spec.arrangement == geometry::Arrangement::checker && (row + column) % 2 == 1;
      elements.push_back(element_at(spec, corner, rotated));
    }
  }
  if (elements.empty()) throw InputError(design.where("array.mask"), "leaves no whole element");
  return {std::move(elements), std::min(element.base_mm, element.width_mm)};
}

}  // namespace retrace::studies

#include "studies/drawing/array_figures.h"
#include "core/overloaded.h"
#include "geometry/elements/ruled_pattern.h"
#include "geometry/elements/whole_elements.h"

#include <cmath>
#include <optional>

namespace retrace::studies {
namespace {

using geometry::Arrangement, geometry::Extent, geometry::Part, geometry::PartSpec, geometry::Rectangle,
    geometry::RtpElement, geometry::Vec2;

Rectangle extent_of(const Part& part) {
  if (part.period_mm) return {Vec2::Zero(), *part.period_mm};
  return geometry::bounding_box(part.outline);
}

/// Returns the corner of the whole element that is nearest to the origin, for a finite part in which elements are
/// missing.
std::optional<Vec2> first_element_there(const Part& part, const Vec2& size) {
  std::optional<Vec2> first;
  for (const geometry::Placement& placement : part.placements) {
    const geometry::SurfacePatch& patch = part.patches[placement.patch];
    for (const geometry::PatchCell& cell : patch.cells) {
      const bool is_element = patch.facets[cell.first_facet].role == geometry::FacetRole::retro_facet;
      const Vec2 lower = cell.lower.head<2>() + placement.offset_mm;
      const bool is_whole = ((cell.upper - cell.lower).head<2>() - size).cwiseAbs().maxCoeff() < 1e-6 * size.maxCoeff();
      if (!is_element || !is_whole) continue;
      if (!first || lower.y() < first->y() - 1e-6 * size.y() ||
          (lower.y() < first->y() + 1e-6 * size.y() && lower.x() < first->x()))
        first = lower;
    }
  }
  return first;
}

void measure_prisms(ArrayFigures& a, const design::Design& design, const Part& part) {
  const PartSpec& spec = part.spec;
  const auto& element = std::get<RtpElement>(spec.element);
  geometry::PrismBlock block = geometry::prism_block(spec.array, element);
  a.size_mm = {element.base_mm, element.width_mm};
  a.pitch_mm = block.pitch_mm;
  a.block_mm = a.extent_mm;
  if (spec.array.extent == Extent::infinite) {
    a.count = {INFINITY, INFINITY};
    if (spec.array.arrangement == Arrangement::offset)
      block.shift_mm = 0.01 * spec.array.overlap_percent * element.base_mm;
  } else if (spec.array.arrangement != Arrangement::single) {
    a.count = {static_cast<double>(block.counts.columns), static_cast<double>(block.counts.rows)};
    a.block_mm = geometry::moved(block.filled, a.extent_mm.lower);
  }
  a.shift_mm = block.shift_mm;
  a.element_is_shifted = block.is_shifted(0);
  a.element_mm = a.block_mm.lower + Vec2(a.element_is_shifted ? a.shift_mm : 0.0, 0.0);
  if (design.mask() || design.facet_planes() || spec.array.outline)
    if (const auto there = first_element_there(part, a.size_mm)) {
      a.element_mm = *there;
      a.element_is_shifted = block.is_shifted(std::llround((there->y() - a.block_mm.lower.y()) / a.pitch_mm.y()));
    }
  a.root_mm = a.element_mm + 0.5 * a.size_mm;
}

void measure_cubes(ArrayFigures& a, const Part& part) {
  const PartSpec& spec = part.spec;
  const Rectangle box = geometry::bounding_box(geometry::element_cell(spec.element).outline);
  a.aperture_mm = std::visit(
      Overloaded{[](const geometry::RtpElement&) { return 0.0; },
                 [](const geometry::RoundCube& cube) { return cube.diameter_mm; },
                 [](const geometry::RuledCells& ruled) { return geometry::aperture_of_mean_cell_mm(*ruled.pattern); },
                 [](const auto& cube) { return cube.aperture_mm; }},
      spec.element);
  a.size_mm = box.size();
  a.pitch_mm = 0.5 * a.aperture_mm * Vec2(3.0, std::sqrt(3.0));
  a.block_mm = a.extent_mm;
  const Vec2 margin(spec.array.x_offset_mm, spec.array.y_offset_mm);
  a.has_neighbours = true;
  if (spec.array.arrangement == Arrangement::single) {
    a.element_mm = a.extent_mm.lower - box.lower;
  } else if (spec.array.extent == Extent::finite) {
    a.block_mm = {a.extent_mm.lower + margin, a.extent_mm.upper - margin};
    a.element_mm = a.extent_mm.centre();
    a.count = a.block_mm.size().cwiseQuotient(a.size_mm);
    a.has_neighbours = (a.element_mm + a.pitch_mm).x() < a.block_mm.upper.x();
  } else {
    a.count = {INFINITY, INFINITY};
  }
  a.root_mm = a.element_mm;
}

}  // namespace

ArrayFigures array_figures(const design::Design& design, const Part& part) {
  ArrayFigures a;
  a.extent_mm = extent_of(part);
  if (!design.elements()) {
    a.block_mm = a.extent_mm;
    a.size_mm = a.extent_mm.size();
    a.root_mm = a.extent_mm.centre();
  } else if (std::holds_alternative<RtpElement>(part.spec.element)) {
    measure_prisms(a, design, part);
  } else {
    measure_cubes(a, part);
  }
  a.section_y_mm = a.root_mm.y();
  return a;
}

}  // namespace retrace::studies

#include "fabrication/job/job.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "fabrication/job/cube_cells.h"
#include "fabrication/job/substrate_cells.h"
#include "geometry/elements/lattice.h"

namespace retrace::fabrication {
namespace {

/// Lengths this close (relative) to a whole number of elements are whole, as in a design.
constexpr double kWholeTolerance = 1e-9;

std::int64_t whole_count(double length_mm, double offset_mm, double gap_mm, double size_mm) {
  const double count = (length_mm - 2.0 * offset_mm + gap_mm) / (size_mm + gap_mm);
  return static_cast<std::int64_t>(std::floor(count + kWholeTolerance * std::max(1.0, count)));
}

bool is_shifted(const Array& array, std::int64_t row, std::int64_t rows) {
  if (array.arrangement != geometry::Arrangement::offset || rows < 2 || array.overlap_percent <= 0.0) return false;
  // Rows count from 1 where their parity is named.
  return ((row + 1) % 2 == 1) == (array.shifted_rows == geometry::RowParity::odd);
}

bool is_cut(const Array& array, std::int64_t row, std::int64_t column, std::int64_t rows) {
  if (array.pattern.empty()) return true;
  return array.pattern[static_cast<std::size_t>(rows - 1 - row)][static_cast<std::size_t>(column)] == '#';
}

}  // namespace

CellCounts cell_counts(const Array& array, const geometry::RtpElement& element) {
  if (array.arrangement == geometry::Arrangement::single) return {1, 1};
  return {whole_count(array.x_length_mm, array.x_offset_mm, array.x_gap_mm, element.base_mm),
          whole_count(array.y_length_mm, array.y_offset_mm, array.y_gap_mm, element.width_mm)};
}

double blank_scale(const Workpiece& workpiece) {
  return 1.0 + 0.01 * workpiece.shrinkage_percent;
}

const geometry::RtpElement& prism_of(const Job& job) {
  const auto* const prism = std::get_if<geometry::RtpElement>(&job.element);
  if (prism == nullptr) throw InputError({job.source, 0, "element.kind"}, "must be \"rtp\" for this");
  return *prism;
}

geometry::RtpElement& prism_of(Job& job) {
  return const_cast<geometry::RtpElement&>(prism_of(std::as_const(job)));
}

geometry::Element blank_element(const Job& job) {
  if (const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&job.element))
    return geometry::HexagonalCube{blank_scale(job.workpiece) * hexagonal->aperture_mm, {}};
  if (const auto* const triangular = std::get_if<geometry::TriangularCube>(&job.element))
    return geometry::TriangularCube{blank_scale(job.workpiece) * triangular->aperture_mm, {}};
  return blank_prism(job);
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

std::vector<CutElement> cut_prisms(const Job& job) {
  const Array& array = job.array;
  const geometry::RtpElement& prism = prism_of(job);
  const auto [columns, rows] = cell_counts(array, prism);
  const double x_pitch_mm = prism.base_mm + array.x_gap_mm;
  const double y_pitch_mm = prism.width_mm + array.y_gap_mm;
  // The block is centred, and so is the workpiece frame.
  const double x_first_mm = -0.5 * x_pitch_mm * static_cast<double>(columns - 1);
  const double y_first_mm = -0.5 * y_pitch_mm * static_cast<double>(rows - 1);
  const bool mirrored = job.workpiece.kind == WorkpieceKind::direct;
  const double scale = blank_scale(job.workpiece);
  std::vector<CutElement> elements;
  for (std::int64_t row = 0; row < rows; ++row) {
    const bool shifted = is_shifted(array, row, rows);
    const double shift_mm = shifted ? 0.01 * array.overlap_percent * prism.base_mm : 0.0;
    const std::int64_t whole = shifted ? columns - 1 : columns;
    for (std::int64_t k = 0; k < whole; ++k) {
      const std::int64_t column = mirrored ? whole - 1 - k : k;
      if (!is_cut(array, row, column, rows)) continue;
      const double x_mm = x_first_mm + shift_mm + x_pitch_mm * static_cast<double>(column);
      const double y_mm = y_first_mm + y_pitch_mm * static_cast<double>(row);
      CutElement element;
      element.centre_mm = scale * geometry::Vec2(y_mm, mirrored ? x_mm : -x_mm);
      element.row = static_cast<std::int32_t>(row);
      element.column = static_cast<std::int32_t>(k);
      element.rotated = array.arrangement == geometry::Arrangement::checker && (row + column) % 2 == 1;
      elements.push_back(element);
    }
  }
  return elements;
}

std::vector<CutElement> cut_cubes(const Job& job) {
  const double scale = blank_scale(job.workpiece);
  std::vector<CutElement> elements;
  for (const CubeCell& cell : cube_cells(job.array, job.element)) {
    if (!cell.is_cut) continue;
    CutElement element;
    element.centre_mm = scale * geometry::Vec2(cell.centre_mm.y(), -cell.centre_mm.x());
    element.row = cell.row;
    element.column = cell.column;
    element.rotated = cell.rotated;
    elements.push_back(element);
  }
  return elements;
}

}  // namespace

std::vector<CutElement> cut_elements(const Job& job) {
  if (job.substrate) return elements_on_substrate(job);
  std::vector<CutElement> elements =
      std::holds_alternative<geometry::RtpElement>(job.element) ? cut_prisms(job) : cut_cubes(job);
  for (CutElement& element : elements) element.foot_mm = {element.centre_mm.x(), element.centre_mm.y(), 0.0};
  return elements;
}

}  // namespace retrace::fabrication

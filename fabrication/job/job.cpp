#include "fabrication/job/job.h"

#include <algorithm>
#include <cmath>

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

geometry::RtpElement blank_element(const Job& job) {
  geometry::RtpElement element = job.element;
  element.base_mm *= blank_scale(job.workpiece);
  element.width_mm *= blank_scale(job.workpiece);
  return element;
}

geometry::Vec2 blank_extent_mm(const Job& job) {
  const bool single = job.array.arrangement == geometry::Arrangement::single;
  const double x_mm = single ? job.element.base_mm : job.array.x_length_mm;
  const double y_mm = single ? job.element.width_mm : job.array.y_length_mm;
  return blank_scale(job.workpiece) * geometry::Vec2(y_mm, x_mm);
}

std::vector<CutElement> cut_elements(const Job& job) {
  const Array& array = job.array;
  const auto [columns, rows] = cell_counts(array, job.element);
  const double x_pitch_mm = job.element.base_mm + array.x_gap_mm;
  const double y_pitch_mm = job.element.width_mm + array.y_gap_mm;
  // The block is centred, and so is the workpiece frame.
  const double x_first_mm = -0.5 * x_pitch_mm * static_cast<double>(columns - 1);
  const double y_first_mm = -0.5 * y_pitch_mm * static_cast<double>(rows - 1);
  const bool mirrored = job.workpiece.kind == WorkpieceKind::direct;
  const double scale = blank_scale(job.workpiece);
  std::vector<CutElement> elements;
  for (std::int64_t row = 0; row < rows; ++row) {
    const bool shifted = is_shifted(array, row, rows);
    const double shift_mm = shifted ? 0.01 * array.overlap_percent * job.element.base_mm : 0.0;
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
      element.turned = array.arrangement == geometry::Arrangement::checker && (row + column) % 2 == 1;
      elements.push_back(element);
    }
  }
  return elements;
}

}  // namespace retrace::fabrication

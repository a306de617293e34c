#include "fabrication/job/cube_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/elements/lattice.h"

namespace retrace::fabrication {
namespace {

using geometry::Vec2;

/// Apertures that cross the border by less than this share of their size lie within it, as in a design.
constexpr double kCubeTolerance = 1e-9;

double aperture_mm(const geometry::Element& element) {
  if (const auto* const hexagonal = std::get_if<geometry::HexagonalCube>(&element)) return hexagonal->aperture_mm;
  return std::get<geometry::TriangularCube>(element).aperture_mm;
}

/// Box of an aperture round its apex, unturned.
geometry::Rectangle box_of(const geometry::Element& element) {
  return geometry::bounding_box(geometry::element_cell(element).outline);
}

/// Finds the whole cells of a tiling. Both tilings repeat with (3 R, sqrt(3) R), R the radius of the aperture.
class Finder {
 public:
  Finder(const Array& array, const geometry::Element& element)
      : element_(element),
        box_(box_of(element)),
        half_period_mm_(0.25 * aperture_mm(element) * Vec2(3.0, std::numbers::sqrt3)) {
    half_block_mm_ = 0.5 * Vec2(array.x_length_mm, array.y_length_mm) - Vec2(array.x_offset_mm, array.y_offset_mm) +
                     Vec2::Constant(kCubeTolerance * aperture_mm(element));
  }

  std::vector<CubeCell> run() {
    const auto rows = static_cast<std::int64_t>(std::ceil(half_block_mm_.y() / half_period_mm_.y()));
    const auto columns = static_cast<std::int64_t>(std::ceil(half_block_mm_.x() / half_period_mm_.x()));
    const bool is_triangular = std::holds_alternative<geometry::TriangularCube>(element_);
    for (std::int64_t row = -rows; row <= rows; ++row) {
      const std::size_t before = cells_.size();
      for (std::int64_t column = -columns - 1; column <= columns + 1; ++column) {
        if ((row + column) % 2 != 0) continue;
        const Vec2 apex(static_cast<double>(column) * half_period_mm_.x(),
                        static_cast<double>(row) * half_period_mm_.y());
        if (is_triangular) add(apex - Vec2(0.5 * aperture_mm(element_), 0.0), true);
        add(apex, false);
      }
      number_row(before);
    }
    return std::move(cells_);
  }

 private:
  void add(const Vec2& apex, bool rotated) {
    const Vec2 low = rotated ? Vec2(apex - box_.upper) : Vec2(apex + box_.lower);
    const Vec2 high = rotated ? Vec2(apex - box_.lower) : Vec2(apex + box_.upper);
    if ((low.array() < -half_block_mm_.array()).any() || (high.array() > half_block_mm_.array()).any()) return;
    cells_.push_back({apex, rows_, 0, rotated, true});
  }

  void number_row(std::size_t first) {
    if (first == cells_.size()) return;
    for (std::size_t k = first; k < cells_.size(); ++k) cells_[k].column = static_cast<std::int32_t>(k - first);
    ++rows_;
  }

  const geometry::Element& element_;
  geometry::Rectangle box_;
  Vec2 half_period_mm_;
  Vec2 half_block_mm_ = Vec2::Zero();
  std::vector<CubeCell> cells_;
  std::int32_t rows_ = 0;
};

std::vector<CubeCell> whole_cells(const Array& array, const geometry::Element& element) {
  if (array.arrangement != geometry::Arrangement::single) return Finder(array, element).run();
  const geometry::Rectangle box = box_of(element);
  return {CubeCell{-0.5 * (box.lower + box.upper), 0, 0, false, true}};
}

}  // namespace

std::vector<CubeCell> cube_cells(const Array& array, const geometry::Element& element) {
  std::vector<CubeCell> cells = whole_cells(array, element);
  if (array.pattern.empty()) return cells;
  for (CubeCell& cell : cells) {
    const std::string& row = array.pattern[array.pattern.size() - 1 - static_cast<std::size_t>(cell.row)];
    cell.is_cut = row[static_cast<std::size_t>(cell.column)] == '#';
  }
  return cells;
}

std::vector<std::int64_t> cube_row_lengths(const Array& array, const geometry::Element& element) {
  std::vector<std::int64_t> lengths;
  for (const CubeCell& cell : whole_cells(array, element)) {
    lengths.resize(static_cast<std::size_t>(cell.row) + 1);
    ++lengths.back();
  }
  return lengths;
}

double cube_cell_estimate(const Array& array, const geometry::Element& element) {
  return array.x_length_mm * array.y_length_mm / geometry::area(geometry::element_cell(element).outline);
}

}  // namespace retrace::fabrication

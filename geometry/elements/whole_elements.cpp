#include "geometry/elements/whole_elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/elements/element_cells.h"

namespace retrace::geometry {
namespace {

/// What crosses the border by less than this share of its size lies within it.
constexpr double kWholeShare = 1e-9;

double aperture_mm(const Element& element) {
  if (const auto* const hexagonal = std::get_if<HexagonalCube>(&element)) return hexagonal->aperture_mm;
  return std::get<TriangularCube>(element).aperture_mm;
}

/// Finds the whole cells of a tiling of cube corners. Both tilings repeat with (3 R, sqrt(3) R), R the radius of the
/// aperture.
class CubeFinder {
 public:
  CubeFinder(const ArrayLayout& array, const Element& element)
      : is_triangular_(std::holds_alternative<TriangularCube>(element)),
        radius_mm_(0.5 * aperture_mm(element)),
        box_(bounding_box(element_cell(element).outline)),
        half_period_mm_(0.5 * radius_mm_ * Vec2(3.0, std::numbers::sqrt3)),
        half_block_mm_(0.5 * Vec2(array.x_length_mm, array.y_length_mm) - Vec2(array.x_offset_mm, array.y_offset_mm) +
                       Vec2::Constant(2.0 * kWholeShare * radius_mm_)) {}

  std::vector<WholeElement> run() {
    const auto rows = static_cast<std::int64_t>(std::ceil(half_block_mm_.y() / half_period_mm_.y()));
    const auto columns = static_cast<std::int64_t>(std::ceil(half_block_mm_.x() / half_period_mm_.x()));
    for (std::int64_t row = -rows; row <= rows; ++row) {
      const std::size_t before = elements_.size();
      for (std::int64_t column = -columns - 1; column <= columns + 1; ++column) {
        if ((row + column) % 2 != 0) continue;
        const Vec2 apex = half_period_mm_.cwiseProduct(Vec2(static_cast<double>(column), static_cast<double>(row)));
        if (is_triangular_) add(apex - Vec2(radius_mm_, 0.0), true);
        add(apex, false);
      }
      number_row(before);
    }
    return std::move(elements_);
  }

 private:
  /// \param apex from the middle of the extent
  void add(const Vec2& apex, bool is_rotated) {
    const Vec2 low = is_rotated ? Vec2(apex - box_.upper) : Vec2(apex + box_.lower);
    const Vec2 high = is_rotated ? Vec2(apex - box_.lower) : Vec2(apex + box_.upper);
    if ((low.array() < -half_block_mm_.array()).any() || (high.array() > half_block_mm_.array()).any()) return;
    elements_.push_back({apex, rows_, 0, is_rotated, true});
  }

  void number_row(std::size_t first) {
    if (first == elements_.size()) return;
    for (std::size_t k = first; k < elements_.size(); ++k) elements_[k].column = static_cast<std::int32_t>(k - first);
    ++rows_;
  }

  bool is_triangular_;
  double radius_mm_;
  Rectangle box_;  ///< of an aperture round its apex, not rotated
  Vec2 half_period_mm_;
  Vec2 half_block_mm_;
  std::vector<WholeElement> elements_;
  std::int32_t rows_ = 0;
};

std::vector<WholeElement> whole_prisms(const ArrayLayout& array, const RtpElement& prism) {
  const PrismBlock block = prism_block(array, prism);
  std::vector<WholeElement> elements;
  elements.reserve(static_cast<std::size_t>(block.counts.columns * block.counts.rows));
  for (std::int64_t row = 0; row < block.counts.rows; ++row)
    for (std::int64_t column = 0; column < block.columns_of(row); ++column)
      elements.push_back({block.centre_mm(row, column), static_cast<std::int32_t>(row),
                          static_cast<std::int32_t>(column), block.is_rotated(row, column), true});
  return elements;
}

std::vector<WholeElement> whole_cubes(const ArrayLayout& array, const Element& element) {
  if (array.arrangement != Arrangement::single) return CubeFinder(array, element).run();
  const Rectangle box = bounding_box(element_cell(element).outline);
  return {WholeElement{-0.5 * (box.lower + box.upper), 0, 0, false, true}};
}

}  // namespace

double whole_count(double length_mm, double offset_mm, double gap_mm, double pitch_mm) {
  const double count = (length_mm - 2.0 * offset_mm + gap_mm) / pitch_mm;
  return std::floor(count + kWholeShare * std::max(1.0, count));
}

bool PrismBlock::is_shifted(std::int64_t row) const {
  // Rows count from 1 where their parity is named.
  return shift_mm > 0.0 && (row % 2 == 0) == (shifted_rows == RowParity::odd);
}

Vec2 PrismBlock::corner_mm(std::int64_t row, std::int64_t column) const {
  return filled.lower + Vec2(is_shifted(row) ? shift_mm : 0.0, 0.0) +
         pitch_mm.cwiseProduct(Vec2(static_cast<double>(column), static_cast<double>(row)));
}

Vec2 PrismBlock::centre_mm(std::int64_t row, std::int64_t column) const {
  const Vec2 first =
      -0.5 * pitch_mm.cwiseProduct(Vec2(static_cast<double>(counts.columns - 1), static_cast<double>(counts.rows - 1)));
  return first + Vec2(is_shifted(row) ? shift_mm : 0.0, 0.0) +
         pitch_mm.cwiseProduct(Vec2(static_cast<double>(column), static_cast<double>(row)));
}

PrismBlock prism_block(const ArrayLayout& array, const RtpElement& element) {
  const Vec2 size(element.base_mm, element.width_mm);
  PrismBlock block;
  block.shifted_rows = array.shifted_rows;
  if (array.arrangement == Arrangement::single) {
    block.counts = {1, 1};
    block.pitch_mm = size;
    block.filled = {Vec2::Zero(), size};
    return block;
  }
  const Vec2 gap(array.x_gap_mm, array.y_gap_mm);
  block.pitch_mm = size + gap;
  const Vec2 counts(whole_count(array.x_length_mm, array.x_offset_mm, gap.x(), block.pitch_mm.x()),
                    whole_count(array.y_length_mm, array.y_offset_mm, gap.y(), block.pitch_mm.y()));
  block.counts = {static_cast<std::int64_t>(counts.x()), static_cast<std::int64_t>(counts.y())};
  const Vec2 filled = counts.cwiseProduct(block.pitch_mm) - gap;
  block.filled.lower = 0.5 * (Vec2(array.x_length_mm, array.y_length_mm) - filled);
  block.filled.upper = block.filled.lower + filled;
  block.is_checker = array.arrangement == Arrangement::checker;
  if (array.arrangement == Arrangement::offset && block.counts.rows > 1)
    block.shift_mm = 0.01 * array.overlap_percent * element.base_mm;
  return block;
}

std::vector<WholeElement> whole_elements(const ArrayLayout& array, const Element& element) {
  const auto* const prism = std::get_if<RtpElement>(&element);
  std::vector<WholeElement> elements = prism != nullptr ? whole_prisms(array, *prism) : whole_cubes(array, element);
  if (array.pattern.empty()) return elements;
  for (WholeElement& at : elements)
    at.is_there = array.pattern[array.pattern.size() - 1 - static_cast<std::size_t>(at.row)]
                               [static_cast<std::size_t>(at.column)] == '#';
  return elements;
}

std::vector<std::int64_t> row_lengths(const ArrayLayout& array, const Element& element) {
  if (const auto* const prism = std::get_if<RtpElement>(&element)) {
    const CellCounts counts = prism_block(array, *prism).counts;
    return std::vector<std::int64_t>(static_cast<std::size_t>(std::max<std::int64_t>(0, counts.rows)), counts.columns);
  }
  std::vector<std::int64_t> lengths;
  for (const WholeElement& at : whole_cubes(array, element)) {
    lengths.resize(static_cast<std::size_t>(at.row) + 1);
    ++lengths.back();
  }
  return lengths;
}

double element_estimate(const ArrayLayout& array, const Element& element) {
  if (const auto* const prism = std::get_if<RtpElement>(&element))
    return (array.x_length_mm + array.x_gap_mm) / (prism->base_mm + array.x_gap_mm) *
           ((array.y_length_mm + array.y_gap_mm) / (prism->width_mm + array.y_gap_mm));
  return array.x_length_mm * array.y_length_mm / area(element_cell(element).outline);
}

}  // namespace retrace::geometry

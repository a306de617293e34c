#include "geometry/elements/whole_elements.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/elements/array_sheet.h"
#include "geometry/elements/element_cells.h"
#include "geometry/elements/ruled_pattern.h"
#include "geometry/elements/substrate_checks.h"

namespace retrace::geometry {
namespace {

/// Maximum distance, relative to its size, by which an element that counts as inside may cross the border.
constexpr double kMaxCrossingFraction = 1e-9;

/// Iterates over the elements of a sheet.
class Walk {
 public:
  explicit Walk(ArraySheet sheet) : sheet_(std::move(sheet)), piece_(sheet_, 0, 0, false) {
    for (std::size_t c = 0; c < sheet_.lattice.cells.size(); ++c)
      if (sheet_.lattice.cells[c].is_element)
        rows_[sheet_.reference_points_mm[c].y()][sheet_.reference_points_mm[c].x()] = c;
  }

  template <class Visit>
  void run(const Visit& visit) {
    const IndexRange all = sheet_.indices();
    for (std::int64_t j = all.lower[1]; j < all.upper[1]; ++j) {
      std::int64_t row = j * static_cast<std::int64_t>(rows_.size());
      for (const auto& [y, cells] : rows_) {
        std::int64_t column = all.lower[0] * static_cast<std::int64_t>(cells.size());
        for (std::int64_t i = all.lower[0]; i < all.upper[0]; ++i)
          for (const auto& [x, cell] : cells) visit_one(cell, {i, j}, row, column++, visit);
        ++row;
        if (std::exchange(column_, 0) > 0) ++row_;
      }
    }
  }

 private:
  template <class Visit>
  void visit_one(std::size_t cell, const std::array<std::int64_t, 2>& period, std::int64_t row, std::int64_t column,
                 const Visit& visit) {
    const Vec2 shift = sheet_.at_mm(period[0], period[1]) - sheet_.anchor_mm;
    const SheetCell place = piece_.sheet_cell(cell, shift);
    if (piece_.is_clear_of_part(place)) return;
    const BorderRelation standing = piece_.border_relation(place);
    if (standing == BorderRelation::outside) return;
    WholeElement element;
    element.is_rotated = sheet_.lattice.cells[cell].rotated;
    if (sheet_.prisms) {
      element.row = static_cast<std::int32_t>(row);
      element.column = static_cast<std::int32_t>(column);
      element.centre_mm = sheet_.prisms->centre_mm(row, column);
    } else {
      element.row = row_;
      element.column = standing == BorderRelation::inside ? column_++ : column_;
      element.centre_mm = apex_mm(cell, shift);
    }
    SubstrateFrame frame = place.frame;
    frame.origin.head<2>() += piece_.origin_mm() - sheet_.centre_mm;
    frame.origin.z() += piece_.height_mm();
    visit(PlacedElement{element, standing, frame});
  }

  /// Returns the apex, rounded to a multiple of half a period. Symmetric positions are then exactly symmetric.
  Vec2 apex_mm(std::size_t cell, const Vec2& shift) const {
    if (std::holds_alternative<RuledCells>(sheet_.spec->element)) return sheet_.reference_points_mm[cell] + shift;
    const Vec2 half = 0.5 * sheet_.lattice.period_mm;
    const Vec2 aside(sheet_.lattice.cells[cell].rotated ? 0.5 * width_across_mm(sheet_.spec->element) : 0.0, 0.0);
    const Vec2 steps = (sheet_.reference_points_mm[cell] + aside + shift).cwiseQuotient(half);
    return half.cwiseProduct(Vec2(std::round(steps.x()), std::round(steps.y()))) - aside;
  }

  const ArraySheet sheet_;
  const SheetPortion piece_;
  /// For each element of a period, the index of its cell in the lattice. The keys are y and x of the element.
  std::map<double, std::map<double, std::size_t>> rows_;
  std::int32_t row_ = 0;  ///< row number among the rows with complete elements
  std::int32_t column_ = 0;
};

}  // namespace

double whole_count(double length_mm, double offset_mm, double gap_mm, double pitch_mm) {
  const double count = (length_mm - 2.0 * offset_mm + gap_mm) / pitch_mm;
  return std::floor(count + kMaxCrossingFraction * std::max(1.0, count));
}

bool PrismBlock::is_shifted(std::int64_t row) const {
  // In RowParity, rows are counted from 1; `row` is counted from 0.
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

std::vector<PlacedElement> place_elements(const PartSpec& spec) {
  std::vector<PlacedElement> elements;
  Walk(ArraySheet(spec)).run([&](const PlacedElement& at) { elements.push_back(at); });
  return elements;
}

namespace {

std::vector<WholeElement> on_plane(const ArrayLayout& array, const Element& element) {
  const auto* const prism = std::get_if<RtpElement>(&element);
  std::vector<WholeElement> elements(1);
  if (array.arrangement == Arrangement::single) {
    if (prism == nullptr) elements[0].centre_mm = -bounding_box(element_cell(element).outline).centre();
    return elements;
  }
  elements.clear();
  const CellCounts counts = prism != nullptr ? prism_block(array, *prism).counts : CellCounts{1, 1};
  if (counts.columns < 1 || counts.rows < 1) return elements;
  PartSpec spec;
  spec.element = element;
  spec.array = array;
  Walk(ArraySheet(spec)).run([&](const PlacedElement& at) {
    if (at.border_relation == BorderRelation::inside) elements.push_back(at.on_sheet);
  });
  return elements;
}

}  // namespace

std::vector<WholeElement> whole_elements(const ArrayLayout& array, const Element& element) {
  std::vector<WholeElement> elements = on_plane(array, element);
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
  for (const WholeElement& at : on_plane(array, element)) {
    lengths.resize(static_cast<std::size_t>(at.row) + 1);
    ++lengths.back();
  }
  return lengths;
}

double element_estimate(const ArrayLayout& array, const Element& element) {
  if (const auto* const prism = std::get_if<RtpElement>(&element))
    return (array.x_length_mm + array.x_gap_mm) / (prism->base_mm + array.x_gap_mm) *
           ((array.y_length_mm + array.y_gap_mm) / (prism->width_mm + array.y_gap_mm));
  if (const auto* const ruled = std::get_if<RuledCells>(&element))
    return array.x_length_mm * array.y_length_mm / ruled->pattern->mean_cell_mm2;
  return array.x_length_mm * array.y_length_mm / area(element_cell(element).outline);
}

}  // namespace retrace::geometry

#include "report/drawing/dimension_layout.h"

#include <algorithm>

#include "report/drawing/svg_sheet.h"

namespace retrace::report {
namespace {

constexpr double kFirst = 26.0;  ///< distance from the figure to the first dimension line
constexpr double kStep = 24.0;   ///< distance between dimension lines
constexpr double kArrow = 8.0;
constexpr double kGap = 3.0;   ///< distance from the measured point to its extension line
constexpr double kOver = 4.0;  ///< length of an extension line beyond the dimension line
constexpr double kClear = 3.0, kTextGap = 4.0;
constexpr int kMaxLevels = 16;

/// Interval of one coordinate in the frame of a side of the figure. The coordinates are the position along the
/// dimension line and the distance away from the figure.
struct Span {
  double from = 0.0, to = 0.0;
};
struct Block {
  Span along, away;
};

bool meet(const Span& a, const Span& b, double clear) {
  return a.from < b.to + clear && b.from < a.to + clear;
}
bool meet(const Block& a, const Block& b, double clear) {
  return meet(a.along, b.along, clear) && meet(a.away, b.away, clear);
}

/// Layout of one side of the figure, with the dimensions that have been placed there.
class SideLayout {
 public:
  SideLayout(DimensionSide side, Point lower, Point upper) : side_(side), lower_(lower), upper_(upper) {}

  PlacedDimension place(const PaperDimension& d) {
    Candidate best = candidate(d, 0, 0);
    for (int level = 0; level < kMaxLevels; ++level)
      for (int position = 0; position < 3; ++position) {
        const Candidate c = candidate(d, level, position);
        if (c.is_possible && is_free(c)) {
          take(c);
          return on_paper(d, c);
        }
      }
    take(best);
    return on_paper(d, best);
  }

 private:
  struct Candidate {
    bool is_possible = false;
    bool is_between = false;
    double from = 0.0;
    double to = 0.0;
    double line = 0.0;  ///< distance of the dimension line from the figure
    double text = 0.0;  ///< centre of the text along the dimension line
    Block text_block;
    Block line_block;
    std::array<Block, 2> extensions;
  };

  bool runs_across() const { return side_ == DimensionSide::below || side_ == DimensionSide::above; }
  double along_of(Point p) const { return runs_across() ? p.x : p.y; }
  double away_of(Point p) const {
    switch (side_) {
      case DimensionSide::below: return p.y - upper_.y;
      case DimensionSide::above: return lower_.y - p.y;
      case DimensionSide::left: return lower_.x - p.x;
      case DimensionSide::right: return p.x - upper_.x;
    }
    return 0.0;
  }
  Point point(double along, double away) const {
    switch (side_) {
      case DimensionSide::below: return {along, upper_.y + away};
      case DimensionSide::above: return {along, lower_.y - away};
      case DimensionSide::left: return {lower_.x - away, along};
      case DimensionSide::right: return {upper_.x + away, along};
    }
    return {};
  }
  /// Returns true if texts are on the outer side of their lines. Texts are above horizontal lines and to the left of
  /// vertical lines.
  bool text_is_outside() const { return side_ == DimensionSide::above || side_ == DimensionSide::left; }

  /// Returns a candidate for the position of a dimension.
  /// \param position position of the text: 0 between the arrows, 1 after them, 2 before them
  Candidate candidate(const PaperDimension& d, int level, int position) const {
    Candidate c;
    c.from = std::min(along_of(d.from), along_of(d.to));
    c.to = std::max(along_of(d.from), along_of(d.to));
    c.line = kFirst + kStep * level;
    const double room = c.to - c.from;
    c.is_between = room >= 2.6 * kArrow;
    const bool fits = room >= d.text_width + 2.0 * kClear;
    c.is_possible = position == 0 ? fits : !fits;
    const double beyond = c.is_between ? 2.0 * kClear : 2.0 * kArrow;
    c.text = position == 0   ? 0.5 * (c.from + c.to)
             : position == 1 ? c.to + beyond + 0.5 * d.text_width
                             : c.from - beyond - 0.5 * d.text_width;
    const double text_from = text_is_outside() ? c.line + kTextGap : c.line - kTextGap - kSheetTextSize;
    c.text_block = {{c.text - 0.5 * d.text_width, c.text + 0.5 * d.text_width},
                    {text_from, text_from + kSheetTextSize}};
    const double outside = c.is_between ? 0.0 : 2.0 * kArrow;
    c.line_block = {
        {std::min(c.from - outside, c.text_block.along.from), std::max(c.to + outside, c.text_block.along.to)},
        {c.line, c.line}};
    for (const std::size_t k : {0U, 1U}) {
      const double at = k == 0 ? c.from : c.to;
      const double start = away_of(along_of(d.from) == at ? d.from : d.to) + kGap;
      c.extensions[k] = {{at, at}, {std::min(start, c.line), c.line + kOver}};
    }
    return c;
  }

  bool is_free(const Candidate& c) const {
    const auto none = [](const std::vector<Block>& blocks, const Block& b, double clear) {
      return std::none_of(blocks.begin(), blocks.end(), [&](const Block& other) { return meet(b, other, clear); });
    };
    if (!none(texts_, c.text_block, kClear) || !none(texts_, c.line_block, kClear)) return false;
    if (!none(lines_, c.text_block, kClear) || !none(lines_, c.line_block, kClear)) return false;
    if (!none(extensions_, c.text_block, kClear)) return false;
    return none(texts_, c.extensions[0], 0.5) && none(texts_, c.extensions[1], 0.5);
  }

  void take(const Candidate& c) {
    texts_.push_back(c.text_block);
    lines_.push_back(c.line_block);
    extensions_.insert(extensions_.end(), c.extensions.begin(), c.extensions.end());
  }

  PlacedDimension on_paper(const PaperDimension& d, const Candidate& c) const {
    PlacedDimension placed;
    placed.text = d.text;
    placed.upwards = !runs_across();
    placed.arrows_point_inward = !c.is_between;
    for (const std::size_t k : {0U, 1U}) {
      const Block& e = c.extensions[k];
      placed.extensions[k] = {point(e.along.from, e.away.from), point(e.along.from, e.away.to)};
      placed.tips[k] = point(e.along.from, c.line);
    }
    placed.line = {point(c.line_block.along.from, c.line), point(c.line_block.along.to, c.line)};
    // Baselines are below horizontal texts and to the right of vertical texts.
    const double baseline = text_is_outside() ? c.text_block.away.from : c.text_block.away.to;
    placed.text_at = point(c.text, baseline);
    return placed;
  }

  DimensionSide side_;
  Point lower_, upper_;
  std::vector<Block> texts_, lines_, extensions_;
};

}  // namespace

std::vector<PlacedDimension> place_dimensions(const std::vector<PaperDimension>& dimensions, Point lower, Point upper) {
  std::array<SideLayout, 4> sides = {
      SideLayout(DimensionSide::below, lower, upper), SideLayout(DimensionSide::left, lower, upper),
      SideLayout(DimensionSide::above, lower, upper), SideLayout(DimensionSide::right, lower, upper)};
  std::vector<PlacedDimension> placed;
  for (const PaperDimension& d : dimensions) placed.push_back(sides[static_cast<std::size_t>(d.side)].place(d));
  return placed;
}

}  // namespace retrace::report

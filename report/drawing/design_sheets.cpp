#include "report/drawing/design_sheets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "report/drawing/dimension_layout.h"
#include "report/drawing/svg_sheet.h"

namespace retrace::report {
namespace {

using geometry::Polygon, geometry::Rectangle, geometry::Vec2, studies::DesignDrawing, studies::PlanPanel,
    studies::SectionPanel;

constexpr double kWholeWidth = 520.0;  ///< maximum width of the figure of a panel
constexpr double kWholeHeight = 460.0;
constexpr double kSheetMargin = 26.0, kPanelGap = 44.0;
constexpr double kArrowLength = 8.0, kArrowHalf = 2.6;
/// Distance between adjacent borders of elements, in drawing units, below which the lines of the plan are drawn finer.
constexpr double kFineLines = 14.0;
/// Ratio of plate thickness to element depth above which the central part of the plate is omitted from the section.
constexpr double kThickPlate = 3.2;
constexpr double kBreakGap = 12.0;
constexpr double kZoneDisc = 10.0;  ///< radius of the disc behind the number of a zone
constexpr double kZoneLegendLine = 19.0;

using ToPaper = std::function<Point(const Vec2&)>;

std::vector<Point> on_paper(const std::vector<Vec2>& polygon, const ToPaper& at) {
  std::vector<Point> points;
  for (const Vec2& p : polygon) points.push_back(at(p));
  return points;
}

std::vector<std::pair<Point, Point>> on_paper(const std::vector<studies::PlanLine>& lines, const ToPaper& at) {
  std::vector<std::pair<Point, Point>> result;
  for (const auto& [a, b] : lines) result.emplace_back(at(a), at(b));
  return result;
}

void arrow(SvgGroup& group, Point tip, Point away) {
  const double length = std::hypot(away.x - tip.x, away.y - tip.y);
  const Point u{(away.x - tip.x) / length, (away.y - tip.y) / length};
  const Point foot{tip.x + kArrowLength * u.x, tip.y + kArrowLength * u.y};
  group.faces("arrow", {{tip,
                         {foot.x - kArrowHalf * u.y, foot.y + kArrowHalf * u.x},
                         {foot.x + kArrowHalf * u.y, foot.y - kArrowHalf * u.x}}});
}

void draw_dimensions(SvgGroup& group, const std::vector<studies::Dimension>& dimensions, const ToPaper& at, Point lower,
                     Point upper) {
  std::vector<PaperDimension> wanted;
  for (const studies::Dimension& d : dimensions) {
    PaperDimension p{static_cast<DimensionSide>(d.side), at(d.from_mm), at(d.to_mm), dimension_text(d), 0.0};
    p.text_width = sheet_text_width(p.text, kSheetTextSize);
    wanted.push_back(std::move(p));
  }
  for (const PlacedDimension& d : place_dimensions(wanted, lower, upper)) {
    group.lines("ext", {d.extensions[0], d.extensions[1]});
    group.lines("dim", {d.line});
    const auto [a, b] = d.tips;
    const auto mirrored = [](Point p, Point about) { return Point{2.0 * about.x - p.x, 2.0 * about.y - p.y}; };
    arrow(group, a, d.arrows_point_inward ? mirrored(b, a) : b);
    arrow(group, b, d.arrows_point_inward ? mirrored(a, b) : a);
    group.text("value", d.text_at, d.text, Align::centre, d.upwards);
    const double half = 0.5 * sheet_text_width(d.text, kSheetTextSize);
    if (d.upwards)
      group.reserve({d.text_at.x - kSheetTextSize, d.text_at.y - half}, {kSheetTextSize, 2.0 * half});
    else
      group.reserve({d.text_at.x - half, d.text_at.y - kSheetTextSize}, {2.0 * half, kSheetTextSize});
  }
}

constexpr std::size_t kZoneColours = 7;  ///< number of different colours of zones in the style sheet

std::string zone_style(std::size_t zone) {
  return fmt::format("z{}", zone % kZoneColours);
}

std::string face_style(const studies::PlanFace& face) {
  const bool is_land = face.role != geometry::FacetRole::retro_facet;
  std::string style =
      is_land ? "land" : fmt::format("f{}", static_cast<int>(std::floor(face.azimuth_deg / 60.0 + 0.25)) % 6);
  if (face.zone) style += " zone " + zone_style(*face.zone);
  return style;
}

void draw_faces(SvgGroup& group, const studies::PlanView& view, const ToPaper& at) {
  std::map<std::string, std::vector<std::vector<Point>>> by_style;
  for (const studies::PlanFace& face : view.faces) by_style[face_style(face)].push_back(on_paper(face.outline_mm, at));
  for (const auto& [style, polygons] : by_style) group.faces(style, polygons);
  group.lines("root", on_paper(view.roots_mm, at));
  group.lines("rim", on_paper(view.rims_mm, at));
}

/// Returns true if the lines of the plan are so close together that they are drawn finer. The mean length of the rims
/// (borders of elements) serves as an estimate of their distance.
bool has_fine_lines(const studies::PlanView& view, double units_per_mm) {
  if (view.rims_mm.size() < 200) return false;
  double sum = 0.0;
  for (const auto& [a, b] : view.rims_mm) sum += (b - a).norm();
  return units_per_mm * sum / static_cast<double>(view.rims_mm.size()) < kFineLines;
}

/// Draws the borders and the numbers of zones.
void draw_zones(SvgGroup& group, const PlanPanel& panel, const ToPaper& at) {
  for (std::size_t k = 0; k < panel.zones.size(); ++k) {
    if (panel.omits_faces)
      for (const Polygon& region : panel.zones[k].regions_mm)
        group.faces("zone " + zone_style(k), {on_paper(region, at)});
    if (panel.zones[k].sides_mm.empty())
      for (const Polygon& region : panel.zones[k].regions_mm) group.outline("zone-border", on_paper(region, at));
    group.lines("zone-border", on_paper(panel.zones[k].sides_mm, at));
  }
  for (std::size_t k = 0; k < panel.zones.size(); ++k)
    for (const Vec2& label : panel.zones[k].labels_mm) {
      const Point centre = at(label);
      group.circle("zone-disc", centre, kZoneDisc);
      group.text("zone-number", {centre.x, centre.y + 0.36 * kSheetTextSize}, fmt::format("{}", k + 1), Align::centre);
    }
}

/// Draws one line per zone below the figure: its colour, number and description.
void draw_zone_legend(SvgGroup& group, const PlanPanel& panel) {
  double top = group.box().upper.y + 14.0;
  for (std::size_t k = 0; k < panel.zones.size(); ++k, top += kZoneLegendLine) {
    const double side = 12.0;
    group.outline("zone swatch " + zone_style(k), {{0.0, top}, {side, top}, {side, top + side}, {0.0, top + side}});
    const std::string text = fmt::format("Zone {}: {}", k + 1, panel.zones[k].description);
    group.text("zone-text", {side + 8.0, top + side - 1.5}, text, Align::left);
    group.reserve({0.0, top}, {side + 8.0 + sheet_text_width(text, kSheetTextSize), side + 4.0});
  }
}

struct Panel {
  SvgGroup group;
  std::string attributes;
};

std::string place_of(const Vec2& origin_mm, double units_per_mm, const char* second) {
  return fmt::format("data-x-mm=\"{:.9g}\" data-{}-mm=\"{:.9g}\" data-units-per-mm=\"{:.12g}\"", origin_mm.x(), second,
                     origin_mm.y(), units_per_mm);
}

void draw_section_marks(SvgGroup& group, Point left, Point right) {
  const double beyond = 14.0;
  group.path("cut", {{left.x - beyond, left.y}, {right.x + beyond, right.y}});
  group.text("mark", {left.x - beyond - 3.0, left.y - 5.0}, "B", Align::right);
  group.text("mark", {right.x + beyond + 3.0, right.y - 5.0}, "B", Align::left);
  group.reserve({right.x + beyond, right.y - 16.0}, {14.0, 12.0});
  group.reserve({left.x - beyond - 14.0, left.y - 16.0}, {14.0, 12.0});
}

/// Returns the outer border of a part and the borders of its holes, in drawing coordinates.
std::vector<std::vector<Point>> borders_on_paper(const Polygon& outer_mm, const PlanPanel& panel, const ToPaper& at) {
  std::vector<std::vector<Point>> borders = {on_paper(outer_mm, at)};
  for (const geometry::PolygonLoop& hole : panel.holes_mm) borders.push_back(on_paper(hole, at));
  return borders;
}

Panel plan_panel(const PlanPanel& panel) {
  const Rectangle& window = panel.view.window_mm;
  const Vec2 size = window.size();
  const double scale = std::min(kWholeWidth / size.x(), kWholeHeight / size.y());
  const Vec2 origin(window.lower.x(), window.upper.y());
  const ToPaper at = [&](const Vec2& p) { return Point{scale * (p.x() - origin.x()), scale * (origin.y() - p.y())}; };
  Panel result{{}, place_of(origin, scale, "y")};
  SvgGroup& group = result.group;
  if (panel.omits_faces && !panel.outline_mm.empty())
    group.faces("plain", borders_on_paper(panel.outline_mm, panel, at));
  const bool fine = has_fine_lines(panel.view, scale);
  if (fine) result.attributes += " class=\"fine\"";
  draw_faces(group, panel.view, at);
  draw_zones(group, panel, at);
  Polygon outline = panel.outline_mm;
  if (!outline.empty()) outline = geometry::clip(outline, window, 1e-9 * size.maxCoeff());
  const bool is_whole = !outline.empty() && outline.size() == panel.outline_mm.size() &&
                        geometry::area(outline) > (1.0 - 1e-9) * geometry::area(panel.outline_mm);
  if (is_whole) group.faces("outline", borders_on_paper(outline, panel, at));
  if (panel.circle_radius_mm) group.circle("round", at(panel.circle_mm), scale * *panel.circle_radius_mm);
  if (panel.period_mm) group.outline("period", on_paper(geometry::to_polygon(*panel.period_mm), at));
  const Point lower = at({window.lower.x(), window.upper.y()});
  const Point upper = at({window.upper.x(), window.lower.y()});
  if (panel.detail_mm) {
    group.outline("frame", on_paper(geometry::to_polygon(*panel.detail_mm), at));
    const Point corner = at({panel.detail_mm->upper.x(), panel.detail_mm->upper.y()});
    group.text("mark", {corner.x + 4.0, corner.y - 4.0}, "A", Align::left);
  }
  if (panel.section_y_mm)
    draw_section_marks(group, {lower.x, at({0.0, *panel.section_y_mm}).y}, {upper.x, at({0.0, *panel.section_y_mm}).y});
  // The marks of the section line are placed between the figure and the first dimension lines.
  const double marks = panel.section_y_mm ? 12.0 : 0.0;
  draw_dimensions(group, panel.dimensions, at, {lower.x - marks, lower.y}, {upper.x + marks, upper.y});
  draw_zone_legend(group, panel);
  return result;
}

/// Heights of the back and of the entrance face in a section.
struct SectionHeights {
  double deepest_mm = 0.0;       ///< lowest point of the back, at most 0
  double highest_back_mm = 0.0;  ///< highest point of the back
  double lowest_mm = 0.0;        ///< lowest point of the entrance face
  double highest_mm = 0.0;       ///< highest point of the entrance face

  explicit SectionHeights(const studies::SectionView& view)
      : highest_back_mm(view.outline_mm.front().y()),
        lowest_mm(view.outline_mm.back().y()),
        highest_mm(view.outline_mm.back().y()) {
    const std::size_t on_back = view.outline_mm.size() - view.entrance_corners;
    for (std::size_t k = 0; k < on_back; ++k) {
      deepest_mm = std::min(deepest_mm, view.outline_mm[k].y());
      highest_back_mm = std::max(highest_back_mm, view.outline_mm[k].y());
    }
    for (std::size_t k = on_back; k < view.outline_mm.size(); ++k) {
      lowest_mm = std::min(lowest_mm, view.outline_mm[k].y());
      highest_mm = std::max(highest_mm, view.outline_mm[k].y());
    }
  }
};

/// Converts heights to drawing coordinates. The central part of a thick plate may be omitted.
struct HeightScale {
  double scale = 1.0;
  double top_mm = 0.0;
  double break_from_mm = 0.0;  ///< range that is omitted; nothing is omitted if both ends are equal
  double break_to_mm = 0.0;

  bool is_interrupted() const { return break_to_mm > break_from_mm; }
  double at(double z_mm) const {
    double down = scale * (top_mm - z_mm);
    if (is_interrupted()) {
      const double out = std::clamp(break_to_mm - z_mm, 0.0, break_to_mm - break_from_mm);
      down -= scale * out;
      if (z_mm < break_to_mm) down += kBreakGap * std::clamp(out / (break_to_mm - break_from_mm), 0.0, 1.0);
    }
    return down;
  }
};

HeightScale height_scale(const SectionHeights& heights, double scale) {
  HeightScale z{scale, heights.highest_mm, 0.0, 0.0};
  const double depth = std::max(heights.highest_back_mm - heights.deepest_mm, 1e-12);
  if (heights.lowest_mm > kThickPlate * depth) {
    z.break_from_mm = std::max(heights.highest_back_mm, 0.0) + 0.9 * depth;
    z.break_to_mm = heights.lowest_mm - 0.6 * depth;
  }
  return z;
}

/// Returns a break line, which indicates that a body continues, from one point to another.
std::vector<Point> broken_line(Point from, Point to) {
  const Point middle{0.5 * (from.x + to.x), 0.5 * (from.y + to.y)};
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const Point u{(to.x - from.x) / length, (to.y - from.y) / length};
  const auto by = [&](double along, double across) {
    return Point{middle.x + along * u.x - across * u.y, middle.y + along * u.y + across * u.x};
  };
  return {from, by(-7.0, 0.0), by(-3.0, -6.0), by(3.0, 6.0), by(7.0, 0.0), to};
}

void draw_break(SvgGroup& group, const HeightScale& z, double width) {
  const double upper = z.at(z.break_to_mm);
  const double lower = upper + kBreakGap;
  const double beyond = 8.0;
  std::vector<Point> above = broken_line({-beyond, upper}, {width + beyond, upper});
  std::vector<Point> below = broken_line({-beyond, lower}, {width + beyond, lower});
  std::vector<Point> gap = above;
  gap.insert(gap.end(), below.rbegin(), below.rend());
  group.faces("gap", {gap});
  group.path("break", above);
  group.path("break", below);
}

void draw_angle(SvgGroup& group, const studies::AngleDimension& angle, const ToPaper& at, double reach_mm) {
  const Point apex = at(angle.apex_mm);
  const Point side = at(angle.apex_mm + reach_mm * Vec2(angle.right.x(), 0.0).normalized());
  const double radius = 0.42 * std::abs(side.x - apex.x);
  group.arc("dim", apex, radius, std::atan2(angle.right.y(), angle.right.x()),
            std::atan2(angle.left.y(), angle.left.x()));
  const std::string text = fmt::format("{:.6g}°", angle.deg);
  // The text is placed in the material, just above the arc of the angle.
  const double half = 0.5 * sheet_text_width(text, kSheetTextSize);
  group.text("value", {apex.x, apex.y - radius - 5.0}, text, Align::centre);
  group.reserve({apex.x - half, apex.y - radius - 5.0 - kSheetTextSize}, {2.0 * half, kSheetTextSize});
}

Panel section_panel(const SectionPanel& panel) {
  const studies::SectionView& view = panel.view;
  const SectionHeights heights(view);
  const double deepest = heights.deepest_mm;
  const double top_mm = heights.highest_mm;
  const double width_mm = view.x_to_mm - view.x_from_mm;
  const double tall_mm = std::min(
      top_mm - deepest, (kThickPlate + 1.0) * (heights.highest_back_mm - deepest) + (top_mm - heights.lowest_mm));
  const double scale = std::min(1.35 * kWholeWidth / width_mm, 0.9 * kWholeHeight / tall_mm);
  const HeightScale z = height_scale(heights, scale);
  const ToPaper at = [&](const Vec2& p) { return Point{scale * (p.x() - view.x_from_mm), z.at(p.y())}; };
  Panel result{{}, place_of({view.x_from_mm, top_mm}, scale, "z")};
  SvgGroup& group = result.group;
  const std::vector<Point> outline = on_paper(view.outline_mm, at);
  const auto on_back = static_cast<std::ptrdiff_t>(outline.size() - view.entrance_corners);
  group.outline(panel.is_continued ? "body bare" : "body", outline);
  if (panel.is_continued) {
    group.path("outline", {outline.begin(), outline.begin() + on_back});
    group.path("outline", {outline.begin() + on_back, outline.end()});
  }
  if (z.is_interrupted()) draw_break(group, z, scale * width_mm);
  if (panel.is_continued)
    for (const bool is_left : {true, false}) {
      const Point top = is_left ? outline.back() : outline[static_cast<std::size_t>(on_back)];
      const Point foot = is_left ? outline.front() : outline[static_cast<std::size_t>(on_back) - 1];
      group.path("break", broken_line({top.x, top.y - 7.0}, {foot.x, foot.y + 7.0}));
    }
  if (panel.angle) draw_angle(group, *panel.angle, at, -deepest);
  draw_dimensions(group, panel.dimensions, at, at({view.x_from_mm, top_mm}), at({view.x_to_mm, deepest}));
  return result;
}

/// Returns a sheet with panels next to each other under a title.
std::string sheet_of(const DesignDrawing& drawing, const std::vector<Panel>& panels,
                     const std::vector<std::string>& titles, const char* id, const std::string& description) {
  SvgGroup head;
  double y = kSheetMargin + kSheetTitleSize;
  head.text("title", {kSheetMargin, y}, drawing.title, Align::left);
  std::string remarks;
  for (const std::string& remark : drawing.remarks) remarks += (remarks.empty() ? "" : "; ") + remark;
  y += kSheetTextSize + 8.0;
  head.text("remark", {kSheetMargin, y}, remarks, Align::left);
  const double panels_top = y + 22.0 + kSheetPanelSize;
  SvgSheet sheet;
  double x = kSheetMargin;
  double bottom = panels_top;
  std::vector<std::pair<Point, std::size_t>> places;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const PaperBox& box = panels[k].group.box();
    head.text("panel", {x, panels_top}, titles[k], Align::left);
    places.push_back({{x - box.lower.x, panels_top + 14.0 - box.lower.y}, k});
    bottom = std::max(bottom, panels_top + 14.0 + box.size().height);
    x += std::max(box.size().width, sheet_text_width(titles[k], kSheetPanelSize) * 1.15) + kPanelGap;
  }
  sheet.add(head, {0.0, 0.0}, "titles");
  for (const auto& [place, k] : places)
    sheet.add(panels[k].group, place, fmt::format("{}-{}", id, k), panels[k].attributes);
  const double text_width =
      std::max(1.2 * sheet_text_width(drawing.title, kSheetTitleSize), sheet_text_width(remarks, kSheetTextSize));
  return sheet.finish({std::max(x - kPanelGap, text_width + kSheetMargin) + kSheetMargin, bottom + kSheetMargin},
                      drawing.title, description);
}

std::string words_of(const std::vector<studies::Dimension>& dimensions) {
  std::string words;
  for (const studies::Dimension& d : dimensions) words += (words.empty() ? "" : ", ") + dimension_text(d) + " mm";
  return words;
}

}  // namespace

std::string dimension_text(const studies::Dimension& dimension) {
  return fmt::format("{} {:.6g}", dimension.name, dimension.value_mm);
}

std::string plan_svg(const DesignDrawing& drawing) {
  std::vector<Panel> panels;
  std::vector<std::string> titles;
  std::string words = "Plan of the part";
  for (const PlanPanel& panel : drawing.plan) {
    panels.push_back(plan_panel(panel));
    titles.push_back(panel.omits_faces ? panel.title + " (elements too small to be drawn)" : panel.title);
    words += "; " + words_of(panel.dimensions);
    for (std::size_t k = 0; k < panel.zones.size(); ++k)
      words += fmt::format("; zone {}: {}", k + 1, panel.zones[k].description);
  }
  return sheet_of(drawing, panels, titles, "plan", words);
}

std::string section_svg(const DesignDrawing& drawing) {
  const SectionPanel& panel = *drawing.section;
  std::string words = "Section across the elements; " + words_of(panel.dimensions);
  if (panel.angle) words += fmt::format(", angle {:.6g} degrees", panel.angle->deg);
  return sheet_of(drawing, {section_panel(panel)}, {panel.title}, "section", words);
}

}  // namespace retrace::report

#include "report/drawing/svg_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace retrace::report {
namespace {

// Style sheet of the SVG. It has light colours, or dark colours if the reader has selected a dark colour scheme. Facets
// whose normals point to the upper left are lighter.
constexpr std::string_view kStyle = R"css(
text{font-family:"DejaVu Sans",Verdana,Arial,sans-serif;font-size:12px;fill:#1d2530}
.title{font-size:17px;font-weight:bold}.panel{font-size:13.5px;font-weight:bold}.remark{fill:#55606e}
path,circle{fill:none;stroke-linejoin:round;stroke-linecap:round}
.paper{fill:#ffffff}
.f0{fill:#b9cfe4}.f1{fill:#c9dbeb}.f2{fill:#e3eef7}.f3{fill:#edf4fa}.f4{fill:#dbe8f3}.f5{fill:#c1d5e8}
.land{fill:#f1efe9}.body{fill:#e3eef7;stroke:#1d2530;stroke-width:1.3}.bare{stroke:none}.plain{fill:#dbe8f3}
.root{stroke:#7d93a8;stroke-width:.7}.rim{stroke:#3c4c5c;stroke-width:.8}.outline{stroke:#1d2530;stroke-width:1.5}
.fine .root{stroke-width:.3}.fine .rim{stroke-width:.35}
.period{stroke:#b4561c;stroke-width:1.4;stroke-dasharray:7 4}.round{stroke:#b4561c;stroke-width:1;stroke-dasharray:5 3}
.cut{stroke:#8a3ffc;stroke-width:1.1;stroke-dasharray:12 3 2 3}.frame{stroke:#8a3ffc;stroke-width:1.2}
.mark{fill:#8a3ffc;font-weight:bold}.dim{stroke:#0b6e99;stroke-width:.9}.ext{stroke:#0b6e99;stroke-width:.55}
.arrow{fill:#0b6e99}.value{fill:#074e6e}.break{stroke:#1d2530;stroke-width:1.1}.gap{fill:#ffffff}
.zone.z0{fill:#0072b2}.zone.z1{fill:#d55e00}.zone.z2{fill:#009e73}.zone.z3{fill:#cc79a7}.zone.z4{fill:#e69f00}
.zone.z5{fill:#56b4e9}.zone.z6{fill:#7a7a7a}.zone{fill-opacity:.5}
.f0.zone{fill-opacity:.62}.f1.zone{fill-opacity:.5}.f2.zone{fill-opacity:.26}.f3.zone{fill-opacity:.18}
.f4.zone{fill-opacity:.32}.f5.zone{fill-opacity:.55}.land.zone{fill-opacity:.1}
.swatch{stroke:#1d2530;stroke-width:.8}.zone-border{stroke:#1d2530;stroke-width:1.3}
.zone-disc{fill:#ffffff;stroke:#1d2530;stroke-width:1.2}.zone-number{font-weight:bold}
@media (prefers-color-scheme:dark){
text{fill:#e7edf4}.remark{fill:#a8b4c2}.paper,.gap{fill:#12171e}
.f0{fill:#24405c}.f1{fill:#2c4b69}.f2{fill:#3a5f82}.f3{fill:#436a8f}.f4{fill:#345777}.f5{fill:#284662}
.land{fill:#2a2f36}.body{fill:#2c4b69;stroke:#e7edf4}.bare{stroke:none}.plain{fill:#345777}
.root{stroke:#86a5c2}.rim{stroke:#b9cbdc}.outline{stroke:#e7edf4}.period,.round{stroke:#f0a05a}
.cut,.frame{stroke:#c4a1ff}.mark{fill:#c4a1ff}.dim,.ext{stroke:#5cc4ee}.arrow{fill:#5cc4ee}.value{fill:#a5e0fb}
.break,.swatch,.zone-border{stroke:#e7edf4}.zone-disc{fill:#12171e;stroke:#e7edf4}}
)css";

/// Returns a number with up to three decimals, without trailing zeros.
std::string coordinate(double value) {
  std::string text = fmt::format("{:.3f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string pair(Point p) {
  return coordinate(p.x) + "," + coordinate(p.y);
}

}  // namespace

void PaperBox::take(Point p) {
  lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
  upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
}

std::string SvgGroup::at(Point p) {
  box_.take(p);
  return pair(p);
}

void SvgGroup::faces(std::string_view style, const std::vector<std::vector<Point>>& polygons) {
  if (polygons.empty()) return;
  markup_ += fmt::format("<path class=\"{}\" d=\"", style);
  for (const auto& polygon : polygons) {
    for (std::size_t k = 0; k < polygon.size(); ++k) markup_ += (k == 0 ? "M" : "L") + at(polygon[k]);
    markup_ += 'Z';
  }
  markup_ += "\"/>\n";
}

void SvgGroup::lines(std::string_view style, const std::vector<std::pair<Point, Point>>& lines) {
  if (lines.empty()) return;
  markup_ += fmt::format("<path class=\"{}\" d=\"", style);
  for (const auto& [a, b] : lines) markup_ += "M" + at(a) + "L" + at(b);
  markup_ += "\"/>\n";
}

void SvgGroup::outline(std::string_view style, const std::vector<Point>& polygon) {
  faces(style, {polygon});
}

void SvgGroup::path(std::string_view style, const std::vector<Point>& points) {
  markup_ += fmt::format("<path class=\"{}\" d=\"", style);
  for (std::size_t k = 0; k < points.size(); ++k) markup_ += (k == 0 ? "M" : "L") + at(points[k]);
  markup_ += "\"/>\n";
}

void SvgGroup::circle(std::string_view style, Point centre, double radius) {
  box_.take({centre.x - radius, centre.y - radius});
  box_.take({centre.x + radius, centre.y + radius});
  markup_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", style, coordinate(centre.x),
                         coordinate(centre.y), coordinate(radius));
}

void SvgGroup::arc(std::string_view style, Point centre, double radius, double from_rad, double to_rad) {
  const auto on_it = [&](double a) { return Point{centre.x + radius * std::cos(a), centre.y - radius * std::sin(a)}; };
  const std::string r = coordinate(radius);
  markup_ += fmt::format("<path class=\"{}\" d=\"M{}A{},{} 0 0 0 {}\"/>\n", style, at(on_it(from_rad)), r, r,
                         at(on_it(to_rad)));
}

void SvgGroup::text(std::string_view style, Point baseline, std::string_view text, Align align, bool upwards) {
  const char* const anchor = align == Align::left ? "start" : align == Align::centre ? "middle" : "end";
  const std::string turn =
      upwards ? fmt::format(" transform=\"rotate(-90 {} {})\"", coordinate(baseline.x), coordinate(baseline.y)) : "";
  markup_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", style,
                         coordinate(baseline.x), coordinate(baseline.y), anchor, turn, markup_text(printable(text)));
  box_.take(baseline);
}

void SvgGroup::reserve(Point corner, Size size) {
  box_.take(corner);
  box_.take({corner.x + size.width, corner.y + size.height});
}

void SvgSheet::add(const SvgGroup& group, Point origin, std::string_view id, std::string_view attributes) {
  markup_ += fmt::format("<g id=\"{}\" transform=\"translate({} {})\"{}{}>\n{}</g>\n", id, coordinate(origin.x),
                         coordinate(origin.y), attributes.empty() ? "" : " ", attributes, group.markup());
}

std::string SvgSheet::finish(Size size, std::string_view title, std::string_view description) const {
  const std::string width = coordinate(size.width);
  const std::string height = coordinate(size.height);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\">\n"
      "<title>{2}</title>\n<desc>{3}</desc>\n<style>{4}</style>\n"
      "<rect class=\"paper\" width=\"{0}\" height=\"{1}\"/>\n{5}</svg>\n",
      width, height, markup_text(printable(title)), markup_text(printable(description)), kStyle, markup_);
}

double sheet_text_width(std::string_view text, double font_size) {
  const Canvas canvas(Canvas::Format::png, {1.0, 1.0}, 1.0);
  return canvas.text_width(text, {font_size, false});
}

}  // namespace retrace::report

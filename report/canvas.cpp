#include "report/canvas.h"

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <stdexcept>

#include "core/error.h"
#include "core/message_text.h"
#include "core/text.h"

#if defined(__has_feature)  // only clang defines it, and sanitizer builds are made with clang
#if __has_feature(address_sanitizer)
// Suppresses reports of the leak checker about Fontconfig, which keeps its font cache until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig\n";
}
#endif
#endif

namespace retrace::report {
namespace {

constexpr std::string_view kEllipsis = "\u2026";
/// Number of points (1/72 inch, cairo's unit in SVG files) per drawing unit (1/96 inch).
constexpr double kPointsPerUnit = 0.75;
constexpr double kLargestScale = 16.0;

struct Release {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw OutputError(std::string("the plot cannot be drawn: ") + cairo_status_to_string(status));
}

cairo_status_t append(void* closure, const unsigned char* data, unsigned int length) noexcept {
  try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {  // exceptions must not propagate through the C code of cairo
    return CAIRO_STATUS_NO_MEMORY;
  }
}

/// Splits a valid UTF-8 text into its characters.
std::vector<std::string> characters(std::string_view text) {
  std::vector<std::string> result;
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(1, utf8_length(text));
    result.emplace_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return result;
}

/// Removes the ids of surfaces, which are not used in the SVG. Cairo numbers all surfaces of the process consecutively,
/// so equal plots would otherwise give different files.
std::string without_surface_ids(std::string svg) {
  constexpr std::string_view start = " id=\"surface";
  for (std::size_t at = svg.find(start); at != std::string::npos; at = svg.find(start, at)) {
    const std::size_t end = svg.find('"', at + start.size());
    if (end == std::string::npos) break;
    svg.erase(at, end + 1 - at);
  }
  return svg;
}

/// Renumbers the ids of images, and the references to them, from 1. Cairo numbers all images of the process
/// consecutively, so equal plots would otherwise give different files.
std::string with_own_image_ids(std::string svg) {
  std::vector<std::string> known;
  for (const std::string_view mark : {" id=\"image", "\"#image"})
    for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + mark.size())) {
      const std::size_t begin = at + mark.size();
      const std::size_t end = svg.find('"', begin);
      if (end == std::string::npos) break;
      const std::string number = svg.substr(begin, end - begin);
      auto place = std::find(known.begin(), known.end(), number);
      if (place == known.end()) place = known.insert(known.end(), number);
      svg.replace(begin, end - begin, std::to_string(place - known.begin() + 1));
    }
  return svg;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      result += "\ufffd";
    } else if (printable_length(text) == 0) {
      result += ' ';
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return result;
}

struct Canvas::Impl {
  Format format;
  std::string bytes;
  std::unique_ptr<cairo_surface_t, Release> surface;
  std::unique_ptr<cairo_t, Release> context;

  void add(const std::vector<Point>& polygon) const {
    cairo_new_sub_path(context.get());
    for (const Point p : polygon) cairo_line_to(context.get(), p.x, p.y);
    cairo_close_path(context.get());
  }
  void set(Colour colour) const { cairo_set_source_rgb(context.get(), colour.red, colour.green, colour.blue); }
  void set(Font font) const {
    cairo_select_font_face(context.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), font.size);
  }
};

Canvas::Canvas(Format format, Size size, double scale) : impl_(std::make_unique<Impl>()) {
  if (!(scale > 0.0 && scale <= kLargestScale))
    throw std::invalid_argument(fmt::format("plot scale {}: not in (0, {}]", scale, kLargestScale));
  Impl& hidden = *impl_;
  hidden.format = format;
  if (format == Format::svg) {
    hidden.surface.reset(cairo_svg_surface_create_for_stream(append, &hidden.bytes, size.width * kPointsPerUnit,
                                                             size.height * kPointsPerUnit));
    check(cairo_surface_status(hidden.surface.get()));
    scale = kPointsPerUnit;
  } else {
    hidden.surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                                    static_cast<int>(std::lround(size.width * scale)),
                                                    static_cast<int>(std::lround(size.height * scale))));
    check(cairo_surface_status(hidden.surface.get()));
  }
  hidden.context.reset(cairo_create(hidden.surface.get()));
  cairo_t* const context = hidden.context.get();
  cairo_scale(context, scale, scale);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  // These options make the drawing independent of the user's font settings and the layout independent of the scale.
  const std::unique_ptr<cairo_font_options_t, Release> options(cairo_font_options_create());
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_set_font_options(context, options.get());
  check(cairo_status(context));
}

Canvas::~Canvas() = default;

double Canvas::text_width(std::string_view text, Font font) const {
  impl_->set(font);
  cairo_text_extents_t extents{};
  cairo_text_extents(impl_->context.get(), std::string(text).c_str(), &extents);
  check(cairo_status(impl_->context.get()));
  return extents.x_advance;
}

std::vector<std::string> Canvas::fitted(std::string_view raw, Font font, double width, int max_lines,
                                        Ellipsis ellipsis) const {
  const std::string text = printable(raw);
  std::vector<std::string> lines;
  std::string rest = text.substr(std::min(text.find_first_not_of(' '), text.size()));
  while (!rest.empty() && static_cast<int>(lines.size()) + 1 < max_lines && text_width(rest, font) > width) {
    // Finds the longest part of the text that ends at a space and fits into the line. A word that is longer than a line
    // is shortened below.
    std::size_t best = 0;
    for (std::size_t at = rest.find(' '); at != std::string::npos; at = rest.find(' ', at + 1)) {
      if (text_width(rest.substr(0, at), font) > width) break;
      best = at;
    }
    if (best == 0) break;
    lines.push_back(rest.substr(0, best));
    rest.erase(0, rest.find_first_not_of(' ', best));
  }
  if (rest.empty()) return lines;
  if (text_width(rest, font) > width) {
    // Finds the maximum number of characters that fit.
    const std::vector<std::string> all = characters(rest);
    const auto shortened = [&](std::size_t kept) {
      const std::size_t tail = ellipsis == Ellipsis::middle ? kept / 2 : 0;
      std::string result;
      for (std::size_t i = 0; i < kept - tail; ++i) result += all[i];
      result += kEllipsis;
      for (std::size_t i = all.size() - tail; i < all.size(); ++i) result += all[i];
      return result;
    };
    std::size_t fits = 0;
    std::size_t too_many = all.size();
    while (too_many - fits > 1) {
      const std::size_t middle = fits + (too_many - fits) / 2;
      (text_width(shortened(middle), font) <= width ? fits : too_many) = middle;
    }
    rest = shortened(fits);
  }
  lines.push_back(rest);
  return lines;
}

void Canvas::fill_rectangle(Point corner, Size size, Colour colour) {
  impl_->set(colour);
  cairo_rectangle(impl_->context.get(), corner.x, corner.y, size.width, size.height);
  cairo_fill(impl_->context.get());
}

void Canvas::image(Point corner, Size size, std::size_t columns, const std::vector<Colour>& colours) {
  cairo_t* const context = impl_->context.get();
  const std::size_t rows = colours.size() / columns;
  const std::unique_ptr<cairo_surface_t, Release> pixels(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(columns), static_cast<int>(rows)));
  check(cairo_surface_status(pixels.get()));
  const auto byte = [](double share) { return static_cast<std::uint32_t>(std::lround(255.0 * share)); };
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(pixels.get()));
  unsigned char* const data = cairo_image_surface_get_data(pixels.get());
  for (std::size_t i = 0; i < rows * columns; ++i) {
    const std::uint32_t pixel = byte(colours[i].red) << 16 | byte(colours[i].green) << 8 | byte(colours[i].blue);
    std::memcpy(data + i / columns * stride + i % columns * sizeof pixel, &pixel, sizeof pixel);
  }
  cairo_surface_mark_dirty(pixels.get());
  cairo_save(context);
  cairo_translate(context, corner.x, corner.y);
  cairo_scale(context, size.width / static_cast<double>(columns), size.height / static_cast<double>(rows));
  cairo_set_source_surface(context, pixels.get(), 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(context), CAIRO_FILTER_NEAREST);
  cairo_paint(context);
  cairo_restore(context);
}

void Canvas::line(const std::vector<Point>& points, const Stroke& stroke) {
  cairo_t* const context = impl_->context.get();
  impl_->set(stroke.colour);
  cairo_set_line_width(context, stroke.width);
  cairo_set_line_cap(context, stroke.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(context, stroke.dashes.data(), static_cast<int>(stroke.dashes.size()), 0.0);
  cairo_new_path(context);
  for (const Point point : points) cairo_line_to(context, point.x, point.y);
  cairo_stroke(context);
}

void Canvas::fill(const std::vector<std::vector<Point>>& polygons, Colour colour, double swell, double opacity) {
  cairo_t* const context = impl_->context.get();
  cairo_set_source_rgba(context, colour.red, colour.green, colour.blue, opacity);
  cairo_new_path(context);
  for (const auto& polygon : polygons) impl_->add(polygon);
  if (swell <= 0.0) {
    cairo_fill(context);
    return;
  }
  cairo_fill_preserve(context);
  cairo_set_dash(context, nullptr, 0, 0.0);
  cairo_set_line_width(context, 2.0 * swell);
  cairo_stroke(context);
}

void Canvas::hatch(const std::vector<Point>& polygon, double spacing, const Stroke& stroke) {
  if (polygon.empty()) return;
  Point lower = polygon[0];
  Point upper = polygon[0];
  for (const Point p : polygon) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
  }
  clip(polygon);
  const double height = upper.y - lower.y;
  for (double x = lower.x - height + spacing; x < upper.x; x += spacing)
    line({{x, upper.y}, {x + height, lower.y}}, stroke);
  end_clip();
}

void Canvas::marker(Point centre, Marker shape, double radius, Colour colour) {
  cairo_t* const context = impl_->context.get();
  // The coordinates of the corners below make all shapes appear equally large.
  const auto polygon = [&](const std::vector<Point>& corners) {
    for (const Point corner : corners)
      cairo_line_to(context, centre.x + radius * corner.x, centre.y + radius * corner.y);
    cairo_close_path(context);
  };
  cairo_new_path(context);
  switch (shape) {
    case Marker::circle: cairo_arc(context, centre.x, centre.y, radius, 0.0, 2.0 * std::numbers::pi); break;
    case Marker::square: polygon({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}}); break;
    case Marker::triangle: polygon({{0.0, -1.3}, {1.15, 0.75}, {-1.15, 0.75}}); break;
    case Marker::diamond: polygon({{0.0, -1.35}, {1.2, 0.0}, {0.0, 1.35}, {-1.2, 0.0}}); break;
    case Marker::inverted_triangle: polygon({{0.0, 1.3}, {1.15, -0.75}, {-1.15, -0.75}}); break;
  }
  // A thin white border separates markers that overlap.
  impl_->set(colour);
  cairo_fill_preserve(context);
  impl_->set(Colour{1.0, 1.0, 1.0});
  cairo_set_dash(context, nullptr, 0, 0.0);
  cairo_set_line_width(context, 0.6);
  cairo_stroke(context);
}

void Canvas::text(Point baseline, std::string_view text, Font font, Colour colour, Align align, bool upwards) {
  cairo_t* const context = impl_->context.get();
  const std::string shown = printable(text);
  const double width = text_width(shown, font);
  cairo_save(context);
  impl_->set(colour);
  cairo_translate(context, baseline.x, baseline.y);
  if (upwards) cairo_rotate(context, -std::numbers::pi / 2.0);
  cairo_move_to(context, align == Align::left ? 0.0 : align == Align::centre ? -0.5 * width : -width, 0.0);
  cairo_show_text(context, shown.c_str());
  cairo_restore(context);
}

void Canvas::move_origin(Point by) {
  cairo_translate(impl_->context.get(), by.x, by.y);
}

void Canvas::clip(Point corner, Size size) {
  cairo_save(impl_->context.get());
  cairo_rectangle(impl_->context.get(), corner.x, corner.y, size.width, size.height);
  cairo_clip(impl_->context.get());
}

void Canvas::clip(const std::vector<Point>& polygon) {
  cairo_t* const context = impl_->context.get();
  cairo_save(context);
  cairo_new_path(context);
  impl_->add(polygon);
  cairo_clip(context);
}

void Canvas::end_clip() {
  cairo_restore(impl_->context.get());
}

std::string Canvas::finish() {
  Impl& hidden = *impl_;
  check(cairo_status(hidden.context.get()));
  cairo_show_page(hidden.context.get());
  if (hidden.format == Format::png)
    check(cairo_surface_write_to_png_stream(hidden.surface.get(), append, &hidden.bytes));
  cairo_surface_finish(hidden.surface.get());
  check(cairo_surface_status(hidden.surface.get()));
  return hidden.format == Format::svg ? with_own_image_ids(without_surface_ids(std::move(hidden.bytes)))
                                      : std::move(hidden.bytes);
}

}  // namespace retrace::report

#pragma once

// Internal to library/: data of a Drawing.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "report/render.h"
#include "retrace/drawing.h"

namespace retrace {

struct Drawing::Content {
  std::function<std::string()> svg;
  std::function<std::string()> png;
};

/// Returns the drawing of a plot.
/// \param plot function that makes the plot and owns the data of the plot
template <class Plot>
Drawing drawing_of(Plot plot) {
  return Drawing(std::make_shared<const Drawing::Content>(
      Drawing::Content{[plot] { return report::render_svg(plot()); }, [plot] { return report::render_png(plot()); }}));
}

/// Returns a drawing that consists of one file.
/// \param text function that returns the content of the file
/// \param is_svg true: the file is an SVG document; false: a PNG file
inline Drawing drawing_of_text(std::function<std::string()> text, bool is_svg) {
  const auto none = [] { return std::string(); };
  Drawing::Content content{none, none};
  (is_svg ? content.svg : content.png) = std::move(text);
  return Drawing(std::make_shared<const Drawing::Content>(std::move(content)));
}

}  // namespace retrace

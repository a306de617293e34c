#pragma once

// Internal to library/: what a Drawing of the library holds.

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

/// The drawing of a plot. \param plot makes the plot, and owns what it is of
template <class Plot>
Drawing drawing_of(Plot plot) {
  return Drawing(std::make_shared<const Drawing::Content>(
      Drawing::Content{[plot] { return report::render_svg(plot()); }, [plot] { return report::render_png(plot()); }}));
}

/// A drawing that is one text or picture. \param is_svg else a PNG file
inline Drawing drawing_of_text(std::function<std::string()> text, bool is_svg) {
  const auto none = [] { return std::string(); };
  Drawing::Content content{none, none};
  (is_svg ? content.svg : content.png) = std::move(text);
  return Drawing(std::make_shared<const Drawing::Content>(std::move(content)));
}

}  // namespace retrace

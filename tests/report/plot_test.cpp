#include "report/plot.h"

#include <cairo.h>
#include <expat.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace retrace::report::plot_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

LinePlot empty_plot() {
  return {"Title", "Incidence angle (°)", "RRE (%)", {}, {}, {}};
}

Series curve(std::string label, std::size_t points, double scale = 1.0) {
  Series series{std::move(label), {}, {}, {}};
  for (std::size_t i = 0; i < points; ++i) {
    const double x = points > 1 ? -40.0 + 80.0 * static_cast<double>(i) / static_cast<double>(points - 1) : 0.0;
    series.x.push_back(x);
    series.y.push_back(scale * 97.0 * std::cos(0.03 * x));
  }
  return series;
}

LinePlot curves(std::size_t count, std::size_t points) {
  LinePlot plot = empty_plot();
  for (std::size_t i = 0; i < count; ++i)
    plot.series.push_back(curve("design " + std::to_string(i), points, 1.0 - 0.9 * static_cast<double>(i) / 100.0));
  return plot;
}

/// A picture that is decoded from the bytes of a PNG file.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;

  /// Returns the number of pixels whose colour is close to `rgb`, so that anti-aliased edges are counted.
  std::size_t count_near(std::uint32_t rgb, int tolerance = 12) const {
    const auto is_near = [&](std::uint32_t pixel) {
      for (const int shift : {0, 8, 16}) {
        const int difference = static_cast<int>(pixel >> shift & 0xff) - static_cast<int>(rgb >> shift & 0xff);
        if (std::abs(difference) > tolerance) return false;
      }
      return true;
    };
    return static_cast<std::size_t>(std::count_if(pixels.begin(), pixels.end(), is_near));
  }
  /// Returns true if the outermost `margin` pixels on all sides are white, so that nothing is cut off.
  bool has_white_border(int margin) const {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool on_border = x < margin || y < margin || x >= width - margin || y >= height - margin;
        if (on_border && (pixels[static_cast<std::size_t>(y * width + x)] & 0xffffff) != 0xffffff) return false;
      }
    return true;
  }
};

Picture decoded(const std::string& png) {
  struct Source {
    std::string_view rest;
  } source{png};
  const auto read = [](void* closure, unsigned char* data, unsigned int length) {
    auto& rest = static_cast<Source*>(closure)->rest;
    if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
    std::copy_n(rest.begin(), length, data);
    rest.remove_prefix(length);
    return CAIRO_STATUS_SUCCESS;
  };
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create_from_png_stream(read, &source), &cairo_surface_destroy);
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("not a PNG file");
  Picture picture;
  picture.width = cairo_image_surface_get_width(surface.get());
  picture.height = cairo_image_surface_get_height(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < picture.height; ++y) {
    const unsigned char* const row = cairo_image_surface_get_data(surface.get()) + y * stride;
    for (int x = 0; x < picture.width; ++x) {
      const auto byte = [&](int i) { return static_cast<std::uint32_t>(row[4 * x + i]); };
      picture.pixels.push_back(byte(0) | byte(1) << 8 | byte(2) << 16);
    }
  }
  return picture;
}

/// Returns an empty text if `text` is a well-formed XML document with the root `svg`, and otherwise a description of
/// the fault.
std::string svg_fault(const std::string& text) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), &XML_ParserFree);
  std::string root;
  XML_SetUserData(parser.get(), &root);
  XML_SetStartElementHandler(parser.get(), [](void* data, const XML_Char* name, const XML_Char**) {
    auto& first = *static_cast<std::string*>(data);
    if (first.empty()) first = name;
  });
  if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), 1) != XML_STATUS_OK)
    return XML_ErrorString(XML_GetErrorCode(parser.get()));
  return root == "svg" ? "" : "root element " + root;
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

constexpr std::uint32_t kBlue = 0x0072b2;  // the first colour of the palette

TEST(RenderSvg, IsWellFormed) {
  EXPECT_EQ(svg_fault(render_svg(curves(3, 25))), "");
  EXPECT_EQ(svg_fault("<svg><g></svg>"), "mismatched tag") << "the check itself works";
}

TEST(RenderSvg, StaysWellFormedWhateverTheTextsHold) {
  LinePlot plot = curves(2, 5);
  plot.title = "<&\"' \xff \x01 ]]> %s 😀";
  plot.x_label = std::string("a\0b", 3);
  plot.series[0].label = "</svg>";
  EXPECT_EQ(svg_fault(render_svg(plot)), "");
  EXPECT_TRUE(decoded(render_png(plot)).has_white_border(4));
}

TEST(RenderPng, HasASignatureAndTheSizeOfItsScale) {
  const LinePlot plot = curves(1, 25);
  const std::string twice = render_png(plot);
  EXPECT_EQ(twice.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(twice.substr(twice.size() - 8, 4), "IEND");
  const std::string once = render_png(plot, 1.0);
  EXPECT_GT(big_endian(once, 16), 600U);
  EXPECT_EQ(big_endian(twice, 16), 2 * big_endian(once, 16));
  EXPECT_EQ(big_endian(twice, 20), 2 * big_endian(once, 20));
}

TEST(RenderPng, RefusesImpossibleScales) {
  for (const double scale : {0.0, -1.0, 17.0, kNan, kInfinity})
    EXPECT_THROW(render_png(empty_plot(), scale), std::invalid_argument);
}

TEST(Render, GivesTheSameBytesEveryTime) {
  const LinePlot plot = curves(12, 30);
  const std::string svg = render_svg(plot);
  const std::string png = render_png(plot);
  static_cast<void>(render_svg(empty_plot()));  // another plot in between must not change the result
  EXPECT_EQ(render_svg(plot), svg);
  EXPECT_EQ(render_png(plot), png);
}

TEST(Render, DrawsTheCurve) {
  LinePlot plot = empty_plot();
  const std::size_t without = decoded(render_png(plot)).count_near(kBlue);
  plot.series.push_back(curve("", 200));
  const std::size_t with = decoded(render_png(plot)).count_near(kBlue);
  EXPECT_EQ(without, 0U);
  EXPECT_GT(with, 2000U);
}

TEST(Render, DrawsOnePointAlone) {
  LinePlot plot = empty_plot();
  plot.series.push_back({"", {3.0}, {97.6}, {}});
  const std::size_t marked = decoded(render_png(plot)).count_near(kBlue);
  EXPECT_GT(marked, 80U);
  EXPECT_LT(marked, 400U);
}

TEST(Render, ShowsErrorBarsOnlyWhereTheyCanBeSeen) {
  LinePlot plot = curves(1, 25);
  const std::string without = render_png(plot);
  plot.series[0].y_error.assign(25, 1e-3);
  EXPECT_EQ(render_png(plot), without);
  plot.series[0].y_error.assign(25, 3.0);
  EXPECT_GT(decoded(render_png(plot)).count_near(kBlue), decoded(without).count_near(kBlue) + 1000);
}

TEST(Render, InterruptsTheLineAtMissingValues) {
  LinePlot plot = curves(1, 101);
  const std::size_t whole = decoded(render_png(plot)).count_near(kBlue);
  for (std::size_t i = 30; i < 70; ++i) plot.series[0].y[i] = i % 2 == 0 ? kNan : kInfinity;
  EXPECT_LT(decoded(render_png(plot)).count_near(kBlue), whole * 3 / 4);
}

TEST(Render, KeepsToGivenRanges) {
  LinePlot plot = curves(1, 101);
  plot.x_range = Range{100.0, 200.0};  // the curve is outside of this range
  plot.series[0].label.clear();
  EXPECT_EQ(decoded(render_png(plot)).count_near(kBlue), 0U);
  plot.x_range = Range{-10.0, 10.0};
  EXPECT_TRUE(decoded(render_png(plot)).has_white_border(4));
}

TEST(Render, KeepsTextsInsideThePicture) {
  LinePlot plot = curves(14, 5);
  const std::string words = "words that make a text which is far too long for the place it has in a picture ";
  plot.title = words + words + words + words;
  plot.x_label = plot.title;
  plot.y_label = std::string(500, 'W');
  plot.series[2].label = std::string(400, 'M');
  EXPECT_TRUE(decoded(render_png(plot)).has_white_border(8));
  EXPECT_EQ(svg_fault(render_svg(plot)), "");
}

TEST(Render, ManySeriesHaveLegendsThatFit) {
  const LinePlot few = curves(10, 20);
  const LinePlot many = curves(100, 3);
  EXPECT_TRUE(decoded(render_png(few)).has_white_border(8));
  const Picture picture = decoded(render_png(many, 1.0));
  EXPECT_TRUE(picture.has_white_border(4));
  EXPECT_GT(picture.height, 60 * 15);
}

TEST(Render, ManyCurvesHaveAColourBarInsteadOfALegend) {
  LinePlot plot = curves(36, 20);
  const Picture with_legend = decoded(render_png(plot, 1.0));
  plot.scale_label = "Azimuth (°)";
  plot.legend.emplace();
  for (std::size_t k = 0; k < plot.series.size(); ++k) plot.series[k].scale_value = 10.0 * static_cast<double>(k);
  EXPECT_EQ(svg_fault(render_svg(plot)), "");
  const Picture picture = decoded(render_png(plot, 1.0));
  EXPECT_TRUE(picture.has_white_border(4));
  EXPECT_LT(picture.height, with_legend.height);
  EXPECT_GT(picture.count_near(0x440154), 100U) << "the first colour of Viridis";
  for (Series& series : plot.series) series.scale_value = 5.0;
  EXPECT_TRUE(decoded(render_png(plot, 1.0)).has_white_border(4)) << "a scale without width";
}

TEST(Render, SurvivesDegenerateInput) {
  std::vector<LinePlot> plots(8, empty_plot());
  plots[0] = {};
  plots[1].series.push_back({});
  plots[2].series.push_back({"all missing", {kNan, 1.0}, {1.0, kInfinity}, {}});
  plots[3].series.push_back({"constant", {0.0, 1.0}, {5.0, 5.0}, {kNan, -1.0}});
  plots[4].series.push_back({"one x", {2.0, 2.0}, {0.0, 100.0}, {}});
  plots[5].series.push_back({"huge", {-1e308, 1e308}, {-1e308, 1e308}, {1e308, 1e308}});
  plots[6].series.push_back({"tiny", {0.0, 1e-300}, {0.0, 5e-324}, {}});
  plots[7].x_range = Range{kNan, 1.0};
  plots[7].y_range = Range{5.0, 5.0};
  for (const LinePlot& plot : plots) {
    EXPECT_EQ(svg_fault(render_svg(plot)), "");
    EXPECT_TRUE(decoded(render_png(plot, 1.0)).has_white_border(2));
  }
}

TEST(Render, RefusesSeriesOfUnequalLengths) {
  LinePlot plot = empty_plot();
  plot.series.push_back({"x", {1.0, 2.0}, {1.0}, {}});
  EXPECT_THROW(render_svg(plot), std::invalid_argument);
  plot.series[0] = {"x", {1.0}, {1.0}, {0.1, 0.2}};
  EXPECT_THROW(render_png(plot), std::invalid_argument);
}

TEST(Render, SharesNeverLeaveWhatASharesCanBe) {
  LinePlot plot = empty_plot();
  plot.series.push_back({"mirror", {-10.0, 0.0, 10.0}, {100.0, 100.0, 100.0}, {}});
  LinePlot same = plot;
  same.y_range = Range{94.0, 100.0};
  EXPECT_EQ(render_svg(plot), render_svg(same));
}

}  // namespace
}  // namespace retrace::report::plot_test

// Tests of picture files, which OpenImageIO reads back, and of colour scales and tone curves, which are compared with
// their definitions.
#include "report/io/picture_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/srgb.h"
#include "report/colour_scale.h"
#include "report/image_plot.h"

namespace retrace::report::picture_file_test {
namespace {

FloatPicture sample() {
  return {3,
          2,
          {{"Y", {0.0, 1.0, 2.5, -3.0, 1e-9, 1e9}}, {"coverage", {1, 0, 1, 0, 1, 0}}},
          {{"retrace:unit", "cd/m2"}},
          {{"retrace:width_mm", 12.5}}};
}

TEST(PictureFile, ExrKeepsValuesNamesAndMetadata) {
  const std::string bytes = exr_file(sample());
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::open("picture.exr", nullptr, &memory);
  ASSERT_TRUE(input) << OIIO::geterror();
  const OIIO::ImageSpec spec = input->spec();
  EXPECT_EQ(spec.width, 3);
  EXPECT_EQ(spec.height, 2);
  EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(spec.get_string_attribute("retrace:unit"), "cd/m2");
  EXPECT_EQ(spec.get_float_attribute("retrace:width_mm"), 12.5F);
  EXPECT_EQ(spec.get_string_attribute("DateTime"), "") << "bytes would depend on the time of day";
  std::vector<float> pixels(3 * 2 * 2);
  ASSERT_TRUE(input->read_image(0, 0, 0, 2, OIIO::TypeDesc::FLOAT, pixels.data()));
  const int y = spec.channelindex("Y");
  const int coverage = spec.channelindex("coverage");
  ASSERT_GE(y, 0);
  ASSERT_GE(coverage, 0);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(pixels[2 * k + static_cast<std::size_t>(y)], static_cast<float>(sample().channels[0].second[k]));
    EXPECT_EQ(pixels[2 * k + static_cast<std::size_t>(coverage)], static_cast<float>(sample().channels[1].second[k]));
  }
}

TEST(PictureFile, GivesTheSameBytesAgain) {
  EXPECT_EQ(exr_file(sample()), exr_file(sample()));
  const std::vector<unsigned char> rgb = {0, 0, 0, 255, 255, 255, 10, 20, 30, 1, 2, 3};
  EXPECT_TRUE(png_file(2, 2, rgb).starts_with("\x89PNG"));
  EXPECT_EQ(png_file(2, 2, rgb), png_file(2, 2, rgb));
}

TEST(ColourScale, LightnessRisesEvenlyWithOneHue) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  // CIELAB of sRGB (IEC 61966-2-1) with the white point D65.
  for (int k = 0; k <= 100; ++k) {
    const auto [r, g, b] = light_colour(0.01 * k);
    const double x = f((0.4124 * linear(r) + 0.3576 * linear(g) + 0.1805 * linear(b)) / 0.9505);
    const double y = f(0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b));
    const double z = f((0.0193 * linear(r) + 0.1192 * linear(g) + 0.9505 * linear(b)) / 1.089);
    EXPECT_NEAR(116.0 * y - 16.0, 5.0 + 0.93 * k, 1.5) << k;
    const double hue_deg = std::atan2(200.0 * (y - z), 500.0 * (x - y)) * 180.0 / std::numbers::pi;
    if (k < 98) {
      EXPECT_NEAR(hue_deg + 360.0, 264.0, 14.0) << k;
    }
  }
  EXPECT_EQ(light_colour(-1.0), light_colour(0.0));
  EXPECT_EQ(light_colour(2.0), light_colour(1.0));
}

TEST(ToneMapped, KeepsTheOrderAndTheMiddleAtItsKey) {
  std::vector<double> luminance;
  for (int k = 0; k < 100; ++k) luminance.push_back(k);
  const std::vector<double> shown = tone_mapped(luminance);
  for (std::size_t k = 1; k < 99; ++k) EXPECT_GT(shown[k], shown[k - 1]);
  EXPECT_EQ(shown[0], 0.0);
  EXPECT_LE(shown[98], 1.0);
  EXPECT_EQ(shown[99], 1.0) << "the brightest burns out";
  EXPECT_EQ(tone_mapped({0.0, 0.0}), (std::vector<double>{0.0, 0.0}));
  // If all pixels have the same value x, the white point of the tone curve is also x. The result is then x (1 + x /
  // x^2) / (1 + x) = 1.
  for (const double value : tone_mapped({5.0, 5.0})) EXPECT_DOUBLE_EQ(value, 1.0);
  EXPECT_EQ(srgb_byte(0.0), 0);
  EXPECT_EQ(srgb_byte(2.0), 255);
  EXPECT_EQ(srgb_byte(0.2140411), 128 - 1);  // IEC 61966-2-1: 0.5 encoded is 0.2140 linear
}

/// Equal ratios of luminance are equal steps of the encoded value, from black to white.
TEST(ToneCurve, LogarithmShowsDecadesInEqualSteps) {
  ToneCurve curve;
  curve.tone = Tone::log;
  curve.white = 50.0;
  for (const double decades : {0.0, 0.5, 1.0, 2.0, 3.5, kToneDecades})
    EXPECT_NEAR(srgb_from_linear(curve.shown(50.0 * std::pow(10.0, -decades))), 1.0 - decades / kToneDecades, 1e-9);
  EXPECT_EQ(curve.shown(1e4), 1.0);
  EXPECT_EQ(curve.shown(50.0 * std::pow(10.0, -kToneDecades - 1.0)), 0.0);
}

TEST(ImagePlot, DrawsTheSameAgainAndStrangeValues) {
  ImagePlot plot{"Title", {"one", "two"}, {{"a", "E", 3, 2, {0, 1, 2, 3, 4, 5}, 12.0, "mm"}}};
  const std::string png = render_png(plot);
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  EXPECT_EQ(png, render_png(plot));
  plot.panels.push_back({"dark", "E", 200, 1, std::vector<double>(200, 0.0), 1e-3, "°", 0.0, true});
  EXPECT_FALSE(render_png(plot).empty());
  EXPECT_THROW(render_png(plot, 0.0), std::invalid_argument);
}

TEST(ImagePlot, ScaleBarsAreRound) {
  EXPECT_DOUBLE_EQ(scale_bar_length(10.0), 2.0);
  EXPECT_DOUBLE_EQ(scale_bar_length(0.45), 0.1);
  EXPECT_DOUBLE_EQ(scale_bar_length(1.0), 0.2);
  EXPECT_DOUBLE_EQ(scale_bar_length(40.0), 10.0);
}

}  // namespace
}  // namespace retrace::report::picture_file_test

#include "report/results/picture_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/number_format.h"
#include "design/io/design_json.h"
#include "report/axis_ticks.h"

namespace retrace::report {

Colour displayed(std::array<double, 3> rgb, double intensity) {
  double lowest = 0.0;
  for (const double value : rgb) lowest = std::min(lowest, value);
  if (lowest < 0.0)
    for (double& value : rgb) value = intensity + (value - intensity) * intensity / (intensity - lowest);
  const double brightest = std::max({rgb[0], rgb[1], rgb[2]});
  if (brightest > 1.0) {
    const double paler = 0.4 * (1.0 - 1.0 / brightest);
    for (double& value : rgb) value = std::lerp(value / brightest, 1.0, paler);
  }
  return {srgb_byte(rgb[0]) / 255.0, srgb_byte(rgb[1]) / 255.0, srgb_byte(rgb[2]) / 255.0};
}

std::string name_with_dye(const design::Design& design, const std::string& dye) {
  const bool is_named = dye == "red" || dye == "amber";
  return design::short_name(design) + (dye == "none" ? "" : is_named ? ", " + dye : ", dyed");
}

std::string rounded_text(double value) {
  if (value >= 100.0) return fixed(value, 0);
  return value >= 10.0 ? fixed(value, 1) : fixed_visible(value, 2);
}

std::string exposure_text(const ToneCurve& tone, bool is_given) {
  return fmt::format("white is {} cd/m\u00b2 (EV100 {}, {}), {} tone curve", rounded_text(tone.white),
                     fixed(tone.ev100(), 1), is_given ? "given" : "automatic",
                     tone.tone == Tone::reinhard ? "Reinhard's" : (tone.tone == Tone::log ? "logarithmic" : "linear"));
}

void draw_luminance_bar(Canvas& canvas, const ToneCurve& tone, Point corner, double width) {
  constexpr int kSteps = 256;
  const bool is_log = tone.tone == Tone::log;
  const auto luminance_at = [&](double fraction) {
    return is_log ? tone.white * std::pow(10.0, kToneDecades * (fraction - 1.0)) : fraction * tone.white;
  };
  std::vector<Colour> colours;
  for (int k = 0; k < kSteps; ++k) {
    const double grey = srgb_byte(tone.shown(luminance_at((k + 0.5) / kSteps))) / 255.0;
    colours.push_back({grey, grey, grey});
  }
  canvas.image(corner, {width, kBarHeight}, kSteps, colours);
  const auto tick = [&](double fraction, const std::string& label, Align align) {
    const double x = corner.x + fraction * width;
    canvas.line({{x, corner.y + kBarHeight}, {x, corner.y + kBarHeight + 3.0}}, {kDim, 1.0, {}});
    canvas.text({x, corner.y + kBarHeight + 14.0}, label, kLineFont, kDim, align);
  };
  if (!is_log) {
    const Ticks ticks = make_ticks({0.0, tone.white}, 4);
    for (std::size_t k = 0; k < ticks.positions.size(); ++k)
      if (ticks.positions[k] < 0.85 * tone.white)
        tick(ticks.positions[k] / tone.white, ticks.labels[k], k == 0 ? Align::left : Align::centre);
  } else {
    for (int e = static_cast<int>(std::ceil(std::log10(tone.white) - kToneDecades));
         e <= std::floor(std::log10(tone.white)); ++e) {
      const double fraction = 1.0 + (e - std::log10(tone.white)) / kToneDecades;
      if (fraction < 0.8)
        tick(fraction, std::abs(e) < 4 ? shortest(std::pow(10.0, e)) : fmt::format("1e{}", e),
             fraction < 0.03 ? Align::left : Align::centre);
    }
  }
  tick(1.0, "cd/m\u00b2", Align::right);
}

bool has_bar(const ToneCurve& tone) {
  return tone.tone != Tone::reinhard;
}

}  // namespace retrace::report

#pragma once

// Display of pictures of luminances: colours, captions, and a bar of the displayed luminances. This header is
// private to report/.

#include <array>
#include <string>

#include "design/design.h"
#include "report/canvas.h"
#include "report/colour_scale.h"

namespace retrace::report {

inline constexpr Colour kPaper{0.10, 0.105, 0.12};
inline constexpr Colour kBright{0.94, 0.94, 0.94};
inline constexpr Colour kDim{0.70, 0.72, 0.76};
inline constexpr Font kNameFont{13.0, true};
inline constexpr Font kLineFont{11.0, false};
inline constexpr double kGap = 12.0;
inline constexpr double kLine = 16.0;
inline constexpr double kBarHeight = 10.0;

/// Returns the colour that is displayed for linear sRGB values. The hue is kept: colours outside of the display's range
/// become paler, and colours brighter than white approach white, as on photographic film.
/// \param intensity luminance of the colour; 1 is white
Colour displayed(std::array<double, 3> rgb, double intensity);

/// Returns the name of a design and its dye as a caption.
/// \param dye "none", "red", "amber" or the path of a file
std::string name_with_dye(const design::Design& design, const std::string& dye);

/// Returns a number as text. Numbers of at least 100 have no decimals, and numbers of at least 10 have one decimal.
/// Smaller numbers are written by fixed_visible() with two decimals.
std::string rounded_text(double value);

/// Returns a description of the exposure and the tone curve of a picture.
/// \param is_given true: the user gave the exposure
std::string exposure_text(const ToneCurve& tone, bool is_given);

/// Returns true if the tone curve requires a bar of the displayed luminances below the picture.
bool has_bar(const ToneCurve& tone);
/// Draws a bar with the displayed intensities of luminances and their values.
void draw_luminance_bar(Canvas& canvas, const ToneCurve& tone, Point corner, double width);

}  // namespace retrace::report

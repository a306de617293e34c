#pragma once

// Colours and elements that all plots have in common. This header is private to report/.

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "report/axis_ticks.h"
#include "report/canvas.h"

namespace retrace::report {

inline constexpr Colour kWhite{1.0, 1.0, 1.0};
inline constexpr Colour kAxis{0.35, 0.35, 0.35};
inline constexpr Colour kText{0.13, 0.13, 0.13};
inline constexpr Colour kFaint{0.42, 0.42, 0.42};
inline constexpr Font kTitleFont{16.0, true};
inline constexpr Font kPanelFont{12.5, true};
inline constexpr double kMargin = 22.0;
/// Maximum number of lines of a title. The last line of a longer title ends in an ellipsis.
inline constexpr int kMaxTitleLines = 3;
inline constexpr double kTitleLineHeight = 1.3 * kTitleFont.size;

/// Colours of Okabe and Ito (2008), which colour-blind readers can distinguish. Their yellow is too pale for a line on
/// white and is not used.
inline constexpr Colour kBlue{0.000, 0.447, 0.698};
inline constexpr Colour kVermilion{0.835, 0.369, 0.000};
inline constexpr Colour kBluishGreen{0.000, 0.620, 0.451};
inline constexpr Colour kReddishPurple{0.800, 0.475, 0.655};
inline constexpr Colour kOrange{0.902, 0.624, 0.000};
inline constexpr Colour kSkyBlue{0.337, 0.706, 0.914};
inline constexpr Colour kBlack{0.000, 0.000, 0.000};

/// Colours at equidistant positions of a scale.
using ColourScale = std::array<Colour, 9>;

/// Colour scale Viridis (Smith and van der Walt 2015). Its lightness changes uniformly, and it is suitable for
/// colour-blind readers.
inline constexpr ColourScale kViridis = {{{0.267, 0.005, 0.329},
                                          {0.279, 0.175, 0.483},
                                          {0.230, 0.322, 0.546},
                                          {0.173, 0.449, 0.558},
                                          {0.128, 0.567, 0.551},
                                          {0.158, 0.684, 0.502},
                                          {0.369, 0.789, 0.383},
                                          {0.678, 0.864, 0.190},
                                          {0.993, 0.906, 0.144}}};

/// Diverging colour scale RdBu of ColorBrewer (C. A. Brewer, 2003), from blue over white to red. It shows differences,
/// with white for 0, and is suitable for colour-blind readers.
inline constexpr ColourScale kBlueWhiteRed = {{{0.129, 0.400, 0.675},
                                               {0.263, 0.576, 0.765},
                                               {0.573, 0.773, 0.871},
                                               {0.820, 0.898, 0.941},
                                               {0.969, 0.969, 0.969},
                                               {0.992, 0.859, 0.780},
                                               {0.957, 0.647, 0.510},
                                               {0.839, 0.376, 0.302},
                                               {0.698, 0.094, 0.169}}};

/// Returns a colour of a scale.
/// \param fraction position on the scale, clamped to 0..1
Colour colour_at(const ColourScale& scale, double fraction);

/// Returns the colour of a contour line on a coloured area: dark on light areas, and white on dark areas.
Colour contour_colour(Colour area);

/// Draws a vertical bar with all colours, without a frame.
void draw_colour_bar(Canvas& canvas, const ColourScale& scale, Point corner, Size size);

void draw_frame(Canvas& canvas, Point corner, Size size, double width = 1.0);

/// Draws a text in one line. A text that is wider than `width` is shortened.
void draw_within(Canvas& canvas, double width, Ellipsis ellipsis, Point baseline, std::string_view text, Font font,
                 Colour colour, Align align);

/// Draws a grid of values as coloured pixels.
/// \param values values of the grid, row by row from the top
/// \param colour returns the colour of a value
void draw_values(Canvas& canvas, Point corner, Size size, std::size_t columns, const std::vector<double>& values,
                 const std::function<Colour(double)>& colour);

/// Returns the values of a grid with its rows in reverse order.
/// \param columns number of values in a row, >= 1
std::vector<double> with_reversed_rows(const std::vector<double>& values, std::size_t columns);

/// Returns a small canvas for the computation of sizes of texts, which do not depend on the canvas.
Canvas measuring_canvas();

/// Returns the lines of a title that fit in a figure of the given width.
std::vector<std::string> title_lines(std::string_view title, double figure_width);

/// Returns the height that a title needs in addition to its first line. It is 0 if the title has one line.
double added_title_height(std::string_view title, double figure_width);

/// Draws the title, centred at the top of a figure, in as many lines as title_lines() returns.
void draw_title(Canvas& canvas, Size figure, std::string_view title);

/// Draws the lines of a title at a given position.
/// \param baseline left end or centre of the baseline of the first line, according to `align`
void draw_title(Canvas& canvas, double figure_width, std::string_view title, Point baseline, Align align);

/// Wraps texts to at most three lines each, and returns the lines of all texts.
std::vector<std::string> wrapped(const std::vector<std::string>& texts, Font font, double width);

/// Dimensions of the ticks of an axis and of their labels.
struct AxisStyle {
  Font font;
  double tick = 4.0;         ///< length of a tick
  double x_label_gap = 0.0;  ///< distance from the x axis to the baseline of its labels
  double y_label_gap = 0.0;  ///< distance from the y axis, or from a colour bar, to the labels
  double baseline = 0.0;     ///< distance of the baseline of a y label below its tick
  double width = 1.0;
};

void draw_x_tick(Canvas& canvas, const AxisStyle& look, Point at, std::string_view label);
void draw_y_tick(Canvas& canvas, const AxisStyle& look, Point at, std::string_view label);
/// Draws a tick on the right side of a colour bar.
void draw_bar_tick(Canvas& canvas, const AxisStyle& look, Point at, std::string_view label);
/// Draws the ticks of a horizontal axis at the height y.
void draw_x_ticks(Canvas& canvas, const AxisStyle& look, const AxisScale& scale, const Ticks& ticks, double y);
/// Draws the ticks of a vertical axis at x.
void draw_y_ticks(Canvas& canvas, const AxisStyle& look, const AxisScale& scale, const Ticks& ticks, double x);
/// Draws the ticks of a colour bar whose right side is at x.
void draw_bar_ticks(Canvas& canvas, const AxisStyle& look, const AxisScale& scale, const Ticks& ticks, double x);

}  // namespace retrace::report

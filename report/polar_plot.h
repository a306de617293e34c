#pragma once

// Plots of a quantity over directions as coloured discs, such as far fields with the test points of a standard.

#include <cstddef>
#include <string>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// A marked direction in a polar panel.
struct PolarMark {
  double right_deg = 0.0;
  double up_deg = 0.0;
  std::string label;
  enum class Kind { holds, open, fails };
  Kind kind = Kind::holds;  ///< kind of mark: a circle, a square, or a warning triangle
};

/// Values for directions around a central direction, as colours in a disc. The distance from the centre of the disc is
/// the angle from the central direction.
struct PolarPanel {
  std::string title;
  double radius_deg = 1.0;
  std::size_t columns = 0;     ///< number of columns and of rows of the square around the disc
  std::vector<double> values;  ///< row by row from the bottom
  std::vector<PolarMark> marks;
  std::string remark = {};  ///< line under the title; not drawn if empty
};

/// Colour scale of polar panels.
enum class PolarScale {
  decades,    ///< logarithmic: four decades below the largest value
  linear,     ///< from 0 to the largest value, with contour lines
  difference  ///< linear, with white for 0 and the same range for both signs, with contour lines
};

/// Discs, two or three in a row, with one colour scale.
struct PolarPlot {
  std::string title;
  std::string value_label;
  std::vector<PolarPanel> panels;
  PolarScale scale = PolarScale::decades;
  /// True: directions are given by incidence (distance from the centre) and azimuth, which is written around the discs.
  bool has_azimuths = false;
};

struct LabelBox;

/// Returns the boxes that the labels of the marks occupy in a panel, relative to the centre of the disc, y down. Boxes
/// do not overlap.
std::vector<LabelBox> mark_label_boxes(const PolarPanel& panel);

class Canvas;
struct Point;

/// Draws a mark with a black outline.
void draw_mark(Canvas& canvas, Point at, PolarMark::Kind kind);

/// Draws the plot. render_svg() and render_png() call this function.
std::string render(const PolarPlot& plot, PlotFormat format, double scale);

}  // namespace retrace::report

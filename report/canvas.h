#pragma once

// Drawing operations for plots, based on cairo. This header is private to report/.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "report/render.h"

namespace retrace::report {

/// Colour in sRGB, with components from 0 to 1.
struct Colour {
  double red = 0.0, green = 0.0, blue = 0.0;
};

struct Point {
  double x = 0.0, y = 0.0;
};

struct Size {
  double width = 0.0, height = 0.0;
};

struct Font {
  double size = 12.0;
  bool bold = false;
};

struct Stroke {
  Colour colour;
  double width = 1.0;
  std::vector<double> dashes;  ///< alternating lengths of dashes and gaps; empty for a solid line
};

enum class Align { left, centre, right };
/// Position of the ellipsis in a shortened text. Sentences are shortened at their end. Names are shortened in the
/// middle, because names often differ in their last characters.
enum class Ellipsis { end, middle };
enum class Marker { circle, square, triangle, diamond, inverted_triangle };

/// Returns `text` as one line of valid UTF-8. Invalid byte sequences are replaced by U+FFFD. Control characters and
/// noncharacters (U+FFFE, U+FFFF) are replaced by spaces.
std::string printable(std::string_view text);

/// A drawing of fixed size in memory. Lengths are in units of 1/96 inch, and the y axis points down.
/// \throw OutputError from any member function if cairo fails
class Canvas {
 public:
  using Format = PlotFormat;
  /// \param scale number of pixels of a PNG per unit of length, > 0 and <= 16
  /// \throw std::invalid_argument if the scale is out of range
  Canvas(Format format, Size size, double scale);
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  ~Canvas();

  double text_width(std::string_view text, Font font) const;
  /// Breaks a text at spaces into at most `max_lines` lines of at most `width`. If the text does not fit, the last
  /// line is shortened with an ellipsis.
  std::vector<std::string> fitted(std::string_view text, Font font, double width, int max_lines,
                                  Ellipsis ellipsis) const;

  void fill_rectangle(Point corner, Size size, Colour colour);
  void line(const std::vector<Point>& points, const Stroke& stroke);
  /// Draws a picture that is stretched over a rectangle, without interpolation between pixels.
  /// \param colours colours of the pixels, row by row from the top
  /// \pre columns >= 1, and colours.size() is a multiple of columns
  void image(Point corner, Size size, std::size_t columns, const std::vector<Colour>& colours);
  /// Fills all polygons in one operation, so that the background is not visible between adjacent polygons.
  /// \param swell distance by which the edges are moved outwards, to overlap with polygons of another colour
  /// \param opacity 0 to 1
  void fill(const std::vector<std::vector<Point>>& polygons, Colour colour, double swell = 0.0, double opacity = 1.0);
  /// Fills a polygon with parallel lines that rise to the right.
  void hatch(const std::vector<Point>& polygon, double spacing, const Stroke& stroke);
  void marker(Point centre, Marker shape, double radius, Colour colour);
  /// Draws a text.
  /// \param baseline left end, centre or right end of the baseline, as given by `align`
  /// \param upwards true: the text is rotated by 90 degrees counter-clockwise
  void text(Point baseline, std::string_view text, Font font, Colour colour, Align align, bool upwards = false);
  /// Moves the origin of all later drawing operations.
  void move_origin(Point by);
  void clip(Point corner, Size size);
  void clip(const std::vector<Point>& polygon);
  void end_clip();

  /// Completes the drawing and returns the content of the file.
  std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace retrace::report

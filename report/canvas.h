#pragma once

// Private to report/: the few drawing operations a plot needs, over cairo, which no other header names.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "report/render.h"

namespace retrace::report {

struct Point {
  double x = 0.0, y = 0.0;
};

struct Size {
  double width = 0.0, height = 0.0;
};

/// sRGB, each 0..1.
struct Colour {
  double red = 0.0, green = 0.0, blue = 0.0;
};

struct Font {
  double size = 12.0;
  bool bold = false;
};

struct Stroke {
  Colour colour;
  double width = 1.0;
  std::vector<double> dashes;  ///< lengths on and off in turn; empty: solid
};

enum class Align { left, centre, right };
/// Where a text is shortened: sentences at their end, names in the middle, because names often differ in their ends.
enum class Ellipsis { end, middle };
enum class Marker { circle, square, triangle, diamond, inverted_triangle };

/// Returns `text` as one line of valid UTF-8. Invalid byte sequences are replaced by U+FFFD. Control characters and
/// noncharacters (U+FFFE, U+FFFF) are replaced by spaces.
std::string printable(std::string_view text);

/// A drawing of fixed size in units of 1/96 inch, y down, kept in memory. \throw OutputError from any member if cairo
/// fails.
class Canvas {
 public:
  using Format = PlotFormat;
  /// \param scale pixels a unit of a PNG, > 0 and <= 16 \throw std::invalid_argument for another scale
  Canvas(Format format, Size size, double scale);
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  ~Canvas();

  double text_width(std::string_view text, Font font) const;
  /// `text` in at most `most_lines` lines of at most `width`, broken at spaces; an ellipsis in the last line stands for
  /// what is too much.
  std::vector<std::string> fitted(std::string_view text, Font font, double width, int most_lines,
                                  Ellipsis ellipsis) const;

  void fill_rectangle(Point corner, Size size, Colour colour);
  void line(const std::vector<Point>& points, const Stroke& stroke);
  /// A picture of columns x colours.size() / columns pixels, its first row on top, stretched over a rectangle. Pixels
  /// keep their edges. \pre columns >= 1, whole rows
  void image(Point corner, Size size, std::size_t columns, const std::vector<Colour>& colours);
  /// All polygons at once, so that none of the background shows between neighbours. \param swell by how much their
  /// edges are moved out, to overlap with those of another colour \param opacity 0..1
  void fill(const std::vector<std::vector<Point>>& polygons, Colour colour, double swell = 0.0, double opacity = 1.0);
  /// Parallel lines that rise to the right, all over a polygon.
  void hatch(const std::vector<Point>& polygon, double spacing, const Stroke& stroke);
  void marker(Point centre, Marker shape, double radius, Colour colour);
  /// `baseline` is the point of the text's baseline that `align` names; `upwards` turns the text by 90 degrees to the
  /// left.
  void text(Point baseline, std::string_view text, Font font, Colour colour, Align align, bool upwards = false);
  void clip(Point corner, Size size);
  void clip(const std::vector<Point>& polygon);
  void end_clip();

  /// Ends the drawing and returns the file's bytes.
  std::string finish();

 private:
  struct Hidden;
  std::unique_ptr<Hidden> hidden_;
};

}  // namespace retrace::report

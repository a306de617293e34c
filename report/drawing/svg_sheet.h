#pragma once

// Builds SVG drawings from groups of lines, faces and texts that know the room they take on the sheet.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/canvas.h"

namespace retrace::report {

/// Lower and upper bounds of what is drawn, y down.
struct PaperBox {
  Point lower{1e300, 1e300};
  Point upper{-1e300, -1e300};

  void take(Point p);
  Size size() const { return {upper.x - lower.x, upper.y - lower.y}; }
};

/// Elements of an SVG document, each in a class of the sheet's style, in units of 1/96 inch, y down. It knows how much
/// room they take.
class SvgGroup {
 public:
  void faces(std::string_view style, const std::vector<std::vector<Point>>& polygons);
  void lines(std::string_view style, const std::vector<std::pair<Point, Point>>& lines);
  void outline(std::string_view style, const std::vector<Point>& polygon);
  void path(std::string_view style, const std::vector<Point>& points);
  void circle(std::string_view style, Point centre, double radius);
  /// A piece of a circle, from one direction to another, angles counter-clockwise from +x in radians.
  void arc(std::string_view style, Point centre, double radius, double from_rad, double to_rad);
  void text(std::string_view style, Point baseline, std::string_view text, Align align, bool upwards = false);
  /// Room that a text of this width takes as well.
  void reserve(Point corner, Size size);

  const PaperBox& box() const { return box_; }
  const std::string& markup() const { return markup_; }

 private:
  std::string at(Point p);

  std::string markup_;
  PaperBox box_;
};

/// A sheet of groups. The same groups give the same bytes.
class SvgSheet {
 public:
  /// Puts the group's origin at a place of the sheet. \param attributes of its element, such as "data-x-mm=\"0\""
  void add(const SvgGroup& group, Point origin, std::string_view id, std::string_view attributes = "");
  /// \param description of what is drawn, for screen readers
  std::string finish(Size size, std::string_view title, std::string_view description) const;

 private:
  std::string markup_;
};

/// Width of a text on such sheets.
double sheet_text_width(std::string_view text, double font_size);

inline constexpr double kSheetTextSize = 12.0;
inline constexpr double kSheetTitleSize = 17.0;
inline constexpr double kSheetPanelSize = 13.5;

}  // namespace retrace::report

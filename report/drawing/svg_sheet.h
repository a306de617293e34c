#pragma once

// Builds SVG drawings from groups of lines, faces and texts. The groups record their bounding boxes.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/canvas.h"

namespace retrace::report {

/// Bounding box in drawing coordinates, y down.
struct PaperBox {
  Point lower{1e300, 1e300};
  Point upper{-1e300, -1e300};

  void take(Point p);
  Size size() const { return {upper.x - lower.x, upper.y - lower.y}; }
};

/// Group of elements of an SVG document. Each element has a style class of the sheet. Coordinates are in units of 1/96
/// inch, with y down. The group records its bounding box.
class SvgGroup {
 public:
  void faces(std::string_view style, const std::vector<std::vector<Point>>& polygons);
  void lines(std::string_view style, const std::vector<std::pair<Point, Point>>& lines);
  void outline(std::string_view style, const std::vector<Point>& polygon);
  void path(std::string_view style, const std::vector<Point>& points);
  void circle(std::string_view style, Point centre, double radius);
  /// Draws an arc of a circle. Angles are counter-clockwise from +x in radians.
  void arc(std::string_view style, Point centre, double radius, double from_rad, double to_rad);
  void text(std::string_view style, Point baseline, std::string_view text, Align align, bool upwards = false);
  /// Extends the bounding box by a rectangle, such as that of a text.
  void reserve(Point corner, Size size);

  const PaperBox& box() const { return box_; }
  const std::string& markup() const { return markup_; }

 private:
  std::string at(Point p);

  std::string markup_;
  PaperBox box_;
};

/// A sheet of groups. Equal groups give equal bytes.
class SvgSheet {
 public:
  /// Adds a group with its origin at a point of the sheet.
  /// \param attributes attributes of the group's element, such as "data-x-mm=\"0\""
  void add(const SvgGroup& group, Point origin, std::string_view id, std::string_view attributes = "");
  /// Returns the SVG document.
  /// \param description description of the drawing, for screen readers
  std::string finish(Size size, std::string_view title, std::string_view description) const;

 private:
  std::string markup_;
};

/// Returns the width of a text on a sheet.
double sheet_text_width(std::string_view text, double font_size);

inline constexpr double kSheetTextSize = 12.0;
inline constexpr double kSheetTitleSize = 17.0;
inline constexpr double kSheetPanelSize = 13.5;

}  // namespace retrace::report

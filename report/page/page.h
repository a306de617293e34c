#pragma once

// The contents of the HTML page of `retrace report` - sections, tables, charts, figures, the view in three dimensions -
// and their HTML.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/page/html_text.h"
#include "report/page/live_page.h"

namespace retrace::report {

/// One cell of a table: what is shown, and the value in full for the CSV file where that differs.
struct PageCell {
  std::string text;
  std::string full;   ///< empty: the same
  std::string style;  ///< "good", "bad", "open" or none

  PageCell() = default;
  PageCell(std::string shown) : text(std::move(shown)) {}
  PageCell(const char* shown) : text(shown) {}
  /// Six digits, and all of them in the CSV file.
  PageCell(double value);
};

/// A table that can be saved as CSV.
struct PageTable {
  std::string caption;
  std::vector<std::string> columns;  ///< with their units: "incidence (deg)"
  std::vector<std::vector<PageCell>> rows;
  std::string csv_name;
  std::size_t left_out = 0;  ///< rows of the result that are not here
};

struct ChartSeries {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// Curves that can be hovered and zoomed.
struct PageChart {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<ChartSeries> series;
  std::optional<double> y_from;  ///< where the y axis begins; none: where the values do
};

/// Straight moves of one kind, in mm.
struct PathMoves {
  std::string label;
  std::vector<std::array<double, 4>> moves;  ///< from x, y to x, y
};

/// The way of a tool in a section, to scale, that can be zoomed and whose kinds can be hidden.
struct PagePath {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PathMoves> kinds;
};

/// A drawing (SVG, made by retrace) or a picture in a file of the folder.
struct PageFigure {
  std::string caption;
  std::string svg;               ///< as markup; empty: a picture
  std::string media_type;        ///< of the picture, such as "image/png"
  std::string bytes;             ///< of the picture
  std::string alternative_text;  ///< says what is to be seen
};

struct PageFact {
  std::string name;
  std::string value;
  std::string style;  ///< as PageCell::style
};

struct PageSection {
  std::string id;  ///< unique, letters and digits
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<PageFact> facts;
  std::vector<std::string> steps;  ///< in their order, to be ticked off
  std::vector<PageChart> charts;
  std::vector<PagePath> paths;
  std::vector<PageFigure> figures;
  std::vector<PageTable> tables;
  std::vector<std::pair<std::string, std::string>> details;  ///< folded texts: title, content
  bool has_scene = false;
  bool has_live = false;
};

PageSection titled(std::string title, const std::string& paragraph = {});

/// One light path of the view in three dimensions.
struct ScenePathView {
  std::string label;
  std::vector<std::array<double, 3>> points_mm;
  std::vector<std::string> events;  ///< what happens on the way, in words
};

/// The view in three dimensions.
struct SceneView {
  std::vector<std::array<double, 3>> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<ScenePathView> paths;
};

struct Page {
  std::string title;
  std::string subtitle;
  std::vector<PageSection> sections;
  std::optional<SceneView> scene;
  std::optional<LiveStart> live;  ///< the design that can be changed on the page
};

/// What retrace ships for such a page. \throw InputError where it is missing
PageAssets assets_for(const Page& page);

/// The page as one HTML file that needs no other file and no network. Whatever texts hold, they are shown as texts.
std::string page_html(const Page& page, const PageAssets& assets);

/// Six significant digits.
std::string shown(double value);

}  // namespace retrace::report

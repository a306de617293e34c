#pragma once

// Content of the HTML page of `retrace report` (sections, tables, charts, figures and the view in three dimensions) and
// its conversion to HTML.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/page/live_page.h"
#include "report/path_plot.h"
#include "report/plot.h"

namespace retrace::report {

/// Rating of a value. The rating determines the colour in which the value is shown.
enum class Rating { none, good, bad, open };

/// Cell of a table: the text that is shown, and the full value for the CSV file if it differs.
struct PageCell {
  std::string text;
  std::string full;  ///< value for the CSV file; if empty, `text` is used
  Rating rating = Rating::none;

  PageCell() = default;
  PageCell(std::string shown) : text(std::move(shown)) {}
  PageCell(const char* shown) : text(shown) {}
  /// Makes a cell that shows six digits. The CSV file contains all digits.
  PageCell(double value);
};

/// A table that can be saved as CSV. A row with a cell that is rated bad is marked.
struct PageTable {
  std::string caption;
  std::vector<std::string> columns;  ///< titles with units, such as "incidence (deg)"
  std::vector<std::vector<PageCell>> rows;
  std::string csv_name;
  std::size_t omitted_rows = 0;  ///< number of rows of the result that were omitted
};

/// A drawing (SVG made by retrace) or a picture from a file of the result folder.
struct PageFigure {
  std::string caption;
  std::string svg;               ///< drawing as markup; empty if the figure is a picture
  std::string media_type;        ///< media type of the picture, such as "image/png"
  std::string bytes;             ///< content of the picture file
  std::string alternative_text;  ///< description of the figure for screen readers
};

struct PageFact {
  std::string name;
  std::string value;
  Rating rating = Rating::none;
  std::string subject = {};  ///< name of the design or job that the value describes; empty if the page has only one
};

struct PageSection {
  std::string id;  ///< unique id of letters and digits
  std::string title;
  std::string subject;  ///< names of the designs or jobs that the section describes; empty if the page has only one
  std::vector<std::string> paragraphs;
  std::vector<PageFact> facts;
  std::vector<std::string> steps;  ///< steps in order; the reader can tick them off
  std::vector<LinePlot> charts;    ///< plots with zoom, whose values can be read off
  std::vector<PathPlot> paths;     ///< plots of tool paths with zoom, in which each kind of move can be hidden
  std::vector<PageFigure> figures;
  std::vector<PageTable> tables;
  std::vector<std::pair<std::string, std::string>> details;  ///< collapsed texts: title and content
  bool has_scene = false;
  bool has_live = false;
};

PageSection titled(std::string title, const std::string& paragraph = {});

/// Returns true if a fact or a cell of the section is rated bad.
bool has_failure(const PageSection& section);

/// Light path in the view in three dimensions.
struct ScenePathView {
  std::string label;
  std::vector<std::array<double, 3>> points_mm;
  std::vector<std::string> events;  ///< events along the path, as text
};

/// Content of the view in three dimensions.
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
  std::optional<LiveStart> live;  ///< design that can be changed on the page
};

/// Returns the shipped scripts and styles that a page needs.
/// \throw InputError if a file is missing
PageAssets assets_for(const Page& page);

/// Returns the page as a single HTML file that needs no other file and no network. All texts are escaped.
std::string page_html(const Page& page, const PageAssets& assets);

/// Returns a number with six significant digits.
std::string six_digits(double value);

}  // namespace retrace::report

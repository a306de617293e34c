#include "report/page/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "core/base64.h"
#include "core/number_format.h"
#include "core/text.h"
#include "report/page/html_text.h"

namespace retrace::report {
namespace {

std::string json_number(double value) {
  return std::isfinite(value) ? shortest(value) : "null";
}

template <class Values, class Text>
std::string json_list(const Values& values, const Text& text) {
  std::string json = "[";
  for (const auto& value : values) {
    if (json.size() > 1) json += ',';
    json += text(value);
  }
  return json + "]";
}

std::string json_of(const LinePlot& plot) {
  const std::string series = json_list(plot.series, [&](const Series& s) {
    std::string look;
    if (s.look) look += fmt::format(R"(,"look":{})", *s.look);
    if (s.scale_value) look += fmt::format(R"(,"value":{})", json_number(*s.scale_value));
    return fmt::format(R"({{"label":{},"line":{},"x":{},"y":{}{}}})",
                       json_string(s.label.empty() ? plot.y_label : s.label), s.has_line, json_list(s.x, json_number),
                       json_list(s.y, json_number), look);
  });
  std::string more;
  if (const std::optional<Range> range = scale_range(plot))
    more += fmt::format(R"(,"scale":{{"label":{},"low":{},"high":{}}})", json_string(plot.scale_label),
                        json_number(range->low), json_number(range->high));
  if (plot.legend)
    more += fmt::format(R"(,"legend":{})", json_list(*plot.legend, [](const LegendKey& key) {
                          return fmt::format(R"({{"label":{},"look":{}}})", json_string(key.label), key.look);
                        }));
  return fmt::format(R"({{"title":{},"x_label":{},"y_label":{},"series":{}{}}})", json_string(plot.title),
                     json_string(plot.x_label), json_string(plot.y_label), series, more);
}

/// Returns the coordinates of points in mm as JSON, rounded to 1 nm.
template <std::size_t count>
std::string json_coordinates(const std::array<double, count>& coordinates) {
  return json_list(coordinates, [](double c) { return shortest(std::round(c * 1e6) / 1e6 + 0.0); });
}

std::string json_of(const PathPlot& plot) {
  return fmt::format(R"({{"title":{},"x_label":{},"y_label":{},"kinds":{}}})", json_string(plot.title),
                     json_string(plot.x_label), json_string(plot.y_label),
                     json_list(plot.kinds, [](const PathKind& kind) {
                       return fmt::format(R"({{"label":{},"dashed":{},"moves":{}}})", json_string(kind.label),
                                          kind.dashed, json_list(kind.moves, [](const auto& move) {
                                            const auto& [from, to] = move;
                                            return json_coordinates(std::array{from.x(), from.y(), to.x(), to.y()});
                                          }));
                     }));
}

std::string json_of(const SceneView& scene) {
  const auto numbers = [](const auto& list) {
    return json_list(list, [](std::uint32_t v) { return std::to_string(v); });
  };
  return fmt::format(R"({{"vertices":{},"triangles":{},"edges":{},"paths":{}}})",
                     json_list(scene.vertices_mm, json_coordinates<3>), json_list(scene.triangles, numbers),
                     json_list(scene.edges, numbers), json_list(scene.paths, [](const ScenePathView& p) {
                       return fmt::format(R"({{"label":{},"points":{},"events":{}}})", json_string(p.label),
                                          json_list(p.points_mm, json_coordinates<3>),
                                          json_list(p.events, json_string));
                     }));
}

bool is_numeric(const PageTable& table, std::size_t column) {
  for (const auto& row : table.rows) {
    const std::string& text = row[column].text;
    if (!text.empty() && text.find_first_not_of("0123456789.+-eE") != std::string::npos) return false;
  }
  return true;
}

/// Returns true if a column contains texts of more than one word.
bool has_phrases(const PageTable& table, std::size_t column) {
  constexpr std::size_t word = 14;  // number of characters above which a text is wrapped
  return std::ranges::any_of(table.rows, [&](const auto& row) { return row[column].text.size() > word; });
}

/// Returns the name of the CSS class for a rating.
std::string_view class_of(Rating rating) {
  switch (rating) {
    case Rating::none: return "";
    case Rating::good: return "good";
    case Rating::bad: return "bad";
    case Rating::open: return "open";
  }
  return "";
}

bool is_bad(const std::vector<PageCell>& row) {
  return std::ranges::any_of(row, [](const PageCell& cell) { return cell.rating == Rating::bad; });
}

bool has_bad_row(const PageTable& table) {
  return std::ranges::any_of(table.rows, is_bad);
}

/// Number of rows above which a table without failures is shown in a box with a scroll bar.
constexpr std::size_t kLongTable = 24;

class HtmlWriter {
 public:
  explicit HtmlWriter(const Page& page) : page_(page) {}

  std::string write(const PageAssets& assets) {
    html_ = html_head(page_.title, assets.style) + "<body>\n";
    write_header();
    add("<main id=\"main\">\n");
    for (const PageSection& section : page_.sections) write_section(section);
    add("</main>\n");
    if (!assets.script.empty()) write_scripts(assets);
    add("</body>\n</html>\n");
    return std::move(html_);
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(html_), format, std::forward<Values>(values)...);
  }

  void write_scripts(const PageAssets& assets) {
    add("<footer>\n<details><summary>Licences of the code in this page</summary><pre>{}</pre></details>\n"
        "</footer>\n",
        markup_text(assets.licences));
    add("<script type=\"application/json\" id=\"page-data\">{{\"charts\":[{}],\"paths\":[{}],\"scene\":{}}}</script>\n",
        charts_, paths_, page_.scene ? json_of(*page_.scene) : "null");
    if (page_.live) html_ += live_elements(*page_.live, assets, true);
    add("<script>{}</script>\n", assets.script);
  }

  void write_header() {
    add("<a class=\"skip\" href=\"#main\">Skip to the results</a>\n<header>\n<h1>{}</h1>\n"
        "<button type=\"button\" id=\"theme\" hidden></button>\n<p>{}</p>\n</header>\n",
        markup_text(page_.title), markup_text(page_.subtitle));
    add("<nav aria-label=\"Contents\"><p>Contents</p>\n<ul>\n");
    for (const PageSection& section : page_.sections)
      add("<li><a href=\"#{}\"{}>{}</a></li>\n", section.id, has_failure(section) ? " class=\"bad\"" : "",
          markup_text(section.title));
    add("</ul></nav>\n");
  }

  void write_section(const PageSection& section) {
    add("<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n", section.id,
        markup_text(section.title));
    if (!section.subject.empty()) add("<p class=\"subject\">{}</p>\n", markup_text(section.subject));
    for (const std::string& text : section.paragraphs) add("<p>{}</p>\n", markup_text(text));
    write_facts(section.facts);
    write_steps(section.steps);
    if (section.has_scene && page_.scene) write_scene();
    if (section.has_live && page_.live) add("<div id=\"live\"></div>\n");
    for (const LinePlot& chart : section.charts) write_chart(chart);
    for (const PathPlot& path : section.paths) write_path(path);
    write_figures(section.figures);
    for (const PageTable& table : section.tables) write_table(table);
    for (const auto& [title, content] : section.details)
      add("<details><summary>{}</summary><pre>{}</pre></details>\n", markup_text(title), markup_text(content));
    add("</section>\n");
  }

  void write_facts(const std::vector<PageFact>& facts) {
    if (facts.empty()) return;
    constexpr std::size_t long_text = 24;
    add("<dl class=\"facts\">\n");
    for (const PageFact& fact : facts) {
      add("<div><dt>{}</dt><dd class=\"{}{}\">{}</dd>", markup_text(fact.name), class_of(fact.rating),
          fact.value.size() > long_text ? " long" : "", markup_text(fact.value));
      if (!fact.subject.empty()) add("<dd class=\"subject\">{}</dd>", markup_text(fact.subject));
      add("</div>\n");
    }
    add("</dl>\n");
  }

  void write_steps(const std::vector<std::string>& steps) {
    if (steps.empty()) return;
    add("<ol class=\"steps\">\n");
    for (const std::string& step : steps) add("<li>{}</li>\n", markup_text(step));
    add("</ol>\n");
  }

  void write_scene() {
    add("<div class=\"scene-box\">\n<div id=\"scene\" tabindex=\"0\" role=\"application\" "
        "aria-label=\"The part and light paths in three dimensions. Arrow keys rotate the view, plus and minus zoom. "
        "The paths are listed as text next to it.\"></div>\n"
        "<div><fieldset id=\"scene-paths\"><legend>Light paths</legend></fieldset>\n"
        "<ol id=\"scene-steps\" aria-live=\"polite\"></ol>\n<noscript><ul>\n");
    for (const ScenePathView& path : page_.scene->paths) add("<li>{}</li>\n", markup_text(path.label));
    add("</ul></noscript></div>\n</div>\n");
  }

  void write_chart(const LinePlot& chart) {
    if (chart_count_ > 0) charts_ += ',';
    charts_ += json_of(chart);
    add("<figure data-chart=\"{}\"><div class=\"plot\"></div><figcaption>{}. <span class=\"how\">Drag to zoom, "
        "double click for all; with the keyboard: arrows, +, - and 0.</span></figcaption></figure>\n",
        chart_count_++, markup_text(chart.title));
  }

  void write_path(const PathPlot& path) {
    if (path_count_ > 0) paths_ += ',';
    paths_ += json_of(path);
    add("<figure data-path=\"{}\"><div class=\"path\"></div><figcaption>{}: {}. <span class=\"how\">Wheel "
        "with the control key, or + and -, to zoom; drag or arrows to move; 0 or double click for "
        "all.</span></figcaption></figure>\n",
        path_count_++, markup_text(path.title), markup_text(fmt::format("{}", fmt::join(path.remarks, "; "))));
  }

  void write_figures(const std::vector<PageFigure>& figures) {
    if (figures.empty()) return;
    add("<div class=\"{}\">\n", figures.size() > 1 && !figures.front().svg.empty() ? "drawings" : "pictures");
    for (const PageFigure& figure : figures) {
      if (!figure.svg.empty())
        add("<figure class=\"drawing\">{}", figure.svg);
      else
        add("<figure class=\"picture\"><img alt=\"{}\" src=\"data:{};base64,{}\">",
            markup_text(figure.alternative_text), figure.media_type, base64(figure.bytes));
      add("<figcaption>{}</figcaption></figure>\n", markup_text(figure.caption));
    }
    add("</div>\n");
  }

  void write_table(const PageTable& table) {
    const bool is_long = table.rows.size() > kLongTable && !has_bad_row(table);
    add("<div class=\"table-box{2}\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table data-csv=\"{1}\">"
        "<caption>{0}</caption>\n<thead><tr>",
        markup_text(table.caption), markup_text(table.csv_name), is_long ? " long" : "");
    std::vector<const char*> style;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      style.push_back(is_numeric(table, c) ? "n" : has_phrases(table, c) ? "p" : "");
      add("<th scope=\"col\" class=\"{}\">{}</th>", style[c], markup_text(table.columns[c]));
    }
    add("</tr></thead>\n<tbody>\n");
    for (const auto& row : table.rows) {
      html_ += is_bad(row) ? "<tr class=\"bad\">" : "<tr>";
      for (std::size_t c = 0; c < row.size(); ++c) {
        add("<td class=\"{} {}\"", style[c], class_of(row[c].rating));
        if (!row[c].full.empty()) add(" data-v=\"{}\"", markup_text(row[c].full));
        add(">{}</td>", markup_text(row[c].text));
      }
      add("</tr>\n");
    }
    add("</tbody></table></div>\n");
    if (table.omitted_rows > 0) add("<p>The file contains {} more rows.</p>\n", table.omitted_rows);
  }

  const Page& page_;
  std::string html_;
  std::string charts_;
  std::size_t chart_count_ = 0;
  std::string paths_;
  std::size_t path_count_ = 0;
};

}  // namespace

PageSection titled(std::string title, const std::string& paragraph) {
  PageSection section;
  section.title = std::move(title);
  if (!paragraph.empty()) section.paragraphs.push_back(paragraph);
  return section;
}

bool has_failure(const PageSection& section) {
  return std::ranges::any_of(section.tables, has_bad_row) ||
         std::ranges::any_of(section.facts, [](const PageFact& fact) { return fact.rating == Rating::bad; });
}

std::string six_digits(double value) {
  if (!std::isfinite(value)) return "";
  return fmt::format("{:.6g}", value + 0.0);
}

PageCell::PageCell(double value) : text(six_digits(value)) {
  if (!std::isfinite(value)) return;
  std::string all = shortest(value);
  if (all != text) full = std::move(all);
}

PageAssets assets_for(const Page& page) {
  return page.live ? shipped_live_assets() : shipped_page_assets();
}

std::string page_html(const Page& page, const PageAssets& assets) {
  return HtmlWriter(page).write(assets);
}

}  // namespace retrace::report

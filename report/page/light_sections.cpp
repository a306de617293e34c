// Sections of the page on efficiency, footprint and far field, with their charts and drawings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/number_format.h"
#include "core/text.h"
#include "report/page/design_names.h"
#include "report/page/document_sections.h"
#include "report/page/document_view.h"

namespace retrace::report::document {

namespace {

/// Returns the chart of the efficiency over the angle of incidence, with one curve for each design, azimuth and
/// acceptance angle. If only the azimuth varies, the chart is over the azimuth.
PageChart rre_chart(const ResultDocument& document, const DesignNames& names) {
  const Json& points = list(document.json, "points");
  const auto several = [&](const char* key) {
    std::set<double> values;
    for (const Json& p : points) values.insert(number(p, key));
    return values.size() > 1;
  };
  const bool over_azimuth = !several("incidence_deg") && several("azimuth_deg");
  const char* const along = over_azimuth ? "azimuth_deg" : "incidence_deg";
  const bool tell_azimuth = !over_azimuth && several("azimuth_deg");
  const bool tell_cone = several("acceptance_half_angle_deg");
  const bool tell_design = several("design");
  PageChart chart;
  chart.title =
      "Retroreflective efficiency against the " + std::string(over_azimuth ? "azimuth" : "angle of incidence");
  chart.x_label = over_azimuth ? "azimuth (deg)" : "angle of incidence (deg)";
  chart.y_label = "RRE (%)";
  for (const Json& p : points) {
    std::vector<std::string> words;
    if (tell_design) words.push_back(names.of(document, number(p, "design")));
    if (tell_azimuth) words.push_back(fmt::format("azimuth {} deg", shown(number(p, "azimuth_deg"))));
    if (tell_cone) words.push_back(fmt::format("within {} deg", shown(number(p, "acceptance_half_angle_deg"))));
    const std::string label = words.empty() ? "RRE (%)" : fmt::format("{}", fmt::join(words, ", "));
    series_of(chart, label).add(number(p, along), 100.0 * number(p, "rre"));
  }
  return chart;
}

/// Returns a table with one row for each point. Its columns are the accounts of the ledger (the terms of the energy
/// balance), in percent of the incident power.
PageTable ledger_table(const ResultDocument& document, const DesignNames& names) {
  const Json& points = list(document.json, "points");
  PageTable table;
  table.caption = "Where the light goes, in percent of the incident power";
  table.csv_name = csv_name(document, "ledger");
  table.columns = {"design", "incidence (deg)", "azimuth (deg)", "acceptance (deg)", "RRE (%)", "std. error (%)"};
  std::vector<std::string> accounts;
  if (!points.empty())
    for (const auto& [key, value] : member(points.front(), "ledger").items()) accounts.push_back(key);
  for (const std::string& account : accounts) table.columns.push_back(column_name(account) + " (%)");
  for (const Json& p : points) {
    if (table.rows.size() == kMostRows) {
      table.left_out = points.size() - kMostRows;
      break;
    }
    const double design = number(p, "design");
    std::vector<PageCell> row = {names.are_several() ? PageCell(names.of(document, design)) : PageCell(design),
                                 number(p, "incidence_deg"),
                                 number(p, "azimuth_deg"),
                                 number(p, "acceptance_half_angle_deg"),
                                 100.0 * number(p, "rre"),
                                 100.0 * number(p, "std_error")};
    for (const std::string& account : accounts) row.emplace_back(100.0 * number(member(p, "ledger"), account.c_str()));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

PageSection rre_section(const ResultDocument& document, const ResultFolder& folder) {
  const DesignNames names(folder);
  PageSection section = titled(
      "Efficiency",
      "RRE is the power that comes back into the acceptance cone over the incident power. The standard error covers "
      "sampling alone; the exact engine has none.");
  const PageChart chart = rre_chart(document, names);
  if (std::any_of(chart.series.begin(), chart.series.end(), [](const ChartSeries& s) { return s.x.size() > 1; }))
    section.charts.push_back(chart);
  section.tables.push_back(ledger_table(document, names));
  return section;
}

namespace {

constexpr std::size_t kMostPanels = 6;
constexpr std::size_t kMostRegions = 1500;  // per panel
constexpr std::size_t kMostSpots = 600;

struct Extent {
  double low_x = INFINITY;
  double low_y = INFINITY;
  double high_x = -INFINITY;
  double high_y = -INFINITY;

  void include(double x, double y) {
    low_x = std::min(low_x, x);
    low_y = std::min(low_y, y);
    high_x = std::max(high_x, x);
    high_y = std::max(high_y, y);
  }
  bool empty() const { return !(high_x > low_x && high_y > low_y); }
  double size() const { return std::max(high_x - low_x, high_y - low_y); }
};

/// Returns the vertices of the outer ring of a GeoJSON polygon.
std::vector<std::array<double, 2>> ring_of(const Json& feature) {
  std::vector<std::array<double, 2>> ring;
  const Json& rings = list(member(feature, "geometry"), "coordinates");
  if (rings.empty() || !rings.front().is_array()) return ring;
  for (const Json& p : rings.front())
    if (p.is_array() && p.size() >= 2 && p[0].is_number() && p[1].is_number())
      ring.push_back({p[0].get<double>(), p[1].get<double>()});
  return ring;
}

bool is_of(const Json& feature, const Json& region) {
  const Json& at = member(feature, "properties");
  for (const char* key : {"design", "incidence_deg", "azimuth_deg", "wavelength_nm"})
    if (number(at, key) != number(region, key)) return false;
  return true;
}

/// Returns the beginning of a caption. It is the name of the design if the folder has several designs; otherwise it is
/// empty.
std::string prefix_of(const DesignNames& names, const ResultDocument& document, double design) {
  return names.are_several() ? names.of(document, design) + ". " : std::string();
}

/// Returns the SVG of a scale bar. Its length is 1, 2 or 5 times a power of ten and at most a quarter of the width.
std::string scale_bar(const Extent& extent) {
  const double about = 0.25 * (extent.high_x - extent.low_x);
  const double decade = std::pow(10.0, std::floor(std::log10(about)));
  const double length = (about >= 5.0 * decade ? 5.0 : about >= 2.0 * decade ? 2.0 : 1.0) * decade;
  const double unit = extent.size() / 100.0;
  const double y = extent.high_y + 4.0 * unit;
  return fmt::format(
      "<line x1=\"{0:.6g}\" y1=\"{2:.6g}\" x2=\"{1:.6g}\" y2=\"{2:.6g}\" "
      "style=\"stroke:var(--text);stroke-width:{3:.3g}\"/>"
      "<text x=\"{4:.6g}\" y=\"{5:.6g}\" font-size=\"{6:.3g}\">{7:.6g} mm</text>",
      extent.low_x, extent.low_x + length, y, 0.8 * unit, extent.low_x + length + 2.0 * unit, y + 1.3 * unit,
      4.0 * unit, length);
}

/// Returns at most kMostPanels entries of a list, evenly selected after sorting by the magnitude of the incidence.
std::vector<const Json*> spread(const Json& entries) {
  std::vector<const Json*> all;
  for (const Json& entry : entries) all.push_back(&entry);
  const auto less = [](const Json* a, const Json* b) {
    return std::abs(number(*a, "incidence_deg")) < std::abs(number(*b, "incidence_deg"));
  };
  // Entries with NaN or infinite angles are removed, because they cannot be sorted.
  std::erase_if(all, [](const Json* entry) { return !std::isfinite(number(*entry, "incidence_deg")); });
  std::stable_sort(all.begin(), all.end(), less);
  if (all.size() <= kMostPanels) return all;
  std::vector<const Json*> chosen;
  for (std::size_t k = 0; k < kMostPanels; ++k) chosen.push_back(all[k * (all.size() - 1) / (kMostPanels - 1)]);
  return chosen;
}

/// Returns the bounding box of all active regions of a design in drawing coordinates (y down). If `design` gives the
/// size of the entrance face, the bounding box also contains this face.
/// \param json footprint document
/// \param number_of_design index of the design in the result
/// \param design JSON object of the design, or null if it is unknown
Extent face_extent(const Json& json, double number_of_design, const Json* design) {
  Extent extent;
  for (const Json& feature : list(json, "features"))
    if (number(member(feature, "properties"), "design") == number_of_design)
      for (const auto& [x, y] : ring_of(feature)) extent.include(x, -y);
  if (design != nullptr) {
    const Json& array = member(*design, "array");
    const Json& element = member(*design, "element");
    const bool is_single = text(array, "arrangement") == "single";
    const double x_mm = is_single ? number(element, "base_mm") : number(array, "x_length_mm");
    const double y_mm = is_single ? number(element, "width_mm") : number(array, "y_length_mm");
    if (std::isfinite(x_mm) && std::isfinite(y_mm)) {
      extent.include(0.0, 0.0);
      extent.include(x_mm, -y_mm);
    }
  }
  return extent.empty() ? Extent{0.0, 0.0, 1.0, 1.0} : extent;
}

/// Draws the active regions of the entrance face for one direction of the light. Regions that return more light are
/// darker.
/// \param json footprint document
/// \param region entry of the list `regions`, which gives the design and the direction
/// \param extent bounding box of the drawing (y down)
/// \param of_design beginning of the caption, see prefix_of()
PageFigure footprint_panel(const Json& json, const Json& region, const Extent& extent, const std::string& of_design) {
  std::string shapes;
  std::size_t drawn = 0;
  for (const Json& feature : list(json, "features")) {
    if (!is_of(feature, region)) continue;
    const auto ring = ring_of(feature);
    if (++drawn > kMostRegions) continue;
    const double efficiency = number(member(feature, "properties"), "efficiency");
    shapes += fmt::format("<polygon class=\"region\" fill-opacity=\"{:.3f}\" points=\"",
                          0.15 + 0.85 * std::clamp(efficiency, 0.0, 1.0));
    for (const auto& [x, y] : ring) shapes += fmt::format("{:.6g},{:.6g} ", x, -y);
    shapes += fmt::format("\"><title>{} comes back</title></polygon>", percent(efficiency));
  }
  PageFigure figure;
  figure.caption = fmt::format("{}Incidence {} deg, azimuth {} deg: {} of the face is active and returns {}.",
                               of_design, shown(number(region, "incidence_deg")), shown(number(region, "azimuth_deg")),
                               percent(number(region, "active_share")), percent(number(region, "rre_shown")));
  if (drawn > kMostRegions) figure.caption += fmt::format(" {} of {} regions are drawn.", kMostRegions, drawn);
  const double margin = 0.04 * extent.size();
  figure.svg = fmt::format(
      "<svg role=\"img\" aria-label=\"{0}\" viewBox=\"{1:.6g} {2:.6g} {3:.6g} {4:.6g}\">"
      "<rect class=\"face\" x=\"{5:.6g}\" y=\"{6:.6g}\" width=\"{7:.6g}\" height=\"{8:.6g}\" stroke-width=\"{9:.3g}\"/>"
      "{10}{11}</svg>",
      markup_text(figure.caption), extent.low_x - margin, extent.low_y - margin,
      extent.high_x - extent.low_x + 2.0 * margin, extent.high_y - extent.low_y + 3.0 * margin, extent.low_x,
      extent.low_y, extent.high_x - extent.low_x, extent.high_y - extent.low_y, 0.004 * extent.size(), shapes,
      scale_bar(extent));
  return figure;
}

}  // namespace

PageSection footprint_section(const ResultDocument& document, const ResultFolder& folder) {
  PageSection section = titled(
      "Footprint",
      "Where light must fall on the entrance face to come back into the acceptance cone; what is left blank is dead. "
      "Darker regions return more of it.");
  const Json& regions = list(document.json, "regions");
  const DesignNames names(folder);
  for (const Json* region : spread(regions)) {
    const double design = number(*region, "design");
    const Extent extent = face_extent(document.json, design, design_of(folder, document, design));
    section.figures.push_back(footprint_panel(document.json, *region, extent, prefix_of(names, document, design)));
  }
  Json rows = regions;
  if (names.are_several())
    for (Json& row : rows)
      if (row.is_object()) row["design"] = names.of(document, number(row, "design"));
  section.tables.push_back(table_of(rows,
                                    {"design", "incidence_deg", "azimuth_deg", "entrance_area_mm2", "active_area_mm2",
                                     "active_share", "rre_shown", "rre"},
                                    "Active area of the entrance face", csv_name(document, "regions")));
  return section;
}

namespace {

/// Draws one spot for each direction in which light is returned. The centre of the drawing is the direction to the
/// source. The area of a spot is proportional to the power in its direction.
/// \param direction entry of the list `directions` of a far-field document
/// \param of_design beginning of the caption, see prefix_of()
PageFigure far_field_panel(const Json& direction, const std::string& of_design) {
  const Json& spots = list(direction, "spots");
  double reach = 1.0;
  double other_reach = 0.0;
  constexpr double kWindowArcmin = 600.0;
  for (const Json& spot : spots) {
    const double r = number(spot, "deviation_arcmin");
    if (r <= kWindowArcmin)
      reach = std::max(reach, 1.15 * r);
    else
      other_reach += number(spot, "power");
  }
  std::string shapes;
  for (const double share : {0.5, 1.0})
    shapes += fmt::format(
        "<circle class=\"guide\" r=\"{:.4g}\" stroke-width=\"0.4\"/>"
        "<text x=\"1\" y=\"{:.4g}\" font-size=\"8\">{:.3g}'</text>",
        95.0 * share, -95.0 * share + 9.0, reach * share);
  std::size_t drawn = 0;
  for (const Json& spot : spots) {
    const double r = number(spot, "deviation_arcmin");
    const double power = number(spot, "power");
    if (!(r <= reach) || ++drawn > kMostSpots) continue;
    const double angle = number(spot, "deviation_azimuth_deg") * std::acos(-1.0) / 180.0;
    const double size = std::max(0.6, 9.0 * std::sqrt(std::max(0.0, power)));
    shapes += fmt::format(
        "<circle class=\"spot{}\" cx=\"{:.4g}\" cy=\"{:.4g}\" r=\"{:.3g}\"><title>{:.4g} arcmin off, {} of the "
        "light</title></circle>",
        number(spot, "depth_min") == 0.0 ? " front" : "", 95.0 * r / reach * std::cos(angle),
        -95.0 * r / reach * std::sin(angle), size, r, percent(power));
  }
  PageFigure figure;
  figure.caption = fmt::format(
      "{}Incidence {} deg, azimuth {} deg. {} of the light leaves more than {:.0f} arcmin from the direction to the "
      "source.",
      of_design, shown(number(direction, "incidence_deg")), shown(number(direction, "azimuth_deg")),
      percent(other_reach), kWindowArcmin);
  figure.svg = fmt::format("<svg role=\"img\" aria-label=\"{}\" viewBox=\"-100 -100 200 200\">{}</svg>",
                           markup_text(figure.caption), shapes);
  return figure;
}

}  // namespace

PageSection far_field_section(const ResultDocument& document, const ResultFolder& folder) {
  PageSection section = titled(
      "Far field",
      "The directions in which light leaves the entrance face, seen from the source: the centre is the way back. The "
      "area of a spot is as its power.");
  const DesignNames names(folder);
  Json rows = Json::array();
  for (const Json* direction : spread(list(document.json, "directions")))
    section.figures.push_back(far_field_panel(*direction, prefix_of(names, document, number(*direction, "design"))));
  for (const Json& direction : list(document.json, "directions")) {
    for (const Json& spot : list(direction, "spots")) {
      if (!spot.is_object()) continue;
      Json row = {{"incidence_deg", member(direction, "incidence_deg")},
                  {"azimuth_deg", member(direction, "azimuth_deg")}};
      if (names.are_several()) row["design"] = names.of(document, number(direction, "design"));
      row.update(spot);
      if (rows.size() <= kMostRows) rows.push_back(std::move(row));
    }
  }
  section.tables.push_back(table_of(rows,
                                    {"design", "incidence_deg", "azimuth_deg", "deviation_arcmin",
                                     "deviation_azimuth_deg", "power", "s1", "s2", "s3", "depth_min"},
                                    "Spots, by falling power (share of the incident power)",
                                    csv_name(document, "spots")));
  return section;
}

}  // namespace retrace::report::document

// Sections of the page on efficiency, footprint and far field, with their charts and drawings.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <ranges>

#include "core/number_format.h"
#include "core/text.h"
#include "geometry/polygon.h"
#include "report/page/design_names.h"
#include "report/page/document_sections.h"
#include "report/page/document_view.h"
#include "report/plot_contents.h"

namespace retrace::report::document {

namespace {

using geometry::Polygon, geometry::Rectangle;

/// Returns the points of the document. Points without a direction are omitted.
std::vector<EfficiencyPoint> efficiency_points(const ResultDocument& document, const DesignNames& names) {
  std::map<double, std::string> known;
  std::vector<EfficiencyPoint> points;
  const design::DesignLabels* const labels = names.labels_of(document);
  for (const Json& p : list(document.json, "points")) {
    if (!std::isfinite(number(p, "incidence_deg")) || !std::isfinite(number(p, "azimuth_deg"))) continue;
    const auto [design, is_new] = known.try_emplace(number_or_0(p, "design"));
    if (is_new) design->second = names.of(document, design->first);
    points.push_back({design->second, number(p, "incidence_deg"), number(p, "azimuth_deg"),
                      number_or_0(p, "acceptance_half_angle_deg"), number(p, "rre"), number(p, "std_error")});
    const double at = design->first;
    if (labels != nullptr && at >= 0.0 && at < static_cast<double>(labels->values.size()))
      points.back().design_value = labels->values[static_cast<std::size_t>(at)];
  }
  return points;
}

/// Returns a cell that shows a fraction in percent with four digits. The CSV file contains all digits.
PageCell percent_cell(double fraction) {
  PageCell cell(100.0 * fraction);
  if (!std::isfinite(fraction)) return cell;
  if (cell.full.empty()) cell.full = cell.text;
  cell.text = fmt::format("{:.4g}", 100.0 * fraction + 0.0);
  return cell;
}

/// Returns a table with one row for each point. Its columns are the accounts of the ledger (the terms of the energy
/// balance), in percent of the incident power. The account of the retroreflected light is RRE.
PageTable ledger_table(const ResultDocument& document, const DesignNames& names) {
  const Json& points = list(document.json, "points");
  PageTable table;
  table.caption = "Ledger: terms of the light, in percent of the incident power. RRE is the retroreflected light";
  table.csv_name = csv_name(document, "ledger");
  table.columns = {"design", "incidence (deg)", "azimuth (deg)", "acceptance (deg)", "RRE (%)", "std. error (%)"};
  std::vector<std::string> accounts;
  if (!points.empty())
    for (const auto& [key, value] : member(points.front(), "ledger").items())
      if (key != "retroreflected") accounts.push_back(key);
  for (const std::string& account : accounts) table.columns.push_back(column_name(account) + " (%)");
  for (const Json& p : points) {
    if (table.rows.size() == kMaxRows) {
      table.omitted_rows = points.size() - kMaxRows;
      break;
    }
    const double design = number(p, "design");
    std::vector<PageCell> row = {names.are_several(document) ? PageCell(names.of(document, design)) : PageCell(design),
                                 number(p, "incidence_deg"),
                                 number(p, "azimuth_deg"),
                                 number(p, "acceptance_half_angle_deg"),
                                 percent_cell(number(p, "rre")),
                                 percent_cell(number(p, "std_error"))};
    for (const std::string& account : accounts)
      row.push_back(percent_cell(number(member(p, "ledger"), account.c_str())));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

PageSection rre_section(const ResultDocument& document, const ResultFolder& folder) {
  const DesignNames names(folder);
  PageSection section = titled("Efficiency",
                               "RRE is the power that returns into the acceptance cone, divided by the incident power. "
                               "The standard error covers only random sampling; the exact engine has no such error.");
  const design::DesignLabels* const labels = names.labels_of(document);
  LinePlot plot = rre_plot(efficiency_points(document, names), labels != nullptr ? labels->key : std::string());
  if (std::ranges::any_of(plot.series, [](const Series& s) { return s.x.size() > 1; }))
    section.charts.push_back(std::move(plot));
  section.tables.push_back(ledger_table(document, names));
  return section;
}

namespace {

constexpr std::size_t kMaxPanels = 6;
constexpr std::size_t kMaxRegions = 1500;  // maximum number of regions that are drawn in a panel
constexpr std::size_t kMaxSpots = 600;

/// Returns the outer ring of a GeoJSON polygon.
Polygon ring_of(const Json& feature) {
  Polygon ring;
  const Json& rings = list(member(feature, "geometry"), "coordinates");
  if (rings.empty() || !rings.front().is_array()) return ring;
  for (const Json& p : rings.front())
    if (p.is_array() && p.size() >= 2 && p[0].is_number() && p[1].is_number())
      ring.emplace_back(p[0].get<double>(), p[1].get<double>());
  return ring;
}

bool is_of(const Json& feature, const Json& region) {
  const Json& at = member(feature, "properties");
  for (const char* key : {"design", "incidence_deg", "azimuth_deg", "wavelength_nm"})
    if (number(at, key) != number(region, key)) return false;
  return true;
}

/// Returns the name of a design if the folder or the document has several designs. Otherwise, returns an empty text.
std::string name_if_several(const DesignNames& names, const ResultDocument& document, double design) {
  return names.are_several(document) ? names.of(document, design) : std::string();
}

/// Returns the SVG of a scale bar below a rectangle. The length of the bar is 1, 2 or 5 times a power of ten, in mm,
/// and at most a quarter of the width of the rectangle.
std::string scale_bar(const Rectangle& face) {
  const double about = 0.25 * face.size().x();
  const double decade = std::pow(10.0, std::floor(std::log10(about)));
  const double length = (about >= 5.0 * decade ? 5.0 : about >= 2.0 * decade ? 2.0 : 1.0) * decade;
  const double unit = face.size().maxCoeff() / 100.0;
  const double y = 4.0 * unit - face.lower.y();
  return fmt::format(
      "<line x1=\"{0:.6g}\" y1=\"{2:.6g}\" x2=\"{1:.6g}\" y2=\"{2:.6g}\" "
      "style=\"stroke:var(--text);stroke-width:{3:.3g}\"/>"
      "<text x=\"{4:.6g}\" y=\"{5:.6g}\" font-size=\"{6:.3g}\">{7:.6g} mm</text>",
      face.lower.x(), face.lower.x() + length, y, 0.8 * unit, face.lower.x() + length + 2.0 * unit, y + 1.3 * unit,
      4.0 * unit, length);
}

/// Returns at most kMaxPanels entries of a list. The entries are sorted by the magnitude of the angle of incidence and
/// then selected at equal intervals.
std::vector<const Json*> spread(const Json& entries) {
  std::vector<const Json*> all;
  for (const Json& entry : entries) all.push_back(&entry);
  const auto less = [](const Json* a, const Json* b) {
    return std::abs(number(*a, "incidence_deg")) < std::abs(number(*b, "incidence_deg"));
  };
  // Entries with NaN or infinite angles are removed, because they cannot be sorted.
  std::erase_if(all, [](const Json* entry) { return !std::isfinite(number(*entry, "incidence_deg")); });
  std::stable_sort(all.begin(), all.end(), less);
  if (all.size() <= kMaxPanels) return all;
  std::vector<const Json*> chosen;
  for (std::size_t k = 0; k < kMaxPanels; ++k) chosen.push_back(all[k * (all.size() - 1) / (kMaxPanels - 1)]);
  return chosen;
}

/// Returns the bounding box of all active regions of a design. If `design` gives the size of the entrance face, the
/// bounding box also contains this face.
/// \param json footprint document
/// \param number_of_design index of the design in the result
/// \param design JSON object of the design, or null if it is unknown
Rectangle face_of(const Json& json, double number_of_design, const Json* design) {
  Polygon corners;
  for (const Json& feature : list(json, "features"))
    if (number(member(feature, "properties"), "design") == number_of_design)
      std::ranges::copy(ring_of(feature), std::back_inserter(corners));
  if (design != nullptr) {
    const Json& array = member(*design, "array");
    const Json& element = member(*design, "element");
    const bool is_single = text(array, "arrangement") == "single";
    const double x_mm = is_single ? number(element, "base_mm") : number(array, "x_length_mm");
    const double y_mm = is_single ? number(element, "width_mm") : number(array, "y_length_mm");
    if (std::isfinite(x_mm) && std::isfinite(y_mm)) {
      corners.emplace_back(0.0, 0.0);
      corners.emplace_back(x_mm, y_mm);
    }
  }
  const Rectangle box = corners.empty() ? Rectangle{} : geometry::bounding_box(corners);
  return box.empty() ? Rectangle{{0.0, 0.0}, {1.0, 1.0}} : box;
}

/// Returns a panel with the active regions of the entrance face for one direction of the light.
/// \param json footprint document
/// \param region entry of the list `regions`; it contains the design and the direction
/// \param design name of the design; empty if the folder has only one design
MapPanel panel_of(const Json& json, const Json& region, const Rectangle& face, const std::string& design) {
  const Json& regions = list(json, "regions");
  const bool has_azimuths = std::any_of(regions.begin(), regions.end(),
                                        [](const Json& other) { return number_or_0(other, "azimuth_deg") != 0.0; });
  MapPanel panel =
      footprint_panel({.design = design,
                       .incidence_deg = number(region, "incidence_deg"),
                       .azimuth_deg = has_azimuths ? std::optional(number_or_0(region, "azimuth_deg")) : std::nullopt,
                       .active_fraction = number_or_0(region, "active_fraction"),
                       .rre_contribution = number_or_0(region, "rre_shown")});
  panel.outline = geometry::to_polygon(face);
  for (const Json& feature : list(json, "features"))
    if (is_of(feature, region))
      panel.regions.push_back({ring_of(feature), 100.0 * number(member(feature, "properties"), "efficiency")});
  return panel;
}

/// Draws a panel. The value of a region is its efficiency in percent, and regions with a higher value are darker. Only
/// the first kMaxRegions regions are drawn.
PageFigure figure_of(const MapPanel& panel) {
  std::string shapes;
  for (const MapRegion& region : panel.regions | std::views::take(kMaxRegions)) {
    shapes += fmt::format("<polygon class=\"region\" fill-opacity=\"{:.3f}\" points=\"",
                          0.15 + 0.85 * std::clamp(0.01 * region.value, 0.0, 1.0));
    for (const geometry::Vec2& p : region.outline) shapes += fmt::format("{:.6g},{:.6g} ", p.x(), -p.y());
    shapes += fmt::format("\"><title>{} returns</title></polygon>", percent(0.01 * region.value));
  }
  PageFigure figure;
  figure.caption = fmt::format("{}: {}.", panel.title, fmt::join(panel.remarks, "; "));
  if (panel.regions.size() > kMaxRegions)
    figure.caption += fmt::format(" {} of {} regions are drawn.", kMaxRegions, panel.regions.size());
  const Rectangle face = geometry::bounding_box(panel.outline);
  const geometry::Vec2 size = face.size();
  const double margin = 0.04 * size.maxCoeff();
  figure.svg = fmt::format(
      "<svg role=\"img\" aria-label=\"{0}\" viewBox=\"{1:.6g} {2:.6g} {3:.6g} {4:.6g}\">"
      "<rect class=\"face\" x=\"{5:.6g}\" y=\"{6:.6g}\" width=\"{7:.6g}\" height=\"{8:.6g}\" stroke-width=\"{9:.3g}\"/>"
      "{10}{11}</svg>",
      markup_text(figure.caption), face.lower.x() - margin, -face.upper.y() - margin, size.x() + 2.0 * margin,
      size.y() + 3.0 * margin, face.lower.x(), -face.upper.y(), size.x(), size.y(), 0.004 * size.maxCoeff(), shapes,
      scale_bar(face));
  return figure;
}

}  // namespace

PageSection footprint_section(const ResultDocument& document, const ResultFolder& folder) {
  PageSection section = titled("Footprint",
                               "Regions of the entrance face from which light returns into the acceptance cone. Blank "
                               "regions are dead zones. Darker regions return more of the light.");
  const Json& regions = list(document.json, "regions");
  const DesignNames names(folder);
  for (const Json* region : spread(regions)) {
    const double design = number(*region, "design");
    const Rectangle face = face_of(document.json, design, design_of(folder, document, design));
    section.figures.push_back(
        figure_of(panel_of(document.json, *region, face, name_if_several(names, document, design))));
  }
  Json rows = regions;
  if (names.are_several())
    for (Json& row : rows)
      if (row.is_object()) row["design"] = names.of(document, number(row, "design"));
  section.tables.push_back(table_of(rows,
                                    {"design", "incidence_deg", "azimuth_deg", "entrance_area_mm2", "active_area_mm2",
                                     "active_fraction", "rre_shown", "rre"},
                                    "Active area of the entrance face", csv_name(document, "regions")));
  return section;
}

namespace {

/// Draws one spot for each direction in which light is returned. The centre of the drawing is the direction to the
/// source. The area of a spot is proportional to the power in its direction.
/// \param direction entry of the list `directions` of a far-field document
/// \param design name of the design; empty if the folder has only one design
PageFigure far_field_panel(const Json& direction, const std::string& design) {
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
    if (!(r <= reach) || ++drawn > kMaxSpots) continue;
    const double angle = number(spot, "deviation_azimuth_deg") * std::acos(-1.0) / 180.0;
    const double size = std::max(0.6, 9.0 * std::sqrt(std::max(0.0, power)));
    shapes += fmt::format(
        "<circle class=\"spot{}\" cx=\"{:.4g}\" cy=\"{:.4g}\" r=\"{:.3g}\"><title>{:.4g} arcmin from the centre, {} of "
        "the "
        "light</title></circle>",
        number(spot, "depth_min") == 0.0 ? " front" : "", 95.0 * r / reach * std::cos(angle),
        -95.0 * r / reach * std::sin(angle), size, r, percent(power));
  }
  PageFigure figure;
  figure.caption = fmt::format(
      "{}Incidence {} deg, azimuth {} deg. {} of the light leaves more than {:.0f} arcmin from the direction to the "
      "source.",
      design.empty() ? design : design + ". ", six_digits(number(direction, "incidence_deg")),
      six_digits(number(direction, "azimuth_deg")), percent(other_reach), kWindowArcmin);
  figure.svg = fmt::format("<svg role=\"img\" aria-label=\"{}\" viewBox=\"-100 -100 200 200\">{}</svg>",
                           markup_text(figure.caption), shapes);
  return figure;
}

}  // namespace

PageSection far_field_section(const ResultDocument& document, const ResultFolder& folder) {
  PageSection section =
      titled("Far field",
             "The directions in which light leaves the entrance face, seen from the source: the centre is the "
             "direction back to the source. The area of a spot is proportional to its power.");
  const DesignNames names(folder);
  Json rows = Json::array();
  for (const Json* direction : spread(list(document.json, "directions")))
    section.figures.push_back(
        far_field_panel(*direction, name_if_several(names, document, number(*direction, "design"))));
  for (const Json& direction : list(document.json, "directions")) {
    for (const Json& spot : list(direction, "spots")) {
      if (!spot.is_object()) continue;
      Json row = {{"incidence_deg", member(direction, "incidence_deg")},
                  {"azimuth_deg", member(direction, "azimuth_deg")}};
      if (names.are_several()) row["design"] = names.of(document, number(direction, "design"));
      row.update(spot);
      if (rows.size() <= kMaxRows) rows.push_back(std::move(row));
    }
  }
  section.tables.push_back(table_of(rows,
                                    {"design", "incidence_deg", "azimuth_deg", "deviation_arcmin",
                                     "deviation_azimuth_deg", "power", "s1", "s2", "s3", "depth_min"},
                                    "Spots, by descending power (fraction of the incident power)",
                                    csv_name(document, "spots")));
  return section;
}

}  // namespace retrace::report::document

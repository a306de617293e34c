#include "report/page/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/number_format.h"
#include "core/version.h"

namespace retrace::report {
namespace {

using Json = nlohmann::ordered_json;

// A page must stay small enough to be sent on: the files have everything.
constexpr std::size_t kMostRows = 400;
constexpr std::size_t kMostPanels = 6;
constexpr std::size_t kMostRegions = 1500;  // of one panel
constexpr std::size_t kMostSpots = 600;

// Reading documents: whatever is missing or of another type reads as absent.

const Json& member(const Json& json, const char* key) {
  static const Json none;
  if (!json.is_object()) return none;
  const auto it = json.find(key);
  return it == json.end() ? none : *it;
}

double number(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return value.is_number() ? value.get<double>() : NAN;
}

std::string text(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

bool flag(const Json& json, const char* key) {
  const Json& value = member(json, key);
  return value.is_boolean() && value.get<bool>();
}

const Json& list(const Json& json, const char* key) {
  static const Json empty = Json::array();
  const Json& value = member(json, key);
  return value.is_array() ? value : empty;
}

/// With a unit; empty if there is none.
std::string measured(double value, int digits, const char* unit) {
  return std::isfinite(value) ? fixed(value, digits) + unit : "";
}

/// The same with six digits.
std::string measured(double value, const char* unit) {
  return std::isfinite(value) ? shown(value) + unit : "";
}

std::string percent(double share) {
  return std::isfinite(share) ? fixed(100.0 * share, 2) + " %" : "";
}

PageCell cell_of(const Json& value) {
  if (value.is_number()) return {value.get<double>()};
  if (value.is_string()) return {value.get<std::string>()};
  if (value.is_boolean()) return {value.get<bool>() ? "yes" : "no"};
  return {value.is_null() ? std::string() : value.dump()};
}

/// "incidence_deg" as a person would write it: "incidence (deg)".
std::string column_name(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> units = {{"_mcd_per_lx", "mcd/lx"},
                                                                         {"_cd_per_lx_m2", "cd/lx/m2"},
                                                                         {"_mm2_per_h", "mm2/h"},
                                                                         {"_arcmin", "arcmin"},
                                                                         {"_deg", "deg"},
                                                                         {"_mm2", "mm2"},
                                                                         {"_mm3", "mm3"},
                                                                         {"_mm", "mm"},
                                                                         {"_um", "um"},
                                                                         {"_nm", "nm"},
                                                                         {"_s", "s"},
                                                                         {"_n", "N"},
                                                                         {"_h", "h"},
                                                                         {"_cm2", "cm2"},
                                                                         {"_percent", "%"}};
  std::string name = key;
  std::string unit;
  for (const auto& [suffix, word] : units)
    if (key.size() > suffix.size() && key.ends_with(suffix)) {
      name.resize(key.size() - suffix.size());
      unit = " (" + word + ")";
      break;
    }
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + unit;
}

/// A table of a list of objects; its columns are the given keys that any of them has.
PageTable table_of(const Json& rows, const std::vector<std::string>& keys, const std::string& caption,
                   const std::string& csv_name) {
  PageTable table;
  table.caption = caption;
  table.csv_name = csv_name;
  std::vector<std::string> present;
  for (const std::string& key : keys)
    if (std::any_of(rows.begin(), rows.end(), [&](const Json& row) { return row.is_object() && row.contains(key); }))
      present.push_back(key);
  for (const std::string& key : present) table.columns.push_back(column_name(key));
  for (const Json& row : rows) {
    if (table.rows.size() == kMostRows) {
      table.left_out = rows.size() - kMostRows;
      break;
    }
    std::vector<PageCell> cells;
    for (const std::string& key : present) cells.push_back(cell_of(member(row, key.c_str())));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

/// The plain members of an object: one row each.
PageTable figures_of(const Json& json, const std::string& caption, const std::string& csv_name) {
  static const std::set<std::string> told = {"schema", "version", "complete", "elapsed_s", "seed"};
  PageTable table;
  table.caption = caption;
  table.csv_name = csv_name;
  table.columns = {"figure", "value"};
  for (const auto& [key, value] : json.items()) {
    if (told.contains(key) || value.is_structured()) continue;
    table.rows.push_back({column_name(key), cell_of(value)});
  }
  return table;
}

std::string csv_name(const ResultDocument& document, const char* what) {
  std::string name = document.name.substr(0, document.name.rfind('.'));
  std::replace(name.begin(), name.end(), '/', '_');
  return name + "_" + what + ".csv";
}

std::string verdict_style(const std::string& verdict) {
  if (verdict == "pass") return "good";
  return verdict == "fail" ? "bad" : "open";
}

std::string name_of_design(const Json& design) {
  if (const std::string title = text(design, "title"); !title.empty()) return title;
  const Json& element = member(design, "element");
  if (!element.is_object()) return text(member(design, "part"), "mesh");
  std::string name = text(element, "kind");
  for (const char* size : {"base_mm", "width_mm", "aperture_mm"})
    if (std::isfinite(number(element, size))) name += " " + shown(number(element, size));
  return name + " mm, " + text(member(design, "array"), "arrangement");
}

// ---------------------------------------------------------------------------------------------------------------- RRE

/// Curves over the incidence, one for each design, azimuth and acceptance angle; the azimuth where that varies alone.
PageChart rre_chart(const Json& json) {
  const Json& points = list(json, "points");
  const auto several = [&](const char* key) {
    std::set<double> values;
    for (const Json& p : points) values.insert(number(p, key));
    return values.size() > 1;
  };
  const bool over_azimuth = !several("incidence_deg") && several("azimuth_deg");
  const char* const along = over_azimuth ? "azimuth_deg" : "incidence_deg";
  const bool tell_azimuth = !over_azimuth && several("azimuth_deg");
  const bool tell_cone = several("acceptance_half_angle_deg");
  const Json& designs = list(json, "designs");
  PageChart chart;
  chart.title =
      "Retroreflective efficiency against the " + std::string(over_azimuth ? "azimuth" : "angle of incidence");
  chart.x_label = over_azimuth ? "azimuth (deg)" : "angle of incidence (deg)";
  chart.y_label = "RRE (%)";
  std::map<std::string, std::size_t> known;
  for (const Json& p : points) {
    const double d = number(p, "design");
    std::vector<std::string> words;
    if (designs.size() > 1 && d >= 0.0 && d < static_cast<double>(designs.size()))
      words.push_back(name_of_design(designs[static_cast<std::size_t>(d)]));
    if (tell_azimuth) words.push_back(fmt::format("azimuth {} deg", shown(number(p, "azimuth_deg"))));
    if (tell_cone) words.push_back(fmt::format("within {} deg", shown(number(p, "acceptance_half_angle_deg"))));
    const std::string label = words.empty() ? "RRE (%)" : fmt::format("{}", fmt::join(words, ", "));
    const auto [it, is_new] = known.try_emplace(label, chart.series.size());
    if (is_new) chart.series.push_back({label, {}, {}});
    chart.series[it->second].x.push_back(number(p, along));
    chart.series[it->second].y.push_back(100.0 * number(p, "rre"));
  }
  return chart;
}

/// Points with their accounts side by side, in percent of the incident power.
PageTable ledger_table(const ResultDocument& document) {
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
    std::vector<PageCell> row = {number(p, "design"),      number(p, "incidence_deg"),
                                 number(p, "azimuth_deg"), number(p, "acceptance_half_angle_deg"),
                                 100.0 * number(p, "rre"), 100.0 * number(p, "std_error")};
    for (const std::string& account : accounts) row.emplace_back(100.0 * number(member(p, "ledger"), account.c_str()));
    table.rows.push_back(std::move(row));
  }
  return table;
}

PageSection rre_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = "Efficiency";
  section.paragraphs.push_back(
      "RRE is the power that comes back into the acceptance cone over the incident power. The standard error covers "
      "sampling alone; the exact engine has none.");
  const PageChart chart = rre_chart(document.json);
  if (std::any_of(chart.series.begin(), chart.series.end(), [](const ChartSeries& s) { return s.x.size() > 1; }))
    section.charts.push_back(chart);
  section.tables.push_back(ledger_table(document));
  return section;
}

// ----------------------------------------------------------------------------------------------------------- drawings

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

/// The corners of a GeoJSON polygon's outline.
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

/// A scale bar of 1, 2 or 5 times a power of ten, about a quarter as long as the drawing is wide.
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

/// Entries of a list to draw: spread over all, from the least incidence to the greatest.
std::vector<const Json*> spread(const Json& entries) {
  std::vector<const Json*> all;
  for (const Json& entry : entries) all.push_back(&entry);
  const auto less = [](const Json* a, const Json* b) {
    return std::abs(number(*a, "incidence_deg")) < std::abs(number(*b, "incidence_deg"));
  };
  // Not finite angles would leave the order without a sense.
  std::erase_if(all, [](const Json* entry) { return !std::isfinite(number(*entry, "incidence_deg")); });
  std::stable_sort(all.begin(), all.end(), less);
  if (all.size() <= kMostPanels) return all;
  std::vector<const Json*> chosen;
  for (std::size_t k = 0; k < kMostPanels; ++k) chosen.push_back(all[k * (all.size() - 1) / (kMostPanels - 1)]);
  return chosen;
}

/// Of the entrance face, as far as the design tells; and of all regions.
Extent face_extent(const Json& json, const Json* design) {
  Extent extent;
  for (const Json& feature : list(json, "features"))
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

/// One direction's active regions, darker where more comes back. y of the drawing points down.
PageFigure footprint_panel(const Json& json, const Json& region, const Extent& extent) {
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
  figure.caption = fmt::format("Incidence {} deg, azimuth {} deg: {} of the face is active and returns {}.",
                               shown(number(region, "incidence_deg")), shown(number(region, "azimuth_deg")),
                               percent(number(region, "active_share")), percent(number(region, "rre_shown")));
  if (drawn > kMostRegions) figure.caption += fmt::format(" {} of {} regions are drawn.", kMostRegions, drawn);
  const double margin = 0.04 * extent.size();
  figure.svg = fmt::format(
      "<svg role=\"img\" aria-label=\"{0}\" viewBox=\"{1:.6g} {2:.6g} {3:.6g} {4:.6g}\">"
      "<rect class=\"face\" x=\"{5:.6g}\" y=\"{6:.6g}\" width=\"{7:.6g}\" height=\"{8:.6g}\" stroke-width=\"{9:.3g}\"/>"
      "{10}{11}</svg>",
      html_text(figure.caption), extent.low_x - margin, extent.low_y - margin,
      extent.high_x - extent.low_x + 2.0 * margin, extent.high_y - extent.low_y + 3.0 * margin, extent.low_x,
      extent.low_y, extent.high_x - extent.low_x, extent.high_y - extent.low_y, 0.004 * extent.size(), shapes,
      scale_bar(extent));
  return figure;
}

PageSection footprint_section(const ResultDocument& document, const ResultFolder& folder) {
  PageSection section;
  section.title = "Footprint";
  section.paragraphs.push_back(
      "Where light must fall on the entrance face to come back into the acceptance cone; what is left blank is dead. "
      "Darker regions return more of it.");
  const Json& regions = list(document.json, "regions");
  const Extent extent = face_extent(document.json, first_design(folder));
  for (const Json* region : spread(regions)) section.figures.push_back(footprint_panel(document.json, *region, extent));
  section.tables.push_back(table_of(regions,
                                    {"design", "incidence_deg", "azimuth_deg", "entrance_area_mm2", "active_area_mm2",
                                     "active_share", "rre_shown", "rre"},
                                    "Active area of the entrance face", csv_name(document, "regions")));
  return section;
}

/// Spots by how far and towards where they miss the way back to the source; their area is as their power.
PageFigure far_field_panel(const Json& direction) {
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
  figure.caption = fmt::format("Incidence {} deg, azimuth {} deg. {} of the light leaves more than {:.0f} arcmin off.",
                               shown(number(direction, "incidence_deg")), shown(number(direction, "azimuth_deg")),
                               percent(other_reach), kWindowArcmin);
  figure.svg = fmt::format("<svg role=\"img\" aria-label=\"{}\" viewBox=\"-100 -100 200 200\">{}</svg>",
                           html_text(figure.caption), shapes);
  return figure;
}

PageSection far_field_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = "Far field";
  section.paragraphs.push_back(
      "The directions in which light leaves the entrance face, seen from the source: the centre is the way back. The "
      "area of a spot is as its power.");
  Json rows = Json::array();
  for (const Json* direction : spread(list(document.json, "directions")))
    section.figures.push_back(far_field_panel(*direction));
  for (const Json& direction : list(document.json, "directions")) {
    for (const Json& spot : list(direction, "spots")) {
      if (!spot.is_object()) continue;
      Json row = {{"incidence_deg", member(direction, "incidence_deg")},
                  {"azimuth_deg", member(direction, "azimuth_deg")}};
      row.update(spot);
      if (rows.size() <= kMostRows) rows.push_back(std::move(row));
    }
  }
  section.tables.push_back(table_of(rows,
                                    {"incidence_deg", "azimuth_deg", "deviation_arcmin", "deviation_azimuth_deg",
                                     "power", "s1", "s2", "s3", "depth_min"},
                                    "Spots, by falling power (share of the incident power)",
                                    csv_name(document, "spots")));
  return section;
}

// ------------------------------------------------------------------------------------------------------------- others

PageSection inspect_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = "Design";
  section.tables.push_back(figures_of(document.json, "What the design is", csv_name(document, "figures")));
  return section;
}

PageSection photometry_section(const ResultDocument& document, const ResultFolder&) {
  const Json& json = document.json;
  const Json& programme = member(json, "programme");
  const std::string verdict = text(json, "verdict");
  PageSection section;
  section.title = "Photometry";
  section.facts = {{"Standard", text(programme, "standard"), ""},
                   {"Class and colour", text(programme, "class") + " " + text(programme, "colour"), ""},
                   {"Area", measured(number(json, "area_cm2"), " cm2"), ""},
                   {"Verdict", verdict, verdict_style(verdict)}};
  section.paragraphs.push_back(
      "R_I at the test points of the standard. Limits that are recalled, not confirmed, make a verdict unconfirmed. It "
      "is no approval test.");
  PageTable table =
      table_of(list(json, "points"),
               {"observation_deg", "v_deg", "h_deg", "rotation_deg", "value_mcd_per_lx", "std_error_mcd_per_lx",
                "limit_mcd_per_lx", "margin", "limit_status", "pass", "r_a_cd_per_lx_m2"},
               "Test points", csv_name(document, "points"));
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c] == "pass")
      for (auto& row : table.rows) row[c].style = row[c].text == "yes" ? "good" : "bad";
  section.tables.push_back(std::move(table));
  return section;
}

PageSection roughness_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = "Roughness";
  PageChart chart;
  chart.title = "Efficiency against the roughness of the facets";
  chart.x_label = "Sa (nm)";
  chart.y_label = "RRE (%)";
  std::map<double, std::size_t> known;
  for (const Json& p : list(document.json, "points")) {
    const double length = number(p, "correlation_length_um");
    const auto [it, is_new] = known.try_emplace(length, chart.series.size());
    if (is_new) chart.series.push_back({fmt::format("correlation length {} um", shown(length)), {}, {}});
    chart.series[it->second].x.push_back(number(p, "sa_nm"));
    chart.series[it->second].y.push_back(100.0 * number(p, "rre"));
  }
  section.charts.push_back(chart);
  section.tables.push_back(table_of(list(document.json, "points"),
                                    {"correlation_length_um", "sa_nm", "sq_nm", "rre", "std_error"}, "Curves",
                                    csv_name(document, "curves")));
  section.tables.push_back(
      table_of(list(document.json, "measured"),
               {"table", "name", "facets", "roughness_sa_nm", "waviness_sa_nm", "rre", "std_error"}, "Measured facets",
               csv_name(document, "measured")));
  return section;
}

PageSection fabrication_section(const ResultDocument& document, const ResultFolder&) {
  const Json& json = document.json;
  PageSection section;
  section.title = "Tool path";
  section.facts = {{"Machining time", measured(number(json, "time_s") / 3600.0, 3, " h"), ""},
                   {"Time an element", measured(number(json, "time_per_element_s"), 2, " s"), ""},
                   {"Elements", shown(number(json, "elements")), ""},
                   {"Machine", text(json, "machine"), ""},
                   {"Strategy", text(json, "strategy"), ""},
                   {"Dialect", text(json, "dialect"), ""}};
  section.tables.push_back(table_of(list(json, "stages"), {"name", "a_deg", "c_deg", "elements", "time_s"},
                                    "Stages of the program", csv_name(document, "stages")));
  section.tables.push_back(figures_of(json, "Figures of the plan", csv_name(document, "figures")));
  return section;
}

PageSection verification_section(const ResultDocument& document, const ResultFolder&) {
  const Json& json = document.json;
  const std::string verdict = text(json, "verdict");
  const Json& findings = list(json, "findings");
  PageSection section;
  section.title = "Verification";
  section.facts = {{"Verdict", verdict, verdict_style(verdict)},
                   {"Findings", std::to_string(findings.size()), findings.empty() ? "good" : "bad"},
                   {"Facets off by at most", measured(number(json, "facet_distance_nm_max"), " nm"), ""},
                   {"Angles off by at most", measured(number(json, "facet_angle_arcmin_max"), " arcmin"), ""}};
  section.paragraphs.push_back(
      "The text of the programs was read back, the machine's axes moved and the blank cut again; planner and writers "
      "take no part in it.");
  if (!findings.empty())
    section.tables.push_back(table_of(findings,
                                      {"kind", "program", "line", "element", "message", "value", "limit", "count"},
                                      "Findings", csv_name(document, "findings")));
  section.tables.push_back(figures_of(json, "Figures of the part that is left", csv_name(document, "figures")));
  return section;
}

PageSection forces_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = "Cutting forces";
  PageChart chart;
  chart.title = "Forces on the tool over one cycle";
  chart.x_label = "time (s)";
  chart.y_label = "force (N)";
  for (const char* key : {"fx_n", "fy_n", "fz_n"}) {
    ChartSeries series{column_name(key), {}, {}};
    for (const Json& sample : list(document.json, "profile")) {
      series.x.push_back(number(sample, "time_s"));
      series.y.push_back(number(sample, key));
    }
    chart.series.push_back(std::move(series));
  }
  section.charts.push_back(std::move(chart));
  section.tables.push_back(figures_of(document.json, "Figures of the cycle", csv_name(document, "figures")));
  return section;
}

/// The keys of the first rows of a list, in their order.
std::vector<std::string> keys_of(const Json& rows) {
  std::vector<std::string> keys;
  std::size_t looked_at = 0;
  for (const Json& row : rows) {
    if (!row.is_object() || ++looked_at > 20) continue;
    for (const auto& [key, value] : row.items())
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

std::vector<std::string> words(const Json& values) {
  std::vector<std::string> words;
  for (const Json& value : values)
    if (value.is_string()) words.push_back(value.get<std::string>());
  return words;
}

/// A curve of the first quantity over the first parameter of numbers, one for each set of the others.
PageChart sweep_chart(const Json& json) {
  const std::vector<std::string> parameters = words(list(json, "parameters"));
  const std::vector<std::string> quantities = words(list(json, "quantities"));
  PageChart chart;
  if (parameters.empty() || quantities.empty()) return chart;
  const Json& points = list(json, "points");
  const auto is_axis = [&](const std::string& key) {
    return !points.empty() && std::isfinite(number(points.front(), key.c_str()));
  };
  const auto axis = std::find_if(parameters.rbegin(), parameters.rend(), is_axis);
  if (axis == parameters.rend()) return chart;
  chart.title = fmt::format("{} against {}", column_name(quantities.front()), column_name(*axis));
  chart.x_label = column_name(*axis);
  chart.y_label = column_name(quantities.front());
  std::map<std::string, std::size_t> known;
  constexpr std::size_t most_series = 20;
  for (const Json& p : points) {
    std::vector<std::string> others;
    for (const std::string& key : parameters)
      if (key != *axis) others.push_back(key + " " + cell_of(member(p, key.c_str())).text);
    const std::string label = others.empty() ? chart.y_label : fmt::format("{}", fmt::join(others, ", "));
    if (!std::isfinite(number(p, quantities.front().c_str()))) continue;
    if (!known.contains(label) && known.size() == most_series) continue;
    const auto [it, is_new] = known.try_emplace(label, chart.series.size());
    if (is_new) chart.series.push_back({label, {}, {}});
    chart.series[it->second].x.push_back(number(p, axis->c_str()));
    chart.series[it->second].y.push_back(number(p, quantities.front().c_str()));
  }
  return chart;
}

PageSection sweep_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = "Sweep";
  const PageChart chart = sweep_chart(document.json);
  if (!chart.series.empty()) section.charts.push_back(chart);
  const Json& points = list(document.json, "points");
  section.tables.push_back(table_of(points, keys_of(points), "Points", csv_name(document, "points")));
  return section;
}

PageSection optimum_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = "Optimum";
  const Json& best = member(document.json, "best");
  if (best.is_object())
    section.tables.push_back(figures_of(best, "The best design", csv_name(document, "best")));
  else
    section.paragraphs.push_back("No design is feasible.");
  const Json& front = list(document.json, "pareto");
  section.tables.push_back(table_of(front, keys_of(front), "Pareto front", csv_name(document, "front")));
  const Json& rejected = list(document.json, "rejected");
  section.tables.push_back(
      table_of(rejected, keys_of(rejected), "What was rejected, and why", csv_name(document, "rejected")));
  return section;
}

/// Documents that have no section of their own: their figures, and tables of what is in lists.
PageSection plain_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section;
  section.title = document.kind;
  section.title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(section.title.front())));
  section.tables.push_back(figures_of(document.json, "Figures", csv_name(document, "figures")));
  for (const auto& [key, value] : document.json.items())
    if (value.is_array() && !value.empty() && value.front().is_object())
      section.tables.push_back(table_of(value, keys_of(value), column_name(key), csv_name(document, key.c_str())));
  return section;
}

using MakeSection = PageSection (*)(const ResultDocument&, const ResultFolder&);

/// In the order of the page: what comes first in a study comes first.
const std::vector<std::pair<std::string, MakeSection>>& makers() {
  static const std::vector<std::pair<std::string, MakeSection>> all = {{"inspect", inspect_section},
                                                                       {"rre", rre_section},
                                                                       {"footprint", footprint_section},
                                                                       {"far_field", far_field_section},
                                                                       {"photometry", photometry_section},
                                                                       {"roughness", roughness_section},
                                                                       {"sweep", sweep_section},
                                                                       {"optimum", optimum_section},
                                                                       {"fabrication", fabrication_section},
                                                                       {"verification", verification_section},
                                                                       {"forces", forces_section}};
  return all;
}

/// Pictures beside a document of that kind that show what the page does not draw itself.
std::vector<std::string> pictures_of(const std::string& kind) {
  if (kind == "photometry") return {"far_field", "r_a"};
  if (kind == "fabrication") return {"roughing", "finishing", "arrangement"};
  if (kind == "metrology") return {"metrology"};
  if (kind == "image") return {"camera", "detector", "angular", "image"};
  return {};
}

std::string caption_of(const std::string& picture) {
  if (picture == "far_field") return "Far field with the test points";
  if (picture == "r_a") return "R_A over the observation angle";
  if (picture == "roughing") return "The way of the tool through one element: roughing";
  if (picture == "finishing") return "The way of the tool through one element: finishing";
  if (picture == "arrangement") return "The elements in the order in which they are cut";
  return picture;
}

std::string folder_of(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? std::string() : name.substr(0, slash + 1);
}

void add_pictures(PageSection& section, const ResultDocument& document, const ResultFolder& folder) {
  for (const std::string& wanted : pictures_of(document.kind))
    for (const ResultPicture& picture : folder.pictures)
      if (picture.name.substr(0, picture.name.rfind('.')) == folder_of(document.name) + wanted)
        section.figures.push_back(
            {caption_of(wanted), "", picture.media_type, picture.bytes, caption_of(wanted) + ", a drawing"});
}

// ---------------------------------------------------------------------------------------------------- summary, source

void add_summary_facts(const ResultDocument& document, std::vector<PageFact>& facts) {
  const Json& json = document.json;
  if (document.kind == "rre") {
    const Json* best = nullptr;
    const Json* normal = nullptr;
    for (const Json& p : list(json, "points")) {
      if (best == nullptr || number(p, "rre") > number(*best, "rre")) best = &p;
      if (normal == nullptr && number(p, "incidence_deg") == 0.0) normal = &p;
    }
    if (normal != nullptr) facts.push_back({"RRE at normal incidence", percent(number(*normal, "rre")), ""});
    if (best != nullptr && best != normal)
      facts.push_back({fmt::format("Greatest RRE, at {} deg", shown(number(*best, "incidence_deg"))),
                       percent(number(*best, "rre")), ""});
  }
  if (document.kind == "inspect") {
    if (const double n = number(json, "elements_full"); std::isfinite(n))
      facts.push_back({"Whole elements", fmt::format("{:.0f}", n), ""});
    if (const double limit = number(json, "tir_limit_deg"); std::isfinite(limit))
      facts.push_back({"Total reflection up to", fixed(limit, 2) + " deg", ""});
  }
  if (document.kind == "photometry")
    facts.push_back({"Photometry", text(json, "verdict"), verdict_style(text(json, "verdict"))});
  if (document.kind == "fabrication")
    facts.push_back({"Machining time", measured(number(json, "time_s") / 3600.0, 2, " h"), ""});
  if (document.kind == "verification")
    facts.push_back({"Verification", text(json, "verdict"), verdict_style(text(json, "verdict"))});
}

PageSection summary_section(const ResultFolder& folder) {
  PageSection section;
  section.title = "Summary";
  for (const auto& [kind, make] : makers())
    for (const ResultDocument& document : folder.documents)
      if (document.kind == kind) add_summary_facts(document, section.facts);
  std::size_t warnings = 0;
  bool is_complete = true;
  for (const ResultDocument& document : folder.documents) {
    warnings += list(document.json, "warnings").size();
    is_complete = is_complete && (flag(document.json, "complete") || !document.json.contains("complete"));
  }
  section.facts.push_back({"Documents", std::to_string(folder.documents.size()), ""});
  if (warnings > 0) section.facts.push_back({"Warnings", fmt::format("{}, see Provenance", warnings), "open"});
  if (!is_complete) section.facts.push_back({"Completeness", "interrupted: not all is computed", "bad"});
  return section;
}

PageSection provenance_section(const ResultFolder& folder) {
  PageSection section;
  section.title = "Provenance";
  section.paragraphs.push_back(
      fmt::format("This page was made by retrace {} from the documents below. With the same design, seed and version "
                  "they come out the same.",
                  kVersion));
  PageTable table;
  table.caption = "Documents";
  table.csv_name = "documents.csv";
  table.columns = {"file", "schema", "version", "seed", "engine", "complete", "elapsed (s)", "bytes"};
  PageTable warnings;
  warnings.caption = "Warnings";
  warnings.csv_name = "warnings.csv";
  warnings.columns = {"file", "warning"};
  std::set<std::string> designs;
  for (const ResultDocument& document : folder.documents) {
    const Json& json = document.json;
    table.rows.push_back({document.name, text(json, "schema"), text(json, "version"), cell_of(member(json, "seed")),
                          text(json, "engine"), cell_of(member(json, "complete")), cell_of(member(json, "elapsed_s")),
                          static_cast<double>(document.bytes)});
    for (const std::string& warning : words(list(json, "warnings"))) warnings.rows.push_back({document.name, warning});
    const auto add_design = [&](const Json& design) {
      const std::string content = design.dump(2);
      if (designs.size() < 8 && designs.insert(content).second)
        section.details.emplace_back("Design: " + name_of_design(design), content);
    };
    if (member(json, "design").is_object()) add_design(member(json, "design"));
    for (const Json& design : list(json, "designs"))
      if (design.is_object()) add_design(design);
  }
  section.tables.push_back(std::move(table));
  if (!warnings.rows.empty()) section.tables.push_back(std::move(warnings));
  return section;
}

/// Sections of one kind from several folders say which is which.
void name_apart(std::vector<PageSection>& sections, const std::vector<std::string>& files) {
  std::map<std::string, int> titles;
  for (const PageSection& section : sections) ++titles[section.title];
  for (std::size_t k = 0; k < sections.size(); ++k)
    if (titles[sections[k].title] > 1 && !files[k].empty()) sections[k].title += ": " + files[k];
  for (std::size_t k = 0; k < sections.size(); ++k) sections[k].id = fmt::format("s{}", k);
}

}  // namespace

const Json* first_design(const ResultFolder& folder) {
  for (const ResultDocument& document : folder.documents) {
    if (const Json& design = member(document.json, "design"); design.is_object()) return &design;
    const Json& designs = list(document.json, "designs");
    if (!designs.empty() && designs.front().is_object()) return &designs.front();
  }
  return nullptr;
}

std::vector<std::array<double, 2>> extreme_directions_deg(const ResultFolder& folder) {
  for (const ResultDocument& document : folder.documents) {
    if (document.kind != "rre") continue;
    std::vector<std::array<double, 2>> all;
    for (const Json& p : list(document.json, "points"))
      if (std::isfinite(number(p, "incidence_deg")) && std::isfinite(number(p, "azimuth_deg")))
        all.push_back({number(p, "incidence_deg"), number(p, "azimuth_deg")});
    if (all.empty()) continue;
    const auto less = [](const auto& a, const auto& b) { return std::abs(a[0]) < std::abs(b[0]); };
    const auto [low, high] = std::minmax_element(all.begin(), all.end(), less);
    if (std::abs((*high)[0]) - std::abs((*low)[0]) < 1.0) return {*low};
    return {*low, *high};
  }
  return {{0.0, 0.0}};
}

Page study_page(const ResultFolder& folder, const std::string& title) {
  Page page;
  page.title = title;
  const Json* const design = first_design(folder);
  if (page.title.empty()) page.title = design != nullptr ? name_of_design(*design) : "Study";
  page.subtitle = fmt::format("Study of a retroreflector, by retrace {}", kVersion);
  std::vector<std::string> files = {"", ""};
  page.sections.push_back(summary_section(folder));
  if (design != nullptr) {
    PageSection view;
    view.title = "In three dimensions";
    view.has_scene = true;
    page.sections.push_back(std::move(view));
  } else {
    files.pop_back();
  }
  const auto add = [&](const ResultDocument& document, MakeSection make) {
    PageSection section = make(document, folder);
    add_pictures(section, document, folder);
    page.sections.push_back(std::move(section));
    files.push_back(document.name);
  };
  std::set<std::string> kinds;
  for (const auto& [kind, make] : makers()) {
    kinds.insert(kind);
    for (const ResultDocument& document : folder.documents)
      if (document.kind == kind) add(document, make);
  }
  for (const ResultDocument& document : folder.documents)
    if (!kinds.contains(document.kind)) add(document, plain_section);
  page.sections.push_back(provenance_section(folder));
  files.emplace_back();
  name_apart(page.sections, files);
  return page;
}

}  // namespace retrace::report

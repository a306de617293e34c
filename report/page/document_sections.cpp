#include "report/page/document_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <tuple>

#include "core/number_format.h"
#include "fabrication/program/program.h"
#include "report/page/design_names.h"
#include "report/page/document_view.h"
#include "report/plot_contents.h"

namespace retrace::report::document {

PageSection inspect_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section = titled("Design");
  section.tables.push_back(figures_of(document.json, "Figures of the design", csv_name(document, "figures")));
  return section;
}

PageSection photometry_section(const ResultDocument& document, const ResultFolder&) {
  const Json& json = document.json;
  const Json& test_plan = member(json, "test_plan");
  const std::string verdict = text(json, "verdict");
  PageSection section = titled("Photometry");
  section.facts = {{"Standard", text(test_plan, "standard")},
                   {"Class and colour", text(test_plan, "class") + " " + text(test_plan, "colour")},
                   {"Area", measured(number(json, "area_cm2"), " cm2")},
                   {"Verdict", verdict, rating_of(verdict)}};
  if (json.contains("reason")) section.facts.push_back({"Reason", text(json, "reason")});
  if (const Json& colour = member(json, "chromaticity"); colour.contains("x"))
    section.facts.push_back({"Colour",
                             fmt::format("x {}, y {}", fixed(number(colour, "x"), 4), fixed(number(colour, "y"), 4)),
                             colour.contains("verdict") ? rating_of(text(colour, "verdict")) : Rating::none});
  section.paragraphs.push_back(
      "R_I at the test points of the standard. A verdict that is based on recalled, unconfirmed limits is unconfirmed. "
      "The computation is not an approval test.");
  section.tables.push_back(
      table_of(list(json, "points"),
               {"verdict", "observation_deg", "v_deg", "h_deg", "rotation_deg", "value_mcd_per_lx", "limit_mcd_per_lx",
                "margin", "std_error_mcd_per_lx", "limit_status", "lower_bound", "r_a_cd_per_lx_m2"},
               "Test points", csv_name(document, "points")));
  return section;
}

PageSection roughness_section(const ResultDocument& document, const ResultFolder& folder) {
  PageSection section = titled("Roughness");
  std::vector<RoughnessValue> values;
  for (const Json& p : list(document.json, "points"))
    values.push_back({number(p, "sa_nm"), number_or_0(p, "correlation_length_um"), {}, number(p, "rre"), 0.0});
  for (const Json& p : list(document.json, "measured")) {
    const std::size_t facets = count_in(p, "facets");
    // Older documents do not have the key `is_process`.
    const bool is_process = p.contains("is_process") ? flag(p, "is_process") : facets > 1;
    values.push_back(
        {number(p, "roughness_sa_nm"), number_or_0(p, "correlation_length_um"),
         MeasuredFacets{is_process, text(p, "name"), text(p, "table"), facets, number_or_0(p, "waviness_sa_nm")},
         number(p, "rre"), 0.0});
  }
  section.charts.push_back(roughness_plot(DesignNames(folder).of(document, 0.0), values));
  section.tables.push_back(table_of(list(document.json, "points"),
                                    {"correlation_length_um", "sa_nm", "sq_nm", "rre", "std_error"}, "Curves",
                                    csv_name(document, "curves")));
  section.tables.push_back(
      table_of(list(document.json, "measured"),
               {"table", "name", "facets", "roughness_sa_nm", "waviness_sa_nm", "rre", "std_error"}, "Measured facets",
               csv_name(document, "measured")));
  return section;
}

namespace {

/// Returns the plot of a tool path through one element. The plot contains only the kinds of moves that occur in the
/// path.
/// \param document document of the job
/// \param path JSON object with `name` and `moves`
PathPlot tool_path(const Json& document, const Json& path) {
  PathPlot plot = tool_path_plot({.job = std::filesystem::path(text(document, "job")).filename().string(),
                                  .machine = text(document, "machine"),
                                  .elements = count_in(document, "elements"),
                                  .is_roughing = text(path, "name") == "roughing",
                                  .is_layered = text(document, "strategy") == "bidirectional",
                                  .is_cube_corner = text(document, "strategy") == "dmc"});
  for (const Json& move : list(path, "moves")) {
    if (!move.is_array() || move.size() != 5 || !move[0].is_string()) continue;
    if (!std::all_of(move.begin() + 1, move.end(), [](const Json& c) { return c.is_number(); })) continue;
    const auto word = std::ranges::find(fabrication::kMotionWords, move[0].get<std::string>());
    const auto kind = static_cast<std::size_t>(word - std::begin(fabrication::kMotionWords));
    const auto point = [&](std::size_t at) {
      return geometry::Vec2(move[at].get<double>(), move[at + 1].get<double>());
    };
    if (kind < plot.kinds.size()) plot.kinds[kind].moves.emplace_back(point(1), point(3));
  }
  std::erase_if(plot.kinds, [](const PathKind& kind) { return kind.moves.empty(); });
  return plot;
}

}  // namespace

PageSection fabrication_section(const ResultDocument& document, const ResultFolder&) {
  const Json& json = document.json;
  PageSection section = titled("Tool path");
  section.facts = {{"Machining time", measured(number(json, "time_s") / 3600.0, 3, " h")},
                   {"Time per element", measured(number(json, "time_per_element_s"), 2, " s")},
                   {"Elements", six_digits(number(json, "elements"))},
                   {"Machine", text(json, "machine")},
                   {"Strategy", text(json, "strategy")},
                   {"Dialect", text(json, "dialect")}};
  for (const Json& path : list(json, "section_path")) {
    PathPlot plot = tool_path(json, path);
    if (!plot.kinds.empty()) section.paths.push_back(std::move(plot));
  }
  section.tables.push_back(table_of(list(json, "stages"), {"name", "a_deg", "c_deg", "elements", "time_s"},
                                    "Stages of the program", csv_name(document, "stages")));
  section.tables.push_back(figures_of(json, "Figures of the plan", csv_name(document, "figures")));
  return section;
}

PageSection verification_section(const ResultDocument& document, const ResultFolder&) {
  const Json& json = document.json;
  const std::string verdict = text(json, "verdict");
  const Json& findings = list(json, "findings");
  PageSection section = titled("Verification");
  section.facts = {{"Verdict", verdict, rating_of(verdict)},
                   {"Findings", std::to_string(findings.size()), findings.empty() ? Rating::good : Rating::bad}};
  const std::tuple<const char*, const char*, const char*> figures[] = {
      {"Maximum facet displacement", "facet_distance_nm_max", " nm"},
      {"Maximum angle error", "facet_angle_arcmin_max", " arcmin"},
      {"Maximum form error", "form_error_mm_max", " mm"},
      {"Maximum cut below the surface", "block_low_nm", " nm"}};
  for (const auto& [name, key, unit] : figures)
    if (const double value = number(json, key); std::isfinite(value))
      section.facts.push_back({name, measured(value, unit)});
  section.paragraphs.push_back(
      "The programs were read back from their text, and their cuts were simulated with the axes of the machine. The "
      "simulation does not use the code that plans and writes programs.");
  if (!findings.empty())
    section.tables.push_back(table_of(findings,
                                      {"kind", "program", "line", "element", "message", "value", "limit", "count"},
                                      "Findings", csv_name(document, "findings")));
  section.tables.push_back(figures_of(json, "Figures of the machined part", csv_name(document, "figures")));
  return section;
}

PageSection forces_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section = titled("Cutting forces");
  LinePlot plot =
      forces_plot(ForcesOfCut{text(document.json, "configuration"), number_or_0(document.json, "depth_of_cut_um"),
                              number_or_0(document.json, "width_mm")});
  constexpr std::array kForces = {"fx_n", "fy_n", "fz_n"};
  for (std::size_t axis = 0; axis < kForces.size(); ++axis)
    for (const Json& sample : list(document.json, "profile"))
      plot.series[axis].add(number(sample, "time_s"), number(sample, kForces[axis]));
  section.charts.push_back(std::move(plot));
  section.tables.push_back(figures_of(document.json, "Figures of the cycle", csv_name(document, "figures")));
  return section;
}

namespace {

/// Returns a plot of the first quantity of a sweep over the last numeric parameter. The plot has one curve for each
/// combination of values of the other parameters.
LinePlot sweep_plot(const Json& json) {
  const std::vector<std::string> parameters = words(list(json, "parameters"));
  const std::vector<std::string> quantities = words(list(json, "quantities"));
  LinePlot plot;
  if (parameters.empty() || quantities.empty()) return plot;
  const Json& points = list(json, "points");
  const auto is_axis = [&](const std::string& key) {
    return !points.empty() && std::isfinite(number(points.front(), key.c_str()));
  };
  const auto axis = std::find_if(parameters.rbegin(), parameters.rend(), is_axis);
  if (axis == parameters.rend()) return plot;
  plot.title = fmt::format("{} against {}", column_name(quantities.front()), column_name(*axis));
  plot.x_label = column_name(*axis);
  plot.y_label = column_name(quantities.front());
  const auto is_other = [&](const std::string& key) { return key != *axis; };
  const auto other = std::ranges::find_if(parameters, is_other);
  // Values of the only other parameter, if they are numbers, may be the colours of the curves.
  const bool has_scale = std::ranges::count_if(parameters, is_other) == 1 && is_axis(*other);
  const std::size_t most_series = has_scale ? 200 : 20;
  for (const Json& p : points) {
    std::vector<std::string> others;
    for (const std::string& key : parameters)
      if (key != *axis) others.push_back(key + " " + cell_of(member(p, key.c_str())).text);
    const std::string label = others.empty() ? plot.y_label : fmt::format("{}", fmt::join(others, ", "));
    if (!std::isfinite(number(p, quantities.front().c_str()))) continue;
    auto series = std::ranges::find(plot.series, label, &Series::label);
    if (series == plot.series.end()) {
      if (plot.series.size() == most_series) continue;
      series = plot.series.insert(series, Series{label, {}, {}, {}});
      if (has_scale) series->scale_value = number(p, other->c_str());
    }
    series->add(number(p, axis->c_str()), number(p, quantities.front().c_str()));
  }
  if (has_scale && plot.series.size() > kMaxCurvesInLegend) {
    plot.scale_label = column_name(*other);
    plot.legend.emplace();
  }
  return plot;
}

}  // namespace

PageSection sweep_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section = titled("Sweep");
  if (LinePlot plot = sweep_plot(document.json); !plot.series.empty()) section.charts.push_back(std::move(plot));
  const Json& points = list(document.json, "points");
  section.tables.push_back(table_of(points, keys_of(points), "Points", csv_name(document, "points")));
  return section;
}

PageSection optimum_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section = titled("Optimum");
  const Json& best = member(document.json, "best");
  if (best.is_object())
    section.tables.push_back(figures_of(best, "The best design", csv_name(document, "best")));
  else
    section.paragraphs.push_back("No design is feasible.");
  const Json& front = list(document.json, "pareto");
  section.tables.push_back(table_of(front, keys_of(front), "Pareto front", csv_name(document, "front")));
  const Json& rejected = list(document.json, "rejected");
  section.tables.push_back(
      table_of(rejected, keys_of(rejected), "Rejected designs, with reasons", csv_name(document, "rejected")));
  return section;
}

PageSection plain_section(const ResultDocument& document, const ResultFolder&) {
  PageSection section = titled(document.kind);
  section.title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(section.title.front())));
  section.tables.push_back(figures_of(document.json, "Figures", csv_name(document, "figures")));
  for (const auto& [key, value] : document.json.items())
    if (value.is_array() && !value.empty() && value.front().is_object())
      section.tables.push_back(table_of(value, keys_of(value), column_name(key), csv_name(document, key.c_str())));
  return section;
}

}  // namespace retrace::report::document

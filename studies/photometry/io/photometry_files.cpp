#include "studies/photometry/io/photometry_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "design/io/design_json.h"
#include "design/io/design_labels.h"
#include "studies/photometry/coefficient_map.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

Json point_json(const PhotometricPoint& p) {
  return {{"observation_deg", p.test_point.observation_deg},
          {"v_deg", p.test_point.v_deg},
          {"h_deg", p.test_point.h_deg},
          {"measured_v_deg", p.v_deg},
          {"rotation_deg", p.rotation_deg},
          {"value_mcd_per_lx", p.r_i_mcd_per_lx},
          {"std_error_mcd_per_lx", p.std_error_mcd_per_lx},
          {"limit_mcd_per_lx", p.limit_mcd_per_lx},
          {"margin", p.margin()},
          {"limit_as_given", p.test_point.minimum},
          {"unit", unit_name(p.test_point.unit)},
          {"limit_status", status_name(p.test_point.status)},
          {"limit_line", p.test_point.line},
          {"limit_source", p.test_point.source},
          {"pass", p.verdict() == Verdict::pass},
          {"verdict", verdict_name(p.verdict())},
          {"lower_bound", p.is_lower_bound},
          {"r_a_cd_per_lx_m2", p.r_a},
          {"r_l_cd_per_lx_m2", p.r_l}};
}

Json points_json(const std::vector<PhotometricPoint>& points) {
  Json json = Json::array();
  for (const PhotometricPoint& p : points) json.push_back(point_json(p));
  return json;
}

Json direction_json(const PhotometricDirection& d) {
  Json json = {{"v_deg", d.v_deg},
               {"h_deg", d.h_deg},
               {"rotation_deg", d.rotation_deg},
               {"incidence_deg", d.incidence_deg},
               {"azimuth_deg", d.azimuth_deg},
               {"rre", d.rre},
               {"std_error", d.std_error},
               {"truncated", d.truncated}};
  if (d.split)
    json["far_field"] = {{"wavelength_nm", d.split->wavelength_nm},
                         {"window_power", d.split->window},
                         {"outside_power", d.split->outside},
                         {"geometric_power", d.split->geometric}};
  return json;
}

Json change_json(const PhotometricChange& change) {
  return {{"key", change.key},
          {"from", change.from},
          {"to", change.to},
          {"verdict", verdict_name(change.verdict)},
          {"points", points_json(change.points)}};
}

Json areas_json(const PhotometrySettings& asked) {
  Json json = Json::array();
  for (const LimitArea& limit : asked.test_plan.areas)
    json.push_back({{"limit", limit.text()},
                    {"limit_status", status_name(limit.status)},
                    {"limit_line", limit.line},
                    {"limit_source", limit.source},
                    {"pass", limit.holds(asked.area_cm2)}});
  return json;
}

Json colour_json(const PhotometricColour& colour) {
  Json json = {{"observation_deg", colour.observation_deg},
               {"measured_v_deg", colour.v_deg},
               {"h_deg", colour.h_deg},
               {"rotation_deg", colour.rotation_deg}};
  if (colour.chromaticity)
    json.update({{"x", colour.chromaticity->x},
                 {"y", colour.chromaticity->y},
                 {"std_error_x", colour.std_error.x},
                 {"std_error_y", colour.std_error.y}});
  json["boundaries"] = Json::array();
  for (const ColourPoint& point : colour.boundaries) {
    Json one = {{"limit", point.boundary.text},
                {"limit_status", status_name(point.boundary.status)},
                {"limit_line", point.boundary.line},
                {"limit_source", point.boundary.source}};
    if (colour.chromaticity) one.update({{"margin", point.margin}, {"std_error", point.std_error}});
    json["boundaries"].push_back(std::move(one));
  }
  if (const auto verdict = colour.verdict()) json["verdict"] = verdict_name(*verdict);
  if (!colour.reason.text.empty()) json["reason"] = colour.reason.text;
  return json;
}

Json test_plan_json(const PhotometryResult& result) {
  const PhotometrySettings& asked = result.request;
  return {{"standard", asked.test_plan.standard},
          {"class", asked.test_plan.part_class},
          {"colour", asked.test_plan.colour},
          {"limits", asked.limits_source},
          {"limits_complete", asked.test_plan.is_complete}};
}

/// Adds the maps over entrance and observation angle to the document.
void add_maps(const PhotometryResult& result, Json& json) {
  if (result.request.compared) {
    json["compared_design"] = design::to_json(result.request.compared->design);
    json["compared_dye"] = result.request.compared->dye;
  }
  json["map_quantity"] = result.limits_are_r_i() ? "r_i" : "r_a";
  json["maps"] = Json::array();
  for (const CoefficientMap& map : result.coefficient_maps)
    json["maps"].push_back({{"design", map.design},
                            {"rotation_deg", map.rotation_deg},
                            {"presentation_deg", map.presentation_deg},
                            {"entrance_deg", map.entrance_deg},
                            {"observation_deg", map.observation_deg},
                            {"r_a_cd_per_lx_m2", map.rows(map.r_a)},
                            {"std_error_cd_per_lx_m2", map.rows(map.std_error)},
                            {"lacks_diffraction", map.lacks_diffraction}});
}

std::string point_text(const PhotometricPoint& p) {
  std::string text = p.verdict() == Verdict::fail ? "FAIL" : std::string(verdict_name(p.verdict()));
  if (p.is_lower_bound) text += " (at least)";
  if (p.v_deg != p.test_point.v_deg)
    text += fmt::format(" (measured at V {}, away from the mirror image of the lamp)", shortest(p.v_deg));
  if (p.test_point.status == LimitStatus::recalled) text += " (limit unconfirmed)";
  return text;
}

/// Returns the indices, in ascending order, of the points with the smallest margins. Of points with equal margins, the
/// first ones are selected.
/// \param max_count maximum number of points
std::vector<std::size_t> indices_of_smallest_margins(const std::vector<PhotometricPoint>& points,
                                                     std::size_t max_count) {
  std::vector<std::size_t> indices(points.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  std::stable_sort(indices.begin(), indices.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].margin() < points[b].margin(); });
  indices.resize(std::min(max_count, indices.size()));
  std::ranges::sort(indices);
  return indices;
}

/// Returns the readings as the rows of a table for the terminal.
/// \param max_rows maximum number of rows; those with the smallest margins are kept
std::string rows_of(const std::vector<PhotometricPoint>& points, std::size_t max_rows) {
  std::string table = fmt::format("{:>7} {:>6} {:>6} {:>9} {:>11} {:>11} {:>9} {:>8}  {}\n", "alpha", "V", "H",
                                  "rotation", "mcd/lx", "limit", "margin_%", "R_A", "verdict");
  const std::vector<std::size_t> shown = indices_of_smallest_margins(points, max_rows);
  for (const std::size_t k : shown) {
    const PhotometricPoint& p = points[k];
    table += fmt::format("{:>7} {:>6} {:>6} {:>9} {:>11} {:>11} {:>9} {:>8}  {}\n",
                         fixed_visible(p.test_point.observation_deg, 2), shortest(p.test_point.v_deg),
                         shortest(p.test_point.h_deg), shortest(p.rotation_deg), fixed(p.r_i_mcd_per_lx, 2),
                         fixed(p.limit_mcd_per_lx, 2), fixed(100.0 * p.margin(), 1), fixed(p.r_a, 1), point_text(p));
  }
  if (shown.size() < points.size())
    table += fmt::format("... and {} points with larger or equal margins\n", points.size() - shown.size());
  return table;
}

/// Returns a line for each limit of the area.
std::string areas_text(const PhotometrySettings& asked) {
  std::string text;
  for (const LimitArea& limit : asked.test_plan.areas)
    text += fmt::format("area: {}{} - must be {}, is {} cm2\n", limit.holds(asked.area_cm2) ? "pass" : "FAIL",
                        limit.status == LimitStatus::recalled ? " (limit unconfirmed)" : "", limit.text(),
                        shortest(asked.area_cm2));
  return text;
}

/// Returns the colour, its verdict, and the boundaries that the colour violates.
std::string colour_text(const PhotometricColour& colour) {
  std::string text = "colour: ";
  if (const auto verdict = colour.verdict())
    text += *verdict == Verdict::fail ? "FAIL - " : fmt::format("{} - ", verdict_name(*verdict));
  if (!colour.chromaticity) return text + "no light is returned\n";
  text += fmt::format("x {}, y {} at {} degrees, V {}, H {}", fixed(colour.chromaticity->x, 4),
                      fixed(colour.chromaticity->y, 4), fixed_visible(colour.observation_deg, 2),
                      shortest(colour.v_deg), shortest(colour.h_deg));
  if (colour.boundaries.empty()) return text + "; the colour boundaries of the standard are not known\n";
  for (const ColourPoint& point : colour.boundaries)
    if (point.margin < 0.0) text += fmt::format("; violates {}", point.boundary.text);
  return text + (colour.reason.text.empty() ? "" : "; " + colour.reason.text) + "\n";
}

/// Returns the name of the light that illuminates the part.
std::string_view light_text(PhotometricLight light) {
  switch (light) {
    case PhotometricLight::illuminant_a: return "CIE A";
    case PhotometricLight::illuminant_d65: return "CIE D65";
    case PhotometricLight::of_design: return "the design's light";
  }
  return {};
}

/// Returns a line with the verdict.
/// \param reason reason of an undetermined verdict
std::string verdict_text(Verdict verdict, const TestPlan& test_plan, const std::string& reason = {}) {
  switch (verdict) {
    case Verdict::pass: return "verdict: pass\n";
    case Verdict::unconfirmed:
      return test_plan.is_complete ? "verdict: unconfirmed - every point passes, but not every limit is confirmed\n"
                                   : "verdict: unconfirmed - every point passes, but the table does not contain all "
                                     "requirements of the standard\n";
    case Verdict::undetermined:
      return reason.empty() ? "verdict: undetermined\n" : fmt::format("verdict: undetermined - {}\n", reason);
    case Verdict::fail: return "verdict: FAIL\n";
  }
  return {};
}

std::string change_text(const PhotometricChange& change, const TestPlan& test_plan, std::size_t max_rows) {
  std::string text =
      fmt::format("\n{} {} = {} (now {}):\n",
                  change.passes() ? "change that passes:" : "best change that was tried, not sufficient:", change.key,
                  shortest(change.to), shortest(change.from));
  return text + rows_of(change.points, max_rows) + verdict_text(change.verdict, test_plan);
}

Json entrance_model_json(const EntranceModel& model) {
  return {{"method", "tangent_planes"},
          {"elements", model.elements},
          {"traced_elements", model.traced_elements},
          {"path_rms_waves", model.path_rms_waves},
          {"angle_rms_arcmin", model.angle_rms_arcmin},
          {"max_angle_arcmin", model.max_angle_arcmin},
          {"allowed_angle_arcmin", model.allowed_angle_arcmin}};
}

/// Returns the spread of the cells if the fields of different cells are added, or null if their intensities are added.
const design::CellSpread* interfering_cells(const PhotometryResult& result) {
  return result.has_diffraction ? result.design.cell_spread() : nullptr;
}

std::string cells_text(const design::CellSpread& spread) {
  return fmt::format("the fields of cells are added: spread of their depths {} nm, of their positions {} nm\n",
                     shortest(spread.depth_nm), shortest(spread.spacing_nm));
}

std::string entrance_model_text(const EntranceModel& model) {
  return fmt::format(
      "curved entrance surface: tangent planes of {} of {} elements; differences from rays: paths {} wavelengths "
      "(rms), directions at most {} arcmin (allowed: {})\n",
      model.traced_elements, model.elements, fixed_visible(model.path_rms_waves, 3),
      fixed_visible(model.max_angle_arcmin, 3), fixed_visible(model.allowed_angle_arcmin, 2));
}

}  // namespace

std::string photometry_json(const PhotometryResult& result) {
  const PhotometrySettings& asked = result.request;
  Json json = {{"engine", result.engine},
               {"engine_requested", raytrace::engine_name(asked.engine)},
               {"diffraction", result.has_diffraction},
               {"design", design::to_json(result.design)},
               {"test_plan", test_plan_json(result)},
               {"area_cm2", asked.area_cm2},
               {"area_limits", areas_json(asked)},
               {"light", light_name(asked.light)},
               {"dye", asked.dye},
               {"wavelengths_nm", result.wavelengths_nm},
               {"rotation_deg", asked.rotation_deg},
               {"source_arcmin", 60.0 * asked.apertures.source.deg()},
               {"receiver_arcmin", 60.0 * asked.apertures.receiver.deg()},
               {"window_deg", asked.window_deg},
               {"seed", asked.seed}};
  json["points"] = points_json(result.points);
  if (result.complete || !result.points.empty()) json["verdict"] = verdict_name(result.verdict);
  if (!result.reason.text.empty()) json["reason"] = result.reason.text;
  if (result.entrance_model) json["entrance_model"] = entrance_model_json(*result.entrance_model);
  if (const design::CellSpread* const spread = interfering_cells(result))
    json["cell_interference"] = {{"depth_spread_nm", spread->depth_nm}, {"spacing_spread_nm", spread->spacing_nm}};
  if (result.colour) json["chromaticity"] = colour_json(*result.colour);
  json["directions"] = Json::array();
  for (const PhotometricDirection& d : result.directions) json["directions"].push_back(direction_json(d));
  if (!result.coefficient_maps.empty()) add_maps(result, json);
  json["changes"] = Json::array();
  if (result.change) json["changes"].push_back(change_json(*result.change));
  json["elapsed_s"] = result.elapsed_s;
  return result_text("retrace.photometry/2", json, result.warnings, result.complete);
}

std::string photometry_csv(const PhotometryResult& result) {
  CsvWriter csv(
      "observation_deg,v_deg,h_deg,rotation_deg,value_mcd_per_lx,std_error_mcd_per_lx,limit_mcd_per_lx,margin,"
      "limit_status,pass,r_a_cd_per_lx_m2,r_l_cd_per_lx_m2,verdict,lower_bound,measured_v_deg,limit_source");
  for (const PhotometricPoint& p : result.points)
    csv.row(p.test_point.observation_deg, p.test_point.v_deg, p.test_point.h_deg, p.rotation_deg, p.r_i_mcd_per_lx,
            p.std_error_mcd_per_lx, p.limit_mcd_per_lx, p.margin(), status_name(p.test_point.status),
            p.verdict() == Verdict::pass, p.r_a, p.r_l, verdict_name(p.verdict()), p.is_lower_bound, p.v_deg,
            p.test_point.source);
  return csv.text();
}

std::string far_field_map_csv(const PhotometryResult& result) {
  CsvWriter csv("v_deg,h_deg,right_deg,up_deg,r_a_cd_per_lx_m2");
  for (const FarFieldMap& map : result.maps)
    for (std::size_t k = 0; k < map.r_a.size(); ++k) {
      const auto middle = [&](std::size_t bin) {
        return map.half_width_deg * (2.0 * (static_cast<double>(bin) + 0.5) / static_cast<double>(map.columns) - 1.0);
      };
      csv.row(map.v_deg, map.h_deg, fixed(middle(k % map.columns), 6), fixed(middle(k / map.columns), 6), map.r_a[k]);
    }
  return csv.text();
}

namespace {

/// Returns maps as CSV, see coefficient_map_csv().
/// \param quantity value of the column `quantity`
/// \param factor factor by which the values of the maps are multiplied
std::string maps_csv(const std::vector<CoefficientMap>& maps, const std::string& quantity, double factor) {
  CsvWriter csv;
  for (const CoefficientMap& map : maps) {
    if (csv.text().empty()) {
      std::vector<std::string> angles;
      for (const double angle : map.observation_deg) angles.push_back("observation_deg=" + shortest(angle));
      csv.row("design", "quantity", "rotation_deg", "presentation_deg", "entrance_deg", angles);
    }
    const std::vector<std::vector<double>> rows = map.rows(map.r_a);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      std::vector<std::string> values;
      for (const double value : rows[k]) values.push_back(std::isfinite(value) ? shortest(factor * value) : "");
      csv.row(map.design, quantity, map.rotation_deg, map.presentation_deg, map.entrance_deg[k], values);
    }
  }
  return csv.text();
}

/// Quantity of the maps of a result: R_A, or R_I if the standard limits R_I.
struct MapQuantity {
  std::string_view name;  ///< such as "R_A"
  std::string_view unit;
  std::string_view key;  ///< name with its unit in CSV files
  double factor = 1.0;   ///< value of the quantity divided by R_A in cd/(lx m^2)
};

MapQuantity quantity_of(const PhotometryResult& result) {
  if (!result.limits_are_r_i()) return {"R_A", "cd/(lx m2)", "r_a_cd_per_lx_m2", 1.0};
  return {"R_I", "mcd/lx", "r_i_mcd_per_lx",
          in_mcd_per_lx(1.0, PhotometricUnit::cd_per_lx_per_m2, result.request.area_cm2)};
}

/// Returns the indices of at most 8 of `count` values: the first one and others at equal distances.
std::vector<std::size_t> shown_indices(std::size_t count) {
  constexpr std::size_t kMaxShown = 8;
  const std::size_t step = (count + kMaxShown - 1) / kMaxShown;
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < count; k += step) indices.push_back(k);
  return indices;
}

/// Returns a number with four significant digits, or with all digits before the decimal point.
std::string four_digits(double value) {
  if (!std::isfinite(value)) return "-";
  const double magnitude = std::abs(value) > 0.0 ? std::floor(std::log10(std::abs(value))) : 0.0;
  return fixed(value, static_cast<int>(std::clamp(3.0 - magnitude, 0.0, 6.0)));
}

/// Returns the table of one map: one line for each entrance angle, one column for each observation angle.
std::string table_of_map(const CoefficientMap& map, double factor) {
  const std::vector<std::size_t> columns = shown_indices(map.observation_deg.size());
  std::string table = "entrance_deg";
  for (const std::size_t column : columns)
    table += fmt::format(" {:>9}", fixed_visible(map.observation_deg[column], 2));
  table += "\n";
  for (const std::size_t row : shown_indices(map.entrance_deg.size())) {
    table += fmt::format("{:>12}", shortest(map.entrance_deg[row]));
    for (const std::size_t column : columns)
      table += fmt::format(" {:>9}", four_digits(factor * map.r_a[map.index(row, column)]));
    table += "\n";
  }
  return table;
}

}  // namespace

std::string coefficient_map_csv(const PhotometryResult& result) {
  const MapQuantity quantity = quantity_of(result);
  return maps_csv(result.coefficient_maps, std::string(quantity.key), quantity.factor);
}

std::string coefficient_ratio_csv(const PhotometryResult& result) {
  return maps_csv(ratio_maps(result), "ratio", 1.0);
}

std::string coefficient_map_table(const PhotometryResult& result, std::size_t max_tables) {
  if (result.coefficient_maps.empty()) return {};
  const MapQuantity quantity = quantity_of(result);
  const std::vector<std::string> names = design::design_labels(result.map_designs()).names;
  std::string text = fmt::format("\nmap of {} in {} for light from {} directions; {} were traced\n", quantity.name,
                                 quantity.unit, result.map_directions, result.traced_map_directions);
  const auto heading = [](const std::string& name, const CoefficientMap& map) {
    return fmt::format("{}, rotation {}, presentation angle {}; columns: observation angle\n", printable(name),
                       shortest(map.rotation_deg), shortest(map.presentation_deg));
  };
  std::vector<std::string> tables;
  for (const CoefficientMap& map : result.coefficient_maps)
    tables.push_back(heading(names[map.design], map) + table_of_map(map, quantity.factor));
  for (const CoefficientMap& map : ratio_maps(result))
    tables.push_back(heading("ratio of the second design to the first", map) + table_of_map(map, 1.0));
  for (std::size_t k = 0; k < std::min(max_tables, tables.size()); ++k) text += tables[k];
  if (tables.size() > max_tables) text += fmt::format("... and {} more maps\n", tables.size() - max_tables);
  return text;
}

std::string first_answer_table(const PhotometricFirstAnswer& answer) {
  std::string table = fmt::format(
      "preliminary readings{} at {} wavelength{}; errors are standard errors, with additional systematic errors of "
      "about {:.0f} %; the computation continues\n",
      answer.lacks_diffraction ? " without diffraction" : "", answer.wavelengths_nm.size(),
      answer.wavelengths_nm.size() == 1 ? "" : "s", 100.0 * kSystematicErrorOfFirstAnswer);
  table += fmt::format("{:>7} {:>6} {:>6} {:>9} {:>11} {:>11}\n", "alpha", "V", "H", "rotation", "mcd/lx", "error");
  for (const PhotometricPoint& p : answer.points)
    table += fmt::format("{:>7} {:>6} {:>6} {:>9} {:>11} {:>11}\n", fixed_visible(p.test_point.observation_deg, 2),
                         shortest(p.test_point.v_deg), shortest(p.test_point.h_deg), shortest(p.rotation_deg),
                         fixed(p.r_i_mcd_per_lx, 2), fixed_visible(p.std_error_mcd_per_lx, 2));
  return table;
}

std::string photometry_table(const PhotometryResult& result, std::size_t max_rows) {
  const TestPlan& test_plan = result.request.test_plan;
  std::string table = printable(test_plan.standard);
  if (!test_plan.part_class.empty()) table += ", class " + printable(test_plan.part_class);
  table += fmt::format(", {}, {} cm2, {}{}\n", printable(test_plan.colour), shortest(result.request.area_cm2),
                       light_text(result.request.light),
                       result.request.dye.empty() ? "" : ", dye " + printable(result.request.dye));
  table += rows_of(result.points, max_rows);
  table += areas_text(result.request);
  if (result.entrance_model) table += entrance_model_text(*result.entrance_model);
  if (const design::CellSpread* const spread = interfering_cells(result)) table += cells_text(*spread);
  if (result.colour) table += colour_text(*result.colour);
  if (!result.points.empty()) table += verdict_text(result.verdict, test_plan, result.reason.text);
  if (result.change) table += change_text(*result.change, test_plan, max_rows);
  return table;
}

}  // namespace retrace::studies

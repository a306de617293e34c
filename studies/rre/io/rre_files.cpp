#include "studies/rre/io/rre_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "design/io/design_json.h"
#include "design/io/design_labels.h"
#include "studies/rre/rre_map.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;
using raytrace::kAccountCount, raytrace::kAccountNames;

Json direction_of(const RrePoint& at) {
  return {{"design", at.design},
          {"incidence_deg", at.incidence_deg},
          {"azimuth_deg", at.azimuth_deg},
          {"wavelength_nm", at.wavelength_nm}};
}

Json direction_and_cone_of(const RrePoint& at) {
  Json json = direction_of(at);
  json["acceptance_half_angle_deg"] = at.acceptance_half_angle_deg;
  return json;
}

Json ledger_json(const raytrace::Ledger& ledger) {
  Json json = Json::object();
  for (std::size_t k = 0; k < kAccountCount; ++k)
    if (raytrace::is_listed(static_cast<raytrace::Account>(k), ledger.power[k]))
      json[std::string(kAccountNames[k])] = ledger.power[k];
  return json;
}

Json by_wavelength_json(const std::vector<SpectralRre>& points) {
  Json json = Json::array();
  for (const SpectralRre& p : points)
    json.push_back({{"wavelength_nm", p.wavelength_nm},
                    {"weight", p.weight},
                    {"rre", p.rre},
                    {"std_error", p.std_error},
                    {"engine", p.engine}});
  return json;
}

/// Returns the design as JSON, with the wavelengths that represent its spectrum.
Json design_json(const RreResult& result, std::size_t d) {
  Json json = design::to_json(result.designs[d]);
  if (result.designs[d].light.spectrum()) json["spectrum"] = design::spectrum_json(result.light[d]);
  return json;
}

Json derivatives_json(const std::vector<RreDerivative>& derivatives) {
  Json json = Json::object();
  for (const RreDerivative& by : derivatives) {
    Json& entry = json[std::string(parameter_name(by.parameter))];
    if (by.missing_reason)
      entry = {{"left_out", text_of(*by.missing_reason)}};
    else
      entry = {{"value", by.derivative.value}, {"error", by.derivative.error}};
  }
  return json;
}

Json point_json(const RrePoint& p) {
  Json json = direction_and_cone_of(p);
  json["rre"] = p.rre;
  json["std_error"] = p.std_error;
  json["stokes"] = p.stokes.values();
  json["ledger"] = ledger_json(p.ledger);
  json["engine"] = p.engine;
  if (!p.by_wavelength.empty()) json["by_wavelength"] = by_wavelength_json(p.by_wavelength);
  if (p.engine == "exact" || p.engine == "stochastic") json["beams"] = p.beams;
  if (p.engine != "exact") return json;
  json["depth"] = p.depth;
  if (!p.derivatives.empty()) json["derivatives"] = derivatives_json(p.derivatives);
  return json;
}

bool has_several_cones(const RreResult& result) {
  for (const design::Design& design : result.designs)
    if (design.detector.acceptance_half_angle_deg.size() > 1) return true;
  return false;
}

/// Column with the labels of the designs in a table. It has no width if there is only one design.
class DesignColumn {
 public:
  explicit DesignColumn(const RreResult& result) {
    if (result.designs.size() < 2) return;
    names_ = design::design_labels(result.designs).names;
    width_ = 6;
    for (std::string& name : names_) {
      name = printable(name);
      width_ = std::max(width_, length_of(name));
    }
  }

  std::string heading() const { return padded("design"); }
  std::string cell(std::size_t design) const { return width_ > 0 ? padded(names_[design]) : std::string(); }

 private:
  /// Returns the number of characters of a UTF-8 text.
  static std::size_t length_of(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
  }
  std::string padded(const std::string& text) const {
    if (width_ == 0) return {};
    return text + std::string(width_ - std::min(width_, length_of(text)) + 2, ' ');
  }

  std::vector<std::string> names_;
  std::size_t width_ = 0;
};

std::string line_of(const RrePoint& point, const RreDerivative& by, const DesignColumn& designs) {
  std::string line = designs.cell(point.design);
  line += fmt::format("{:>13}  {:>11}  {:>14}  {:<18}  ", shortest(point.incidence_deg), shortest(point.azimuth_deg),
                      shortest(point.acceptance_half_angle_deg), parameter_name(by.parameter));
  if (by.missing_reason) return line + fmt::format("not computed: {}\n", text_of(*by.missing_reason));
  return line + fmt::format("{:>13.6g}  {:.1e}\n", by.derivative.value, by.derivative.error);
}

Json map_json(const RreMap& map) {
  return {{"design", map.design},
          {"acceptance_half_angle_deg", map.acceptance_half_angle_deg},
          {"mean_rre", map.mean()},
          {"incidence_deg", map.incidence_deg},
          {"azimuth_deg", map.azimuth_deg},
          {"rre", map.rows(map.rre)},
          {"std_error", map.rows(map.std_error)}};
}

/// Direction of a map with its value.
struct MapExtreme {
  double rre = 0.0;
  double incidence_deg = 0.0;
  double azimuth_deg = 0.0;
};

std::string text_of(const MapExtreme& at) {
  return fmt::format("{:>9} at incidence {}, azimuth {}\n", fixed(100.0 * at.rre, 4), shortest(at.incidence_deg),
                     shortest(at.azimuth_deg));
}

/// Returns the direction whose value is before all others in an order.
template <class Less>
MapExtreme first_of(const RreMap& map, Less is_less) {
  const auto found = std::min_element(map.rre.begin(), map.rre.end(), is_less);
  const auto k = static_cast<std::size_t>(found - map.rre.begin());
  return {*found, map.incidence_deg[k % map.incidence_deg.size()], map.azimuth_deg[k / map.incidence_deg.size()]};
}

std::string summary_of(const RreMap& map) {
  std::string text = fmt::format("mean     {:>9} by solid angle, incidence {} to {}\n", fixed(100.0 * map.mean(), 4),
                                 shortest(map.incidence_deg.front()), shortest(map.incidence_deg.back()));
  text += "maximum  " + text_of(first_of(map, std::greater<>()));
  text += "minimum  " + text_of(first_of(map, std::less<>()));
  text += "incidence_deg      min_%     mean_%      max_%\n";
  constexpr std::size_t kMaxLines = 17;
  const std::size_t step = (map.incidence_deg.size() + kMaxLines - 1) / kMaxLines;
  for (std::size_t i = 0; i < map.incidence_deg.size(); i += step) {
    double low = map.rre[map.index(i, 0)];
    double high = low;
    for (std::size_t k = 0; k < map.azimuth_deg.size(); ++k) {
      low = std::min(low, map.rre[map.index(i, k)]);
      high = std::max(high, map.rre[map.index(i, k)]);
    }
    text += fmt::format("{:>13}  {:>9}  {:>9}  {:>9}\n", shortest(map.incidence_deg[i]), fixed(100.0 * low, 4),
                        fixed(100.0 * map.mean_at(i), 4), fixed(100.0 * high, 4));
  }
  return text;
}

}  // namespace

std::string rre_json(const RreResult& result) {
  Json json = {{"engine", result.engine}, {"engine_requested", result.engine_requested}};
  json["designs"] = Json::array();
  for (std::size_t d = 0; d < result.designs.size(); ++d) json["designs"].push_back(design_json(result, d));
  json["seed"] = result.seed;
  json["points"] = Json::array();
  for (const RrePoint& p : result.points) json["points"].push_back(point_json(p));
  if (result.has_complete_maps()) {
    json["maps"] = Json::array();
    for (const RreMap& map : rre_maps(result)) json["maps"].push_back(map_json(map));
  }
  json["elapsed_s"] = result.elapsed_s;
  json["rays"] = result.rays;
  return result_text("retrace.rre/1", json, result.warnings, result.complete);
}

std::string rre_csv(const RreResult& result) {
  CsvWriter csv;
  // The columns of some accounts are optional (is_listed()). An optional column is written only if its power is not 0
  // at one or more points.
  std::vector<std::size_t> accounts;
  std::vector<std::string_view> names;
  for (std::size_t k = 0; k < kAccountCount; ++k) {
    const auto is_listed_at = [&](const RrePoint& p) {
      return raytrace::is_listed(static_cast<raytrace::Account>(k), p.ledger.power[k]);
    };
    if (!raytrace::is_listed(static_cast<raytrace::Account>(k), 0.0) &&
        std::ranges::none_of(result.points, is_listed_at))
      continue;
    accounts.push_back(k);
    names.push_back(kAccountNames[k]);
  }
  csv.row("design", "incidence_deg", "azimuth_deg", "wavelength_nm", "acceptance_half_angle_deg", "rre", "std_error",
          std::span<const std::string_view>(names), "engine");
  for (const RrePoint& p : result.points) {
    std::vector<double> power;
    for (const std::size_t k : accounts) power.push_back(p.ledger.power[k]);
    csv.row(p.design, p.incidence_deg, p.azimuth_deg, p.wavelength_nm, p.acceptance_half_angle_deg, p.rre, p.std_error,
            std::span<const double>(power), p.engine);
  }
  return csv.text();
}

std::string rre_table(const RreResult& result) {
  const bool several_cones = has_several_cones(result);
  const DesignColumn designs(result);
  std::string table = designs.heading() + "incidence_deg  azimuth_deg  ";
  if (several_cones) table += "acceptance_deg  ";
  table += "    RRE_%    +-_%   cut_%  engine\n";
  for (const RrePoint& p : result.points) {
    table += designs.cell(p.design);
    table += fmt::format("{:>13}  {:>11}  ", shortest(p.incidence_deg), shortest(p.azimuth_deg));
    if (several_cones) table += fmt::format("{:>14}  ", shortest(p.acceptance_half_angle_deg));
    table += fmt::format("{:>9}  {}  {}  {}\n", fixed(100.0 * p.rre, 4), fixed(100.0 * p.std_error, 4),
                         fixed(100.0 * p.ledger[raytrace::Account::truncated], 4), p.engine);
  }
  return table;
}

std::string rre_map_csv(const RreResult& result) {
  CsvWriter csv;
  for (const RreMap& map : rre_maps(result)) {
    if (csv.text().empty()) {
      std::vector<std::string> incidences;
      for (const double incidence : map.incidence_deg) incidences.push_back("incidence_deg=" + shortest(incidence));
      csv.row("design", "acceptance_half_angle_deg", "azimuth_deg", incidences);
    }
    for (std::size_t k = 0; k < map.azimuth_deg.size(); ++k)
      csv.row(map.design, map.acceptance_half_angle_deg, map.azimuth_deg[k], map.row(map.rre, k));
  }
  return csv.text();
}

std::string rre_map_table(const RreResult& result) {
  const std::vector<RreMap> maps = rre_maps(result);
  const std::vector<std::string> names = design::design_labels(result.designs).names;
  std::size_t directions = 0;
  std::string summaries;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    // The maps of a design for several acceptance cones have the same directions.
    if (k == 0 || maps[k].design != maps[k - 1].design) directions += maps[k].rre.size();
    summaries += fmt::format("\n{}, acceptance {} degrees, RRE in percent\n", printable(names[maps[k].design]),
                             shortest(maps[k].acceptance_half_angle_deg)) +
                 summary_of(maps[k]);
  }
  return fmt::format("RRE of {} directions; {} were traced, the others follow from symmetries\n", directions,
                     result.traced_directions) +
         summaries;
}

namespace {

/// Points of one design and acceptance cone, at one or all azimuths.
struct CurveSummary {
  std::vector<const RrePoint*> points;  ///< in the order of the result
  bool has_all_azimuths = false;
};

/// Returns the curves of the result.
/// \param has_all_azimuths true if one curve holds all azimuths for a given design and cone
std::vector<CurveSummary> curves_of(const RreResult& result, bool has_all_azimuths) {
  std::map<std::tuple<std::size_t, double, double>, std::size_t> curve_index;
  std::vector<CurveSummary> curves;
  for (const RrePoint& p : result.points) {
    const auto [it, is_new] = curve_index.try_emplace(
        {p.design, has_all_azimuths ? 0.0 : p.azimuth_deg, p.acceptance_half_angle_deg}, curves.size());
    if (is_new) curves.push_back({{}, has_all_azimuths});
    curves[it->second].points.push_back(&p);
  }
  return curves;
}

/// Returns the smallest angles on either side of normal incidence at which RRE falls to half of a value, by linear
/// interpolation. None if it does not fall so far.
/// \param by_incidence RRE of one azimuth by incidence
std::array<std::optional<double>, 2> half_angles(const std::map<double, double>& by_incidence, double start_deg,
                                                 double half) {
  std::array<std::optional<double>, 2> found;
  const auto crossing = [&](const auto& from, const auto& to) -> std::optional<double> {
    if (from.second < half || to.second >= half) return std::nullopt;
    return from.first + (to.first - from.first) * (from.second - half) / (from.second - to.second);
  };
  const auto start = by_incidence.find(start_deg);
  if (start == by_incidence.end()) return found;
  for (auto at = start; !found[1] && std::next(at) != by_incidence.end(); ++at)
    found[1] = crossing(*at, *std::next(at));
  for (auto at = start; !found[0] && at != by_incidence.begin(); --at) found[0] = crossing(*at, *std::prev(at));
  return found;
}

/// Returns the angles at which RRE falls to half of its value at the point `start`, as a text. Angles that differ
/// between azimuths are given as a range.
std::string half_text(const CurveSummary& curve, const RrePoint& start) {
  std::map<double, std::map<double, double>> by_azimuth;
  for (const RrePoint* p : curve.points) by_azimuth[p->azimuth_deg].try_emplace(p->incidence_deg, p->rre);
  std::array<std::vector<double>, 2> found;
  for (const auto& [azimuth_deg, by_incidence] : by_azimuth) {
    const auto angles = half_angles(by_incidence, start.incidence_deg, 0.5 * start.rre);
    for (std::size_t side = 0; side < 2; ++side)
      if (angles[side]) found[side].push_back(*angles[side]);
  }
  std::vector<std::string> parts;
  for (const std::vector<double>& angles : found) {
    if (angles.empty()) continue;
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    parts.push_back(*high - *low < 0.005 ? fixed(*low, 2) : fixed(*low, 2) + " to " + fixed(*high, 2));
  }
  return parts.empty() ? "-" : fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

std::string rre_summary(const RreResult& result, std::size_t max_lines) {
  std::vector<CurveSummary> curves = curves_of(result, false);
  if (curves.empty()) return {};
  if (curves.size() >= max_lines) curves = curves_of(result, true);
  const bool several_cones = has_several_cones(result);
  const DesignColumn designs(result);
  std::string table = designs.heading() + "azimuth_deg  ";
  if (several_cones) table += "acceptance_deg  ";
  table += "points     RRE_%  at_deg     max_%  at_deg  half_at_deg\n";
  const std::size_t shown = curves.size() < max_lines ? curves.size() : max_lines - 2;
  for (std::size_t k = 0; k < shown; ++k) {
    const CurveSummary& curve = curves[k];
    const auto is_normal = [](const RrePoint* p) { return p->incidence_deg == 0.0; };
    const auto normal = std::ranges::find_if(curve.points, is_normal);
    const RrePoint& start = normal != curve.points.end() ? **normal : *curve.points.front();
    const RrePoint& top = **std::ranges::max_element(curve.points, {}, &RrePoint::rre);
    table += designs.cell(start.design);
    table += fmt::format("{:>11}  ", curve.has_all_azimuths ? "all" : shortest(start.azimuth_deg));
    if (several_cones) table += fmt::format("{:>14}  ", shortest(start.acceptance_half_angle_deg));
    table += fmt::format("{:>6}  {:>8}  {:>6}  {:>8}  {:>6}  {}\n", curve.points.size(), fixed(100.0 * start.rre, 4),
                         shortest(start.incidence_deg), fixed(100.0 * top.rre, 4), shortest(top.incidence_deg),
                         half_text(curve, start));
  }
  if (shown < curves.size()) table += fmt::format("and {} more curves\n", curves.size() - shown);
  return table;
}

std::string derivative_table(const RreResult& result) {
  const DesignColumn designs(result);
  std::string lines;
  for (const RrePoint& point : result.points)
    for (const RreDerivative& by : point.derivatives) lines += line_of(point, by, designs);
  if (lines.empty()) return {};
  return "\n"
         "derivatives of RRE (a fraction) per unit of the parameter\n" +
         designs.heading() + "incidence_deg  azimuth_deg  acceptance_deg  parameter               derivative  +-\n" +
         lines;
}

namespace {

/// Returns a closed ring for GeoJSON, in which the last point is equal to the first.
Json ring_of(const geometry::Polygon& outline) {
  Json ring = Json::array();
  for (std::size_t k = 0; k <= outline.size(); ++k) {
    const geometry::Vec2& p = outline[k % outline.size()];
    ring.push_back(Json::array({p.x(), p.y()}));
  }
  return ring;
}

Json feature_of(const RrePoint& at, const ActiveRegion& region) {
  Json feature = {{"type", "Feature"}};
  feature["geometry"] = {{"type", "Polygon"}, {"coordinates", Json::array({ring_of(region.outline_mm)})}};
  feature["properties"] = direction_and_cone_of(at);
  feature["properties"]["efficiency"] = region.efficiency;
  return feature;
}

Json summary_of(const RrePoint& at, const Footprint& footprint) {
  Json summary = direction_and_cone_of(at);
  summary["entrance_area_mm2"] = footprint.entrance_area_mm2;
  summary["active_area_mm2"] = footprint.active_area_mm2;
  summary["active_fraction"] = footprint.active_fraction();
  summary["rre_shown"] = footprint.rre_contribution();
  summary["rre"] = at.rre;
  return summary;
}

}  // namespace

std::string footprint_json(const RreResult& result) {
  Json json = {{"type", "FeatureCollection"}};
  json["features"] = Json::array();
  json["regions"] = Json::array();
  for (const ReturnedLight& light : result.returned) {
    if (!light.footprint) continue;
    for (const ActiveRegion& region : light.footprint->regions)
      json["features"].push_back(feature_of(light.at, region));
    json["regions"].push_back(summary_of(light.at, *light.footprint));
  }
  return result_text("retrace.footprint/2", json, result.warnings, result.complete);
}

namespace {

using Fields = std::array<std::pair<std::string_view, double>, 6>;

/// Returns the names or the values of all fields.
template <std::size_t part>
std::vector<std::tuple_element_t<part, Fields::value_type>> parts_of(const Fields& fields) {
  std::vector<std::tuple_element_t<part, Fields::value_type>> parts;
  for (const auto& field : fields) parts.push_back(std::get<part>(field));
  return parts;
}

Fields fields_of(const FarFieldSpot& spot) {
  const raytrace::Stokes& s = spot.stokes;
  return {{{"deviation_arcmin", 60.0 * spot.deviation.deg()},
           {"deviation_azimuth_deg", spot.orientation.deg()},
           {"power", s.i},
           {"s1", s.q / s.i},
           {"s2", s.u / s.i},
           {"s3", s.v / s.i}}};
}

Json spot_of(const FarFieldSpot& spot) {
  Json json = Json::object();
  for (const auto& [name, value] : fields_of(spot)) json[std::string(name)] = value;
  json["depth_min"] = spot.min_depth;
  return json;
}

}  // namespace

std::string far_field_json(const RreResult& result) {
  Json json;
  json["directions"] = Json::array();
  for (const ReturnedLight& light : result.returned) {
    if (!light.far_field) continue;
    Json direction = direction_of(light.at);
    direction["total_power"] = light.far_field->total_power;
    direction["other_power"] = light.far_field->other_power;
    direction["spots"] = Json::array();
    for (const FarFieldSpot& spot : light.far_field->spots) direction["spots"].push_back(spot_of(spot));
    json["directions"].push_back(std::move(direction));
  }
  return result_text("retrace.far_field/1", json, result.warnings, result.complete);
}

std::string far_field_csv(const RreResult& result) {
  CsvWriter csv;
  const Fields names = fields_of({});
  csv.row("design", "incidence_deg", "azimuth_deg", "wavelength_nm", parts_of<0>(names), "depth_min");
  for (const ReturnedLight& light : result.returned) {
    if (!light.far_field) continue;
    const RrePoint& at = light.at;
    for (const FarFieldSpot& spot : light.far_field->spots) {
      const Fields fields = fields_of(spot);
      csv.row(at.design, at.incidence_deg, at.azimuth_deg, at.wavelength_nm, parts_of<1>(fields), spot.min_depth);
    }
  }
  return csv.text();
}

}  // namespace retrace::studies

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"
#include "core/data_directory.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/overloaded.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "materials/io/material_library.h"
#include "requests/json.h"
#include "requests/row.h"
#include "studies/photometry/io/limits_reader.h"
#include "studies/photometry/standards.h"

namespace retrace::app {
namespace {

// Wavelength of the helium d line in nm, at which tables give refractive indices. It is also the default wavelength of
// a design.
constexpr double kShownWavelengthNm = 587.56;

using Json = nlohmann::ordered_json;

/// Writes a list as text and as the JSON document `retrace.WHAT/1`.
ExitCode write_list(const CommonOptions& common, const std::string& what, Json json, const std::string& text) {
  const ResultFiles files(common, {}, what + ".json");
  files.prepare();
  return files.write(result_text("retrace." + what + "/1", std::move(json), {}), text);
}

template <class Value>
Json sourced(const fabrication::Sourced<Value>& item, Json value) {
  return {{"value", std::move(value)},
          {"basis", item.basis == fabrication::Basis::measured ? "measured" : "assumed"},
          {"source", item.source}};
}

Json direction_json(const fabrication::Sourced<geometry::Vec3>& item) {
  return sourced(item, Json{item.value.x(), item.value.y(), item.value.z()});
}

ExitCode list_machines(const CommonOptions& common) {
  std::string text = fmt::format("{:<10} {:<10} {:<10} {}\n", "name", "A or B", "C axis", "title");
  Json json = {{"machines", Json::array()}};
  for (const fabrication::Machine& m : fabrication::shipped_machines()) {
    const auto basis = [](const auto& item) {
      return item.basis == fabrication::Basis::measured ? "measured" : "assumed";
    };
    text += fmt::format("{:<10} {:<10} {:<10} {}\n", m.name, basis(m.a.direction), basis(m.c.direction), m.title);
    json["machines"].push_back({{"name", m.name},
                                {"title", m.title},
                                {m.tilt_letter() == 'A' ? "a_direction" : "b_direction", direction_json(m.a.direction)},
                                {"c_direction", direction_json(m.c.direction)}});
  }
  return write_list(common, "machines", std::move(json), text);
}

ExitCode list_processes(const CommonOptions& common) {
  std::string text = fmt::format("{:<16} {:<13} {:<16} {}\n", "name", "roughing (um)", "finishing (um)", "source");
  Json json = {{"processes", Json::array()}};
  for (const fabrication::Process& p : fabrication::shipped_processes()) {
    text += fmt::format("{:<16} {:<13} {:<16} {}\n", p.name, shortest(p.roughing_depth_um),
                        fmt::format("{} x {}", p.finishing_cuts, shortest(p.finishing_depth_um)), p.source);
    json["processes"].push_back({{"name", p.name},
                                 {"source", p.source},
                                 {"clearance_mm", p.clearance_mm},
                                 {"roughing_depth_um", p.roughing_depth_um},
                                 {"finishing_depth_um", p.finishing_depth_um},
                                 {"finishing_cuts", p.finishing_cuts},
                                 {"plough_length_mm", p.plough_length_mm},
                                 {"dwell_s", p.dwell_s},
                                 {"roughing_feed_mm_per_min", p.roughing_feed_mm_per_min},
                                 {"finishing_feed_mm_per_min", p.finishing_feed_mm_per_min},
                                 {"retract_feed_mm_per_min", p.retract_feed_mm_per_min}});
  }
  return write_list(common, "processes", std::move(json), text);
}

Json absorption_json(const materials::Material& m) {
  return std::visit(Overloaded{[](double per_mm) { return Json(per_mm); },
                               [](const materials::SpectralCurve& curve) {
                                 Json pairs = Json::array();
                                 for (std::size_t k = 0; k < curve.values.size(); ++k)
                                   pairs.push_back({curve.wavelengths_nm[k], curve.values[k]});
                                 return pairs;
                               }},
                    m.absorption_per_mm);
}

/// Returns dn/dT per kelvin of the index relative to air, at the temperature of the material data. It is computed by a
/// central difference of +-1 degree.
double growth_per_k(const materials::Material& m, const materials::Material& air) {
  const auto n = [&](double temperature_c) {
    return materials::index_relative_to_air(m, air, kShownWavelengthNm, temperature_c);
  };
  return 0.5 * (n(m.temperature_c + 1.0) - n(m.temperature_c - 1.0));
}

ExitCode list_materials(const CommonOptions& common) {
  const auto library = materials::MaterialLibrary::shipped();
  std::string text = fmt::format("{:<16} {:<10} {:<12} {}\n", "name", "n 588 nm", "data (nm)", "description");
  Json json = {{"materials", Json::array()}};
  for (const materials::Material& m : library.all()) {
    const double n = materials::refractive_index(m.dispersion, kShownWavelengthNm);
    const std::string range = shortest(m.valid_from_nm) + "-" + shortest(m.valid_to_nm);
    text += fmt::format("{:<16} {:<10} {:<12} {}\n", m.name, fixed(n, 5), range, m.description);
    json["materials"].push_back({{"name", m.name},
                                 {"description", m.description},
                                 {"refractive_index", n},
                                 {"wavelength_nm", kShownWavelengthNm},
                                 {"relative_to", m.relative_to_vacuum ? "vacuum" : "air"},
                                 {"valid_from_nm", m.valid_from_nm},
                                 {"valid_to_nm", m.valid_to_nm},
                                 {"temperature_c", m.temperature_c},
                                 {"absorption_per_mm", absorption_json(m)},
                                 {"source", m.source}});
    if (!m.thermo_optic) continue;
    json["materials"].back()["dn_dt_per_k"] = growth_per_k(m, library.air());
    json["materials"].back()["thermo_optic_source"] = m.thermo_optic->source;
  }
  json["metals"] = Json::array();
  for (const materials::Metal& m : library.metals()) {
    const std::complex<double> n = materials::complex_index(m.model, kShownWavelengthNm);
    const std::string range = shortest(m.valid_from_nm) + "-" + shortest(m.valid_to_nm);
    text += fmt::format("{:<16} {:<10} {:<12} {}\n", m.name,
                        fmt::format("{}+{}i", fixed(n.real(), 2), fixed(n.imag(), 2)), range, m.description);
    json["metals"].push_back({{"name", m.name},
                              {"description", m.description},
                              {"refractive_index", n.real()},
                              {"extinction_coefficient", n.imag()},
                              {"wavelength_nm", kShownWavelengthNm},
                              {"relative_to", "vacuum"},
                              {"valid_from_nm", m.valid_from_nm},
                              {"valid_to_nm", m.valid_to_nm},
                              {"source", m.source}});
  }
  return write_list(common, "materials", std::move(json), text);
}

/// Returns a standard as JSON, with its classes and colours from the table of limits.
Json standard_json(const studies::ShippedStandard& standard, const studies::LimitTable& table) {
  std::vector<std::string> classes;
  std::vector<std::string> colours;
  const auto add = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  const auto add_row = [&](const auto& row) {
    if (row.standard != standard.table_name) return;
    for (const std::string& name : row.classes) add(classes, name);
    add(colours, row.colour == "clear" ? "white" : row.colour);
  };
  for (const studies::LimitRow& row : table.rows) add_row(row);
  for (const studies::LimitFactor& factor : table.factors) add_row(factor);
  const bool is_complete = std::none_of(table.gaps.begin(), table.gaps.end(),
                                        [&](const auto& gap) { return gap.standard == standard.table_name; });
  return {{"name", standard.name},
          {"description", standard.description},
          {"classes", classes},
          {"colours", colours},
          {"limits_complete", is_complete},
          {"source_arcmin", 60.0 * standard.apertures.source.deg()},
          {"receiver_arcmin", 60.0 * standard.apertures.receiver.deg()},
          {"rotation_deg", standard.rotation_deg},
          {"conditions", standard.conditions}};
}

ExitCode list_standards(const CommonOptions& common) {
  const studies::LimitTable table = studies::read_limits(data_directory() / "photometry_limits.csv");
  std::string text = fmt::format("{:<9} {:<22} {:<17} {}\n", "name", "classes", "colours", "description");
  Json json = {{"standards", Json::array()}};
  for (const studies::ShippedStandard& standard : studies::shipped_standards()) {
    json["standards"].push_back(standard_json(standard, table));
    const auto& one = json["standards"].back();
    const auto classes = one["classes"].get<std::vector<std::string>>();
    const auto colours = one["colours"].get<std::vector<std::string>>();
    text += fmt::format("{:<9} {:<22} {:<17} {}{}\n", standard.name, fmt::format("{}", fmt::join(classes, " ")),
                        fmt::format("{}", fmt::join(colours, " ")), standard.description,
                        one["limits_complete"].get<bool>() ? "" : " (limits incomplete)");
  }
  return write_list(common, "standards", std::move(json), text);
}

ExitCode list_requests(const CommonOptions& common) {
  std::string text =
      fmt::format("{:<12} {:<20} {:<22} {:<30} {}\n", "request", "field", "option", "allowed", "meaning");
  for (const requests::Request* const request : requests::all_requests())
    for (const requests::Row& row : request->rows)
      text += fmt::format("{:<12} {:<20} {:<22} {:<30} {}\n", request->name, row.name, requests::option_of(row),
                          schema::allowed(row.kind), row.meaning);
  return write_list(common, "requests", requests::description_json(), text);
}

/// Names of the lists, and the functions that write them.
constexpr std::array<std::pair<std::string_view, ExitCode (*)(const CommonOptions&)>, 5> kLists = {
    {{"materials", list_materials},
     {"machines", list_machines},
     {"processes", list_processes},
     {"requests", list_requests},
     {"standards", list_standards}}};

struct ListOptions {
  std::string what;
};

std::vector<Argument> arguments(ListOptions& options) {
  const auto words = [] {
    Words names;
    for (const auto& [name, list] : kLists) names.emplace_back(name);
    return names;
  };
  return {{"WHAT", "materials, machines, processes, requests or standards", &options.what, one_of(words)}};
}

ExitCode run(const ListOptions& options, const CommonOptions& common) {
  for (const auto& [name, list] : kLists)
    if (name == options.what) return list(common);
  throw InputError(fmt::format("list: must be materials, machines, processes, requests or standards, got {}",
                               printable(options.what)));
}

}  // namespace

Command list_command() {
  return {
      .name = "list",
      .summary = "shipped materials, machines, processes and standards; fields of requests",
      .manual =
          "Lists the shipped materials, machines, processes or standards with their sources; `--json` adds details. "
          "`retrace list requests` lists the fields of all requests, which are settings of commands, library and "
          "Python: options, allowed values and meanings.",
      .writes = {"retrace.materials/1", "retrace.machines/1", "retrace.processes/1", "retrace.requests/1",
                 "retrace.standards/1"},
      .begin = begins<ListOptions>(arguments, run)};
}

}  // namespace retrace::app

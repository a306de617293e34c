#include "studies/design/design_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/io/toml_node.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/design/table_reader.h"

namespace retrace::studies {
namespace {

/// The key works; its value is checked where it is read.
struct Served {};
/// The key belongs to the format, but this version cannot do what it asks.
struct NotAvailable {};
/// The same, but one value asks for nothing and is let pass.
struct OnlyNumber {
  double value;
};
struct OnlyWord {
  std::string_view value;
};
using Availability = std::variant<Served, NotAvailable, OnlyNumber, OnlyWord>;

struct KeyRule {
  std::string_view name;
  Availability availability = Served{};
};

constexpr std::array kElementKeys = {KeyRule{"kind"},
                                     KeyRule{"base_mm"},
                                     KeyRule{"width_mm"},
                                     KeyRule{"apex_angle_deg"},
                                     KeyRule{"aperture_mm"},
                                     KeyRule{"cant_deg"},
                                     KeyRule{"cant_azimuth_deg"},
                                     KeyRule{"diameter_mm"},
                                     KeyRule{"mirror_offset_mm"},
                                     KeyRule{"mirror_half_angle_deg"}};
constexpr std::array kArrayKeys = {KeyRule{"arrangement"},      KeyRule{"extent"},          KeyRule{"shifted_rows"},
                                   KeyRule{"partial_elements"}, KeyRule{"x_length_mm"},     KeyRule{"y_length_mm"},
                                   KeyRule{"x_gap_mm"},         KeyRule{"y_gap_mm"},        KeyRule{"x_offset_mm"},
                                   KeyRule{"y_offset_mm"},      KeyRule{"overlap_percent"}, KeyRule{"mask"},
                                   KeyRule{"mask_threshold"},   KeyRule{"gap_mm"}};
constexpr std::array kBodyKeys = {KeyRule{"thickness_mm"},      KeyRule{"material"},   KeyRule{"refractive_index"},
                                  KeyRule{"absorption_per_mm"}, KeyRule{"back_index"}, KeyRule{"facet_coating"}};
constexpr std::array kLightKeys = {KeyRule{"wavelength_nm"}, KeyRule{"polarisation"}, KeyRule{"polarisation_angle_deg"},
                                   KeyRule{"spectrum"}, KeyRule{"weighting"}};
constexpr std::array kDetectorKeys = {KeyRule{"acceptance_half_angle_deg"}};
constexpr std::array kSurfaceKeys = {KeyRule{"model"},
                                     KeyRule{"roughness_sq_nm"},
                                     KeyRule{"correlation_length_um"},
                                     KeyRule{"waviness_sq_nm"},
                                     KeyRule{"waviness_length_um"},
                                     KeyRule{"abg_a"},
                                     KeyRule{"abg_b"},
                                     KeyRule{"abg_g"},
                                     KeyRule{"slope_distribution"},
                                     KeyRule{"height_map"},
                                     KeyRule{"height_map_level_axis"},
                                     KeyRule{"height_map_form"},
                                     KeyRule{"root_radius_um"},
                                     KeyRule{"rim_radius_um"},
                                     KeyRule{"root_chamfer_um"},
                                     KeyRule{"rim_chamfer_um"},
                                     KeyRule{"edge_chords"},
                                     KeyRule{"walls"},
                                     KeyRule{"scratches"},
                                     KeyRule{"dihedral_error_arcmin"},
                                     KeyRule{"facet_tilt_arcmin"},
                                     KeyRule{"angle_error_sigma_arcmin"},
                                     KeyRule{"angle_error_seed"}};
constexpr std::array kIdealisationKeys = {KeyRule{"facets"}, KeyRule{"entrance"}};
constexpr std::array kBaseKeys = {KeyRule{"kind"}, KeyRule{"incline_deg"}, KeyRule{"azimuth_deg"}, KeyRule{"radius_mm"},
                                  KeyRule{"axis"}, KeyRule{"sag_mm"},      KeyRule{"elements"}};
constexpr std::array kPartKeys = {KeyRule{"mesh"}, KeyRule{"allow_open"}, KeyRule{"facets"}, KeyRule{"plate_mm"}};
constexpr std::array kFrontKeys = {KeyRule{"turned"}, KeyRule{"mesh"}, KeyRule{"mesh_side"}, KeyRule{"centre_mm"}};

struct TableRule {
  std::string_view name;
  std::span<const KeyRule> keys;
};
constexpr std::array kTables = {TableRule{"element", kElementKeys},   TableRule{"array", kArrayKeys},
                                TableRule{"body", kBodyKeys},         TableRule{"light", kLightKeys},
                                TableRule{"detector", kDetectorKeys}, TableRule{"surface", kSurfaceKeys},
                                TableRule{"base", kBaseKeys},         TableRule{"part", kPartKeys},
                                TableRule{"front", kFrontKeys},       TableRule{"idealisation", kIdealisationKeys}};
constexpr std::array<std::string_view, 2> kTopLevelKeys = {"schema", "title"};

/// One entry of the design: its table's rule (null at top level) and its name there.
struct Entry {
  const toml::node* node;
  const TableRule* table;
  std::string name;

  std::string full_name() const {
    return table != nullptr ? fmt::format("{}.{}", table->name, printable(name)) : printable(name);
  }
};

template <class Rule>
const Rule* find_rule(std::span<const Rule> rules, std::string_view name) {
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const Rule& rule) { return rule.name == name; });
  return found != rules.end() ? &*found : nullptr;
}

/// Every table and key of the first two levels, in the order they were written.
std::vector<Entry> entries_in_order(const DesignDocument& document) {
  std::vector<Entry> entries;
  for (auto&& [key, node] : document.root()) {
    entries.push_back({&node, nullptr, std::string(key.str())});
    const TableRule* const rule = find_rule(std::span<const TableRule>(kTables), key.str());
    const toml::table* const table = node.as_table();
    if (rule == nullptr || table == nullptr) continue;
    for (auto&& [inner_key, inner] : *table) entries.push_back({&inner, rule, std::string(inner_key.str())});
  }
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    return document.position(*a.node) < document.position(*b.node);
  });
  return entries;
}

/// What to say of `name`, which is none of `candidates`: a close one if there is one, and what is allowed.
std::string unknown(std::string_view what, std::string_view name, std::span<const std::string_view> candidates,
                    std::span<const std::string_view> allowed) {
  const std::string_view meant = closest(name, candidates);
  const std::string suggestion = meant.empty() ? "" : fmt::format(", did you mean {}?", in_quotes(meant));
  return fmt::format("unknown {}{} (allowed: {})", what, suggestion, fmt::join(allowed, ", "));
}

std::string unknown_top_level(const Entry& entry) {
  for (const TableRule& table : kTables)
    if (find_rule(table.keys, entry.name) != nullptr)
      return fmt::format("unknown key at the top level, it belongs in [{}]", table.name);
  std::vector<std::string_view> known;
  if (!entry.node->is_table()) known.assign(kTopLevelKeys.begin(), kTopLevelKeys.end());
  for (const TableRule& table : kTables) known.push_back(table.name);
  return unknown(entry.node->is_table() ? "table" : "key", entry.name, known, known);
}

std::string unknown_in_table(const Entry& entry) {
  std::vector<std::string_view> served;
  std::vector<std::string_view> all;
  for (const KeyRule& rule : entry.table->keys) {
    all.push_back(rule.name);
    if (std::holds_alternative<Served>(rule.availability)) served.push_back(rule.name);
  }
  return unknown("key", entry.name, all, served.empty() ? all : served);
}

/// Says what is wrong with a value where only one asks for nothing; empty if it is that one.
struct UnavailableText {
  const toml::node& node;

  std::string operator()(const Served&) const { return {}; }
  std::string operator()(const NotAvailable&) const { return "not available in this version"; }
  std::string operator()(const OnlyNumber& only) const {
    const toml::array* const list = node.as_array();
    const auto is_that = [&](const toml::node& item) { return item.is_number() && item.value<double>() == only.value; };
    if (list != nullptr ? std::all_of(list->begin(), list->end(), is_that) : is_that(node)) return {};
    if (list == nullptr && !node.is_number()) return "must be a number, got " + shown(node);
    return fmt::format("not available in this version, which takes only {}, got {}", shortest(only.value), shown(node));
  }
  std::string operator()(const OnlyWord& only) const {
    if (!node.is_string()) return "must be a string, got " + shown(node);
    if (node.as_string()->get() == only.value) return {};
    return fmt::format("not available in this version, which takes only {}, got {}", in_quotes(only.value),
                       shown(node));
  }
};

/// What is wrong with an entry's name or availability; empty if nothing is.
std::string complaint(const Entry& entry) {
  if (entry.table != nullptr) {
    const KeyRule* const rule = find_rule(entry.table->keys, entry.name);
    return rule != nullptr ? std::visit(UnavailableText{*entry.node}, rule->availability) : unknown_in_table(entry);
  }
  if (std::find(kTopLevelKeys.begin(), kTopLevelKeys.end(), entry.name) != kTopLevelKeys.end()) return {};
  if (find_rule(std::span<const TableRule>(kTables), entry.name) == nullptr) return unknown_top_level(entry);
  return entry.node->is_table() ? std::string() : "must be a table, got " + shown(*entry.node);
}

}  // namespace

void check_keys(const DesignDocument& document) {
  for (const Entry& entry : entries_in_order(document)) {
    const std::string text = complaint(entry);
    if (!text.empty()) throw InputError(document.location(*entry.node, entry.full_name()), text);
  }
}

std::string complaint_about_key(std::string_view name) {
  std::vector<std::string> served;
  for (const TableRule& table : kTables)
    for (const KeyRule& rule : table.keys)
      if (!std::holds_alternative<NotAvailable>(rule.availability))
        served.push_back(fmt::format("{}.{}", table.name, rule.name));
  if (std::find(served.begin(), served.end(), name) != served.end()) return {};
  const std::vector<std::string_view> names(served.begin(), served.end());
  const std::string_view meant = closest(name, names);
  return fmt::format("{} is no key of a design{}", in_quotes(name),
                     meant.empty() ? "" : fmt::format(", did you mean {}?", in_quotes(meant)));
}

}  // namespace retrace::studies

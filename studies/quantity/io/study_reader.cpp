#include "studies/quantity/io/study_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/atomic_file.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "core/schema/reader.h"
#include "core/toml_file.h"
#include "studies/design/design_format.h"
#include "studies/design/design_reader.h"
#include "studies/quantity/io/point_texts.h"
#include "studies/quantity/io/quantity_reader.h"

namespace retrace::studies {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kSchema = "retrace.study/1";
constexpr std::array<std::string_view, 11> kTopLevel = {"schema",   "title",      "design",    "parameter",
                                                        "quantity", "analysis",   "machining", "sweep",
                                                        "optimize", "constraint", "tolerance"};
/// Parts of a study that decide what its points are.
constexpr std::array<std::string_view, 8> kParts = {"parameter", "quantity",  "analysis",   "machining",
                                                    "sweep",     "tolerance", "constraint", "optimize"};
constexpr std::array<std::string_view, 6> kAnalysisKeys = {"incidence_deg", "azimuth_deg", "engine",
                                                           "target_error",  "samples",     "cutoff"};
constexpr std::array<std::string_view, 13> kMachiningKeys = {"tool_width_mm",
                                                             "clearance_um",
                                                             "roughing_depth_um",
                                                             "finishing_depth_um",
                                                             "finishing_cuts",
                                                             "plough_length_um",
                                                             "roughing_feed_mm_per_min",
                                                             "finishing_feed_mm_per_min",
                                                             "traverse_feed_mm_per_min",
                                                             "dwell_s",
                                                             "strategy",
                                                             "edge_radius_um",
                                                             "surface"};
constexpr std::array kEngines = {
    TomlChoice<Engine>{"auto", Engine::automatic}, TomlChoice<Engine>{"exact", Engine::exact},
    TomlChoice<Engine>{"montecarlo", Engine::montecarlo}, TomlChoice<Engine>{"cell", Engine::cell},
    TomlChoice<Engine>{"embree", Engine::embree}};
constexpr std::array kStrategies = {
    TomlChoice<fabrication::Strategy>{"two-step", fabrication::Strategy::two_step},
    TomlChoice<fabrication::Strategy>{"unidirectional", fabrication::Strategy::unidirectional}};
constexpr std::array kSurfaces = {TomlChoice<bool>{"as_designed", false}, TomlChoice<bool>{"as_cut", true}};
constexpr std::array kScales = {TomlChoice<bool>{"linear", false}, TomlChoice<bool>{"log", true}};
constexpr std::array kDistributions = {TomlChoice<Distribution::Kind>{"normal", Distribution::Kind::normal},
                                       TomlChoice<Distribution::Kind>{"uniform", Distribution::Kind::uniform},
                                       TomlChoice<Distribution::Kind>{"triangular", Distribution::Kind::triangular}};
constexpr NumberRange kStudyIncidence{.low = -90.0, .low_included = false, .high = 90.0, .high_included = false};
constexpr NumberRange kShare{.low = 0.0, .low_included = false, .high = 1.0, .high_included = false};
constexpr NumberRange kCutoff{.low = 0.0, .high = 1.0, .high_included = false};
constexpr NumberRange kSane{.low = 1e-6, .high = 1e6};
constexpr NumberRange kSaneOrNone{.low = 0.0, .high = 1e6};
constexpr double kMostValues = 100'000.0;

double whole_number(TomlTable& table, std::string_view key, const NumberRange& range, double otherwise) {
  const double value = table.number(key, range).value_or(otherwise);
  if (value != std::floor(value)) table.fail(key, fmt::format("must be a whole number, got {}", shortest(value)));
  return value;
}

AnalysisSettings read_analysis(TomlTable document, std::uint32_t seed) {
  TomlTable table = document.table("analysis");
  AnalysisSettings analysis;
  analysis.incidence_deg = table.number("incidence_deg", kStudyIncidence).value_or(0.0);
  analysis.azimuth_deg = table.number("azimuth_deg", NumberRange{}).value_or(0.0);
  analysis.engine = table.choice("engine", all(kEngines)).value_or(Engine::automatic);
  analysis.target_error = table.number("target_error", kShare);
  if (table.has("samples"))
    analysis.rays = static_cast<std::uint64_t>(whole_number(table, "samples", {.low = 1.0, .high = 0x1p36}, 1.0));
  analysis.cutoff = table.number("cutoff", kCutoff);
  analysis.seed = seed;
  table.finish();
  return analysis;
}

MachiningProcess read_machining(TomlTable document) {
  TomlTable table = document.table("machining");
  MachiningProcess process;
  const auto read = [&](std::string_view key, const NumberRange& range, double& value) {
    value = table.number(key, range).value_or(value);
  };
  process.tool_width_mm = table.number("tool_width_mm", kSane);
  read("clearance_um", kSaneOrNone, process.clearance_um);
  read("roughing_depth_um", kSane, process.roughing_depth_um);
  read("finishing_depth_um", kSaneOrNone, process.finishing_depth_um);
  process.finishing_cuts = static_cast<int>(whole_number(table, "finishing_cuts", {.low = 0.0, .high = 1000.0}, 2.0));
  read("plough_length_um", kSaneOrNone, process.plough_length_um);
  read("roughing_feed_mm_per_min", kSane, process.roughing_feed_mm_per_min);
  read("finishing_feed_mm_per_min", kSane, process.finishing_feed_mm_per_min);
  read("traverse_feed_mm_per_min", kSane, process.traverse_feed_mm_per_min);
  read("dwell_s", {.low = 0.0, .high = 3600.0}, process.dwell_s);
  process.strategy = table.choice("strategy", all(kStrategies)).value_or(process.strategy);
  if (process.strategy == fabrication::Strategy::unidirectional) {
    table.refuse({"finishing_cuts"}, "not allowed for strategy = \"unidirectional\", which finishes no facet");
    process.finishing_cuts = 0;
  }
  read("edge_radius_um", {.low = 0.0, .high = 1000.0}, process.edge_radius_um);
  process.surface_as_cut = table.choice("surface", all(kSurfaces)).value_or(false);
  table.finish();
  return process;
}

/// What is wrong with a key that a parameter names; empty if nothing is.
std::string complaint_about_parameter(const std::string& key) {
  if (key == "design") return {};
  if (!is_setting(key)) return schema::complaint_about_key(design_format(), key);
  const bool analysis = key.starts_with("analysis.");
  const std::string name = key.substr(key.find('.') + 1);
  const std::span<const std::string_view> known =
      analysis ? std::span<const std::string_view>(kAnalysisKeys) : std::span<const std::string_view>(kMachiningKeys);
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  return fmt::format("{} is no key of [{}], which has {}", in_quotes(key), analysis ? "analysis" : "machining",
                     fmt::join(known, ", "));
}

void check_top_level(const TomlTable& document) {
  for (const std::string& name : document.names()) {
    if (std::find(kTopLevel.begin(), kTopLevel.end(), name) != kTopLevel.end()) continue;
    const std::string_view meant = closest(name, kTopLevel);
    document.fail(name, fmt::format("unknown key{} (allowed: {})",
                                    meant.empty() ? "" : fmt::format(", did you mean {}?", in_quotes(meant)),
                                    fmt::join(kTopLevel, ", ")));
  }
}

/// The tables `[[name]]`, of which there may be none.
std::vector<TomlTable> tables_of(TomlTable document, std::string_view name) {
  return document.tables(name, fmt::format("one or more tables [[{}]]", name));
}

ParameterValue value_of(const TomlTable& table, const TomlItem& item) {
  if (item.number && std::isfinite(*item.number)) return Parameter::value_of(*item.number);
  if (!item.text && !item.is_list)
    table.fail("values", fmt::format("must be a list of finite numbers, strings or lists, got {} in it", item.shown));
  return {item.toml, item.text.value_or(item.toml)};
}

std::vector<ParameterValue> read_values(TomlTable& table) {
  const auto items = table.items("values");
  if (!items || items->empty())
    table.fail("values", fmt::format("must be a list of at least one value, got {}", table.shown("values")));
  std::vector<ParameterValue> values;
  for (const TomlItem& item : *items) values.push_back(value_of(table, item));
  return values;
}

/// The ends of a range, where `from` and `to` were given.
Interval read_interval(TomlTable& table) {
  Interval interval;
  interval.logarithmic = table.choice("scale", all(kScales)).value_or(false);
  const NumberRange allowed = interval.logarithmic ? NumberRange{.low = 0.0, .low_included = false} : NumberRange{};
  interval.from = table.required_number("from", allowed);
  interval.to = table.required_number("to", allowed);
  if (!(interval.to > interval.from))
    table.fail("to", fmt::format("must be > from ({}), got {}", shortest(interval.from), shortest(interval.to)));
  return interval;
}

/// The values of a range with a step or a count: those of a LIST, or equal parts.
std::vector<ParameterValue> range_values(TomlTable& table, const Interval& interval) {
  std::vector<ParameterValue> values;
  if (table.has("step")) {
    table.refuse({"count"}, "either step or count");
    if (interval.logarithmic) table.fail("step", "a logarithmic range takes count");
    const double step = table.required_number("step", NumberRange{.low = 0.0, .low_included = false});
    const double steps = std::floor((interval.to - interval.from) / step + 1e-9);
    if (!(steps < kMostValues))
      table.fail("step", fmt::format("makes more than {} values, got {}", kMostValues, shortest(step)));
    for (double k = 0.0; k <= steps; ++k) values.push_back(Parameter::value_of(interval.from + k * step));
    return values;
  }
  const double count = whole_number(table, "count", {.low = 2.0, .high = kMostValues}, 2.0);
  for (double k = 0.0; k < count; ++k) values.push_back(Parameter::value_of(interval.at(k / (count - 1.0))));
  return values;
}

Distribution read_distribution(TomlTable& table) {
  Distribution distribution;
  distribution.kind = *table.choice("distribution", all(kDistributions));
  table.refuse({"values", "step", "count", "scale"}, "not allowed beside distribution");
  const bool normal = distribution.kind == Distribution::Kind::normal;
  if (normal) {
    distribution.mean = table.required_number("mean", NumberRange{});
    distribution.sigma = table.required_number("sigma", NumberRange{.low = 0.0, .low_included = false});
  }
  if (!normal || table.has("from") || table.has("to")) distribution.range = read_interval(table);
  if (distribution.kind == Distribution::Kind::triangular)
    distribution.mean =
        table.required_number("mode", {.low = distribution.range->from, .high = distribution.range->to});
  // A cut that leaves nothing of the distribution would have all its values in a tail nobody meant.
  if (normal && distribution.range &&
      (distribution.range->from > distribution.mean || distribution.range->to < distribution.mean))
    table.fail("mean", fmt::format("must lie between from and to, got {}", shortest(distribution.mean)));
  return distribution;
}

std::vector<std::string> read_keys(TomlTable& table) {
  constexpr std::string_view key = "key";
  std::vector<std::string> keys;
  if (table.shape_of(key) == TomlTable::Shape::text) keys.push_back(table.required_text(key));
  for (const TomlItem& item : table.items(key).value_or(std::vector<TomlItem>()))
    keys.push_back(item.text.value_or(""));
  if (keys.empty())
    table.fail(key, fmt::format("{}, must be a key of a design such as \"element.base_mm\", or a list of keys",
                                table.has(key) ? "got " + table.shown(key) : "missing"));
  for (const std::string& each : keys)
    if (const std::string text = complaint_about_parameter(each); !text.empty()) table.fail(key, text);
  return keys;
}

/// Paths of designs are meant from the folder of the study.
void resolve_designs(const TomlTable& table, const fs::path& folder, Parameter& parameter) {
  for (ParameterValue& value : parameter.values) {
    const std::string* const name = std::get_if<std::string>(&value.shown);
    if (name == nullptr || name->empty()) table.fail("values", "must be names of design files");
    value.toml = (folder / *name).string();
  }
}

/// \param folder that designs are meant from
Parameter read_parameter(TomlTable table, const fs::path& folder) {
  Parameter parameter;
  parameter.location = table.where();
  parameter.keys = read_keys(table);
  parameter.name = table.text("name").value_or(parameter.keys.front());
  if (table.has("distribution")) {
    parameter.distribution = read_distribution(table);
  } else if (table.has("values")) {
    table.refuse({"from", "to", "step", "count", "scale"}, "not allowed beside values");
    parameter.values = read_values(table);
  } else if (table.has("from") || table.has("to")) {
    const Interval interval = read_interval(table);
    if (table.has("step") || table.has("count"))
      parameter.values = range_values(table, interval);
    else
      parameter.interval = interval;
  } else {
    table.fail("values", "missing: a parameter has values, or from and to, or a distribution");
  }
  const bool is_design = parameter.keys.front() == "design";
  if (is_design && (parameter.keys.size() > 1 || parameter.values.empty()))
    table.fail("key", "\"design\" stands alone and takes values, names of design files");
  if (is_design) resolve_designs(table, folder, parameter);
  table.finish();
  return parameter;
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Columns of a table are told apart by their names, whatever their case.
void check_columns(const Study& study, const std::vector<InputLocation>& quantity_locations) {
  std::set<std::string> taken = {"point", "failed", "reason", "elapsed_s", "version", "status"};
  const auto take = [&](const std::string& name, const InputLocation& where, std::string_view what) {
    if (name.empty() || name.size() > 128 || printable(name, 200) != name || !taken.insert(lower(name)).second)
      throw InputError(where, fmt::format("{} {} is taken or no name: give another name", what, in_quotes(name)));
  };
  for (const Parameter& parameter : study.parameters) take(parameter.name, parameter.location, "the column");
  for (std::size_t k = 0; k < study.quantities.size(); ++k) {
    take(study.quantities[k]->name(), quantity_locations[k], "the column");
    take(study.quantities[k]->name() + "_std_error", quantity_locations[k], "the column");
  }
}

/// A key has one value at a point.
void check_keys_once(const Study& study) {
  std::set<std::string> taken;
  for (const Parameter& parameter : study.parameters)
    for (const std::string& key : parameter.keys)
      if (!taken.insert(key).second)
        throw InputError(parameter.location, fmt::format("{} has a parameter already", in_quotes(key)));
  for (const std::string& text : study.overrides)
    if (taken.contains(key_of(text)))
      throw InputError({"--set " + printable(text), 0, ""}, "the study varies this key");
}

/// FNV-1a: tells whether a file was changed, not by whom.
std::string fingerprint(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return fmt::format("{} bytes, {:016x}", text.size(), hash);
}

/// What is in files, which need not be there: a point that wants them fails.
std::string fingerprints(const std::vector<fs::path>& files) {
  std::string parts;
  for (const fs::path& file : files) {
    try {
      parts += file.filename().string() + ": " + fingerprint(read_file(file, kMostDataBytes)) + "\n";
    } catch (const InputError&) {
      parts += file.filename().string() + ": cannot be read\n";
    }
  }
  return parts;
}

std::vector<std::pair<std::string, std::string>> parts_of(const TomlTable& document, const Study& study,
                                                          const std::vector<fs::path>& named) {
  std::vector<std::pair<std::string, std::string>> parts;
  for (const std::string_view key : kParts) parts.emplace_back(key, document.as_json(key));
  std::string designs;
  for (const auto& [file, text] : study.design_texts)
    designs += fs::path(file).filename().string() + " " + parse_toml(text, file, kShortTomlBytes).as_json() + "\n";
  parts.emplace_back("the design", designs);
  parts.emplace_back("a file of the design", fingerprints(named));
  parts.emplace_back("--set", fmt::format("{}", fmt::join(study.overrides, "\n")));
  parts.emplace_back("--seed", fmt::format("{}", study.seed));
  return parts;
}

void read_designs(TomlTable top, Study& study) {
  const auto varied = std::find_if(study.parameters.begin(), study.parameters.end(),
                                   [](const Parameter& p) { return p.keys.front() == "design"; });
  const std::optional<fs::path> file = top.file("design");
  if (varied != study.parameters.end()) {
    if (file) top.fail("design", "a parameter names the designs");
    for (const ParameterValue& value : varied->values)
      study.design_texts.emplace(value.toml, read_toml_text(value.toml));
    return;
  }
  if (!file) top.fail("design", "missing, must be the name of a design file");
  study.design_file = file->string();
  study.design_texts.emplace(study.design_file, read_toml_text(study.design_file));
}

}  // namespace

Study parse_study(const std::string& text, const std::string& source_name, std::span<const std::string> overrides,
                  std::uint32_t seed) {
  TomlTable top = parse_toml(text, source_name, kShortTomlBytes, overrides_for(overrides, true));
  const fs::path folder = fs::path(source_name).parent_path();
  Study study;
  study.source = source_name;
  study.text = text;
  study.overrides.assign(overrides.begin(), overrides.end());
  study.seed = seed;
  const std::optional<std::string> schema = top.text("schema");
  if (schema && *schema != kSchema)
    top.fail("schema", fmt::format("must be {}, got {}", in_quotes(kSchema), in_quotes(*schema)));
  check_top_level(top);
  study.title = top.text("title").value_or("");
  for (const TomlTable& table : tables_of(top, "parameter")) study.parameters.push_back(read_parameter(table, folder));
  std::vector<InputLocation> quantity_locations;
  std::vector<fs::path> of_quantities;
  for (const TomlTable& table : tables_of(top, "quantity"))
    for (auto& quantity : read_quantity(table, of_quantities)) {
      study.quantities.push_back(std::move(quantity));
      quantity_locations.push_back(table.where("name"));
    }
  if (study.parameters.empty()) top.fail("parameter", "missing, must be one or more tables [[parameter]]");
  if (study.quantities.empty()) top.fail("quantity", "missing, must be one or more tables [[quantity]]");
  check_columns(study, quantity_locations);
  check_keys_once(study);
  read_analysis(top, seed);
  read_machining(top);
  read_designs(top, study);
  std::vector<fs::path> named = files_of_designs(study);
  named.insert(named.end(), of_quantities.begin(), of_quantities.end());
  study.files = {source_name};
  for (const auto& [file, design] : study.design_texts) study.files.push_back(file);
  for (const fs::path& file : named) study.files.push_back(file.string());
  study.parts = parts_of(top, study, named);
  return study;
}

Study read_study(const fs::path& file, std::span<const std::string> overrides, std::uint32_t seed) {
  return parse_study(read_toml_text(file), file == "-" ? "standard input" : file.string(), overrides, seed);
}

Candidate make_candidate(const Study& study, std::span<const ParameterValue> values) {
  PointTexts texts = texts_at(study, values);
  const TomlTable document = parse_toml(study.text, study.source, kShortTomlBytes, texts.for_study);
  const MachiningProcess machining = read_machining(document);
  // What the study says of the surface counts more than what cutting leaves.
  const std::vector<std::string> as_cut = surface_overrides(machining);
  texts.for_design.insert(texts.for_design.begin(), as_cut.begin(), as_cut.end());
  const Design varied = parse_design(study.design_texts.at(texts.design), texts.design, texts.for_design);
  varied.require_elements("a study");
  varied.require_plane_front("a study");
  return {varied, read_analysis(document, study.seed), machining};
}

}  // namespace retrace::studies

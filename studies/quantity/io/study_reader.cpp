#include "studies/quantity/io/study_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/atomic_file.h"
#include "core/length_units.h"
#include "core/message_text.h"
#include "core/named_file.h"
#include "core/number_format.h"
#include "core/schema/reader.h"
#include "core/text.h"
#include "core/toml_file.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"
#include "fabrication/job/io/process_files.h"
#include "fabrication/machine/io/machine_files.h"
#include "studies/quantity/io/point_texts.h"
#include "studies/quantity/io/quantity_reader.h"
#include "studies/quantity/io/study_format.h"

namespace retrace::studies {
namespace fs = std::filesystem;
namespace {

using schema::Document;

/// Names of the tables of a study file that determine its points.
constexpr std::array<std::string_view, 8> kIntervalsPerFunction = {"parameter", "quantity",  "analysis",   "machining",
                                                                   "sweep",     "tolerance", "constraint", "optimize"};
constexpr double kMaxValues = 100'000.0;

AnalysisSettings analysis_of(const Document& document, std::uint32_t seed) {
  AnalysisSettings analysis;
  analysis.incidence_deg = document.number("analysis.incidence_deg");
  analysis.azimuth_deg = document.number("analysis.azimuth_deg");
  analysis.rotation_deg = document.number("analysis.rotation_deg");
  analysis.engine = document.choice<raytrace::Engine>("analysis.engine");
  analysis.target_error = document.number_if("analysis.target_error");
  if (const auto rays = document.number_if("analysis.samples")) analysis.rays = static_cast<std::uint64_t>(*rays);
  if (analysis.rays && analysis.target_error)
    document.fail("analysis.target_error", "not allowed together with analysis.samples");
  analysis.cutoff = document.number_if("analysis.cutoff");
  analysis.seed = seed;
  return analysis;
}

/// Returns the parameter that varies a key, or null.
const Parameter* parameter_of(const Study& study, std::string_view key) {
  const auto found =
      std::ranges::find_if(study.parameters, [key](const Parameter& p) { return std::ranges::count(p.keys, key) > 0; });
  return found == study.parameters.end() ? nullptr : &*found;
}

/// Returns true if rays or beams are traced for some quantity of this kind ("rre" or "photometry").
bool is_traced(const Study& study, std::string_view kind) {
  return std::ranges::any_of(study.quantities, [kind](const auto& q) { return q->tracing().starts_with(kind); });
}

/// Refuses a setting of [analysis] that the study sets or varies, but that none of its quantities uses.
void refuse_setting(const Document& document, const Study& study, const std::string& key, const std::string& reason) {
  const Parameter* const varied = parameter_of(study, key);
  if (varied == nullptr && !document.has(key)) return;
  throw InputError(varied != nullptr ? varied->location : document.where(key), reason);
}

/// Refuses settings without effect. Photometry by rays has no cut-off, and only RRE is traced to a target error.
void check_settings_have_effect(const Document& document, const Study& study) {
  if (is_traced(study, "rre")) return;
  refuse_setting(document, study, "analysis.target_error",
                 "requires a table [[quantity]] with kind = \"rre\", \"ledger\" or \"far_field\", because other "
                 "quantities have no target error");
  const bool is_exact = raytrace::may_be_exact(document.choice<raytrace::Engine>("analysis.engine")) ||
                        parameter_of(study, "analysis.engine") != nullptr;
  if (!is_exact && is_traced(study, "photometry"))
    refuse_setting(document, study, "analysis.cutoff",
                   fmt::format("a cut-off requires analysis.engine = \"auto\" or \"exact\" for photometry, got {}",
                               in_quotes(document.text("analysis.engine"))));
}

/// Returns the machine or the process that a key names. A name with an extension is a file, relative to the folder of
/// the study.
std::string name_or_file(const Document& document, const std::string& key) {
  const fs::path name = document.text_if(key);
  if (!name.has_extension() || name.is_absolute()) return name.string();
  return (fs::path(document.source()).parent_path() / name).string();
}

/// Replaces default values by values of the process that [machining] names. Values that [machining] itself gives are
/// kept.
void take_process(const Document& document, MachiningProcess& machining) {
  if (machining.process.empty()) return;
  const fabrication::Process process =
      fabrication::load_process(machining.process, document.where("machining.process"));
  for (const ProcessValue& value : kProcessValues)
    if (!document.has(std::string("machining.") + value.key))
      machining.*value.machining = value.factor * (process.*value.process);
  const bool finishes = machining.strategy != fabrication::Strategy::unidirectional;
  if (finishes && !document.has("machining.finishing_cuts")) machining.finishing_cuts = process.finishing_cuts;
}

MachiningProcess machining_of(const Document& document) {
  MachiningProcess process;
  schema::fill(document, *schema::table_at(study_format().root, "machining"), "machining", &process);
  process.machine = name_or_file(document, "machining.machine");
  process.process = name_or_file(document, "machining.process");
  take_process(document, process);
  return process;
}

/// Checks that the machine of [machining] exists and is valid.
/// \throw InputError
void check_machine(const Document& document) {
  const std::string machine = name_or_file(document, "machining.machine");
  if (machine.empty()) return;
  const InputLocation where = document.where("machining.machine");
  if (fabrication::load_machine(machine, where).tilt == fabrication::Tilt::head)
    throw InputError(where,
                     "must be a machine with a tilting table, because prisms are cut, got " + in_quotes(machine));
}

/// Returns the machine file and the process file that [machining] names, if any.
std::vector<design::NamedFile> files_of_machining(const Document& document) {
  std::vector<design::NamedFile> files;
  for (const std::string key : {"machining.machine", "machining.process"})
    if (const fs::path name = name_or_file(document, key); name.has_extension())
      files.push_back({name, key, document.where(key)});
  return files;
}

/// Returns a message that explains why the key of a parameter is invalid. Empty if the key is valid.
std::string complaint_about_parameter(const std::string& key) {
  if (key == "design") return {};
  return schema::complaint_about_key(is_setting(key) ? study_format() : design::design_format(), key);
}

ParameterValue value_of(const std::string& toml) {
  TomlTable table = parse_toml("value = " + toml, "");
  if (table.shape_of("value") == TomlTable::Shape::number) return Parameter::value_of(*table.number("value"));
  if (table.shape_of("value") == TomlTable::Shape::text) return {toml, *table.text("value")};
  return {toml, toml};
}

/// Reads the lower and upper limit of a range.
Interval read_interval(const Document& document, const std::string& at) {
  Interval interval;
  interval.logarithmic = document.row(at + ".scale") != nullptr && document.text(at + ".scale") == "log";
  for (const auto& [key, end] : {std::pair(at + ".from", &interval.from), std::pair(at + ".to", &interval.to)}) {
    if (!document.has(key)) document.fail(key, "is missing; it must be a number");
    *end = document.number(key);
    if (interval.logarithmic && !(*end > 0.0)) document.fail(key, "must be > 0, got " + shortest(*end));
  }
  if (!(interval.to > interval.from))
    document.fail(at + ".to", fmt::format("must be greater than from ({}), got {}", shortest(interval.from),
                                          shortest(interval.to)));
  return interval;
}

/// Returns the values of a range with a step or a count. Steps work as in a LIST of the command line; a count divides
/// the range into equal parts.
std::vector<ParameterValue> range_values(const Document& document, const std::string& at, const Interval& interval) {
  std::vector<ParameterValue> values;
  if (const auto step = document.number_if(at + ".step")) {
    if (interval.logarithmic) document.fail(at + ".step", "not allowed for a logarithmic range: give count");
    const double steps = std::floor((interval.to - interval.from) / *step + 1e-9);
    if (!(steps < kMaxValues))
      document.fail(at + ".step", fmt::format("must give at most {} values, got {}", kMaxValues, shortest(*step)));
    for (double k = 0.0; k <= steps; ++k) values.push_back(Parameter::value_of(interval.from + k * *step));
    return values;
  }
  const double count = document.number(at + ".count");
  for (double k = 0.0; k < count; ++k) values.push_back(Parameter::value_of(interval.at(k / (count - 1.0))));
  return values;
}

Distribution read_distribution(const Document& document, const std::string& at) {
  Distribution distribution;
  distribution.kind = document.choice<Distribution::Kind>(at + ".distribution");
  const bool normal = distribution.kind == Distribution::Kind::normal;
  if (normal) {
    distribution.mean = document.number(at + ".mean");
    distribution.sigma = document.number(at + ".sigma");
  }
  if (!normal || document.has(at + ".from") || document.has(at + ".to"))
    distribution.range = read_interval(document, at);
  if (distribution.kind == Distribution::Kind::triangular) {
    distribution.mean = document.number(at + ".mode");
    const NumberRange within{.low = distribution.range->from, .high = distribution.range->to};
    if (!within.contains(distribution.mean))
      document.fail(at + ".mode", fmt::format("must be {}, got {}", within.text(), shortest(distribution.mean)));
  }
  // A mean outside the range of the distribution is refused because it is probably a mistake: all values would come
  // from a tail of the distribution.
  if (normal && distribution.range &&
      (distribution.range->from > distribution.mean || distribution.range->to < distribution.mean))
    document.fail(at + ".mean", fmt::format("must be between from and to, got {}", shortest(distribution.mean)));
  return distribution;
}

/// Makes the file names of designs relative to the folder of the study.
void resolve_designs(const Document& document, const std::string& at, Parameter& parameter) {
  const fs::path folder = fs::path(document.source()).parent_path();
  for (ParameterValue& value : parameter.values) {
    const std::string* const name = std::get_if<std::string>(&value.shown);
    if (name == nullptr || name->empty()) document.fail(at + ".values", "must be names of design files");
    value.toml = (folder / *name).string();
  }
}

Parameter read_parameter(const Document& document, const std::string& at) {
  Parameter parameter;
  parameter.location = document.where(at);
  parameter.keys = document.texts(at + ".key");
  parameter.name = document.has(at + ".name") ? document.text(at + ".name") : parameter.keys.front();
  for (std::string& key : parameter.keys) {
    key = current_key(key);
    if (const std::string text = complaint_about_parameter(key); !text.empty()) document.fail(at + ".key", text);
  }
  if (document.has(at + ".distribution")) {
    parameter.distribution = read_distribution(document, at);
  } else if (document.has(at + ".values")) {
    for (const std::string& toml : document.texts(at + ".values")) parameter.values.push_back(value_of(toml));
  } else if (document.has(at + ".from") || document.has(at + ".to")) {
    const Interval interval = read_interval(document, at);
    if (document.has(at + ".step") || document.has(at + ".count"))
      parameter.values = range_values(document, at, interval);
    else
      parameter.interval = interval;
  } else {
    document.fail(at + ".values", "is missing: a parameter requires values, or from and to, or a distribution");
  }
  const bool is_design = parameter.keys.front() == "design";
  if (is_design && (parameter.keys.size() > 1 || parameter.values.empty()))
    document.fail(at + ".key",
                  "\"design\" must be the only key of the parameter, and its values must be names of design files");
  if (is_design) resolve_designs(document, at, parameter);
  return parameter;
}

/// Returns the key paths of all entries in a list of tables. The list must have at least one entry.
std::vector<std::string> entries_of(const Document& document, const std::string& list) {
  std::vector<std::string> paths;
  for (std::size_t k = 0; k < document.count(list); ++k) paths.push_back(schema::path_of_entry(list, k));
  if (paths.empty()) document.fail(list, fmt::format("is missing; it must be one or more tables [[{}]]", list));
  return paths;
}

/// Checks that the names of columns are unique, ignoring upper and lower case.
void check_columns(const Study& study, const std::vector<InputLocation>& quantity_locations) {
  std::set<std::string> taken = {"point", "failed", "reason", "elapsed_s", "version", "status"};
  const auto take = [&](const std::string& name, const InputLocation& where, std::string_view what) {
    if (name.empty() || name.size() > 128 || printable(name, 200) != name || !taken.insert(lower_case(name)).second)
      throw InputError(
          where, fmt::format("{} {} is already used or is not a valid name: give another name", what, in_quotes(name)));
  };
  for (const Parameter& parameter : study.parameters) take(parameter.name, parameter.location, "the column");
  for (std::size_t k = 0; k < study.quantities.size(); ++k) {
    take(study.quantities[k]->name(), quantity_locations[k], "the column");
    take(study.quantities[k]->name() + "_std_error", quantity_locations[k], "the column");
  }
}

/// Checks that no two parameters set the same key.
void check_keys_once(const Study& study) {
  std::set<std::string> taken;
  for (const Parameter& parameter : study.parameters)
    for (const std::string& key : parameter.keys)
      if (!taken.insert(key).second)
        throw InputError(parameter.location, fmt::format("{} is already set by another parameter", in_quotes(key)));
  for (const std::string& text : study.overrides)
    if (taken.contains(current_key(key_of(text))))
      throw InputError({"--set " + printable(text), 0, ""}, "not allowed, because the study varies this key");
}

/// Returns a fingerprint (FNV-1a) that shows whether a file was changed. It gives no protection against forgery.
std::string fingerprint(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return fmt::format("{} bytes, {:016x}", text.size(), hash);
}

/// Returns the fingerprints of the files that the designs and quantities of a study name.
/// \throw InputError if a file cannot be read; the location is that of the file's name
std::string fingerprints(const std::vector<design::NamedFile>& files) {
  std::string parts;
  for (const auto& [file, key, where] : files) {
    const std::string content = read_named(where, [&] { return read_file(file, kMaxDataBytes); });
    parts += file.filename().string() + ": " + fingerprint(content) + "\n";
  }
  return parts;
}

/// Returns replacements that convert former and current names of keys to the names of the first version. Stores contain
/// texts with these names, so that stores of former versions remain valid.
std::vector<TomlRename> names_of_stores(const schema::Format& format) {
  std::vector<TomlRename> names = schema::former_names(format);
  const std::vector<TomlRename> back = reversed(names);
  names.insert(names.end(), back.begin(), back.end());
  return names;
}

/// Returns the text of an override with the key name that stores contain, see names_of_stores().
std::string override_of_stores(const std::string& text) {
  const std::string key = key_of(text);
  const std::string stored =
      current_path(key, names_of_stores(is_setting(key) ? study_format() : design::design_format()));
  return stored == key ? text : stored + text.substr(text.find('='));
}

std::vector<std::pair<std::string, std::string>> parts_of(const Study& study,
                                                          const std::vector<design::NamedFile>& named) {
  std::vector<std::pair<std::string, std::string>> parts;
  const Document::Origin& origin = study.document->origin();
  const TomlTable as_given =
      parse_toml(origin.text, study.source, kMaxDesignBytes, origin.overrides, names_of_stores(study_format()));
  for (const std::string_view key : kIntervalsPerFunction) parts.emplace_back(key, as_given.as_json(key));
  std::string designs;
  for (const auto& [file, text] : study.design_texts)
    designs += fs::path(file).filename().string() + " " +
               parse_toml(text, file, kMaxDesignBytes, {}, names_of_stores(design::design_format())).as_json() + "\n";
  parts.emplace_back("the design", designs);
  parts.emplace_back("a file of the design", fingerprints(named));
  std::vector<std::string> overrides;
  for (const std::string& text : study.overrides) overrides.push_back(override_of_stores(text));
  parts.emplace_back("--set", fmt::format("{}", fmt::join(overrides, "\n")));
  parts.emplace_back("--seed", fmt::format("{}", study.seed));
  return parts;
}

void read_designs(const Document& document, const FileTexts& given, Study& study) {
  const auto text_of = [&](const std::string& file, const std::string& key) {
    const auto found = given.find(file);
    if (found != given.end()) return found->second;
    return read_named(document.where(key), [&] { return design::read_toml_text(file); });
  };
  const auto varied = std::find_if(study.parameters.begin(), study.parameters.end(),
                                   [](const Parameter& p) { return p.keys.front() == "design"; });
  if (varied != study.parameters.end()) {
    if (document.has("design"))
      document.fail("design", "not allowed, because a parameter of the study already varies the design");
    const auto number = static_cast<std::size_t>(varied - study.parameters.begin());
    const std::string key = schema::path_of_entry("parameter", number) + ".values";
    for (const ParameterValue& value : varied->values) study.design_texts.emplace(value.toml, text_of(value.toml, key));
    return;
  }
  if (!document.has("design")) document.fail("design", "is missing; it must be the name of a design file");
  study.design_file = document.file("design").string();
  study.design_texts.emplace(study.design_file, text_of(study.design_file, "design"));
}

}  // namespace

Study parse_study(const std::string& text, const std::string& source_name, std::span<const std::string> overrides,
                  std::uint32_t seed, const FileTexts& designs) {
  Study study;
  study.document = std::make_shared<const Document>(
      schema::read_document(study_format(), text, source_name, kMaxDesignBytes, overrides_for(overrides, true)));
  const Document& document = *study.document;
  study.source = source_name;
  study.overrides.assign(overrides.begin(), overrides.end());
  study.seed = seed;
  study.title = document.text_if("title");
  for (const std::string& at : entries_of(document, "parameter"))
    study.parameters.push_back(read_parameter(document, at));
  std::vector<InputLocation> quantity_locations;
  std::vector<design::NamedFile> of_quantities;
  for (const std::string& at : entries_of(document, "quantity"))
    for (auto& quantity : read_quantity(document, at, of_quantities)) {
      study.quantities.push_back(std::move(quantity));
      quantity_locations.push_back(document.where(at + ".name"));
    }
  check_columns(study, quantity_locations);
  check_keys_once(study);
  check_settings_have_effect(document, study);
  // Contradictory settings and invalid files are reported before any point is computed.
  analysis_of(document, seed);
  machining_of(document);
  check_machine(document);
  read_designs(document, designs, study);
  std::vector<design::NamedFile> named = files_of_designs(study);
  named.insert(named.end(), of_quantities.begin(), of_quantities.end());
  const std::vector<design::NamedFile> of_machining = files_of_machining(document);
  named.insert(named.end(), of_machining.begin(), of_machining.end());
  study.files = {source_name};
  for (const auto& [file, design] : study.design_texts) study.files.push_back(file);
  for (const design::NamedFile& each : named) study.files.push_back(each.file.string());
  study.parts = parts_of(study, named);
  return study;
}

Study read_study(const fs::path& file, std::span<const std::string> overrides, std::uint32_t seed) {
  return parse_study(design::read_toml_text(file), file == "-" ? "standard input" : file.string(), overrides, seed);
}

namespace {

/// Sets the root radius of the design and the edge radius of the tool to the same value, if only one of them is given.
void link_edge_to_root(const Document& document, const std::string& text, PointTexts& texts, design::Design& varied,
                       MachiningProcess& machining) {
  constexpr std::string_view root = "surface.root_radius_um";
  if (varied.elements() == nullptr || !std::holds_alternative<geometry::RtpElement>(varied.part().element)) return;
  const bool has_root = varied.document->has(root);
  const bool has_edge = document.has("machining.edge_radius_um");
  if (has_edge == has_root) return;
  if (has_root) {
    machining.edge_radius_um = kUmPerMm * varied.part().edges.root_radius_mm;
    return;
  }
  if (!(machining.edge_radius_um > 0.0)) return;
  texts.for_design.push_back(fmt::format("{}={}", root, shortest(machining.edge_radius_um)));
  varied = design::parse_design(text, texts.design, texts.for_design);
}

/// Returns the settings for a level of accuracy. The target error is multiplied by ErrorLevel::scale. If the study
/// gives a number of rays instead, this number is divided by the square of the scale.
AnalysisSettings at_level(AnalysisSettings analysis, const std::optional<ErrorLevel>& level) {
  if (!level) return analysis;
  constexpr double max_target = 0.5;
  constexpr std::uint64_t min_rays = 1024;
  if (level->scale != 1.0) {
    if (analysis.rays)
      analysis.rays =
          std::max(std::min(*analysis.rays, min_rays),
                   static_cast<std::uint64_t>(static_cast<double>(*analysis.rays) / (level->scale * level->scale)));
    else
      analysis.target_error = std::min(max_target, level->scale * analysis.target_error.value_or(kDefaultTargetError));
  }
  analysis.seed += level->replicate;
  return analysis;
}

}  // namespace

Candidate make_candidate(const Study& study, std::span<const ParameterValue> values) {
  PointTexts texts = texts_at(study, values);
  std::shared_ptr<const Document> given = study.document;
  if (!texts.for_study.empty())
    given = std::make_shared<const Document>(schema::with(study_format(), *given, texts.for_study));
  const Document& document = *given;
  MachiningProcess machining = machining_of(document);
  // The surface that results from machining comes first, so that surface keys of the study override it.
  const std::vector<std::string> as_cut = surface_overrides(machining);
  texts.for_design.insert(texts.for_design.begin(), as_cut.begin(), as_cut.end());
  const std::string& text = study.design_texts.at(texts.design);
  design::Design varied = design::parse_design(text, texts.design, texts.for_design);
  link_edge_to_root(document, text, texts, varied, machining);
  design::require_supported(varied,
                            {.what = "a study", .solids = true, .entrances = true, .shells = true, .wet_backs = true});
  return {varied, at_level(analysis_of(document, study.seed), study.level), machining};
}

Warnings keys_without_effect(const Study& study) {
  Warnings warnings = schema::renamed_keys(*study.document);
  try {
    append(warnings, make_candidate(study, example_values(study)).design().warnings());
  } catch (const InputError&) {  // the study reports it when it computes this point
  }
  return warnings;
}

}  // namespace retrace::studies

#include "live/engine/engine.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/infinity.h"
#include "core/version.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"
#include "design/io/init_templates.h"
#include "live/engine/answers.h"
#include "live/engine/changes.h"
#include "live/engine/form.h"
#include "live/engine/request.h"

namespace retrace::live {
namespace {

std::string_view kind_of(const Error& error) {
  return dynamic_cast<const BudgetError*>(&error) != nullptr ? "budget" : "input";
}

Json failure(std::string_view kind, const std::string& text) {
  return {{"ok", false}, {"kind", kind}, {"text", text}};
}

Json failure(const InputError& error) {
  Json json = failure("input", error.what());
  const InputLocation& at = error.where();
  if (!at.file.empty()) json["file"] = at.file;
  if (at.line > 0) json["line"] = at.line;
  if (!at.key.empty()) json["key"] = at.key;
  json["message"] = error.text();
  return json;
}

/// Returns the JSON value without numbers that are not finite.
Json finite(Json json) {
  if (json.is_array())
    for (Json& item : json) item = finite(std::move(item));
  if (!json.is_object()) return json;
  Json kept = Json::object();
  for (auto& [key, value] : json.items())
    if (!value.is_number_float() || std::isfinite(value.get<double>())) kept[key] = finite(std::move(value));
  return kept;
}

Json materials_json(const materials::MaterialLibrary& library) {
  Json list = Json::array();
  for (const materials::Material& material : library.all())
    list.push_back({{"name", material.name}, {"description", material.description}});
  return list;
}

/// Returns the template that `retrace init` writes for a kind of design. If `extent` requests it, arrays are made
/// infinite.
std::string template_of(const std::string& kind, const std::string& extent) {
  std::string text = design::design_template(kind);
  if (extent.empty() || extent == "finite") return text;
  const design::Design design = design::parse_design(text, kind);
  if (design.part().array.arrangement == geometry::Arrangement::single) return text;
  return changed(*design.document, {{"array.extent", extent}}, true).toml;
}

}  // namespace

Engine::Engine() : library_(materials::MaterialLibrary::shipped()) {}
Engine::~Engine() = default;

std::string Engine::call(std::string_view request) {
  Json answered;
  Json id;
  try {
    const Json asked = Json::parse(request);
    if (asked.is_object() && asked.contains("id")) id = asked["id"];
    answered = {{"ok", true}};
    answered.update(answer(asked));
  } catch (const InputError& error) {
    answered = failure(error);
  } catch (const Error& error) {
    answered = failure(kind_of(error), error.what());
  } catch (const Json::exception& error) {
    answered = failure("input", std::string("the request cannot be read: ") + error.what());
  } catch (const std::exception& error) {
    answered = failure("fault", error.what());
  }
  if (!id.is_null()) answered["id"] = id;
  return finite(std::move(answered)).dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json Engine::answer(const Json& request) {
  const auto ask = get<std::string>(request, "ask");
  const auto seconds = get<double>(request, "seconds", 0.0);
  TimeLimit limit(seconds > 0.0 ? seconds : kInfinity);
  if (ask == "about") return about();
  if (ask == "form") return {{"groups", form_json()}};
  if (ask == "template")
    return {
        {"toml", template_of(get<std::string>(request, "kind"), get<std::string>(request, "extent", std::string()))}};
  if (ask == "open")
    return opened(get<std::string>(request, "toml"), get<std::string>(request, "source", std::string("design.toml")));
  if (ask == "set") return changed(request);
  if (ask == "close") {
    designs_.erase(get<std::size_t>(request, "design"));
    return Json::object();
  }
  if (ask == "standards") return standards_json();
  if (ask == "part") return part_json(design_of(request));
  if (ask == "stl") return stl_json(design_of(request));
  if (ask == "direction") return direction_json(design_of(request), request, limit);
  if (ask == "rre") return rre_json(design_of(request), request, limit);
  if (ask == "path") return path_json(design_of(request), request);
  if (ask == "stories") return typical_paths_json(design_of(request), request);
  if (ask == "photometry") return photometry_json(design_of(request), request, limit);
  throw InputError({"", 0, "ask"}, "must be a request of live/README.md, got " + ask);
}

Json Engine::about() const {
  Json accounts = Json::array();
  for (const std::string_view name : raytrace::kAccountNames) accounts.push_back(name);
  Json kinds = Json::array();
  for (const std::string_view kind : design::design_kinds())
    kinds.push_back({{"kind", kind}, {"title", design::parse_design(design::design_template(kind), "").title}});
  return {{"version", kVersion},
          {"schema", design::design_format().id},
          {"accounts", std::move(accounts)},
          {"kinds", std::move(kinds)},
          {"materials", materials_json(library_)}};
}

const OpenedDesign& Engine::design_of(const Json& request) const {
  const auto found = designs_.find(get<std::size_t>(request, "design"));
  if (found == designs_.end()) throw InputError({"", 0, "design"}, "is not open");
  return *found->second;
}

Json Engine::opened(std::string toml, const std::string& source) {
  auto design = std::make_unique<const OpenedDesign>(std::move(toml), source, library_);
  if (designs_.size() >= kMaxOpenDesigns) designs_.erase(designs_.begin());
  Json json = {{"design", ++last_}};
  json.update(design_json(*design));
  designs_[last_] = std::move(design);
  return json;
}

Json Engine::changed(const Json& request) {
  const OpenedDesign& before = design_of(request);
  try {
    const ChangedText text =
        live::changed(*before.design().document, get<Json>(request, "changes"), get<bool>(request, "adapt", false));
    Json json = opened(text.toml, before.design().source);
    json["adapted"] = text.adapted;
    return json;
  } catch (const InputError& error) {
    // The user has not seen this text, so its line numbers are removed.
    throw InputError({error.where().file, 0, error.where().key}, error.text());
  }
}

}  // namespace retrace::live

#include "requests/json.h"

#include <nlohmann/json.hpp>

#include "core/overloaded.h"
#include "core/schema/json.h"
#include "requests/descriptions.h"

namespace retrace::requests {
namespace {

using Json = nlohmann::ordered_json;

std::string kind_name(const schema::Kind& kind) {
  return std::visit(
      Overloaded{[](const schema::Number&) { return "number"; }, [](const schema::Integer&) { return "whole"; },
                 [](const schema::Flag&) { return "flag"; }, [](const schema::Word&) { return "word"; },
                 [](const schema::File&) { return "file"; }, [](const schema::WordOrFile&) { return "word_or_file"; },
                 [](const schema::NumberOrNumbers&) { return "number_or_numbers"; },
                 [](const schema::Numbers&) { return "numbers"; },
                 [](const schema::NumberRows&) { return "number_rows"; }, [](const schema::Texts&) { return "texts"; },
                 [](const auto&) { return "text"; }},
      kind);
}

std::string keyword_of(const Row& row) {
  return std::string(row.spelling.keyword.empty() ? row.name : row.spelling.keyword);
}

Json needs_json(const Row& row) {
  Json needs = Json::array();
  for (const Need need : row.needs) {
    Json any = Json::array();
    for (const schema::Condition& condition : need) {
      using Is = schema::Condition::Is;
      Json one = {{"field", condition.key}};
      if (condition.is == Is::given || condition.is == Is::absent)
        one["is"] = condition.is == Is::given ? "given" : "absent";
      else
        one[condition.is == Is::one_of ? "one_of" : "none_of"] =
            std::vector<std::string>(condition.words.begin(), condition.words.end());
      any.push_back(std::move(one));
    }
    needs.push_back(std::move(any));
  }
  return needs;
}

Json field_json(const Request& request, const Row& row) {
  Json json = {{"name", row.name}};
  if (!row.spelling.is_no_keyword) json["keyword"] = keyword_of(row);
  if (!row.spelling.former.empty()) json["former"] = row.spelling.former;
  json["kind"] = kind_name(row.kind);
  json["allowed"] = schema::allowed(row.kind);
  if (const auto* const word = std::get_if<schema::Word>(&row.kind))
    json["words"] = std::vector<std::string>(word->words.begin(), word->words.end());
  if (const auto* const numbers = std::get_if<schema::Numbers>(&row.kind)) {
    json["count"] = numbers->count;
    json["is_whole"] = numbers->is_integer;
  }
  if (const std::string_view unit = schema::unit_of(row.name); !unit.empty()) json["unit"] = unit;
  json["meaning"] = row.meaning;
  json["default"] = schema::to_json(row.access.get(request.initial()));
  json["default_text"] = default_text(request, row);
  if (!row.spelling.otherwise.empty()) json["otherwise"] = row.spelling.otherwise;
  if (!row.spelling.usual.empty()) json["usual"] = row.spelling.usual;
  if (row.is_required) json["required"] = true;
  if (!row.spelling.is_no_option) {
    json["option"] = option_of(row);
    json["value"] = row.spelling.value;
  }
  if (!row.needs.empty()) json["needs"] = needs_json(row);
  return json;
}

}  // namespace

Json description_json() {
  Json requests = Json::array();
  for (const Request* const request : all_requests()) {
    Json fields = Json::array();
    for (const Row& row : request->rows) fields.push_back(field_json(*request, row));
    requests.push_back({{"name", request->name}, {"command", request->command}, {"fields", std::move(fields)}});
  }
  return {{"requests", std::move(requests)}};
}

std::string keyword_of_field(std::string_view field) {
  for (const Request* const request : all_requests())
    for (const Row& row : request->rows)
      if (row.field().name == field) return keyword_of(row);
  return std::string(field.substr(field.rfind('.') + 1));
}

}  // namespace retrace::requests

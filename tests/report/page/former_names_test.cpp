#include "report/page/former_names.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "core/error.h"
#include "core/json_text.h"
#include "report/page/result_folder.h"
#include "report/page/sections.h"
#include "tests/support/refusals.h"

// Documents of former versions give the same pages as documents of the current version. A former document is made from
// the paths of former_names(): each path becomes a key with a value, within the objects and lists of the path.

namespace retrace::report::former_names_test {
namespace {

using Json = nlohmann::ordered_json;

/// Adds the key or value of a path, such as "zones[].share" or "findings[].kind=excess", to an object. Lists get one
/// entry. The value of a key is `value` unless the path contains a value.
void add(Json& object, const std::string& path, const Json& value) {
  const std::size_t dot = path.find('.');
  const std::size_t equals = path.find('=');
  std::string name = path.substr(0, std::min(dot, equals));
  const bool is_list = name.ends_with("[]");
  if (is_list) name.resize(name.size() - 2);
  Json& member = object[name];
  if (dot == std::string::npos) {
    if (!member.is_structured()) member = equals == std::string::npos ? value : Json(path.substr(equals + 1));
    return;
  }
  if (is_list && !member.is_array()) member = Json::array({Json::object()});
  if (!is_list && !member.is_object()) member = Json::object();
  add(is_list ? member[0] : member, path.substr(dot + 1), value);
}

/// Returns a document with all renamed keys of a kind.
/// \param version version of the document; the keys have their former names if it is not the current version
Json document_of(std::string_view kind, int version) {
  Json document = {{"schema", "retrace." + std::string(kind) + "/" + std::to_string(version)}, {"before", 1}};
  Json design = {{"source", "design.toml"}, {"title", "A design"}};
  double value = 1.5;
  for (const FormerName& name : former_names()) {
    if (!name.kind.empty() && name.kind != kind) continue;
    const std::string path(version < current_version(kind) ? name.former : name.current);
    add(name.kind.empty() ? design : document, path, value += 0.25);
  }
  document["design"] = design;
  document["designs"] = Json::array({design});
  document["after"] = 2;
  return document;
}

std::set<std::string> renamed_kinds() {
  std::set<std::string> kinds;
  for (const FormerName& name : former_names())
    if (!name.kind.empty()) kinds.insert(name.kind);
  return kinds;
}

/// Returns the page of a document. The schema in the table of documents is replaced by "schema", and the size by 0.
std::string page_of(const std::string& kind, const Json& document) {
  ResultFolder folder;
  add_result(folder, kind + ".json", to_text(document));
  EXPECT_EQ(folder.documents.size(), 1U);
  for (ResultDocument& each : folder.documents) {
    each.json["schema"] = "schema";
    each.bytes = 0;
  }
  return page_html(study_page(folder, ""), {"", "", ""});
}

TEST(FormerNames, DocumentsOfFormerVersionsGiveTheSamePages) {
  for (const std::string& kind : renamed_kinds()) {
    SCOPED_TRACE(kind);
    const Json former = document_of(kind, 1);
    const Json current = document_of(kind, 2);
    EXPECT_NE(former, current);
    Json renamed = former;
    replace_former_names(renamed);
    renamed["schema"] = current["schema"];
    EXPECT_EQ(to_text(renamed), to_text(current));
    EXPECT_EQ(current_document(to_text(former)), to_text(current));
    EXPECT_EQ(page_of(kind, former), page_of(kind, current));
  }
}

/// Former names are replaced one by one, so that each entry of the table has an effect.
TEST(FormerNames, EachNameIsReplaced) {
  for (const FormerName& name : former_names()) {
    SCOPED_TRACE(name.kind + " " + name.former);
    const bool is_of_design = name.kind.empty();
    Json former = {{"schema", "retrace." + (is_of_design ? "rre" : name.kind) + "/1"}};
    Json current = former;
    for (auto* const one : {&former, &current}) {
      const std::string path(one == &former ? name.former : name.current);
      if (is_of_design) (*one)["design"] = Json::object();
      add(is_of_design ? (*one)["design"] : *one, path, 1.5);
    }
    EXPECT_NE(former, current);
    replace_former_names(former);
    EXPECT_EQ(to_text(former), to_text(current));
  }
}

TEST(FormerNames, CurrentDocumentsDoNotChange) {
  for (const std::string& kind : renamed_kinds()) {
    const Json current = document_of(kind, 2);
    Json same = current;
    replace_former_names(same);
    EXPECT_EQ(to_text(same), to_text(current)) << kind;
    EXPECT_EQ(current_document(current.dump()), current.dump()) << kind;
  }
  for (const char* const text : {"", "{", "[1]", "{\"schema\": \"somebody/7\"}"})
    EXPECT_EQ(current_document(text), text);
}

/// A key that a former version used for something else keeps its name in documents of the current version.
TEST(FormerNames, NamesAreReplacedOnlyInTheirDocuments) {
  for (const Json& document : {Json{{"schema", "retrace.metrology/1"}, {"frames", 1}, {"base", {{"share", 2}}}},
                               Json{{"schema", "retrace.verification/2"}, {"frames", 1}}}) {
    Json same = document;
    replace_former_names(same);
    EXPECT_EQ(same, document);
  }
}

TEST(FormerNames, LaterVersionsAreRefused) {
  const auto refused = [](const std::string& schema) {
    ResultFolder folder;
    return refusal_of([&] { add_result(folder, "a.json", Json{{"schema", schema}}.dump()); });
  };
  for (const char* const schema : {"retrace.inspect/3", "retrace.rre/2", "retrace.rre/0", "retrace.rre"})
    EXPECT_EQ(refused(schema), "a.json: schema") << schema;
  EXPECT_EQ(refused("retrace.inspect/1"), "");
  try {
    ResultFolder folder;
    add_result(folder, "a.json", R"({"schema": "retrace.inspect/3"})");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("retrace.inspect/3"), std::string::npos) << error.what();
  }
}

/// The renamed names of documents are those of the project's table of all renamed names.
TEST(FormerNames, AreThoseOfTheTableOfTheProject) {
  std::ifstream file(std::string(RETRACE_SOURCE_DIR) + "/tests/data/renames.json");
  const Json table = Json::parse(file);
  using Name = std::tuple<std::string, std::string, std::string>;
  std::set<Name> expected;
  for (const Json& entry : table)
    if (entry.at("kind") == "document")
      expected.emplace(entry.at("format").get<std::string>(), entry.at("former").get<std::string>(),
                       entry.at("current").get<std::string>());
  std::set<Name> names;
  for (const FormerName& name : former_names())
    if (!name.kind.empty()) names.emplace(name.kind, name.former, name.current);
  EXPECT_EQ(names, expected);
}

}  // namespace
}  // namespace retrace::report::former_names_test

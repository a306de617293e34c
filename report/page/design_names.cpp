#include "report/page/design_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "report/page/document_view.h"

namespace retrace::report {
namespace {

using namespace document;

/// Returns a text that is equal for equal designs. It contains all keys of the design, except the name of the file and
/// the computed spectrum.
std::string content_of(Json design) {
  design.erase("source");
  design.erase("spectrum");
  return design.dump();
}

std::string folder_of(const ResultDocument& document) {
  return std::filesystem::path(document.name).parent_path().generic_string();
}

/// Returns the document whose list of designs belongs to a document: the document itself, or the efficiency document of
/// the same folder. Returns null if there is none.
const ResultDocument* with_designs(const ResultFolder& folder, const ResultDocument& document) {
  if (!list(document.json, "designs").empty()) return &document;
  for (const ResultDocument& other : folder.documents)
    if (other.kind == "rre" && folder_of(other) == folder_of(document)) return &other;
  return nullptr;
}

}  // namespace

const Json* design_of(const ResultFolder& folder, const ResultDocument& document, double number) {
  if (const Json& design = member(document.json, "design"); design.is_object()) return &design;
  const ResultDocument* const source = with_designs(folder, document);
  if (source == nullptr) return nullptr;
  const Json& designs = list(source->json, "designs");
  if (!(number >= 0.0 && number < static_cast<double>(designs.size()))) return nullptr;
  const Json& design = designs[static_cast<std::size_t>(number)];
  return design.is_object() ? &design : nullptr;
}

DesignNames::DesignNames(const ResultFolder& folder) : folder_(folder) {
  std::vector<std::string> contents;
  std::vector<Json> different;
  std::vector<std::string> short_names;
  const auto add = [&](const Json& design) {
    if (!design.is_object()) return;
    std::string content = content_of(design);
    if (std::ranges::find(contents, content) != contents.end()) return;
    contents.push_back(std::move(content));
    different.push_back(design);
    short_names.push_back(name_of_design(design));
  };
  for (const ResultDocument& document : folder.documents) {
    add(member(document.json, "design"));
    const Json& designs = list(document.json, "designs");
    for (const Json& design : designs) add(design);
    if (designs.size() < 2) continue;
    const std::vector<Json> of_document(designs.begin(), designs.end());
    std::vector<std::string> names;
    for (const Json& design : of_document)
      names.push_back(design.is_object() ? name_of_design(design) : std::string("design"));
    labels_.emplace(document.name, design::design_labels(of_document, names));
  }
  const std::vector<std::string> names = design::design_labels(different, short_names).names;
  for (std::size_t k = 0; k < contents.size(); ++k) names_.emplace(contents[k], names[k]);
}

std::string DesignNames::of(const Json& design) const {
  const auto found = names_.find(content_of(design));
  return found != names_.end() ? found->second : name_of_design(design);
}

std::string DesignNames::of(const ResultDocument& document, double number) const {
  const design::DesignLabels* const labels = labels_of(document);
  if (labels != nullptr && number >= 0.0 && number < static_cast<double>(labels->names.size()))
    return labels->names[static_cast<std::size_t>(number)];
  if (const Json* const design = design_of(folder_, document, number)) return of(*design);
  return fmt::format("design {}", six_digits(number));
}

const design::DesignLabels* DesignNames::labels_of(const ResultDocument& document) const {
  if (member(document.json, "design").is_object()) return nullptr;
  const ResultDocument* const source = with_designs(folder_, document);
  const auto found = source != nullptr ? labels_.find(source->name) : labels_.end();
  return found != labels_.end() ? &found->second : nullptr;
}

}  // namespace retrace::report

#include "report/page/design_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

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

const Json* quoted(const ResultDocument& document, double number) {
  if (const Json& design = member(document.json, "design"); design.is_object()) return &design;
  const Json& designs = list(document.json, "designs");
  if (!(number >= 0.0 && number < static_cast<double>(designs.size()))) return nullptr;
  const Json& design = designs[static_cast<std::size_t>(number)];
  return design.is_object() ? &design : nullptr;
}

}  // namespace

const Json* design_of(const ResultFolder& folder, const ResultDocument& document, double number) {
  if (const Json* const own = quoted(document, number)) return own;
  for (const ResultDocument& other : folder.documents)
    if (other.kind == "rre" && folder_of(other) == folder_of(document)) return quoted(other, number);
  return nullptr;
}

DesignNames::DesignNames(const ResultFolder& folder) : folder_(folder) {
  std::set<std::string> taken;
  const auto add = [&](const Json& design) {
    if (!design.is_object()) return;
    const std::string content = content_of(design);
    if (names_.contains(content)) return;
    std::string name = name_of_design(design);
    if (const std::string file = std::filesystem::path(text(design, "source")).filename().string();
        taken.contains(name) && !file.empty())
      name += fmt::format(" ({})", file);
    const std::string in_file = name;
    for (std::size_t k = 2; !taken.insert(name).second; ++k) name = fmt::format("{}, {}", in_file, k);
    names_.emplace(content, std::move(name));
  };
  for (const ResultDocument& document : folder.documents) {
    add(member(document.json, "design"));
    for (const Json& design : list(document.json, "designs")) add(design);
  }
}

std::string DesignNames::of(const Json& design) const {
  const auto found = names_.find(content_of(design));
  return found != names_.end() ? found->second : name_of_design(design);
}

std::string DesignNames::of(const ResultDocument& document, double number) const {
  if (const Json* const design = design_of(folder_, document, number)) return of(*design);
  return fmt::format("design {}", six_digits(number));
}

}  // namespace retrace::report

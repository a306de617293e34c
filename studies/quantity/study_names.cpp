#include "studies/quantity/study_names.h"

#include <algorithm>
#include <filesystem>

namespace retrace::studies {

std::optional<std::size_t> quantity_index(const Study& study, std::string_view name) {
  const auto found = std::ranges::find_if(study.quantities, [&](const auto& each) { return each->name() == name; });
  if (found == study.quantities.end()) return std::nullopt;
  return static_cast<std::size_t>(found - study.quantities.begin());
}

const Quantity* quantity_named(const Study& study, std::string_view name) {
  const std::optional<std::size_t> index = quantity_index(study, name);
  return index ? study.quantities[*index].get() : nullptr;
}

std::string shown_title(const Study& study) {
  return study.title.empty() ? std::filesystem::path(study.source).filename().string() : study.title;
}

}  // namespace retrace::studies

#include "design/io/design_labels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>

#include "core/number_format.h"
#include "design/io/design_json.h"

namespace retrace::design {
namespace {

using Json = nlohmann::ordered_json;
using Indices = std::vector<std::size_t>;

constexpr std::size_t kMaxKeys = 3;
constexpr std::size_t kLongestValue = 32;  ///< number of bytes

/// Returns true if a key describes the part or its light.
bool is_compared(const std::string& path) {
  return !(path == "source" || path == "title" || path == "spectrum" || path == "schema");
}

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return shortest(value.get<double>());
  if (!value.is_array()) return value.dump();
  std::vector<std::string> items;
  for (const Json& item : value) items.push_back(text_of(item));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

/// Values of a design by the paths of their keys. Tables have entries as well, with an empty text.
struct Flat {
  std::vector<std::string> order;  ///< paths in the order of the file
  std::map<std::string, const Json*> values;

  void add(const Json& table, const std::string& within) {
    for (const auto& [key, value] : table.items()) {
      const std::string path = within.empty() ? key : within + "." + key;
      if (!is_compared(path)) continue;
      order.push_back(path);
      values.emplace(path, &value);
      if (value.is_object()) add(value, path);
    }
  }
  const Json* at(const std::string& path) const {
    const auto found = values.find(path);
    return found == values.end() ? nullptr : found->second;
  }
};

bool are_equal(const Json* a, const Json* b) {
  return a == nullptr || b == nullptr ? a == b : *a == *b;
}

std::string table_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? std::string() : path.substr(0, dot);
}

/// Returns the key as it is shown. Keys of the body are shown without their table.
std::string shown(const std::string& path) {
  constexpr std::string_view body = "body.";
  return path.starts_with(body) ? path.substr(body.size()) : path;
}

class Labeller {
 public:
  Labeller(const std::vector<Json>& designs, const std::vector<std::string>& names)
      : designs_(designs), names_(names), flat_(designs.size()) {
    for (std::size_t d = 0; d < designs.size(); ++d) flat_[d].add(designs[d], "");
  }

  DesignLabels labels() const {
    Indices all(designs_.size());
    std::iota(all.begin(), all.end(), 0U);
    DesignLabels labels;
    labels.names = all.size() == 1 ? names_ : numbered(labels_of(all));
    const std::vector<std::string> keys = differing(all);
    if (keys.size() != 1) return labels;
    for (const Flat& flat : flat_) {
      const Json* const value = flat.at(keys.front());
      if (value == nullptr || !value->is_number()) return labels;
      labels.values.push_back(value->get<double>());
    }
    labels.key = shown(keys.front());
    return labels;
  }

 private:
  /// Returns the paths whose values differ between designs. A key of a table that only some designs have counts as
  /// differing only if its values differ between these designs.
  std::vector<std::string> differing(const Indices& which) const {
    std::vector<std::string> paths;
    std::set<std::string> seen;
    for (const std::size_t d : which)
      for (const std::string& path : flat_[d].order)
        if (seen.insert(path).second && differs(which, path)) paths.push_back(path);
    return paths;
  }

  bool differs(const Indices& which, const std::string& path) const {
    const std::string table = table_of(path);
    const Json* first = nullptr;
    bool is_first = true;
    for (const std::size_t d : which) {
      if (!table.empty() && flat_[d].at(table) == nullptr) continue;
      const Json* const value = flat_[d].at(path);
      if (!is_first && value != nullptr && first != nullptr && value->is_object() && first->is_object()) continue;
      if (!is_first && !are_equal(first, value)) return true;
      first = value;
      is_first = false;
    }
    return false;
  }

  /// Returns the text for a differing key of a design. Empty if the design lacks the table of the key. None if the
  /// value is too long.
  std::optional<std::string> part_of(std::size_t d, const std::string& path, bool all_have) const {
    const std::string table = table_of(path);
    if (!table.empty() && flat_[d].at(table) == nullptr) return std::string();
    const Json* const value = flat_[d].at(path);
    if (value == nullptr) return "without " + shown(path);
    if (value->is_object()) return "with " + shown(path);
    const std::string text = text_of(*value);
    if (text.size() <= kLongestValue) return fmt::format("{} = {}", shown(path), text);
    if (!all_have) return "with " + shown(path);
    return std::nullopt;
  }

  /// Returns the labels by differing keys. None if the designs do not differ, or differ too much.
  std::optional<std::vector<std::string>> by_keys(const Indices& which) const {
    const std::vector<std::string> paths = differing(which);
    if (paths.empty() || paths.size() > kMaxKeys) return std::nullopt;
    std::vector<std::string> labels;
    for (const std::size_t d : which) {
      std::vector<std::string> parts;
      for (const std::string& path : paths) {
        const bool all_have =
            std::all_of(which.begin(), which.end(), [&](std::size_t k) { return flat_[k].at(path) != nullptr; });
        const std::optional<std::string> part = part_of(d, path, all_have);
        if (!part) return std::nullopt;
        if (!part->empty()) parts.push_back(*part);
      }
      labels.push_back(fmt::format("{}", fmt::join(parts, ", ")));
    }
    return labels;
  }

  /// Returns the name of the file without folder and extension, or the short name if the design has no file.
  std::string file_name(std::size_t d) const {
    const Json& design = designs_[d];
    const auto source = design.find("source");
    if (source == design.end() || !source->is_string()) return names_[d];
    const std::string file = source->get<std::string>();
    const std::string stem = std::filesystem::path(file).stem().string();
    return stem.empty() || file == "-" ? names_[d] : stem;
  }

  /// Returns labels for some designs. Designs that are equal, or that cannot be distinguished, have equal labels.
  std::vector<std::string> labels_of(const Indices& which) const {
    if (const auto labels = by_keys(which)) return *labels;
    std::vector<std::string> labels;
    for (const std::size_t d : which) labels.push_back(file_name(d));
    std::map<std::string, Indices> groups;
    for (std::size_t k = 0; k < which.size(); ++k) groups[labels[k]].push_back(k);
    for (const auto& [name, members] : groups) {
      if (members.size() < 2) continue;
      Indices designs;
      for (const std::size_t k : members) designs.push_back(which[k]);
      const std::vector<std::string> more = labels_within_file(designs);
      for (std::size_t k = 0; k < members.size(); ++k)
        if (!more[k].empty()) labels[members[k]] = groups.size() > 1 ? name + ", " + more[k] : more[k];
    }
    return labels;
  }

  /// Returns texts that distinguish designs of the same file: differing keys, or different titles. They are empty if
  /// the designs cannot be distinguished.
  std::vector<std::string> labels_within_file(const Indices& which) const {
    std::vector<std::string> labels = by_keys(which).value_or(std::vector<std::string>(which.size()));
    if (!std::all_of(labels.begin(), labels.end(), [](const std::string& text) { return text.empty(); })) return labels;
    std::set<std::string> titles;
    for (const std::size_t d : which) titles.insert(names_[d]);
    if (titles.size() < 2) return labels;
    for (std::size_t k = 0; k < which.size(); ++k) labels[k] = names_[which[k]];
    return labels;
  }

  /// Returns the labels with numbers after those that are equal.
  static std::vector<std::string> numbered(std::vector<std::string> labels) {
    std::map<std::string, std::size_t> count;
    for (const std::string& label : labels) ++count[label];
    std::map<std::string, std::size_t> used;
    for (std::string& label : labels)
      if (const std::string plain = label; count[plain] > 1) label = fmt::format("{} ({})", plain, ++used[plain]);
    return labels;
  }

  const std::vector<Json>& designs_;
  const std::vector<std::string>& names_;
  std::vector<Flat> flat_;
};

}  // namespace

DesignLabels design_labels(const std::vector<Json>& designs, const std::vector<std::string>& names) {
  return Labeller(designs, names).labels();
}

DesignLabels design_labels(const std::vector<Design>& designs) {
  std::vector<Json> json;
  std::vector<std::string> names;
  for (const Design& design : designs) {
    json.push_back(designs.size() > 1 ? to_json(design) : Json::object());
    names.push_back(short_name(design));
  }
  return design_labels(json, names);
}

}  // namespace retrace::design

#include "studies/roughness/io/facet_table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/number_format.h"

namespace retrace::studies {
namespace {

constexpr std::size_t kMostFacets = 10000;
constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr double kMostTableSaNm = 1e5;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  return fields;
}

/// Which column holds what.
struct Columns {
  std::size_t count = 0;
  std::size_t roughness = 0;
  std::string roughness_name;
  std::optional<std::size_t> waviness, process, facet;
};

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  std::vector<FacetGroup> read(std::string_view content) {
    require_short_text(content, name_, kMostBytes);
    for (std::size_t begin = 0; begin < content.size();) {
      const std::size_t end = std::min(content.find('\n', begin), content.size());
      ++line_;
      take(trimmed(content.substr(begin, end - begin)));
      begin = end + 1;
    }
    line_ = 0;
    if (groups_.empty()) fail("", "must have a line of column names and one line for each facet");
    return std::move(groups_);
  }

 private:
  [[noreturn]] void fail(const std::string& column, std::string_view text) const {
    throw InputError({printable(name_, std::string::npos), line_, column}, text);
  }

  void take(std::string_view line) {
    if (line.empty() || line.starts_with('#')) return;
    const std::vector<std::string_view> fields = fields_of(line);
    if (columns_.count == 0)
      take_names(fields);
    else
      take_facet(fields);
  }

  void take_names(std::span<const std::string_view> names) {
    const auto find = [&](std::string_view name) -> std::optional<std::size_t> {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) return std::nullopt;
      if (std::find(found + 1, names.end(), name) != names.end())
        fail(std::string(name), "stands twice in the heading");
      return static_cast<std::size_t>(found - names.begin());
    };
    const auto roughness = find("roughness_sa_nm");
    const auto sa = find("sa_nm");
    if (!roughness && !sa)
      fail("", fmt::format("the line of column names must hold roughness_sa_nm or sa_nm, got {}",
                           in_quotes(names.front())));
    columns_ = {names.size(),
                roughness ? *roughness : *sa,
                roughness ? "roughness_sa_nm" : "sa_nm",
                find("waviness_sa_nm"),
                find("process"),
                find("facet")};
  }

  void take_facet(std::span<const std::string_view> fields) {
    if (fields.size() != columns_.count)
      fail("", fmt::format("every line must have the {} fields of the heading, got {}", columns_.count, fields.size()));
    if (++facets_ > kMostFacets) fail("", fmt::format("at most {} facets are allowed", kMostFacets));
    FacetGroup& group = columns_.process ? group_of(fields[*columns_.process]) : groups_.emplace_back(named(fields));
    ++group.facets;
    // Means are kept as they grow: sums of finite numbers stay finite.
    const auto mean = [&](double& kept, double next) { kept += (next - kept) / static_cast<double>(group.facets); };
    mean(group.roughness_sa_nm, number(columns_.roughness_name, fields[columns_.roughness]));
    if (columns_.waviness) mean(group.waviness_sa_nm, number("waviness_sa_nm", fields[*columns_.waviness]));
  }

  FacetGroup named(std::span<const std::string_view> fields) const {
    FacetGroup group;
    group.table = name_;
    group.line = line_;
    group.name = columns_.facet ? printable(fields[*columns_.facet]) : fmt::format("line {}", line_);
    return group;
  }

  FacetGroup& group_of(std::string_view process) {
    const std::string name = printable(process);
    if (name.empty()) fail("process", "must name a process, got \"\"");
    const auto found =
        std::find_if(groups_.begin(), groups_.end(), [&](const FacetGroup& group) { return group.name == name; });
    if (found != groups_.end()) return *found;
    FacetGroup group;
    group.table = name_;
    group.line = line_;
    group.name = name;
    group.is_process = true;
    return groups_.emplace_back(std::move(group));
  }

  double number(const std::string& column, std::string_view text) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0.0 && value <= kMostTableSaNm))
      fail(column, fmt::format("must be a number from 0 to {}, got {}", shortest(kMostTableSaNm), in_quotes(text)));
    return value;
  }

  std::string name_;
  int line_ = 0;
  Columns columns_;
  std::size_t facets_ = 0;
  std::vector<FacetGroup> groups_;
};

}  // namespace

std::vector<FacetGroup> parse_facet_table(std::string_view content, const std::string& name) {
  return Reader(name).read(content);
}

std::vector<FacetGroup> read_facet_table(const std::filesystem::path& file) {
  return parse_facet_table(read_file(file, kMostBytes), file.string());
}

}  // namespace retrace::studies

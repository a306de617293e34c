#include "studies/roughness/io/facet_table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/message_text.h"

namespace retrace::studies {
namespace {

constexpr std::size_t kMaxFacets = 10000;
constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr NumberRange kSaNm{.low = 0.0, .high = 1e5};

/// Indices of the columns of a table.
struct Columns {
  std::size_t roughness = 0;
  std::optional<std::size_t> waviness, process, facet;
};

Columns columns_of(const CsvReader& table) {
  const auto roughness = table.find("roughness_sa_nm");
  const auto sa = table.find("sa_nm");
  if (!roughness && !sa) table.fail("the table must have a column roughness_sa_nm or sa_nm");
  return {roughness ? *roughness : *sa, table.find("waviness_sa_nm"), table.find("process"), table.find("facet")};
}

/// Returns the group of a row. It is created if it does not exist yet.
FacetGroup& group_of(const CsvReader& row, const Columns& columns, std::vector<FacetGroup>& groups,
                     const std::string& table) {
  FacetGroup group;
  group.table = table;
  group.line = row.line();
  group.is_process = columns.process.has_value();
  if (!columns.process) {
    group.name = columns.facet ? printable(row[*columns.facet]) : fmt::format("line {}", row.line());
    return groups.emplace_back(std::move(group));
  }
  group.name = printable(row[*columns.process]);
  if (group.name.empty()) row.fail(*columns.process, "must be the name of a process, got \"\"");
  const auto found = std::ranges::find(groups, group.name, &FacetGroup::name);
  return found != groups.end() ? *found : groups.emplace_back(std::move(group));
}

}  // namespace

std::vector<FacetGroup> parse_facet_table(std::string_view content, const std::string& name) {
  CsvReader table(content, name, kMaxBytes);
  const Columns columns = columns_of(table);
  std::vector<FacetGroup> groups;
  while (table.next()) {
    if (table.rows() > kMaxFacets) table.fail(fmt::format("at most {} facets are allowed", kMaxFacets));
    FacetGroup& group = group_of(table, columns, groups, name);
    ++group.facets;
    // Running means are used instead of sums because sums could overflow.
    const auto mean = [&](double& kept, double next) { kept += (next - kept) / static_cast<double>(group.facets); };
    mean(group.roughness_sa_nm, table.number(columns.roughness, kSaNm));
    if (columns.waviness) mean(group.waviness_sa_nm, table.number(*columns.waviness, kSaNm));
  }
  if (groups.empty()) table.fail("the table must have a line of column names and one line for each facet");
  return groups;
}

std::vector<FacetGroup> read_facet_table(const std::filesystem::path& file) {
  return parse_facet_table(read_file(file, kMaxBytes), file.string());
}

}  // namespace retrace::studies

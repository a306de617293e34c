#include "studies/calibration/io/measurement_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/message_text.h"
#include "core/named_file.h"

namespace retrace::studies {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr std::size_t kMaxMeasurements = 10000;
constexpr std::size_t kMaxJobs = 32;
constexpr NumberRange kElement{.low = 0.0, .high = 1e9};
constexpr NumberRange kFacet{.low = 1.0, .high = 3.0};
/// Range of measured values. Larger deviations, about a degree or a millimetre, mean that the wrong part was measured.
constexpr NumberRange kValue{.low = -1e6, .high = 1e6};
constexpr NumberRange kUncertainty{.low = 0.0, .low_included = false, .high = 1e6};
constexpr NumberRange kAlongEdge{.low = -1.0, .high = 1.0};

/// Indices of the columns.
struct Columns {
  std::size_t job, element, facet, what, value, uncertainty;
  std::optional<std::size_t> from_element, from_facet, at;

  explicit Columns(const CsvReader& table)
      : job(needed(table, "job")),
        element(needed(table, "element")),
        facet(needed(table, "facet")),
        what(needed(table, "what")),
        value(needed(table, "value")),
        uncertainty(needed(table, "uncertainty")),
        from_element(table.find("from_element")),
        from_facet(table.find("from_facet")),
        at(table.find("at")) {}

 private:
  static std::size_t needed(const CsvReader& table, std::string_view column) {
    if (const auto found = table.find(column)) return *found;
    table.fail(fmt::format(
        "the table must have the columns job, element, facet, what, value and uncertainty: {} is missing", column));
  }
};

std::size_t whole(const CsvReader& row, std::size_t column, const NumberRange& range) {
  const double value = row.number(column, range);
  if (value != std::floor(value))
    row.fail(column, fmt::format("must be a whole number, got {}", printable(row[column])));
  return static_cast<std::size_t>(value);
}

/// Returns the reference facet of a value, or nothing if the columns are empty.
std::optional<FacetId> from_of(const CsvReader& row, const Columns& columns) {
  const auto is_given = [&](const std::optional<std::size_t>& column) { return column && !row[*column].empty(); };
  if (!is_given(columns.from_element) && !is_given(columns.from_facet)) return std::nullopt;
  if (!is_given(columns.from_element) || !is_given(columns.from_facet))
    row.fail("from_element and from_facet must be given together or not at all");
  return FacetId{whole(row, *columns.from_element, kElement), whole(row, *columns.from_facet, kFacet) - 1};
}

Measurement measurement_of(const CsvReader& row, const Columns& columns) {
  Measurement m;
  m.line = row.line();
  m.at = {whole(row, columns.element, kElement), whole(row, columns.facet, kFacet) - 1};
  m.what = static_cast<FacetQuantity>(row.one_of(columns.what, kFacetQuantityWords));
  m.uncertainty = row.number(columns.uncertainty, kUncertainty);
  m.from = from_of(row, columns);
  if (columns.at && !row[*columns.at].empty()) {
    m.along_edge = row.number(*columns.at, kAlongEdge);
    if (m.what != FacetQuantity::cut_end)
      row.fail(*columns.at,
               "only allowed in rows with what = end_nm, where it is the position along the edge at which a cut ends");
  }
  return m;
}

/// Reads the rows of a table, and plans each job one time.
class Reader {
 public:
  Reader(std::string_view text, const fs::path& file, const FileTexts& texts)
      : table_(text, file.string(), kMaxBytes), columns_(table_), folder_(file.parent_path()), texts_(texts) {
    result_.file = file.string();
  }

  MeasuredParts read() {
    while (table_.next()) {
      if (table_.rows() > kMaxMeasurements)
        table_.fail(fmt::format("at most {} measurements are allowed", kMaxMeasurements));
      Measurement m = measurement_of(table_, columns_);
      m.part = part_of(std::string(table_[columns_.job]));
      if (table_[columns_.value].empty()) {
        ++result_.empty_rows;
        continue;
      }
      m.value = table_.number(columns_.value, kValue);
      result_.measurements.push_back(m);
    }
    if (result_.measurements.empty()) table_.fail("the table must contain at least one row with a value");
    return std::move(result_);
  }

 private:
  std::size_t part_of(const std::string& job) {
    if (job.empty()) table_.fail(columns_.job, "must be the name of a job file");
    const auto known = std::find(result_.jobs.begin(), result_.jobs.end(), job);
    if (known != result_.jobs.end()) return static_cast<std::size_t>(known - result_.jobs.begin());
    if (result_.jobs.size() == kMaxJobs) table_.fail(fmt::format("at most {} jobs are allowed", kMaxJobs));
    FabricationRequest request;
    const fs::path file = folder_ / job;
    if (const auto text = texts_.find(file.string()); text != texts_.end()) request.job_text = text->second;
    FabricationResult plan = read_named({result_.file, table_.line(), "job"}, [&] { return fabricate(file, request); });
    if (!result_.plans.empty() && plan.machine.name != result_.plans.front().machine.name)
      table_.fail(columns_.job,
                  fmt::format("the job is for machine {}, but the preceding jobs are for machine {}",
                              in_quotes(plan.machine.name), in_quotes(result_.plans.front().machine.name)));
    result_.jobs.push_back(job);
    result_.plans.push_back(std::move(plan));
    return result_.jobs.size() - 1;
  }

  CsvReader table_;
  Columns columns_;
  fs::path folder_;
  const FileTexts& texts_;
  MeasuredParts result_;
};

}  // namespace

MeasuredParts parse_measurements(std::string_view text, const fs::path& file, const FileTexts& texts) {
  return Reader(text, file, texts).read();
}

MeasuredParts read_measurements(const fs::path& file) {
  return parse_measurements(read_file(file, kMaxBytes), file);
}

}  // namespace retrace::studies

#include "studies/sweep/io/sweep_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/csv.h"
#include "core/json_text.h"
#include "core/message_text.h"
#include "core/number_format.h"
#include "studies/quantity/io/study_json.h"

namespace retrace::studies {
namespace {

using Json = nlohmann::ordered_json;

/// Maximum number of rows in the table for the terminal. Files contain all rows.
constexpr std::size_t kMaxRows = 200;

Json value_json(const compute::StoredValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

std::string value_text(const compute::StoredValue& value) {
  const double* const number = std::get_if<double>(&value);
  return number != nullptr ? shortest(*number) : std::get<std::string>(value);
}

Json point_json(const compute::StoredPoint& point, const compute::StoreLayout& layout) {
  Json json = {{"point", point.point}, {"status", point.failed ? "failed" : "done"}};
  for (std::size_t k = 0; k < layout.inputs.size(); ++k) json[layout.inputs[k]] = value_json(point.inputs[k]);
  if (point.failed) json["reason"] = point.reason;
  for (std::size_t k = 0; k < point.outputs.size(); ++k) {
    if (!point.outputs[k].value) continue;
    json[layout.outputs[k]] = *point.outputs[k].value;
    json[layout.outputs[k] + "_std_error"] = point.outputs[k].std_error;
  }
  return json;
}

using Row = std::vector<std::string>;

Row table_row(const compute::StoredPoint& point) {
  Row row;
  for (const compute::StoredValue& input : point.inputs) row.push_back(printable(value_text(input), 40));
  if (point.failed) {
    row.push_back("failed: " + printable(point.reason, 100));
    return row;
  }
  for (const compute::StoredOutput& output : point.outputs)
    row.push_back(output.value ? fmt::format("{:.6g}", *output.value) : "-");
  return row;
}

}  // namespace

std::string sweep_json(const SweepResult& result) {
  const compute::StoreLayout layout = result.sweep.layout();
  const Study& study = result.sweep.study();
  Json json = begin_document(study);
  json["parameters"] = layout.inputs;
  json["quantities"] = layout.outputs;
  json["seed"] = study.seed;
  json["points_in_all"] = result.sweep.size();
  json["failed"] = std::count_if(result.points.begin(), result.points.end(), [](const auto& p) { return p.failed; });
  json["points"] = Json::array();
  for (const compute::StoredPoint& point : result.points) json["points"].push_back(point_json(point, layout));
  json["elapsed_s"] = result.elapsed_s;
  return result_text("retrace.sweep/1", json, result.warnings, result.complete);
}

std::string sweep_csv(const SweepResult& result) {
  const compute::StoreLayout layout = result.sweep.layout();
  CsvWriter csv;
  std::vector<std::string> outputs;
  for (const std::string& name : layout.outputs) outputs.insert(outputs.end(), {name, name + "_std_error"});
  csv.row("point", "status", layout.inputs, outputs, "version", "reason");
  for (const compute::StoredPoint& point : result.points) {
    csv.add(point.point);
    csv.add(point.failed ? "failed" : "done");
    for (const compute::StoredValue& input : point.inputs) csv.add(value_text(input));
    for (std::size_t k = 0; k < layout.outputs.size(); ++k) {
      const compute::StoredOutput output = k < point.outputs.size() ? point.outputs[k] : compute::StoredOutput{};
      csv.add(output.value);
      csv.add(output.value ? std::optional(output.std_error) : std::nullopt);
    }
    csv.row(point.version, point.reason);
  }
  return csv.text();
}

std::string point_text(const Sweep& sweep, const compute::StoredPoint& point) {
  const compute::StoreLayout layout = sweep.layout();
  std::string text;
  for (std::size_t k = 0; k < layout.inputs.size(); ++k)
    text += fmt::format("{}{} = {}", k == 0 ? "" : ", ", printable(layout.inputs[k], 40),
                        printable(value_text(point.inputs[k]), 40));
  for (std::size_t k = 0; k < point.outputs.size(); ++k)
    if (point.outputs[k].value)
      text +=
          fmt::format("{}{} = {:.4g}", k == 0 ? ": " : ", ", printable(layout.outputs[k], 40), *point.outputs[k].value);
  return text;
}

std::string sweep_so_far(const Sweep& sweep, const std::vector<compute::StoredPoint>& points) {
  std::string text = fmt::format("so far, {} of {} points", points.size(), sweep.size());
  const auto is_done = [](const compute::StoredPoint& point) { return !point.failed; };
  const auto last = std::find_if(points.rbegin(), points.rend(), is_done);
  return last == points.rend() ? text : text + "; " + point_text(sweep, *last);
}

std::string sweep_table(const SweepResult& result) {
  const compute::StoreLayout layout = result.sweep.layout();
  std::vector<Row> rows(1);
  for (const auto* names : {&layout.inputs, &layout.outputs})
    for (const std::string& name : *names) rows.front().push_back(printable(name, 40));
  for (const compute::StoredPoint& point : result.points) {
    if (rows.size() > kMaxRows) break;
    rows.push_back(table_row(point));
  }
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k)
      if (!row[k].starts_with("failed: ")) widths[k] = std::max(widths[k], row[k].size());
  std::string table;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) line += fmt::format("{}{:>{}}", k == 0 ? "" : "  ", row[k], widths[k]);
    table += line + '\n';
  }
  if (result.points.size() > kMaxRows)
    table += fmt::format("... and {} more points\n", result.points.size() - kMaxRows);
  return table;
}

}  // namespace retrace::studies

#include "fabrication/check/io/finding_rows.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/message_text.h"

namespace retrace::fabrication {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShownFindings = 20;

std::string place_of(const Finding& finding) {
  std::string place = printable(finding.program, std::string::npos);
  if (finding.line > 0) place += fmt::format(":{}", finding.line);
  return place.empty() ? place : place + ": ";
}

}  // namespace

Json findings_json(const std::vector<Finding>& findings) {
  Json rows = Json::array();
  for (const Finding& f : findings) {
    Json json = {{"kind", f.kind}, {"program", f.program}};
    if (f.line > 0) json["line"] = f.line;
    if (f.element >= 0) json["element"] = f.element;
    json["message"] = f.message;
    json["value"] = f.value;
    json["limit"] = f.limit;
    json["count"] = f.count;
    rows.push_back(std::move(json));
  }
  return rows;
}

std::string findings_table(const std::vector<Finding>& findings) {
  std::string text;
  for (std::size_t i = 0; i < findings.size() && i < kShownFindings; ++i) {
    const Finding& f = findings[i];
    text += fmt::format("{}{}: {}{}\n", place_of(f), f.kind, printable(f.message, std::string::npos),
                        f.count > 1 ? fmt::format(" ({} times)", f.count) : std::string());
  }
  if (findings.size() > kShownFindings) text += fmt::format("and {} more findings\n", findings.size() - kShownFindings);
  return text;
}

Json program_json(const NcProgram& program) {
  return {{"file", program.file}, {"dialect", kNcDialectWords[static_cast<std::size_t>(program.dialect)]}};
}

}  // namespace retrace::fabrication

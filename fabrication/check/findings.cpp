#include "fabrication/check/findings.h"

#include <cmath>

namespace retrace::fabrication {

std::string text_of(const Finding& finding) {
  const std::string program = finding.program.empty() ? "" : finding.program + ": ";
  const std::string line = finding.line == 0 ? "" : "line " + std::to_string(finding.line) + ": ";
  return program + line + finding.message;
}

void FindingList::add(Finding finding) {
  // Findings without a line are merged only if they have the same element or the same message.
  std::string where = finding.kind;
  if (finding.line == 0) where += " " + (finding.element < 0 ? finding.message : std::to_string(finding.element));
  const auto [entry, is_new] = findings_.try_emplace({finding.program, finding.line, where}, finding);
  if (is_new) return;
  Finding& known = entry->second;
  const std::int64_t count = known.count + 1;
  if (std::abs(finding.value) > std::abs(known.value)) known = std::move(finding);
  known.count = count;
}

std::vector<Finding> FindingList::take() {
  std::vector<Finding> result;
  for (auto& [key, finding] : findings_) result.push_back(std::move(finding));
  findings_.clear();
  return result;
}

}  // namespace retrace::fabrication

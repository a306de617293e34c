#include "fabrication/verify/findings.h"

#include <cmath>

namespace retrace::fabrication {

void FindingList::add(Finding finding) {
  // Findings without a line are told apart by their element.
  const std::string where = finding.line == 0 ? finding.kind + " " + std::to_string(finding.element) : finding.kind;
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

#pragma once

#include <algorithm>
#include <string>

#include "fabrication/planing/check/check.h"

namespace retrace::fabrication::test {

/// Returns true if a check has a finding of the given kind.
inline bool finds(const PlaningCheck& check, const std::string& kind) {
  return std::any_of(check.findings.begin(), check.findings.end(), [&](const Finding& f) { return f.kind == kind; });
}

}  // namespace retrace::fabrication::test

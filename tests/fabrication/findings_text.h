#pragma once

#include <fmt/format.h>

#include <string>

#include "fabrication/chisel/check/verify.h"

namespace retrace::fabrication::test {

/// Returns the findings as text, one per line, to show them when a test fails.
inline std::string listed(const Verification& v) {
  std::string text;
  for (const Finding& f : v.findings)
    text += fmt::format("{}:{} {} [{}] {} ({} > {}) x{}\n", f.program, f.line, f.kind, f.element, f.message, f.value,
                        f.limit, f.count);
  return text.substr(0, 3000);
}

}  // namespace retrace::fabrication::test

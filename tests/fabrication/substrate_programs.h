#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string>
#include <string_view>

#include "core/atomic_file.h"
#include "fabrication/chisel/check/verify.h"
#include "fabrication/chisel/plan/plan.h"
#include "fabrication/machine/io/machine_files.h"
#include "fabrication/post/post.h"
#include "tests/fabrication/controls.h"
#include "tests/fabrication/findings_text.h"
#include "tests/fabrication/substrate_jobs.h"

namespace retrace::fabrication::test {

inline Machine machine(const std::string& name) {
  return parse_machine(read_file(std::string(RETRACE_SOURCE_DIR) + "/data/machines/" + name + ".toml"), name);
}
inline Machine machine_of(const Job& job) {
  return machine(job.strategy == Strategy::dmc ? "ideal-dmc" : "ideal");
}

inline std::string text_of(const Job& job, std::string_view dialect = "rs274ngc") {
  return nc_text(make_plan(job, for_dialect(machine_of(job), dialect)).programs.front(), dialect);
}

inline Verification verified(const Job& job, const std::string& text, NcDialect dialect = NcDialect::rs274ngc) {
  return verify_programs(job, machine_of(job), {parse_nc(text, "p", dialect, control_texts())}, {}, {});
}

inline std::string kinds_of(const Verification& v) {
  std::set<std::string> kinds;
  for (const Finding& finding : v.findings) kinds.insert(finding.kind);
  return fmt::format("{}", fmt::join(kinds, " "));
}

}  // namespace retrace::fabrication::test

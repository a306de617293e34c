#pragma once

// Writes findings to JSON documents and tables, for all processes.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// Returns the findings as JSON with `kind`, `program`, `message`, `value`, `limit` and `count`. The keys `line` and
/// `element` are present only if a finding has them.
nlohmann::ordered_json findings_json(const std::vector<Finding>& findings);

/// Returns the first twenty findings, one in each line, and the number of further findings.
std::string findings_table(const std::vector<Finding>& findings);

/// Returns `file` and `dialect` of a program as JSON.
nlohmann::ordered_json program_json(const NcProgram& program);

}  // namespace retrace::fabrication

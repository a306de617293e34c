#pragma once

// Findings in documents and tables, the same for every process.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fabrication/check/findings.h"
#include "fabrication/read/nc_program.h"

namespace retrace::fabrication {

/// `kind`, `program`, `line` and `element` where there are such, `message`, `value`, `limit` and `count` of each.
nlohmann::ordered_json findings_json(const std::vector<Finding>& findings);

/// A line for each of the first twenty, and how many more there are.
std::string findings_table(const std::vector<Finding>& findings);

/// `file` and `dialect` of a program as it was read.
nlohmann::ordered_json program_json(const NcProgram& program);

}  // namespace retrace::fabrication

#pragma once

// Documents and tables of `retrace job` and `retrace fabricate`.

#include <nlohmann/json.hpp>
#include <string>

#include "studies/fabrication/fabricate.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::studies {

/// These functions return the result of `retrace job` as JSON (retrace.job_summary/1) and as a table.
std::string job_json(const GeneratedJob& made);
std::string job_table(const GeneratedJob& made);

/// These functions return the result of `retrace fabricate` as JSON (retrace.fabrication/2), as CSV with one line for
/// each stage, and as a table.
/// \param setup value of the key `setup`; the key is omitted if it is null
std::string fabrication_json(const FabricationResult& result, const nlohmann::ordered_json& setup = nullptr);
std::string stages_csv(const FabricationResult& result);
std::string fabrication_table(const FabricationResult& result);

}  // namespace retrace::studies

#pragma once

// Reads tables of the run times of NC programs, and writes the results of a calibration that is based on them.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/file_texts.h"
#include "studies/calibration/time_calibration.h"

namespace retrace::studies {

/// Reads a table with the columns `program` (a file in the table's folder), `seconds` and `uncertainty`. Tables from a
/// log also have `from_line` and `to_line`, the first and last line of the main program. A line that calls a subroutine
/// includes the whole call. Rows without seconds are skipped.
/// \param texts contents of programs that are used instead of reading files
/// \throw InputError that names file, line and column
TimedPrograms parse_times(std::string_view text, const std::filesystem::path& file, const fabrication::Machine& machine,
                          const FileTexts& texts = {});
TimedPrograms read_times(const std::filesystem::path& file, const fabrication::Machine& machine);

std::string time_calibration_json(const TimeCalibration& result);
std::string time_calibration_table(const TimeCalibration& result);
/// Returns a table without values, into which the user enters the times of the programs.
std::string times_csv(const std::vector<std::string>& programs);
std::string time_programs_json(const fabrication::Machine& machine, const std::vector<std::string>& programs);

}  // namespace retrace::studies

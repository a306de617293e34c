#pragma once

// The table of times of programs, and the documents of what they tell.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/file_texts.h"
#include "studies/calibration/time_calibration.h"

namespace retrace::studies {

/// Reads a table with the columns `program` (a file from the table's folder), `seconds`, `uncertainty`, and, of a log,
/// `from_line` and `to_line`: lines of the main program, both included, calls with all that they do. Rows without
/// seconds are passed over. \param texts programs in place of files that would be read
/// \throw InputError naming file, line and column
TimedPrograms parse_times(std::string_view text, const std::filesystem::path& file, const fabrication::Machine& machine,
                          const FileTexts& texts = {});
TimedPrograms read_times(const std::filesystem::path& file, const fabrication::Machine& machine);

std::string time_calibration_json(const TimeCalibration& result);
std::string time_calibration_table(const TimeCalibration& result);
/// The table to be filled in with how long these programs take.
std::string times_csv(const std::vector<std::string>& programs);
std::string time_programs_json(const fabrication::Machine& machine, const std::vector<std::string>& programs);

}  // namespace retrace::studies

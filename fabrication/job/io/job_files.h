#pragma once

// Reads, checks and writes fabrication jobs (retrace.job/1).

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/file_texts.h"
#include "core/schema/schema.h"
#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Returns the schema of job files (retrace.job/1). A job file contains the data of a Job.
const schema::Format& job_format();

/// Reads and checks a job file. The path of a machine file is relative to the folder of the job.
/// \param texts contents of files that are used instead of reading these files
/// \throw InputError with a message of one line that contains file, line, key, allowed values and given value
Job read_job(const std::filesystem::path& file, const FileTexts& texts = {});

/// Reads and checks the text of a job file.
/// \param source_name name of the file in error messages
Job parse_job(std::string_view text, const std::string& source_name);

/// Returns the job as text. parse_job() reads this text back to an equal job.
std::string job_text(const Job& job);

/// Checks the conditions of a job that involve several keys. The tool must fit the root and the element, and chips must
/// be able to leave. The array must contain an element. A pattern must have the size of the array and a cell to cut.
/// parse_job() calls this function.
/// \param where file name for error messages
/// \throw InputError if a condition is not met
void check_job(const Job& job, const InputLocation& where);

}  // namespace retrace::fabrication

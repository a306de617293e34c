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

/// The format of job files (retrace.job/1), whose object is a Job.
const schema::Format& job_format();

/// Reads and checks a job file. A machine named by a file is taken from the folder of the job.
/// \throw InputError naming file, line, key, what was given and what is allowed, on one line
/// \param texts of files that are given in place of being read
Job read_job(const std::filesystem::path& file, const FileTexts& texts = {});

/// The same for the text of a job file; `source_name` stands for the file in messages.
Job parse_job(std::string_view text, const std::string& source_name);

/// The job as text that parse_job() reads back to the same job.
std::string job_text(const Job& job);

/// What a job must fulfil that only several of its values together can tell: the tool fits the root and the element,
/// chips can leave, the array holds an element, a pattern has the array's size and cells to cut. parse_job() does this.
/// \param where the file, for messages
/// \throw InputError
void check_job(const Job& job, const InputLocation& where);

}  // namespace retrace::fabrication

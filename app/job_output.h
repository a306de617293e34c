#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::app {

/// What the options say of how a job is made. \pre there is a width of the tool
studies::JobRequest job_request(const JobOptions& options, double tool_width_mm);

/// Files that making a job reads beside the design. Names without an ending are shipped ones, not files.
std::vector<std::string> files_of_making(const JobOptions& options);

/// The text of a job that is to lie at a place: its machine's file is named as seen from there. \param file empty: the
/// working directory
std::string job_text_at(studies::MadeJob& made, const std::filesystem::path& file);

}  // namespace retrace::app

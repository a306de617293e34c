#pragma once

// Options and texts shared by the commands that make a fabrication job of a design: `retrace job`, and `retrace
// optimize` with --job.

#include <filesystem>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/request_options.h"
#include "requests/job.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::app {

/// Options of all commands that make a fabrication job.
struct MakingOptions {
  FieldTexts fields;
};

/// Returns the arguments that set MakingOptions.
/// \param needs option that each of the arguments requires, such as "--job". If it is empty, the arguments require no
/// other option, and --tool-width-mm must be given.
std::vector<Argument> making_arguments(MakingOptions& options, const std::string& needs);

/// Creates the request for a fabrication job from the options of the command line. The tool width of the request is 0
/// if the option --tool-width-mm is not given.
/// \throw InputError that names the field, if its value is not allowed
JobRequest job_request(const MakingOptions& options, const CommonOptions& common);

/// Returns the files that are read in addition to the design: machine and process. Names without an extension refer to
/// shipped machines and processes and are not files.
std::vector<std::string> files_of_making(const JobRequest& request);

/// Returns the path of a file relative to the folder of a job.
/// \param folder folder of the job; if empty, the working directory
std::string name_from(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Returns the text of a job file. The paths of the design and of the machine file are made relative to the job file.
/// \param file path of the job file. If it is empty, the job is printed instead, and the job contains only the name of
/// the design file, without its folder.
std::string job_text_at(studies::GeneratedJob& made, const std::filesystem::path& file);

}  // namespace retrace::app

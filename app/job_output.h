#pragma once

// Options and texts shared by the commands that make a fabrication job of a design: `retrace job`, and `retrace
// optimize` with --job.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "studies/fabrication/job_maker.h"

namespace retrace::app {

/// How a job is made, for every command that makes one.
struct MakingOptions {
  studies::JobRequest request;
  std::optional<double> tool_width_mm;
};

/// Their declaration. \param needs the option that they cannot go without; empty: none, and the width of the tool is
/// required
std::vector<Argument> making_arguments(MakingOptions& options, const std::string& needs);

/// What the options say of how a job is made.
studies::JobRequest job_request(const MakingOptions& options, double tool_width_mm);

/// Files that making a job reads beside the design. Names without an ending are shipped ones, not files.
std::vector<std::string> files_of_making(const MakingOptions& options);

/// How a job that is to lie in a folder names a file. \param folder empty: the working directory
std::string name_from(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The text of a job that is to lie at a place: its design and its machine's file are named as seen from there.
/// \param file empty: the job is printed, and names its design by the file's name alone
std::string job_text_at(studies::MadeJob& made, const std::filesystem::path& file);

}  // namespace retrace::app

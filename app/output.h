#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line.h"
#include "studies/design/design.h"

namespace retrace::app {

/// Writes to standard output. \throw OutputError if that fails
void print(std::string_view text);

/// A file of a result, ready to be written.
struct OutputFile {
  std::string name;
  std::string content;
};

/// What a command reads and writes, to be kept apart.
struct FileNames {
  std::vector<std::string> inputs;  ///< every file that it reads
  std::string document;             ///< file in the output folder that holds the same as --json
  std::vector<std::string> others;  ///< further files in the output folder
};

/// The files that designs come from, with those that they name.
std::vector<std::string> files_read(const std::vector<studies::Design>& designs);

/// Refuses, before anything is written, a file that an option names if it is one that is read, by whatever path or
/// link, or the one of --json. \throw InputError
void check_output_file(const CommonOptions& options, const std::string& option, const std::filesystem::path& file,
                       const std::vector<std::string>& inputs);

/// Refuses, before any work is done, outputs that would replace a file that is read or each other and outputs that
/// cannot be written; makes the output folder. \throw InputError, OutputError
void prepare_outputs(const CommonOptions& options, const FileNames& names);

/// Writes the JSON document and the files where the options want them, and the text to standard output if neither
/// `--quiet` nor `--json -` forbids it. \throw OutputError
void write_outputs(const CommonOptions& options, std::string_view json, const std::vector<OutputFile>& files,
                   std::string_view text);

/// One line on standard error, free of control characters. That nobody can read it is no reason to stop.
void say(std::string_view text);

/// Warnings on standard error, one line each, unless `--quiet`.
void print_warnings(const CommonOptions& options, const std::vector<std::string>& warnings);

}  // namespace retrace::app

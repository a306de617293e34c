#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line.h"

namespace retrace::app {

/// Writes to standard output. \throw OutputError if that fails
void print(std::string_view text);

/// A file of a result, ready to be written.
struct OutputFile {
  std::string name;
  std::string content;
};

/// Refuses, before any work is done, outputs that cannot be written; makes the output folder.
/// \throw OutputError
void prepare_outputs(const CommonOptions& options);

/// Writes the JSON document and the files where the options want them, and the text to standard output if neither
/// `--quiet` nor `--json -` forbids it. \throw OutputError
void write_outputs(const CommonOptions& options, std::string_view json, const std::vector<OutputFile>& files,
                   std::string_view text);

/// Warnings on standard error, one line each, unless `--quiet`.
void print_warnings(const CommonOptions& options, const std::vector<std::string>& warnings);

}  // namespace retrace::app

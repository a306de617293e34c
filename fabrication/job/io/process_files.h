#pragma once

// Reads cutting processes (retrace.process/1) from files, and lists the processes that are shipped with the program.

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"
#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Returns the schema of process files (retrace.process/1). A process file contains the data of a Process.
const schema::Format& process_format();

/// Returns the keys of a process as a table of another format, such as `[process]` of a job.
schema::Table process_table(std::string_view name, schema::Child child);

/// Reads a process from the text of its file.
/// \param source_name name of the file in error messages
/// \throw InputError for invalid text
Process parse_process(std::string_view text, const std::string& source_name);

/// Returns the shipped processes (data/processes/*.toml), sorted by name.
std::vector<Process> shipped_processes();

/// Returns the shipped process with a name, or the process in a file.
/// \throw InputError at `where` if neither exists
Process load_process(const std::string& name_or_file, const InputLocation& where);

}  // namespace retrace::fabrication

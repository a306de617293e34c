#pragma once

// Reads cutting processes (retrace.process/1), the shipped ones included: depths, feeds, dwells.

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"
#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// The format of process files (retrace.process/1), whose object is a Process.
const schema::Format& process_format();

/// The keys of a process as a table of another file, such as `[process]` of a job.
schema::Table process_table(std::string_view name, schema::Child child);

/// A process from the text of its file; `source_name` stands for the file in messages. \throw InputError
Process parse_process(std::string_view text, const std::string& source_name);

/// The shipped processes (data/processes/*.toml), by name.
std::vector<Process> shipped_processes();

/// The shipped process of that name, or the process of a file. \throw InputError at `where` if there is neither
Process load_process(const std::string& name_or_file, const InputLocation& where);

}  // namespace retrace::fabrication

#pragma once

// Reads and writes machine files (retrace.machine/1), and lists the machines that are shipped with the program.

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// Returns the format of machine files (retrace.machine/1), which describes a Machine.
const schema::Format& machine_format();

/// Reads a machine from the text of its file (retrace.machine/1). Directions are normalised.
/// \param source_name name of the file in error messages
/// \throw InputError in one line, with file, line, key, allowed values and given value
Machine parse_machine(std::string_view text, const std::string& source_name);

/// Returns a machine as the text of a file. Each value is written with its source.
std::string machine_text(const Machine& machine);

/// Returns the shipped machines (data/machines/*.toml).
std::vector<Machine> shipped_machines();

/// Returns the shipped machine with the given name, or the machine in the given file. A name with an extension is a
/// file name.
/// \throw InputError at `where` if the machine does not exist, or if the file is invalid
Machine load_machine(const std::string& name_or_file, const InputLocation& where);

}  // namespace retrace::fabrication

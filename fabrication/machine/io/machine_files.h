#pragma once

// Reads machine files (retrace.machine/1), the shipped ones included.

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/schema/schema.h"
#include "fabrication/machine/machine.h"

namespace retrace::fabrication {

/// The format of machine files (retrace.machine/1), whose object is a Machine.
const schema::Format& machine_format();

/// The machine of a text (schema retrace.machine/1). Directions are normalised. `source_name` stands for the file.
/// \throw InputError naming file, line, key, what was given and what is allowed, on one line
Machine parse_machine(std::string_view text, const std::string& source_name);

/// A machine as the text of a file; values as they were given or found, each with its source.
std::string machine_text(const Machine& machine);

/// The shipped machines (data/machines/*.toml), by name.
std::vector<Machine> shipped_machines();

/// The shipped machine of that name, or the machine of a file (a name with an ending).
/// \throw InputError at `where` if there is neither, or for a file that cannot be read or understood
Machine load_machine(const std::string& name_or_file, const InputLocation& where);

}  // namespace retrace::fabrication

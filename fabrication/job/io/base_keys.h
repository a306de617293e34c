#pragma once

#include <string>

#include "core/toml_file.h"
#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// The table `[base]` of a job, with the keys of a design's. \param at gets where its shape is given
/// \throw InputError
geometry::Base read_base(TomlTable table, InputLocation& at);

/// Its lines, without the head of the table; they read back equal.
std::string base_text(const geometry::Base& base);

/// That the job is of a kind that a base can have. \param at where its shape is given \pre job.base \throw InputError
void check_array_on_base(const Job& job, const InputLocation& at);

/// That the base carries the elements, and that a tool comes out of their cuts. \pre check_array_on_base()
/// \throw InputError
void check_base_of(const Job& job, const InputLocation& at);

}  // namespace retrace::fabrication

#pragma once

// Reads, checks and writes the outline of a job: `[outline]` of job files.

#include "core/schema/schema.h"
#include "fabrication/job/job.h"

namespace retrace::fabrication {

/// Returns the keys of Job::outline as a table of job files.
schema::Table outline_table();

/// Checks the outline of the part, and that at least one element is completely inside it.
void check_outline(const Job& job, const schema::Refuse& refuse);

}  // namespace retrace::fabrication

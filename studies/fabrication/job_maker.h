#pragma once

// Makes a fabrication job from a design, with a tool, a machine and a process.

#include <filesystem>

#include "core/error.h"
#include "core/warning.h"
#include "design/design.h"
#include "fabrication/job/job.h"
#include "requests/job.h"

namespace retrace::studies {

struct GeneratedJob {
  fabrication::Job job;               ///< job, which contains only the file name of its design, without the folder
  std::filesystem::path design_file;  ///< path of the design; empty if it was read from standard input
  std::int64_t elements = 0;          ///< number of elements that are cut
  std::int64_t partial_elements = 0;  ///< number of partial elements of the design, which the job omits
  Warnings warnings;
};

/// Checks everything in a request that does not depend on a design: its fields, its machine and its process.
/// \throw InputError for an invalid value
void check_job_request(const JobRequest& request);

/// Checks that the requested strategy can cut designs with zones.
/// \throw InputError at the field `strategy` if the strategy cannot cut them
void check_cuts_zones(const JobRequest& request);

/// Checks that the requested strategy can cut the elements of the design.
/// \throw InputError at the field `strategy` if only another strategy can cut them
/// \throw InputError at a key of the design if no strategy can cut them
void check_element(const design::Design& design, const JobRequest& request);

/// Returns the fabrication job of a design, which is an array of elements or has zones of cube corners. The job
/// contains the dihedral errors of the design and, for cube corners, its facet tilts. It omits partial elements, and
/// the random errors, edge radii and scratches of [surface]. Warnings list all omissions.
/// \throw InputError for designs and requests that cannot be cut
GeneratedJob make_job(const design::Design& design, const JobRequest& request);

}  // namespace retrace::studies

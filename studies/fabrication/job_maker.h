#pragma once

// Makes a fabrication job of a design: which elements are cut, with which tool, machine and process.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/warning.h"
#include "fabrication/job/job.h"
#include "studies/design/design.h"

namespace retrace::studies {

/// What a design does not say of its fabrication.
struct JobRequest {
  std::string machine = "ideal";  ///< a shipped one, or a file
  double tool_width_mm = 0.0;
  std::string strategy = "two-step";
  std::string process = "thesis-acrylic";  ///< a shipped one, or a file
  std::string workpiece = "mould";
  double shrinkage_percent = 0.0;
};

struct MadeJob {
  fabrication::Job job;               ///< names its design by the file's name alone
  std::filesystem::path design_file;  ///< that it was made from, from the working directory; none: standard input
  std::int64_t elements = 0;          ///< that are cut
  std::int64_t partial_elements = 0;  ///< that the design has and the job leaves out
  Warnings warnings;
};

/// What can be told of a request without a design: its words, machine and process. \throw InputError
void check_making(const JobRequest& request);

/// Checks that the strategy supports designs with zones.
/// \throw InputError at --strategy if it does not
void check_cuts_zones(const JobRequest& request);

/// Whether the strategy cuts the design's element. \throw InputError at --strategy, and for designs that nothing cuts
void check_element(const Design& design, const JobRequest& request);

/// Returns the fabrication job of a design. The design is an array of elements or has zones of cube corners. The job
/// contains the dihedral errors of the design and, for cube corners, its facet tilts. It does not contain the random
/// errors, edge radii and scratches of [surface], and it omits partial elements. Warnings name what is not cut.
/// \throw InputError for designs and requests that cannot be cut
MadeJob make_job(const Design& design, const JobRequest& request);

}  // namespace retrace::studies

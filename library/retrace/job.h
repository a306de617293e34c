#pragma once

// Makes fabrication jobs from designs, and NC programs from fabrication jobs.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/warning.h"
#include "requests/job.h"
#include "retrace/design.h"
#include "retrace/drawing.h"

namespace retrace {

struct Job {
  std::string text;                   ///< text of the job file (format retrace.job/1)
  std::int64_t elements = 0;          ///< number of elements that are cut
  std::int64_t partial_elements = 0;  ///< number of partial elements of the design, which are not cut
  Warnings warnings;
  std::string json;   ///< JSON document retrace.job_summary/1
  std::string table;  ///< summary as text
};

/// Makes the fabrication job of a design.
/// \throw InputError if the design cannot be cut
RETRACE_API Job make_job(const Design& design, const JobRequest& request);

struct NcText {
  std::string file;  ///< file name that `retrace fabricate` would use
  std::string text;
};

struct Fabrication {
  std::vector<NcText> programs;  ///< in the order in which they run
  Warnings warnings;
  std::string json;     ///< JSON document retrace.fabrication/2
  std::string table;    ///< summary as text
  Drawing roughing;     ///< tool path through one element in roughing; empty if the job has no roughing stages
  Drawing finishing;    ///< tool path through one element in finishing; empty if the job has no finishing stages
  Drawing arrangement;  ///< elements that are cut, in the order of cutting
};

/// Plans a job and returns its NC programs.
/// \param job job file
/// \throw InputError
RETRACE_API Fabrication fabricate(const std::filesystem::path& job, const FabricationRequest& request = {});

}  // namespace retrace

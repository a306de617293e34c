#pragma once

// Makes fabrication jobs from designs, and NC programs from fabrication jobs.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/warning.h"
#include "retrace/design.h"
#include "retrace/drawing.h"

namespace retrace {

/// Settings of a fabrication job that are not in the design. They correspond to the options of `retrace job`.
struct JobRequest {
  std::string machine = "ideal";  ///< name of a shipped machine, or a file
  double tool_width_mm = 0.0;     ///< width of the cutting edge, > 0
  std::string strategy = "two-step";
  std::string process = "thesis-acrylic";  ///< name of a shipped process, or a file
  std::string workpiece = "mould";         ///< "mould", or "direct" if the optic itself is cut
  double shrinkage_percent = 0.0;
};

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

/// Settings of NC programs. They correspond to the options of `retrace fabricate`.
struct FabricationRequest {
  std::string dialect = "rs274ngc";  ///< rs274ngc, sinumerik, fanuc, pmac, a3200 or automation1
  std::string phase = "all";
  std::optional<std::uint64_t> from_element = {};
  /// Number, from 1, of the tool pass at which the programs start. Passes are counted within the first visit of the
  /// tool to the element `from_element`. A narrow tool needs several passes for each element.
  std::optional<std::uint64_t> from_pass = {};
  std::optional<std::uint64_t> stop_every = {};
  std::optional<double> split_hours = {};
  std::optional<std::string> job_text = {};  ///< text of the job file; if given, the file itself is not read
};

struct NcText {
  std::string file;  ///< file name that `retrace fabricate` would use
  std::string text;
};

struct Fabrication {
  std::vector<NcText> programs;  ///< in the order in which they run
  Warnings warnings;
  std::string json;     ///< JSON document retrace.fabrication/1
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

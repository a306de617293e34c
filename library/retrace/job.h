#pragma once

// Fabrication jobs of designs, and their NC programs.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "retrace/design.h"
#include "retrace/drawing.h"

namespace retrace {

/// What a design does not say of its fabrication, as the options of `retrace job`.
struct JobRequest {
  std::string machine = "ideal";  ///< a shipped one, or a file
  double tool_width_mm = 0.0;     ///< > 0
  std::string strategy = "two-step";
  std::string process = "thesis-acrylic";  ///< a shipped one, or a file
  std::string workpiece = "mould";         ///< or direct: the optic itself is cut
  double shrinkage_percent = 0.0;
};

struct Job {
  std::string text;                   ///< of the job file, retrace.job/1
  std::int64_t elements = 0;          ///< that are cut
  std::int64_t partial_elements = 0;  ///< that the design has and the job leaves out
  std::vector<std::string> warnings;
  std::string json;   ///< document retrace.job_summary/1
  std::string table;  ///< for people
};

/// The fabrication job of a design. \throw InputError for what cannot be cut
RETRACE_API Job make_job(const Design& design, const JobRequest& request);

/// How a job is written as NC programs, as the options of `retrace fabricate`.
struct FabricationRequest {
  std::string dialect = "rs274ngc";  ///< rs274ngc, sinumerik, fanuc, pmac, a3200 or automation1
  std::string phase = "all";
  std::optional<std::uint64_t> from_element = {};
  std::optional<std::uint64_t> from_pass = {};  ///< first pass, counted from 1, of the first visit of `from_element`
  std::optional<std::uint64_t> stop_every = {};
  std::optional<double> split_hours = {};
  std::optional<std::string> job_text = {};  ///< of the job, whose file is then a name alone
};

struct NcText {
  std::string file;  ///< its usual name
  std::string text;
};

struct Fabrication {
  std::vector<NcText> programs;  ///< in the order in which they run
  std::vector<std::string> warnings;
  std::string json;     ///< document retrace.fabrication/1
  std::string table;    ///< for people
  Drawing roughing;     ///< the way of the tool through one element; none without such stages
  Drawing finishing;    ///< likewise
  Drawing arrangement;  ///< which elements are cut, in which order
};

/// Plans a job and writes its programs. \param job its file \throw InputError
RETRACE_API Fabrication fabricate(const std::filesystem::path& job, const FabricationRequest& request = {});

}  // namespace retrace

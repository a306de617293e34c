#pragma once

// Requests for fabrication jobs and for NC programs.

#include <cstdint>
#include <optional>
#include <string>

namespace retrace {

/// Settings of a fabrication job that are not in the design, as in `retrace job`.
struct JobRequest {
  /// Name of a shipped machine, or a machine file.
  std::string machine = "ideal";
  /// Width of the tool between the outer ends of its cutting edges, in mm; 0.1 to 2 mm with all strategies except dmc;
  /// >= 0.01 and <= 10. Required.
  double tool_width_mm = 0.0;
  /// Cutting strategy: unidirectional, bidirectional or two-step for prisms; dmc (diamond micro chiseling) for cube
  /// corners.
  std::string strategy = "two-step";
  /// Name of a shipped process, or a process file; a process contains the depths, feeds and dwell times of the cuts.
  std::string process = "thesis-acrylic";
  /// Kind of workpiece: mould if a mould of the part is cut, direct if the optical part itself is cut.
  std::string workpiece = "mould";
  /// Shrinkage of the moulded part, in percent; the mould is larger than the part by this percentage; >= 0 and <= 10.
  double shrinkage_percent = 0.0;
};

/// Settings of NC programs, as in `retrace fabricate`.
struct FabricationRequest {
  /// Dialect of the programs: rs274ngc, sinumerik, fanuc, pmac, a3200 or automation1.
  std::string dialect = "rs274ngc";
  /// Stages that the programs contain: all, roughing, finishing, or one stage such as finishing-1-facet-2; a + after
  /// the name also includes all later stages.
  std::string phase = "all";
  /// Number, counted from 0, of the element at which the programs start; all earlier cuts of the selected stages are
  /// omitted; a whole number >= 0 and <= 2147483647. Default: the first.
  std::optional<std::uint64_t> from_element = {};
  /// Number, counted from 1, of the pass with which the programs start at the first element; a tool that is narrower
  /// than an element needs several parallel passes for it; a whole number >= 1 and <= 2147483647. Default: 1.
  std::optional<std::uint64_t> from_pass = {};
  /// Number of elements that the tool cuts between two optional stops; an element that is cut in several stages counts
  /// several times; a whole number >= 1 and <= 2147483647. Default: no stops.
  std::optional<std::uint64_t> stop_every = {};
  /// Maximum run time of one program in hours; a longer job is split into several programs; > 0. Default: all in one
  /// program.
  std::optional<double> split_hours = {};
  /// Text of the job file; if it is given, the file is not read. Default: the text of the file.
  std::optional<std::string> job_text = {};
};

}  // namespace retrace

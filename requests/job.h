#pragma once

// Requests for fabrication jobs and for NC programs.

#include <cstdint>
#include <optional>
#include <string>

namespace retrace {

/// Settings of a fabrication job that are not in the design, as in `retrace job`.
struct JobRequest {
  /// Shipped machine, or machine file.
  std::string machine = "ideal";
  /// Width of the cutting edge, 0.1 to 2, in mm; with the strategy dmc 0.01 to 10; >= 0.01 and <= 10. Required.
  double tool_width_mm = 0.0;
  /// Strategy of cutting: unidirectional, bidirectional or two-step; dmc for cube corners.
  std::string strategy = "two-step";
  /// Shipped process or file with the depths, feeds and dwell times of the cuts.
  std::string process = "thesis-acrylic";
  /// Workpiece: mould, or direct if the optic itself is cut.
  std::string workpiece = "mould";
  /// Shrinkage of the part, in percent; the mould is larger than the part by this amount; >= 0 and <= 10.
  double shrinkage_percent = 0.0;
};

/// Settings of NC programs, as in `retrace fabricate`.
struct FabricationRequest {
  /// Dialect of the programs: rs274ngc, sinumerik, fanuc, pmac, a3200 or automation1.
  std::string dialect = "rs274ngc";
  /// Stages in the programs: all, roughing, finishing, or one stage such as finishing-1-facet-2; a + after the name
  /// includes all later stages.
  std::string phase = "all";
  /// Number of the element at which the programs start, with the first visit of the tool; a whole number >= 0 and <=
  /// 2147483647. Default: the first.
  std::optional<std::uint64_t> from_element = {};
  /// Number, counted from 1, of the tool pass at which the programs start, within the first visit to the element; a
  /// narrow tool needs several passes for each element; a whole number >= 1 and <= 2147483647. Default: 1.
  std::optional<std::uint64_t> from_pass = {};
  /// Number of visits of the tool to an element between optional stops; a whole number >= 1 and <= 2147483647. Default:
  /// no stops.
  std::optional<std::uint64_t> stop_every = {};
  /// Maximum duration of one program in hours; > 0. Default: all in one program.
  std::optional<double> split_hours = {};
  /// Text of the job file, which is used instead of reading the file. Default: the text of the file.
  std::optional<std::string> job_text = {};
};

}  // namespace retrace

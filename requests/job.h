#pragma once

// Requests for fabrication jobs and for NC programs.

#include <cstdint>
#include <optional>
#include <string>

namespace retrace {

/// Settings of a fabrication job that are not in the design, as in `retrace job`.
struct JobRequest {
  std::string machine = "ideal";
  double tool_width_mm = 0.0;
  std::string strategy = "two-step";
  std::string process = "thesis-acrylic";
  std::string workpiece = "mould";
  double shrinkage_percent = 0.0;
};

/// Settings of NC programs, as in `retrace fabricate`.
struct FabricationRequest {
  std::string dialect = "rs274ngc";
  std::string phase = "all";
  std::optional<std::uint64_t> from_element = {};
  std::optional<std::uint64_t> from_pass = {};
  std::optional<std::uint64_t> stop_every = {};
  std::optional<double> split_hours = {};
  std::optional<std::string> job_text = {};
};

}  // namespace retrace

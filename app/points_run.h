#pragma once

#include <functional>
#include <string>

#include "app/command_line.h"
#include "app/output.h"
#include "core/error.h"
#include "studies/sweep/sweep.h"

namespace retrace::app {

/// A command whose points are known beforehand and kept in a store.
struct PointsCommand {
  std::string doing;  ///< what the progress bar says
  std::string store;  ///< file in the output folder
  /// Reads the study and checks all of it; also on ranks that only compute.
  std::function<studies::Sweep()> read;
  std::string document;             ///< JSON in the output folder
  std::vector<std::string> others;  ///< further files there, beside the store
  /// Writes what came out, which may be incomplete, and adds its warnings. \return the exit code of a complete run
  std::function<ExitCode(studies::SweepResult& result)> write;
};

/// Computes what the store lacks - by itself, or as one rank of a job under MPI, with a progress bar - and has it
/// written. \throw Error
ExitCode run_points(const CommandLine& line, const PointsCommand& command);

}  // namespace retrace::app

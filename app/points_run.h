#pragma once

// The common course of `retrace sweep` and `retrace tolerance`: compute the points of a study that its store lacks,
// alone or under MPI, then write the result.

#include <functional>
#include <optional>
#include <string>

#include "app/output.h"
#include "app/shared_arguments.h"
#include "core/error.h"
#include "studies/sweep/sweep.h"

namespace retrace::app {

/// A command whose points are known beforehand and kept in a store.
struct PointsCommand {
  std::string doing;              ///< what the progress bar says
  std::string fewer_points = {};  ///< advice that reduces the number of points, such as "give fewer values"
  std::string store;              ///< its file in the output folder
  /// Reads the study and checks all of it; also on ranks that only compute.
  std::function<studies::Sweep()> read;
  std::string document;  ///< JSON in the output folder
  /// Names further files there, beside the store. \param result is there when they are made
  std::function<void(ResultFiles& files, const std::optional<studies::SweepResult>& result)> add_files;
  /// Writes what came out, which may be incomplete, and adds its warnings. \return the exit code of a complete run
  std::function<ExitCode(studies::SweepResult& result, const ResultFiles& files)> write;
};

/// Computes what the store lacks - by itself, or as one rank of a job under MPI, with a progress bar - and has it
/// written. \throw Error
ExitCode run_points(const StudyOptions& options, const CommonOptions& common, const PointsCommand& command);

}  // namespace retrace::app

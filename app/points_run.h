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

/// A command that computes a known list of points and keeps them in a store.
struct PointsCommand {
  std::string doing;              ///< activity that the progress bar shows, such as "sweeping"
  std::string fewer_points = {};  ///< advice that reduces the number of points, such as "give fewer values"
  std::string store;              ///< name of the store file in the output folder
  /// Function that reads and checks the study. Under MPI, every rank calls it.
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

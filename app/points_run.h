#pragma once

// Common implementation of `retrace sweep` and `retrace tolerance`. Computes the points of a study that are missing in
// its store (an SQLite file), optionally under MPI, and writes the result.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/output.h"
#include "app/shared_arguments.h"
#include "core/error.h"
#include "studies/sweep/sweep.h"

namespace retrace::app {

/// Description of a command that computes a list of points and saves them in a store (an SQLite file).
struct PointsCommand {
  std::string doing;              ///< activity that the progress bar shows, such as "sweeping"
  std::string fewer_points = {};  ///< advice on how to reduce the number of points, such as "give fewer values"
  std::string store;              ///< name of the store file in the output folder
  /// Function that reads and checks the study. Under MPI, every rank calls it.
  std::function<studies::Sweep()> read;
  std::string document;  ///< name of the JSON document in the output folder
  /// Returns a summary of the finished points in one line. Long runs print this line from time to time. If empty, no
  /// such lines are printed.
  std::function<std::string(const std::vector<compute::StoredPoint>& points)> so_far = {};
  /// Function that adds further output files.
  /// \param result result of the computation; it has a value when the contents of the files are requested
  std::function<void(ResultFiles& files, const std::optional<studies::SweepResult>& result)> add_files;
  /// Function that writes the result, which may be incomplete, and adds warnings to it.
  /// \return exit code of a complete run
  std::function<ExitCode(studies::SweepResult& result, const ResultFiles& files)> write;
};

/// Computes the points that are not in the store and writes the result. Runs as a single process or as one rank of an
/// MPI job, and shows a progress bar.
/// \throw Error
ExitCode run_points(const StudyOptions& options, const CommonOptions& common, const PointsCommand& command);

}  // namespace retrace::app

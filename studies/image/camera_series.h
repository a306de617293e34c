#pragma once

// Several camera pictures that are displayed with the same exposure.

#include <cstddef>
#include <memory>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "core/warning.h"
#include "studies/image/camera_study.h"

namespace retrace::studies {

struct CameraSeriesResult {
  std::vector<CameraResult> pictures;  ///< in the order of the request, without pictures that have no finished pass
  std::vector<std::size_t> positions;  ///< position of each picture in the request, counted from 0
  Warnings warnings;                   ///< warnings of all pictures
  bool complete = true;                ///< true if all requested pictures are complete
};

/// Study of several camera pictures: one for each design, or one for each request.
class CameraSeries {
 public:
  static constexpr std::size_t kMaxPictures = 64;

  /// \param designs one design, or one for each picture
  /// \param requests one request, or one for each picture
  /// \throw InputError if both lists have more than one element, if one of them is empty or has more than kMaxPictures
  /// elements, and in the same cases as CameraStudy
  CameraSeries(const std::vector<design::Design>& designs, const std::vector<CameraRequest>& requests);

  /// Computes the pictures one after the other.
  /// \param distribute function that distributes the pictures among several processes with equal series. Without it,
  ///        this process computes all pictures.
  CameraSeriesResult run(Progress* progress = nullptr, const Cancellation* cancel = nullptr,
                         const DistributeTasks& distribute = {}) const;
  /// Returns a task that computes the picture with a given number, using all threads.
  /// \pre the series outlives the task
  ComputeTask pictures() const;

  std::size_t size() const { return studies_.size(); }

 private:
  std::vector<std::unique_ptr<const CameraStudy>> studies_;
};

}  // namespace retrace::studies

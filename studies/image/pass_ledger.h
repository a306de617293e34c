#pragma once

// Divides a camera picture into passes, which are tasks that several processes can share.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/shared_tasks.h"
#include "raytrace/observers/camera.h"
#include "requests/image.h"

namespace retrace::studies {

/// Estimates the number of passes after which the noise is as low as requested. Each pass adds one sample to every
/// pixel. The noise is inversely proportional to the square root of the number of passes.
double passes_needed(const raytrace::CameraImage& image, const CameraRequest& request);

/// Distributes the passes of a picture as tasks. Results are added in ascending order of the pass numbers, even if the
/// passes are finished in another order.
class PassLedger : public TaskLedger {
 public:
  /// \param images pictures to which passes are added; the noise of the first one is compared with the request
  /// \param after_pass function that is called after each added pass; may be empty
  /// \pre all arguments outlive the object; there is at least one image
  PassLedger(const CameraRequest& request, std::vector<raytrace::CameraImage>& images, Progress* progress,
             const std::function<void()>& after_pass);

  std::optional<std::uint64_t> take() override;
  void give_back(std::uint64_t pass) override { given_back_.insert(pass); }
  void finish(std::uint64_t pass, const std::string& bytes) override;
  bool is_finished() override { return is_finished_; }

  /// Adds the next pass to all images.
  /// \param pass results of the pass: the values of all images, one image after the other
  void add(const std::vector<double>& pass);

 private:
  const CameraRequest& request_;
  std::vector<raytrace::CameraImage>& images_;
  raytrace::CameraImage& image_;
  Progress* progress_;
  const std::function<void()>& after_pass_;
  std::uint32_t goal_;
  std::size_t max_ahead_;  ///< maximum number of passes that may be started while an earlier pass is missing
  std::uint64_t next_ = 0;
  std::set<std::uint64_t> given_back_;
  std::map<std::uint64_t, std::string> ahead_;
  double furthest_ = 0.0;
  bool is_finished_ = false;
};

}  // namespace retrace::studies

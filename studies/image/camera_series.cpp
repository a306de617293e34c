#include "studies/image/camera_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/task_progress.h"

namespace retrace::studies {
namespace {

/// List of pictures that are computed by several processes.
class PictureLedger : public TaskLedger {
 public:
  PictureLedger(std::size_t count, Progress* progress) : finished_(count), progress_(progress) {
    for (std::size_t k = 0; k < count; ++k) open_.insert(k);
  }

  std::optional<std::uint64_t> take() override {
    if (open_.empty()) return std::nullopt;
    return open_.extract(open_.begin()).value();
  }
  void give_back(std::uint64_t picture) override { open_.insert(picture); }
  void finish(std::uint64_t picture, const std::string& bytes) override {
    if (finished_[picture].empty()) ++count_;
    finished_[picture] = bytes;
    if (progress_ != nullptr) progress_->at(static_cast<double>(count_) / static_cast<double>(finished_.size()));
  }
  bool is_finished() override { return count_ == finished_.size(); }

  /// Returns the bytes of each picture; empty if the picture is not finished.
  const std::vector<std::string>& finished() const { return finished_; }

 private:
  std::set<std::uint64_t> open_;
  std::vector<std::string> finished_;
  std::size_t count_ = 0;
  Progress* progress_;
};

}  // namespace

CameraSeries::CameraSeries(const std::vector<design::Design>& designs, const std::vector<CameraRequest>& requests) {
  const std::size_t count = std::max(designs.size(), requests.size());
  const auto is_count = [count](std::size_t size) { return size == 1 || size == count; };
  if (!is_count(designs.size()) || !is_count(requests.size()) || (designs.size() > 1 && requests.size() > 1))
    throw InputError(
        fmt::format("a series needs one design and several camera requests, or several designs and one "
                    "request, got {} designs and {} requests",
                    designs.size(), requests.size()));
  if (count > kMaxPictures)
    throw InputError(fmt::format("a series must have 1 to {} pictures, got {}", kMaxPictures, count));
  std::map<std::filesystem::path, std::shared_ptr<const Background>> backgrounds;
  for (std::size_t k = 0; k < count; ++k) {
    const CameraRequest& request = requests[requests.size() > 1 ? k : 0];
    std::shared_ptr<const Background>& background = backgrounds[request.background];
    if (!background) background = background_of(request);
    studies_.push_back(std::make_unique<const CameraStudy>(designs[designs.size() > 1 ? k : 0], request,
                                                           raytrace::DiscAverage::kernel, background));
  }
}

ComputeTask CameraSeries::pictures() const {
  return [this](std::uint64_t picture, const Cancellation* cancel) { return studies_[picture]->run_to_bytes(cancel); };
}

CameraSeriesResult CameraSeries::run(Progress* progress, const Cancellation* cancel,
                                     const DistributeTasks& distribute) const {
  CameraSeriesResult series;
  const auto count = static_cast<double>(size());
  const auto add = [&series](std::size_t position, CameraResult result) {
    series.pictures.push_back(std::move(result));
    series.positions.push_back(position);
  };
  if (distribute) {
    PictureLedger ledger(size(), progress);
    distribute(pictures(), ledger);
    for (std::size_t k = 0; k < size(); ++k)
      if (const std::string& bytes = ledger.finished()[k]; !bytes.empty()) add(k, studies_[k]->result_of(bytes));
  } else {
    for (std::size_t k = 0; k < size() && !is_cancelled(cancel); ++k) {
      PartProgress part(progress, static_cast<double>(k) / count, static_cast<double>(k + 1) / count);
      CameraResult result = studies_[k]->run(&part, cancel);
      if (result.image.passes > 0) add(k, std::move(result));
    }
  }
  for (const CameraResult& picture : series.pictures)
    series.warnings.insert(series.warnings.end(), picture.warnings.begin(), picture.warnings.end());
  series.complete = series.pictures.size() == size() &&
                    std::ranges::all_of(series.pictures, [](const auto& p) { return p.complete; });
  return series;
}

}  // namespace retrace::studies

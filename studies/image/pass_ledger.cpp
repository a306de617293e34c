#include "studies/image/pass_ledger.h"

#include <algorithm>
#include <cmath>

#include "studies/image/camera_study.h"

namespace retrace::studies {
namespace {

// Maximum memory, in bytes, for the results of passes that wait for an earlier pass. At least kFewestAhead passes may
// always wait.
constexpr std::size_t kBytesAhead = std::size_t{1} << 30U;
constexpr std::size_t kFewestAhead = 8;

}  // namespace

double passes_needed(const raytrace::CameraImage& image, const CameraRequest& request) {
  return image.passes * std::pow(image.relative_noise() / request.noise, 2.0);
}

PassLedger::PassLedger(const CameraRequest& request, std::vector<raytrace::CameraImage>& images, Progress* progress,
                       const std::function<void()>& after_pass)
    : request_(request),
      images_(images),
      image_(images.front()),
      progress_(progress),
      after_pass_(after_pass),
      goal_(request.passes.value_or(CameraStudy::kMaxPasses)),
      max_ahead_(std::max(kFewestAhead, kBytesAhead / (images.size() * image_.luminance.size() * 3 * sizeof(double)))) {
}

std::optional<std::uint64_t> PassLedger::take() {
  if (is_finished_) return std::nullopt;
  if (!given_back_.empty()) return given_back_.extract(given_back_.begin()).value();
  if (next_ >= goal_ || next_ >= image_.passes + max_ahead_) return std::nullopt;
  return next_++;
}

void PassLedger::finish(std::uint64_t pass, const std::string& bytes) {
  ahead_[pass] = bytes;
  for (auto next = ahead_.find(image_.passes); !is_finished_ && next != ahead_.end();
       next = ahead_.find(image_.passes)) {
    add(numbers_of(next->second));
    ahead_.erase(next);
  }
}

void PassLedger::add(const std::vector<double>& pass) {
  const auto length = static_cast<std::ptrdiff_t>(pass.size() / images_.size());
  auto begin = pass.begin();
  for (raytrace::CameraImage& image : images_) {
    image.add({begin, begin + length});
    begin += length;
  }
  if (after_pass_) after_pass_();
  double share = static_cast<double>(image_.passes) / goal_;
  is_finished_ = image_.passes == goal_;
  if (!request_.passes) {
    const double noise = image_.passes > 1 ? image_.relative_noise() : 1.0;
    is_finished_ =
        is_finished_ || (image_.passes >= CameraStudy::kMinPasses && noise <= request_.noise) ||
        (image_.passes >= CameraStudy::kPassesToJudge && passes_needed(image_, request_) > CameraStudy::kMaxPasses);
    share = image_.passes > 1 ? std::min(0.99, std::pow(request_.noise / std::max(noise, 1e-300), 2.0)) : 0.0;
  }
  furthest_ = std::max(furthest_, share);
  if (progress_ != nullptr && !is_finished_) progress_->at(furthest_);
}

}  // namespace retrace::studies

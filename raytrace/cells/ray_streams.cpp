#include "raytrace/cells/ray_streams.h"

#include <algorithm>
#include <bit>

namespace retrace::raytrace {

RayStreams::RayStreams(std::size_t column_count, std::size_t numbers,
                       const std::optional<geometry::Rectangle>& inner_mm)
    : inner_mm_(inner_mm), streams_(kStreamsOfColumn * column_count, RayStore(numbers)), waiting_(64) {}

StreamKey RayStreams::key_of(std::size_t index) {
  return {static_cast<std::uint32_t>(index / kStreamsOfColumn), static_cast<RayLocation>(index % kLocations),
          index % kStreamsOfColumn >= kLocations};
}

lanes::Rays RayStreams::end_of(const StreamKey& key, std::size_t most) {
  RayStore& rays = streams_[index_of(key)];
  rays.reserve(rays.size() + most);
  return rays.rays(rays.size());
}

void RayStreams::grow(const StreamKey& key, std::size_t more) {
  if (more == 0) return;
  RayStore& rays = streams_[index_of(key)];
  const std::size_t before = rays.size();
  rays.resize(before + more);
  const auto bits = static_cast<std::size_t>(std::bit_width(before + more));
  if (static_cast<std::size_t>(std::bit_width(before)) != bits) waiting_[bits].push_back(index_of(key));
}

void RayStreams::grow_from_neighbour(const StreamKey& key, std::size_t more, const Vec2& shift_mm) {
  if (more == 0) return;
  RayStore& stream = streams_[index_of(key)];
  const lanes::Rays rays = stream.rays(stream.size());
  if (shift_mm != Vec2::Zero()) lanes::shift(rays, more, shift_mm);
  grow(key, keep_inner(rays, more, 0.0, key.inside(), key.scattered));
}

std::optional<StreamKey> RayStreams::take_fullest(RayStore& rays) {
  for (std::size_t bits = waiting_.size(); bits-- > 1;)
    while (!waiting_[bits].empty()) {
      const std::size_t index = waiting_[bits].back();
      waiting_[bits].pop_back();
      // `waiting_` gets a new entry for a stream when the bit width of the stream's size grows. The old entry remains
      // and is skipped here.
      if (static_cast<std::size_t>(std::bit_width(streams_[index].size())) != bits) continue;
      rays.clear();
      rays.swap(streams_[index]);
      return key_of(index);
    }
  return std::nullopt;
}

std::size_t RayStreams::keep_inner(const lanes::Rays& rays, std::size_t count, double height_mm, bool inside,
                                   bool scattered) {
  if (!inner_mm_) return count;
  labels_.resize(std::max(labels_.size(), count + lanes::kPadding));
  std::fill_n(labels_.begin(), count, lanes::kKept);
  if (lanes::mark_beyond(rays, count, {height_mm, inner_mm_->lower, inner_mm_->upper}, lanes::kKept, lanes::kRemoved,
                         labels_.data()) == 0)
    return count;
  hand_over(rays, count, labels_.data(), lanes::kRemoved, inside, scattered);
  return lanes::select(labels_.data(), lanes::kKept, count, rays, rays);
}

void RayStreams::hand_over(const lanes::Rays& rays, std::size_t count, const lanes::Label* labels, lanes::Label label,
                           bool inside, bool scattered) {
  for (std::size_t k = 0; k < count; ++k)
    if (labels[k] == label)
      handed_over_.push_back({position_of(rays, k), ray_of(rays, k, inside, scattered), owner_of(rays, k)});
}

}  // namespace retrace::raytrace

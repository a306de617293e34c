#pragma once

// Internal to surface_models/io/: reads little-endian values from bytes, independent of the byte order of the machine.

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <string_view>

#include "surface_models/io/raw_map.h"

namespace retrace::surface_models {

/// Reads values from `bytes` in order. Each function throws InputError if there are not enough bytes.
class ByteReader {
 public:
  /// \param start offset of `bytes` in the file, for messages
  ByteReader(const Source& source, std::string_view bytes, std::size_t start)
      : source_(&source), remainder_(bytes), at_(start) {}

  bool is_at_end() const { return remainder_.empty(); }
  std::size_t at() const { return at_; }
  std::size_t remaining() const { return remainder_.size(); }

  std::string_view take(std::uint64_t count) {
    if (count > remainder_.size())
      source_->fail(0, fmt::format("the file is cut short: {} bytes are required at byte {}, but only {} follow", count,
                                   at_, remainder_.size()));
    const std::string_view taken = remainder_.substr(0, static_cast<std::size_t>(count));
    remainder_.remove_prefix(taken.size());
    at_ += taken.size();
    return taken;
  }
  std::uint32_t u32() { return static_cast<std::uint32_t>(unsigned_of(take(4))); }
  std::uint64_t u64() { return unsigned_of(take(8)); }
  double f32() { return static_cast<double>(std::bit_cast<float>(u32())); }
  double f64() { return std::bit_cast<double>(u64()); }
  /// Reads a text that ends with a zero byte.
  std::string_view text() {
    const std::size_t end = remainder_.find('\0');
    if (end == std::string_view::npos)
      source_->fail(0, fmt::format("the file is cut short: the text at byte {} is not terminated by a zero byte", at_));
    return take(end + 1).substr(0, end);
  }
  /// Skips the next `count` bytes and returns a separate reader of these bytes.
  ByteReader part(std::uint64_t count) {
    const std::size_t start = at_;
    return {*source_, take(count), start};
  }

 private:
  static std::uint64_t unsigned_of(std::string_view bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
  }

  const Source* source_;
  std::string_view remainder_;
  std::size_t at_;
};

}  // namespace retrace::surface_models

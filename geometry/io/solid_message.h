#pragma once

// Result of the program that reads solids (step_solid_program.cpp) as a sequence of numbers. Both programs run on the
// same machine, so the numbers have its native format.

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "geometry/vec.h"

namespace retrace::geometry {

/// File name of the program in lib/retrace.
inline constexpr std::string_view kSolidReaderName = "retrace_solid_reader";

/// First number of a result.
enum class SolidResult { refused, solid };

class SolidMessageWriter {
 public:
  void put(double value) { text_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put_count(std::size_t count) { put(static_cast<double>(count)); }
  void put_result(SolidResult result) { put(static_cast<double>(result)); }
  void put(const Vec3& p) {
    for (const double c : {p.x(), p.y(), p.z()}) put(c);
  }
  /// Adds a text at the end of the result.
  void put_text(std::string_view text) { text_ += text; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Reads a result. All functions throw std::runtime_error if the result is damaged.
class SolidMessageReader {
 public:
  explicit SolidMessageReader(std::string_view text) : remaining_(text) {}

  double number() {
    double value = 0.0;
    if (remaining_.size() < sizeof value) fail();
    std::memcpy(&value, remaining_.data(), sizeof value);
    remaining_.remove_prefix(sizeof value);
    return value;
  }
  Vec3 point() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }
  /// Reads a whole number that is less than `end`.
  std::size_t index(std::size_t end) {
    const double value = number();
    if (!(value >= 0.0 && value < static_cast<double>(end))) fail();
    return static_cast<std::size_t>(value);
  }
  /// Reads the length of a list whose items have at least one number.
  std::size_t count() { return index(remaining_.size() / sizeof(double) + 1); }
  std::string_view remaining() const { return remaining_; }
  [[noreturn]] static void fail() { throw std::runtime_error("the result is damaged"); }

 private:
  std::string_view remaining_;
};

}  // namespace retrace::geometry

#pragma once

// Results of the program that reads STEP files (step_program/), as a sequence of numbers. Both programs run
// on the same machine, so the numbers have its native format.

#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/outline/outline.h"
#include "geometry/surface/step_face.h"
#include "geometry/surface/step_surface.h"

namespace retrace::geometry {

/// Word for the kind of result, as command-line argument of the program.
inline constexpr std::string_view kStepSurfaceWord = "surface";
inline constexpr std::string_view kStepOutlineWord = "outline";
inline constexpr std::string_view kStepSolidWord = "solid";

/// First number of a result.
enum class StepResult { refused, surface, outline, solid };

/// Surface before it is prepared for evaluation.
struct StepPatches {
  std::vector<PatchTree> faces;
  std::vector<FaceBorder> borders;
};

class StepMessageWriter {
 public:
  void put(double value) {
    char bytes[sizeof(double)];
    std::memcpy(bytes, &value, sizeof(double));
    text_.append(bytes, sizeof(double));
  }
  void put(const Vec2& p) {
    put(p.x());
    put(p.y());
  }
  void put(const Vec3& p) {
    for (const double c : {p.x(), p.y(), p.z()}) put(c);
  }
  void put(std::string_view text) {
    put(static_cast<double>(text.size()));
    text_.append(text);
  }
  template <class Item, class Put>
  void put_list(const std::vector<Item>& items, const Put& put_item) {
    put(static_cast<double>(items.size()));
    for (const Item& item : items) put_item(item);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Reads a result. All functions throw std::runtime_error if the result is damaged.
class StepMessageReader {
 public:
  explicit StepMessageReader(std::string_view text) : remainder_(text) {}

  double number() {
    double value = 0.0;
    std::memcpy(&value, take(sizeof(double)).data(), sizeof(double));
    return value;
  }
  Vec2 point() {
    const double x = number();
    return {x, number()};
  }
  Vec3 position() {
    const Vec2 p = point();
    return {p.x(), p.y(), number()};
  }
  /// Reads the length of a list whose items have at least one byte.
  std::size_t count() {
    const double value = number();
    if (!(value >= 0.0 && value <= static_cast<double>(remainder_.size()))) fail();
    return static_cast<std::size_t>(value);
  }
  std::string text() { return std::string(take(count())); }
  template <class Item, class Read>
  std::vector<Item> list(const Read& read) {
    std::vector<Item> items;
    for (std::size_t left = count(); left > 0; --left) items.push_back(read());
    return items;
  }
  /// Reads an index that is less than `end`.
  std::uint32_t index(std::size_t end) {
    const double value = number();
    if (!(value >= 0.0 && value < static_cast<double>(end))) fail();
    return static_cast<std::uint32_t>(value);
  }
  bool is_at_end() const { return remainder_.empty(); }
  [[noreturn]] static void fail() { throw std::runtime_error("the result is damaged"); }

 private:
  std::string_view take(std::size_t bytes) {
    if (bytes > remainder_.size()) fail();
    const std::string_view taken = remainder_.substr(0, bytes);
    remainder_.remove_prefix(bytes);
    return taken;
  }

  std::string_view remainder_;
};

}  // namespace retrace::geometry

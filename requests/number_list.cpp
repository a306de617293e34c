#include "requests/number_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "core/error.h"
#include "core/message_text.h"
#include "core/text.h"

namespace retrace::requests {
namespace {

constexpr std::size_t kMaxValues = 100000;

class ListReader {
 public:
  ListReader(Field field, bool may_choose) : field_(field), may_choose_(may_choose) {}

  std::vector<double> values;
  std::vector<std::array<double, 2>> chosen;

  void read_item(std::string_view item) {
    const auto parts = split(item, ':');
    if (parts.size() == 1) {
      add(number(parts[0], item));
      return;
    }
    if (parts.size() != 3) fail(fmt::format("a range must be {}, got {}", ranges(), in_quotes(item)));
    if (may_choose_ && parts[2] == "auto") {
      chosen.push_back({number(parts[0], item) + 0.0, number(parts[1], item) + 0.0});  // -0 is 0
      if (!(chosen.back()[0] < chosen.back()[1]))
        fail(fmt::format("a range start:stop:auto must have start < stop, got {}", in_quotes(item)));
      return;
    }
    add_range(number(parts[0], item), number(parts[1], item), number(parts[2], item), item);
  }

  [[noreturn]] void fail(const std::string& text) const { throw InputError(field_, text); }

 private:
  std::string_view ranges() const { return may_choose_ ? "start:stop:step or start:stop:auto" : "start:stop:step"; }

  double number(std::string_view text, std::string_view item) const {
    const std::optional<double> value = number_in(text);
    if (!value) fail(fmt::format("must be numbers a,b,c or ranges {}, got {}", ranges(), in_quotes(item)));
    return *value;
  }

  void add_range(double start, double stop, double step, std::string_view item) {
    if (step == 0.0) fail(fmt::format("the step of a range must not be 0, got {}", in_quotes(item)));
    const double steps = (stop - start) / step;
    if (steps < 0.0)
      fail(fmt::format("the step of a range must lead from start towards stop, got {}", in_quotes(item)));
    if (steps > static_cast<double>(kMaxValues))
      fail(fmt::format("a range may have at most {} values, got {}", kMaxValues, in_quotes(item)));
    // The range includes `stop`, even if rounding errors make start + i * step differ from it slightly.
    const auto last = static_cast<long>(std::floor(steps + 1e-9 * std::max(1.0, steps)));
    for (long i = 0; i <= last; ++i) {
      const double value = start + static_cast<double>(i) * step;
      const bool is_stop = std::abs(value - stop) <= 1e-9 * std::abs(step);
      add(is_stop ? stop : value);
    }
  }

  void add(double value) {
    if (value == 0.0) value = 0.0;  // -0 is 0
    if (!seen_.insert(value).second) return;
    if (values.size() == kMaxValues) fail(fmt::format("a list may have at most {} values", kMaxValues));
    values.push_back(value);
  }

  Field field_;
  bool may_choose_;
  std::unordered_set<double> seen_;
};

void read_items(std::string_view text, ListReader& reader) {
  if (text.find_first_not_of(' ') == std::string_view::npos)
    reader.fail("must contain at least one number, got an empty list");
  for (const std::string_view item : split(text, ',')) reader.read_item(item);
}

}  // namespace

std::vector<double> read_number_list(std::string_view text, Field field) {
  ListReader reader(field, false);
  read_items(text, reader);
  return reader.values;
}

CurveList read_curve_list(std::string_view text, Field field) {
  ListReader reader(field, true);
  read_items(text, reader);
  return {reader.values, reader.chosen};
}

}  // namespace retrace::requests

#include "fabrication/chisel/plan/order.h"

#include <algorithm>

namespace retrace::fabrication {

namespace {

void put_in_order(const std::vector<CutElement>& elements, bool rotated, std::vector<std::int32_t>& order) {
  const auto line_of = [&](std::int32_t k) {
    const CutElement& element = elements[static_cast<std::size_t>(k)];
    return rotated ? element.row : element.column;
  };
  const auto place_of = [&](std::int32_t k) {
    const CutElement& element = elements[static_cast<std::size_t>(k)];
    return rotated ? element.column : element.row;
  };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    if (line_of(a) != line_of(b)) return line_of(a) < line_of(b);
    return place_of(a) < place_of(b);
  });
  // Reverse every second line. Lines without elements are not counted.
  bool backwards = false;
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first, order.end(), [&](std::int32_t k) { return line_of(k) != line_of(*first); });
    if (backwards) std::reverse(first, last);
    backwards = !backwards;
    first = last;
  }
}

}  // namespace

std::map<ElementGroup, std::vector<std::int32_t>> cutting_orders(const std::vector<CutElement>& elements) {
  std::map<ElementGroup, std::vector<std::int32_t>> orders;
  for (std::size_t k = 0; k < elements.size(); ++k)
    orders[{elements[k].rotated, elements[k].orientation}].push_back(static_cast<std::int32_t>(k));
  for (auto& [group, order] : orders) put_in_order(elements, group.first, order);
  return orders;
}

}  // namespace retrace::fabrication

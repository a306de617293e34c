#include "fabrication/plan/order.h"

#include <algorithm>

namespace retrace::fabrication {

std::vector<std::int32_t> cutting_order(const std::vector<CutElement>& elements, bool turned) {
  const auto line_of = [&](std::int32_t k) {
    const CutElement& element = elements[static_cast<std::size_t>(k)];
    return turned ? element.row : element.column;
  };
  const auto place_of = [&](std::int32_t k) {
    const CutElement& element = elements[static_cast<std::size_t>(k)];
    return turned ? element.column : element.row;
  };
  std::vector<std::int32_t> order;
  for (std::size_t k = 0; k < elements.size(); ++k)
    if (elements[k].turned == turned) order.push_back(static_cast<std::int32_t>(k));
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    if (line_of(a) != line_of(b)) return line_of(a) < line_of(b);
    return place_of(a) < place_of(b);
  });
  // Every second line backwards; empty lines do not count.
  bool backwards = false;
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first, order.end(), [&](std::int32_t k) { return line_of(k) != line_of(*first); });
    if (backwards) std::reverse(first, last);
    backwards = !backwards;
    first = last;
  }
  return order;
}

}  // namespace retrace::fabrication

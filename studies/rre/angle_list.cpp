#include "studies/rre/angle_list.h"

#include <algorithm>

namespace retrace::studies {

std::vector<double> equidistant(double last, std::size_t count) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k)
    values.push_back(last * static_cast<double>(k) / static_cast<double>(count - 1));
  return values;
}

void sort_and_remove_repeated(std::vector<double>& angles_deg) {
  std::sort(angles_deg.begin(), angles_deg.end());
  const auto are_equal = [](double a, double b) { return b - a < kSameAngleDeg; };
  angles_deg.erase(std::unique(angles_deg.begin(), angles_deg.end(), are_equal), angles_deg.end());
}

}  // namespace retrace::studies

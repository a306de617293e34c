#include "studies/image/background.h"

#include <algorithm>

namespace retrace::studies {

std::array<double, 3> Background::mean_colour(std::size_t pixel, std::size_t picture_columns,
                                              std::size_t picture_rows) const {
  constexpr int kSamples = 4;  // along each side of a pixel
  const auto own_columns = static_cast<double>(columns);
  const auto own_rows = static_cast<double>(rows);
  const auto wanted_columns = static_cast<double>(picture_columns);
  const auto wanted_rows = static_cast<double>(picture_rows);
  const double scale = std::min(own_columns / wanted_columns, own_rows / wanted_rows);
  std::array<double, 3> sum{};
  for (int k = 0; k < kSamples * kSamples; ++k) {
    const double x = static_cast<double>(pixel % picture_columns) + (k % kSamples + 0.5) / kSamples;
    const double y = static_cast<double>(pixel / picture_columns) + (k / kSamples + 0.5) / kSamples;
    const double column = 0.5 * own_columns + scale * (x - 0.5 * wanted_columns);
    const double row = 0.5 * own_rows + scale * (y - 0.5 * wanted_rows);
    const auto i = static_cast<std::size_t>(std::clamp(column, 0.0, own_columns - 1.0));
    const auto j = static_cast<std::size_t>(std::clamp(row, 0.0, own_rows - 1.0));
    for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(rgb[j * columns + i][c]) / (kSamples * kSamples);
  }
  return sum;
}

}  // namespace retrace::studies

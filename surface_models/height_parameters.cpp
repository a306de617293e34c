#include "surface_models/height_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace retrace::surface_models {

HeightParameters height_parameters(std::span<const double> heights_nm) {
  double sum = 0.0;
  double count = 0.0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double z : heights_nm) {
    if (!std::isfinite(z)) continue;
    sum += z;
    count += 1.0;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  const double mean = sum / count;
  double absolute = 0.0;
  double second = 0.0;
  double third = 0.0;
  double fourth = 0.0;
  for (const double z : heights_nm) {
    if (!std::isfinite(z)) continue;
    const double d = z - mean;
    absolute += std::abs(d);
    second += d * d;
    third += d * d * d;
    fourth += d * d * d * d;
  }
  HeightParameters p;
  p.sa_nm = absolute / count;
  p.sq_nm = std::sqrt(second / count);
  p.sz_nm = high - low;
  // The remaining height of a constant surface is a rounding error of the mean, so skewness and kurtosis stay 0.
  if (p.sq_nm <= 1e-12 * std::max(std::abs(low), std::abs(high))) return p;
  p.ssk = third / count / (p.sq_nm * p.sq_nm * p.sq_nm);
  p.sku = fourth / count / (p.sq_nm * p.sq_nm * p.sq_nm * p.sq_nm);
  return p;
}

Summary summarise(std::span<const double> values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  Summary s;
  s.count = finite.size();
  if (finite.empty()) return s;
  const auto n = static_cast<double>(s.count);
  for (const double value : finite) s.mean += value / n;
  double squares = 0.0;
  for (const double value : finite) squares += (value - s.mean) * (value - s.mean);
  if (s.count > 1) s.standard_deviation = std::sqrt(squares / (n - 1.0));
  std::sort(finite.begin(), finite.end());
  s.median = 0.5 * (finite[(s.count - 1) / 2] + finite[s.count / 2]);
  return s;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace retrace::surface_models

#include "materials/chromaticity.h"

namespace retrace::materials {

Tristimulus tristimulus(const SpectralCurve& power, const ColourMatching& functions) {
  Tristimulus sums{};
  for (std::size_t k = 0; k < sums.size(); ++k)
    for (std::size_t w = 0; w < functions[k].values.size(); ++w)
      sums[k] += power.at(functions[k].wavelengths_nm[w]) * functions[k].values[w];
  return sums;
}

Chromaticity chromaticity(const Tristimulus& values) {
  const double sum = values[0] + values[1] + values[2];
  return {values[0] / sum, values[1] / sum};
}

}  // namespace retrace::materials

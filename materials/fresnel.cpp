#include "materials/fresnel.h"

#include <algorithm>
#include <cmath>

namespace retrace::materials {

FresnelCoefficients fresnel(double index_ratio, double cos_incidence) {
  const double ci = std::clamp(cos_incidence, 0.0, 1.0);
  const double sin2_refracted = index_ratio * index_ratio * (1.0 - ci * ci);
  FresnelCoefficients f;
  if (ci == 0.0) {  // at grazing incidence everything is reflected, for any index ratio
    f.r_s = f.r_p = -1.0;
    f.total_reflection = true;
    return f;
  }
  if (sin2_refracted >= 1.0) {
    f.total_reflection = true;
    // returns (a - i b) / (a + i b) for real a and b
    const auto phase = [](double a, double b) {
      return std::complex<double>(a * a - b * b, -2.0 * a * b) / (a * a + b * b);
    };
    const double decay = std::sqrt(sin2_refracted - 1.0);
    f.r_s = phase(index_ratio * ci, decay);
    f.r_p = phase(ci, index_ratio * decay);
    return f;
  }
  const double ct = std::sqrt(1.0 - sin2_refracted);
  f.cos_refracted = ct;
  const double s_sum = index_ratio * ci + ct;
  const double p_sum = ci + index_ratio * ct;
  f.r_s = (index_ratio * ci - ct) / s_sum;
  f.r_p = (ci - index_ratio * ct) / p_sum;
  const double flux = 2.0 * std::sqrt(index_ratio * ci * ct);
  f.t_s = flux / s_sum;
  f.t_p = flux / p_sum;
  return f;
}

FresnelCoefficients fresnel_metal(std::complex<double> index_ratio, double cos_incidence) {
  const double ci = std::clamp(cos_incidence, 0.0, 1.0);
  // The square root has two values. The value for which the wave decays into the metal is chosen.
  std::complex<double> ct = std::sqrt(1.0 - index_ratio * index_ratio * (1.0 - ci * ci));
  if ((ct / index_ratio).imag() < 0.0) ct = -ct;
  FresnelCoefficients f;
  f.r_s = (index_ratio * ci - ct) / (index_ratio * ci + ct);
  f.r_p = (ci - index_ratio * ct) / (ci + index_ratio * ct);
  f.total_reflection = true;
  return f;
}

double reflectance(double index_ratio, double cos_incidence) {
  const FresnelCoefficients f = fresnel(index_ratio, cos_incidence);
  return 0.5 * (std::norm(f.r_s) + std::norm(f.r_p));
}

}  // namespace retrace::materials

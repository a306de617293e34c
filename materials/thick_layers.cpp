#include "materials/thick_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace retrace::materials {
namespace {

using Complex = std::complex<double>;

/// Products of amplitudes for one order of reflections: s with s, p with p, and s with the conjugate of p. Orders
/// without a fixed phase are combined by adding each of the three products.
using Products = std::array<Complex, 3>;

Products products_of(Complex s, Complex p, double coherence) {
  return {std::norm(s), std::norm(p), coherence * s * std::conj(p)};
}

/// Reflection and transmission of a face for light from one side.
struct Powers {
  Products reflected{};
  Products transmitted{};

  static Powers of(const FresnelCoefficients& f) {
    return {products_of(f.r_s, f.r_p, f.r_coherence), products_of(f.t_s, f.t_p, f.t_coherence)};
  }
};

/// Computes amplitudes from the products of amplitudes. The third product determines the phase difference and the
/// coherence.
void set_amplitudes(const Products& products, Complex& s, Complex& p, double& coherence) {
  const double both = std::sqrt(std::max(0.0, products[0].real()) * std::max(0.0, products[1].real()));
  const double left = std::abs(products[2]);
  const Complex turn = left > 0.0 ? products[2] / left : Complex(1.0);
  s = turn * std::sqrt(std::max(0.0, products[0].real()));
  p = std::sqrt(std::max(0.0, products[1].real()));
  coherence = both > 0.0 ? std::min(1.0, left / both) : 1.0;
}

FresnelCoefficients coefficients_of(const Powers& powers, double cos_refracted, bool is_total) {
  FresnelCoefficients f;
  set_amplitudes(powers.reflected, f.r_s, f.r_p, f.r_coherence);
  set_amplitudes(powers.transmitted, f.t_s, f.t_p, f.t_coherence);
  f.cos_refracted = cos_refracted;
  f.total_reflection = is_total;
  return f;
}

/// Reflection and transmission of one or more faces, for light from both sides.
struct FacePowers {
  Powers ahead;   ///< for light in the direction of the incident light
  Powers behind;  ///< for light in the opposite direction
};

/// Adds the next face to `met`, which contains the faces in front of it. The medium between them transmits the fraction
/// `kept` of the power. All multiple reflections between `met` and the new face are included. Their contributions form
/// a geometric series, which is summed in closed form.
void add(FacePowers& met, double kept, const FacePowers& face) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Complex between = kept * kept * met.behind.reflected[k] * face.ahead.reflected[k];
    const Complex sum = 1.0 / (1.0 - between);
    const Complex once = met.ahead.transmitted[k] * kept * sum;
    const Complex back = face.behind.transmitted[k] * kept * sum;
    const Complex reflected =
        met.ahead.reflected[k] + once * kept * face.ahead.reflected[k] * met.behind.transmitted[k];
    const Complex behind = face.behind.reflected[k] + back * kept * met.behind.reflected[k] * face.ahead.transmitted[k];
    met.ahead.reflected[k] = reflected;
    met.ahead.transmitted[k] = once * face.ahead.transmitted[k];
    met.behind.transmitted[k] = back * met.behind.transmitted[k];
    met.behind.reflected[k] = behind;
  }
}

/// Returns the coefficients of the face between two media. The thin layers are on the face next to the body.
FresnelCoefficients face_between(const LayerStack& thin, StackSide from, bool is_next_to_body, double near, double far,
                                 double cosine) {
  return is_next_to_body ? fresnel_layers(thin, from, near, far, cosine) : fresnel(near / far, cosine);
}

}  // namespace

FresnelCoefficients fresnel_thick_layers(const LayerStack& thin, std::span<const ThickLayer> thick, StackSide from,
                                         double from_index, double to_index, double cos_incidence) {
  if (thick.empty()) return fresnel_layers(thin, from, from_index, to_index, cos_incidence);
  const std::size_t count = thick.size();
  const bool outwards = from == StackSide::body;
  const StackSide against = outwards ? StackSide::outside : StackSide::body;
  const auto layer = [&](std::size_t k) -> const ThickLayer& { return thick[outwards ? k : count - 1 - k]; };
  double near = from_index;
  double cosine = std::clamp(cos_incidence, 0.0, 1.0);
  FacePowers met;
  for (std::size_t k = 0; k <= count; ++k) {
    const bool is_last = k == count;
    const double far = is_last ? to_index : layer(k).index;
    const bool is_next_to_body = outwards ? k == 0 : is_last;
    const FresnelCoefficients f = face_between(thin, from, is_next_to_body, near, far, cosine);
    FacePowers face{Powers::of(f), {}};
    if (!f.total_reflection)
      face.behind = Powers::of(face_between(thin, against, is_next_to_body, far, near, f.cos_refracted));
    if (k == 0)
      met = face;
    else
      add(met, std::exp(-layer(k - 1).absorption_per_mm * layer(k - 1).thickness_mm / cosine), face);
    if (f.total_reflection || is_last) return coefficients_of(met.ahead, f.cos_refracted, f.total_reflection);
    near = far;
    cosine = f.cos_refracted;
  }
  return {};  // not reached, because the loop returns at the last face
}

FresnelCoefficients mixed(const FresnelCoefficients& one, const FresnelCoefficients& other, double fraction_of_other) {
  Powers sum = Powers::of(one);
  const Powers more = Powers::of(other);
  for (std::size_t k = 0; k < 3; ++k) {
    sum.reflected[k] += fraction_of_other * (more.reflected[k] - sum.reflected[k]);
    sum.transmitted[k] += fraction_of_other * (more.transmitted[k] - sum.transmitted[k]);
  }
  return coefficients_of(sum, one.cos_refracted, one.total_reflection);
}

}  // namespace retrace::materials

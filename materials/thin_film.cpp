#include "materials/thin_film.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace retrace::materials {
namespace {

using Complex = std::complex<double>;

/// Returns (exp(z) - 1) / z. A series is used near z = 0, which occurs for thin layers and at grazing incidence.
Complex mean_exponential(Complex z, Complex exponential) {
  constexpr double kSmall = 0.1;
  constexpr int kTerms = 11;  // the first omitted term, 0.1^11 / 12!, is far below the rounding error
  if (std::abs(z) > kSmall) return (exponential - 1.0) / z;
  Complex sum = 1.0;
  for (int k = kTerms; k >= 2; --k) sum = 1.0 + z * sum / static_cast<double>(k);
  return sum;
}

/// Returns the normal component of the wave vector, in units of the wave number in air. It is a square root, which has
/// two values. The value for which the wave decays or propagates forward is returned.
Complex normal_component(Complex index, double tangential2) {
  const Complex w = std::sqrt(index * index - tangential2);
  return w.imag() < 0.0 ? -w : w;
}

/// Tangential fields of one component (s or p) on a plane of the stack, relative to the transmitted field. Exponential
/// growth is scaled out. `field` and `other` are E and H for s, but H and E for p. With this choice, the signs of the
/// amplitudes are those of FresnelCoefficients.
struct TangentialFields {
  Complex field = 1.0;
  Complex other;  ///< initially the admittance of the medium behind the stack
};

/// Transfers the fields from the far side of a layer to its near side with the characteristic matrix. Let w be the
/// normal component of the wave vector in the layer, and let `turn` be 2 pi times the thickness in wavelengths. The
/// layer then changes the phase by the product w * turn. The matrix is multiplied by exp(i * w * turn), so that no
/// element grows even if the layer absorbs strongly.
/// \param along scaled diagonal element of the matrix
/// \param across scaled i * sin(w * turn) / w, from which the off-diagonal elements are computed
/// \param w2 square of w
/// \param weight ratio of the admittance to w: 1 for s, 1 / permittivity for p
void pass(TangentialFields& at, Complex along, Complex across, Complex w2, Complex weight) {
  const Complex far = at.field;
  at.field = along * far - across / weight * at.other;
  at.other = along * at.other - across * w2 * weight * far;
}

/// Returns the reflection amplitude.
/// \param near admittance of the medium of the incident light
Complex reflected(const TangentialFields& at, double near) {
  return (near * at.field - at.other) / (near * at.field + at.other);
}

/// Returns the transmission amplitude, scaled such that its square is a fraction of power.
/// \param far admittance behind the stack
/// \param passed product of the phase factors of all layers
Complex transmitted(const TangentialFields& at, double near, double far, Complex passed) {
  return 2.0 * std::sqrt(near * far) * passed / (near * at.field + at.other);
}

}  // namespace

bool LayerStack::absorbs() const {
  return std::any_of(layers.begin(), layers.end(), [](const ThinLayer& layer) { return layer.index.imag() > 0.0; });
}

bool LayerStack::is_opaque() const {
  return std::any_of(layers.begin(), layers.end(), [](const ThinLayer& layer) { return std::isinf(layer.thickness); });
}

FresnelCoefficients fresnel_layers(const LayerStack& stack, StackSide from, double from_index, double to_index,
                                   double cos_incidence) {
  const std::vector<ThinLayer>& layers = stack.layers;
  const double ratio = from_index / to_index;
  if (layers.empty()) return fresnel(ratio, cos_incidence);
  const auto met = [&](std::size_t k) -> const ThinLayer& {
    return from == StackSide::body ? layers[k] : layers[layers.size() - 1 - k];
  };
  std::size_t count = 0;
  while (count < layers.size() && std::isfinite(met(count).thickness)) ++count;
  const bool ends = count < layers.size();
  if (ends && count == 0) return fresnel_metal(from_index / met(0).index, cos_incidence);

  const double ci = std::clamp(cos_incidence, 0.0, 1.0);
  const double tangential2 = from_index * from_index * (1.0 - ci * ci);
  const double sin2_refracted = ratio * ratio * (1.0 - ci * ci);
  const double root = std::sqrt(std::abs(1.0 - sin2_refracted));
  FresnelCoefficients f;
  f.total_reflection = ends || ci == 0.0 || sin2_refracted >= 1.0;
  if (!f.total_reflection) f.cos_refracted = root;

  const Complex last = ends ? met(count).index : Complex(to_index);
  const Complex far_w = ends                    ? normal_component(last, tangential2)
                        : sin2_refracted >= 1.0 ? Complex(0.0, to_index * root)
                                                : Complex(to_index * root);
  TangentialFields s{1.0, far_w};
  TangentialFields p{1.0, far_w / (last * last)};
  Complex passed = 1.0;
  for (std::size_t k = count; k-- > 0;) {
    const ThinLayer& layer = met(k);
    const Complex permittivity = layer.index * layer.index;
    const Complex i_turn(0.0, 2.0 * std::numbers::pi * layer.thickness);
    const Complex phase = i_turn * normal_component(layer.index, tangential2);
    const Complex once = std::exp(phase);
    const Complex along = 0.5 * (1.0 + once * once);
    const Complex across = i_turn * mean_exponential(2.0 * phase, once * once);
    pass(s, along, across, permittivity - tangential2, 1.0);
    pass(p, along, across, permittivity - tangential2, 1.0 / permittivity);
    passed *= once;
  }
  f.r_s = reflected(s, from_index * ci);
  f.r_p = reflected(p, ci / from_index);
  if (f.total_reflection) return f;
  f.t_s = transmitted(s, from_index * ci, far_w.real(), passed);
  f.t_p = transmitted(p, ci / from_index, far_w.real() / (to_index * to_index), passed);
  return f;
}

}  // namespace retrace::materials

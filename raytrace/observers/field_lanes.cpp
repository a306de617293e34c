#include "raytrace/observers/field_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/observers/field_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file one time for every instruction set
// Must be included after foreach_target.h.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace retrace::raytrace::field_lanes::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

// Fringes are neglected at directions where the lobe of scattered light is below this fraction of its maximum.
constexpr double kMinLobe = 1e-12;

HWY_INLINE V splat(double value) {
  return hn::Set(D(), value);
}

struct Complex {
  V re, im;
};

/// Returns exp(i phase) for phases below 1e9. Multiples of pi / 2 are subtracted first, with pi / 2 as the sum of two
/// numbers. The remaining phase is at most pi / 4. Its sine and cosine are computed by the polynomials of FDLIBM (Sun
/// Microsystems 1993, k_sin.c and k_cos.c), whose errors are below 2^-58. A single reduction for both functions takes
/// about half of the time of hn::Sin and hn::Cos.
HWY_INLINE Complex unit(V phase) {
  const V quarters = hn::Round(hn::Mul(phase, splat(0.6366197723675814)));
  const V left =
      hn::NegMulAdd(quarters, splat(6.123233995736766e-17), hn::NegMulAdd(quarters, splat(1.5707963267948966), phase));
  const V square = hn::Mul(left, left);
  const auto polynomial = [&](const std::array<double, 6>& coefficients) {
    V sum = splat(coefficients.back());
    for (std::size_t k = coefficients.size() - 1; k > 0; --k) sum = hn::MulAdd(sum, square, splat(coefficients[k - 1]));
    return sum;
  };
  const V sine =
      hn::MulAdd(hn::Mul(square, left),
                 polynomial({-1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
                             2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10}),
                 left);
  const V cosine =
      hn::MulAdd(hn::Mul(square, square),
                 polynomial({4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
                             -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11}),
                 hn::NegMulAdd(splat(0.5), square, splat(1.0)));
  // Number of quarters modulo 4: odd numbers exchange sine and cosine.
  const V quadrant = hn::NegMulAdd(splat(4.0), hn::Floor(hn::Mul(quarters, splat(0.25))), quarters);
  const auto is_odd = hn::Or(hn::Eq(quadrant, splat(1.0)), hn::Eq(quadrant, splat(3.0)));
  const V re = hn::IfThenElse(is_odd, sine, cosine);
  const V im = hn::IfThenElse(is_odd, cosine, sine);
  const auto is_negative_re = hn::Or(hn::Eq(quadrant, splat(1.0)), hn::Eq(quadrant, splat(2.0)));
  const auto is_negative_im = hn::Ge(quadrant, splat(2.0));
  return {hn::IfThenElse(is_negative_re, hn::Neg(re), re), hn::IfThenElse(is_negative_im, hn::Neg(im), im)};
}

/// Returns the mean of exp(-i x) over phases x between those of two corners, in the same way as mean_along() of
/// polygon_transform.cpp.
HWY_INLINE Complex mean_along(V phase_from, const Complex& from, V phase_to, const Complex& to) {
  const V step = hn::Sub(phase_to, phase_from);
  const auto is_short = hn::Le(hn::Abs(step), splat(0.05));
  const V inverse = hn::Div(splat(1.0), hn::IfThenElse(is_short, splat(1.0), step));
  Complex mean{hn::Mul(hn::Sub(from.im, to.im), inverse), hn::Mul(hn::Sub(to.re, from.re), inverse)};
  if (hn::AllFalse(D(), is_short)) return mean;
  const V square = hn::Mul(step, step);
  const V series = hn::NegMulAdd(hn::Mul(square, splat(1.0 / 24.0)),
                                 hn::NegMulAdd(square, splat(1.0 / 80.0), splat(1.0)), splat(1.0));
  const Complex middle = unit(hn::Mul(splat(-0.5), hn::Add(phase_from, phase_to)));
  mean.re = hn::IfThenElse(is_short, hn::Mul(series, middle.re), mean.re);
  mean.im = hn::IfThenElse(is_short, hn::Mul(series, middle.im), mean.im);
  return mean;
}

void transform(const Outline& outline, const Block& block_x, const Block& block_y, ComplexBlock& result) {
  for (std::size_t k = 0; k < kBlock; k += hn::Lanes(D())) {
    const V kx = hn::LoadU(D(), block_x.data() + k);
    const V ky = hn::LoadU(D(), block_y.data() + k);
    const V square = hn::MulAdd(kx, kx, hn::Mul(ky, ky));
    const Complex middle =
        unit(hn::Neg(hn::MulAdd(kx, splat(outline.centroid_mm.x()), hn::Mul(ky, splat(outline.centroid_mm.y())))));
    const auto phase_at = [&](const geometry::Vec2& corner) {
      return hn::MulAdd(kx, splat(corner.x()), hn::Mul(ky, splat(corner.y())));
    };
    geometry::Vec2 from = outline.corners_mm.back();
    V phase_from = phase_at(from);
    Complex wave_from = unit(hn::Neg(phase_from));
    Complex sum{hn::Zero(D()), hn::Zero(D())};
    for (const geometry::Vec2& to : outline.corners_mm) {
      const V phase_to = phase_at(to);
      const Complex wave_to = unit(hn::Neg(phase_to));
      const V flux = hn::MulSub(kx, splat(to.y() - from.y()), hn::Mul(ky, splat(to.x() - from.x())));
      const Complex mean = mean_along(phase_from, wave_from, phase_to, wave_to);
      sum.re = hn::MulAdd(flux, mean.re, sum.re);
      sum.im = hn::MulAdd(flux, mean.im, sum.im);
      from = to;
      phase_from = phase_to;
      wave_from = wave_to;
    }
    // If the phase varies by less than 1e-5 over the polygon, the result is the area times the phase factor at the
    // centroid.
    const auto is_flat = hn::Lt(hn::Mul(square, splat(outline.size_mm * outline.size_mm)), splat(1e-10));
    const V over = hn::Div(splat(1.0), hn::IfThenElse(is_flat, splat(1.0), square));
    const V re = hn::IfThenElse(is_flat, splat(outline.area_mm2), hn::Neg(hn::Mul(over, sum.im)));
    const V im = hn::IfThenElseZero(hn::Not(is_flat), hn::Mul(over, sum.re));
    hn::StoreU(hn::MulSub(re, middle.re, hn::Mul(im, middle.im)), D(), result.re.data() + k);
    hn::StoreU(hn::MulAdd(re, middle.im, hn::Mul(im, middle.re)), D(), result.im.data() + k);
  }
}

void add_power(const std::vector<Use>& uses, const std::vector<ComplexBlock>& transforms,
               const std::array<double, 4>& coherency, double copies, Block& sum) {
  for (std::size_t k = 0; k < kBlock; k += hn::Lanes(D())) {
    const V zero = hn::Zero(D());
    Complex xx{zero, zero}, xy{zero, zero}, yx{zero, zero}, yy{zero, zero};
    for (const Use& use : uses) {
      const ComplexBlock& at = transforms[use.outline];
      const V re = hn::LoadU(D(), at.re.data() + k);
      const V im = hn::LoadU(D(), at.im.data() + k);
      const auto add = [&](Complex& to, double a, double b) {
        to.re = hn::NegMulAdd(im, splat(b), hn::MulAdd(re, splat(a), to.re));
        to.im = hn::MulAdd(im, splat(a), hn::MulAdd(re, splat(b), to.im));
      };
      add(xx, use.amplitude[0], use.amplitude[1]);
      add(xy, use.amplitude[2], use.amplitude[3]);
      add(yx, use.amplitude[4], use.amplitude[5]);
      add(yy, use.amplitude[6], use.amplitude[7]);
    }
    const auto power_of_row = [&](const Complex& a, const Complex& b) {
      const V aa = hn::MulAdd(a.re, a.re, hn::Mul(a.im, a.im));
      const V bb = hn::MulAdd(b.re, b.re, hn::Mul(b.im, b.im));
      // Real and imaginary part of a conj(b).
      const V re = hn::MulAdd(a.re, b.re, hn::Mul(a.im, b.im));
      const V im = hn::MulSub(a.im, b.re, hn::Mul(a.re, b.im));
      const V cross = hn::MulSub(splat(coherency[2]), re, hn::Mul(splat(coherency[3]), im));
      return hn::MulAdd(splat(2.0), cross, hn::MulAdd(splat(coherency[0]), aa, hn::Mul(splat(coherency[1]), bb)));
    };
    const V power = hn::Add(power_of_row(xx, xy), power_of_row(yx, yy));
    hn::StoreU(hn::MulAdd(splat(copies), power, hn::LoadU(D(), sum.data() + k)), D(), sum.data() + k);
  }
}

/// Vectors in the plane for several directions. Each SIMD lane contains one vector.
struct Plane {
  V x, y;
};

HWY_INLINE V dot(const Plane& a, const Plane& b) {
  return hn::MulAdd(a.x, b.x, hn::Mul(a.y, b.y));
}

HWY_INLINE Plane product(const Eigen::Matrix2d& matrix, const Plane& a) {
  return {hn::MulAdd(splat(matrix(0, 0)), a.x, hn::Mul(splat(matrix(0, 1)), a.y)),
          hn::MulAdd(splat(matrix(1, 0)), a.x, hn::Mul(splat(matrix(1, 1)), a.y))};
}

/// Returns exp(-(a . moments a) / 2).
HWY_INLINE V gaussian(const Eigen::Matrix2d& moments, const Plane& a) {
  return hn::Exp(D(), hn::Mul(splat(-0.5), dot(a, product(moments, a))));
}

void add_fringes(const Fringes& fringes, double wave_number, const Block& x, const Block& y, Block& sum) {
  const auto difference = [&](const geometry::Vec2& cosines, std::size_t k) {
    return Plane{hn::Mul(splat(wave_number), hn::Sub(hn::LoadU(D(), x.data() + k), splat(cosines.x()))),
                 hn::Mul(splat(wave_number), hn::Sub(hn::LoadU(D(), y.data() + k), splat(cosines.y())))};
  };
  Block kx, ky, lobe, phase;
  bool is_dark = true;
  for (std::size_t k = 0; k < kBlock; k += hn::Lanes(D())) {
    const Plane here = difference(fringes.first_cosines, k);
    const Plane there = difference(fringes.second_cosines, k);
    const Plane back = product(fringes.partner_map.transpose(), there);
    const V height = gaussian(fringes.spread_mm2, there);
    is_dark = is_dark && hn::AllTrue(D(), hn::Lt(height, splat(kMinLobe)));
    hn::StoreU(hn::Sub(here.x, back.x), D(), kx.data() + k);
    hn::StoreU(hn::Sub(here.y, back.y), D(), ky.data() + k);
    hn::StoreU(height, D(), lobe.data() + k);
    hn::StoreU(dot(there, {splat(fringes.shift_mm.x()), splat(fringes.shift_mm.y())}), D(), phase.data() + k);
  }
  ComplexBlock places{};
  if (!is_dark) HWY_NAMESPACE::transform(fringes.outline, kx, ky, places);
  for (std::size_t k = 0; k < kBlock; k += hn::Lanes(D())) {
    const Plane here = difference(fringes.first_cosines, k);
    const Plane there = difference(fringes.second_cosines, k);
    const Plane between{hn::Mul(splat(0.5), hn::Add(here.x, there.x)), hn::Mul(splat(0.5), hn::Add(here.y, there.y))};
    const V dip = hn::Mul(splat(fringes.dip_area_mm2), gaussian(fringes.dip_mm2, between));
    const V height = hn::LoadU(D(), lobe.data() + k);
    const Complex wave = unit(hn::LoadU(D(), phase.data() + k));
    const V re = hn::LoadU(D(), places.re.data() + k);
    const V im = hn::LoadU(D(), places.im.data() + k);
    const V real = hn::MulSub(height, hn::MulSub(wave.re, re, hn::Mul(wave.im, im)), dip);
    const V imaginary = hn::Mul(height, hn::MulAdd(wave.re, im, hn::Mul(wave.im, re)));
    const V power = hn::MulSub(splat(fringes.coefficient[0]), real, hn::Mul(splat(fringes.coefficient[1]), imaginary));
    hn::StoreU(hn::Add(hn::LoadU(D(), sum.data() + k), power), D(), sum.data() + k);
  }
}

}  // namespace retrace::raytrace::field_lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace retrace::raytrace::field_lanes {

HWY_EXPORT(transform);
HWY_EXPORT(add_power);
HWY_EXPORT(add_fringes);

Outline::Outline(const PolygonTransform& transform)
    : centroid_mm(transform.centroid_mm()), area_mm2(transform.area_mm2()), size_mm(transform.size_mm()) {
  for (const geometry::Vec2& corner : transform.polygon()) corners_mm.push_back(corner - centroid_mm);
}

void transform(const Outline& outline, const Block& kx, const Block& ky, ComplexBlock& result) {
  HWY_DYNAMIC_DISPATCH(transform)(outline, kx, ky, result);
}

void add_power(const std::vector<Use>& uses, const std::vector<ComplexBlock>& transforms,
               const std::array<double, 4>& coherency, double copies, Block& sum) {
  HWY_DYNAMIC_DISPATCH(add_power)(uses, transforms, coherency, copies, sum);
}

void add_fringes(const Fringes& fringes, double wave_number, const Block& x, const Block& y, Block& sum) {
  HWY_DYNAMIC_DISPATCH(add_fringes)(fringes, wave_number, x, y, sum);
}

}  // namespace retrace::raytrace::field_lanes
#endif

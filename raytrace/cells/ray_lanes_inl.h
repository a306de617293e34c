// SIMD types for vectors, Stokes parameters and rays. The include guard of this file is special, because
// foreach_target.h includes the file again for each instruction set.
#if defined(RETRACE_RAY_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RETRACE_RAY_LANES_INL_H
#undef RETRACE_RAY_LANES_INL_H
#else
#define RETRACE_RAY_LANES_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "raytrace/cells/cell_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace retrace::raytrace::lanes::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using DI = hn::RebindToSigned<D>;
using VI = hn::Vec<DI>;  ///< labels
/// Vector of values of type T: double or Label.
template <class T>
using VectorOf = hn::Vec<hn::Rebind<T, D>>;

HWY_INLINE V splat(double value) {
  return hn::Set(D(), value);
}
HWY_INLINE VI splat(Label label) {
  return hn::Set(DI(), label);
}
template <class T>
HWY_INLINE VectorOf<T> load(const T* from, std::size_t k) {
  return hn::LoadU(hn::Rebind<T, D>(), from + k);
}
template <class T>
HWY_INLINE void store(VectorOf<T> values, T* to, std::size_t k) {
  hn::StoreU(values, hn::Rebind<T, D>(), to + k);
}
HWY_INLINE VI chosen(M mask, VI yes, VI no) {
  return hn::IfThenElse(hn::RebindMask(DI(), mask), yes, no);
}
HWY_INLINE M are(VI labels, Label wanted) {
  return hn::RebindMask(D(), hn::Eq(labels, splat(wanted)));
}
HWY_INLINE M present(std::size_t k, std::size_t count) {
  return k + hn::Lanes(D()) <= count ? hn::FirstN(D(), hn::Lanes(D())) : hn::FirstN(D(), count - k);
}

struct V3 {
  V x, y, z;
};

HWY_INLINE V3 splat(const geometry::Vec3& v) {
  return {splat(v.x()), splat(v.y()), splat(v.z())};
}
HWY_INLINE V dot(const V3& a, const V3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE V3 cross(const V3& a, const V3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
/// Returns a + t b.
HWY_INLINE V3 along(const V3& a, V t, const V3& b) {
  return {hn::MulAdd(t, b.x, a.x), hn::MulAdd(t, b.y, a.y), hn::MulAdd(t, b.z, a.z)};
}
HWY_INLINE V3 times(V t, const V3& a) {
  return {hn::Mul(t, a.x), hn::Mul(t, a.y), hn::Mul(t, a.z)};
}
/// Normalizes vectors whose length differs from 1 only by rounding, with one Newton step for 1 / |a|.
HWY_INLINE V3 renormalised(const V3& a) {
  return times(hn::NegMulAdd(splat(0.5), dot(a, a), splat(1.5)), a);
}
HWY_INLINE V3 load3(const Rays& rays, std::size_t first, std::size_t k) {
  return {load(rays[first], k), load(rays[first + 1], k), load(rays[first + 2], k)};
}
HWY_INLINE void store3(const V3& v, const Rays& rays, std::size_t first, std::size_t k) {
  store(v.x, rays[first], k);
  store(v.y, rays[first + 1], k);
  store(v.z, rays[first + 2], k);
}
HWY_INLINE V3 chosen(M mask, const V3& yes, const V3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

/// Stokes parameters of several rays, one ray per SIMD lane.
struct S {
  V i, q, u, v;
};

HWY_INLINE S load_light(const Rays& rays, std::size_t k) {
  return {load(rays[kI], k), load(rays[kQ], k), load(rays[kU], k), load(rays[kV], k)};
}
HWY_INLINE void store_light(const S& s, const Rays& rays, std::size_t k) {
  store(s.i, rays[kI], k);
  store(s.q, rays[kQ], k);
  store(s.u, rays[kU], k);
  store(s.v, rays[kV], k);
}
HWY_INLINE S scaled(const S& s, V factor) {
  return {hn::Mul(s.i, factor), hn::Mul(s.q, factor), hn::Mul(s.u, factor), hn::Mul(s.v, factor)};
}
HWY_INLINE S where(M mask, const S& s) {
  return {hn::IfThenElseZero(mask, s.i), hn::IfThenElseZero(mask, s.q), hn::IfThenElseZero(mask, s.u),
          hn::IfThenElseZero(mask, s.v)};
}
HWY_INLINE double total(V values) {
  return hn::GetLane(hn::SumOfLanes(D(), values));
}
HWY_INLINE Stokes total(const S& s) {
  return {total(s.i), total(s.q), total(s.u), total(s.v)};
}

/// Writes the lanes selected by `mask` to `to`, without gaps. Highway's Compress is not used, because it copies its
/// tables to the stack with GCC 12.
HWY_INLINE void append(V values, M mask, double* to) {
#if HWY_TARGET <= HWY_AVX3
  hn::StoreU(V{_mm512_maskz_compress_pd(mask.raw, values.raw)}, D(), to);
#else
  double lanes[8];
  hn::StoreU(values, D(), lanes);
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(D(), mask, bits);
  for (unsigned left = bits[0]; left != 0; left &= left - 1) *to++ = lanes[hwy::Num0BitsBelowLS1Bit_Nonzero32(left)];
#endif
}

HWY_INLINE void append3(const V3& v, M mask, const Rays& to, std::size_t first, std::size_t found) {
  append(v.x, mask, to[first] + found);
  append(v.y, mask, to[first + 1] + found);
  append(v.z, mask, to[first + 2] + found);
}

/// Appends the rays selected by `mask` behind the first `found` rays of `to`.
/// \param from arrays from which the remaining values (origin of the period, owner) are copied, at index k
/// \param to passed by value; the compiler then need not reload the pointers after each store
HWY_INLINE void append_ray(const V3& place, const V3& direction, const S& light, const V3& axis, M mask,
                           const Rays& from, std::size_t k, const Rays to, std::size_t found) {
  append3(place, mask, to, kX, found);
  append3(direction, mask, to, kDx, found);
  append(light.i, mask, to[kI] + found);
  append(light.q, mask, to[kQ] + found);
  append(light.u, mask, to[kU] + found);
  append(light.v, mask, to[kV] + found);
  append3(axis, mask, to, kAx, found);
  for (std::size_t number = kComponentsOfInfinite; number < to.component_count; ++number)
    append(load(from[number], k), mask, to[number] + found);
}

}  // namespace retrace::raytrace::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // RETRACE_RAY_LANES_INL_H

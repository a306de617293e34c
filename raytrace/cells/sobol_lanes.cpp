#include "raytrace/cells/cell_lanes.h"

#include <bit>

#include "raytrace/sampling/sobol.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/cells/sobol_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file one time for every instruction set
// Must be included after foreach_target.h.
#include "raytrace/cells/ray_lanes_inl.h"

HWY_BEFORE_NAMESPACE();
namespace retrace::raytrace::lanes::HWY_NAMESPACE {

using U = hn::ScalableTag<std::uint32_t>;
using VU = hn::Vec<U>;

HWY_INLINE VU mixed(VU node, std::uint64_t key) {
  const U u;
  VU x = hn::Add(hn::Mul(node, hn::Set(u, 0x9e3779b9U)), hn::Set(u, static_cast<std::uint32_t>(key)));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<17>(x)), hn::Set(u, 0xed5ad4bbU));
  x = hn::Add(x, hn::Set(u, static_cast<std::uint32_t>(key >> 32)));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<11>(x)), hn::Set(u, 0xac4c1b51U));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<15>(x)), hn::Set(u, 0x31848babU));
  return hn::Xor(x, hn::ShiftRight<14>(x));
}

/// Returns `digits` after the bits given by nested_flips() have been flipped (nested scrambling).
HWY_INLINE VU scrambled(VU digits, std::uint64_t key) {
  const U u;
  const VU one = hn::Set(u, 1);
  VU left = digits;
  VU flips = hn::Zero(u);
  VU node = one;
  for (int block = 0; block < kScrambleBlocks; ++block) {
    const VU hash = mixed(node, key);
    VU below = one;
    for (int level = 0; level < kScrambleLevels; ++level) {
      flips = hn::Or(hn::Add(flips, flips), hn::And(hn::Shr(hash, below), one));
      below = hn::Or(hn::Add(below, below), hn::ShiftRight<31>(left));
      left = hn::Add(left, left);
    }
    node = hn::Or(hn::ShiftLeft<kScrambleLevels>(node), hn::And(below, hn::Set(u, (1U << kScrambleLevels) - 1U)));
  }
  const VU rest = hn::ShiftRight<32 - kScrambleRest>(mixed(node, key));
  return hn::Xor(digits, hn::Or(hn::ShiftLeft<kScrambleRest>(flips), rest));
}

/// Stores the digits as fractions in [0, 1), multiplied by `size`.
HWY_INLINE void store_fractions(VU digits, double size, double* to) {
  const hn::RebindToUnsigned<D> wide;
  std::array<std::uint32_t, kPadding> buffer;
  hn::StoreU(digits, U(), buffer.data());
  for (std::size_t at = 0; at < hn::Lanes(U()); at += hn::Lanes(D())) {
    const auto words = hn::PromoteTo(wide, hn::LoadU(hn::Rebind<std::uint32_t, D>(), buffer.data() + at));
    store(hn::Mul(hn::ConvertTo(D(), hn::BitCast(hn::RebindToSigned<D>(), words)), splat(size * 0x1p-32)), to, at);
  }
}

void sobol(std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first, std::size_t count, const geometry::Vec2& size,
           double* x, double* y) {
  const U u;
  // The digits of consecutive points differ by a mask that depends only on the number of trailing ones of the index.
  std::array<std::array<std::uint32_t, 2>, 33> steps{};
  for (std::size_t ones = 0; ones < 32; ++ones) steps[ones] = SobolSquare::digits((2U << ones) - 1U);
  steps[32] = steps[31];
  std::uint32_t index = first;
  std::array<std::uint32_t, 2> digits = SobolSquare::digits(first);
  for (std::size_t i = 0; i < count; i += hn::Lanes(u)) {
    std::array<std::array<std::uint32_t, kPadding>, 2> point{};
    for (std::size_t lane = 0; lane < hn::Lanes(u); ++lane) {
      point[0][lane] = digits[0];
      point[1][lane] = digits[1];
      const auto& step = steps[static_cast<std::size_t>(std::countr_one(index))];
      digits[0] ^= step[0];
      digits[1] ^= step[1];
      ++index;
    }
    store_fractions(scrambled(hn::LoadU(u, point[0].data()), key_x), size.x(), x + i);
    store_fractions(scrambled(hn::LoadU(u, point[1].data()), key_y), size.y(), y + i);
  }
}

}  // namespace retrace::raytrace::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace retrace::raytrace::lanes {

HWY_EXPORT(sobol);

void sobol(std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first, std::size_t count, const geometry::Vec2& size,
           double* x, double* y) {
  HWY_DYNAMIC_DISPATCH(sobol)(key_x, key_y, first, count, size, x, y);
}

}  // namespace retrace::raytrace::lanes
#endif

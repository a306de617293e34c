#include "raytrace/cells/cell_lanes.h"

#include <bit>

#include "raytrace/sampling/sobol.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/cells/cell_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for every instruction set
// After foreach_target.h.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace retrace::raytrace::lanes::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V splat(double value) {
  return hn::Set(D(), value);
}
HWY_INLINE V load(const double* from, std::size_t k) {
  return hn::LoadU(D(), from + k);
}
HWY_INLINE void store(V values, double* to, std::size_t k) {
  hn::StoreU(values, D(), to + k);
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
/// a + t b
HWY_INLINE V3 along(const V3& a, V t, const V3& b) {
  return {hn::MulAdd(t, b.x, a.x), hn::MulAdd(t, b.y, a.y), hn::MulAdd(t, b.z, a.z)};
}
HWY_INLINE V3 times(V t, const V3& a) {
  return {hn::Mul(t, a.x), hn::Mul(t, a.y), hn::Mul(t, a.z)};
}
/// Of vectors that have unit length but for rounding: one step of Newton's towards 1 / |a|.
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

/// Stokes parameters.
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

/// As Light::turn_to_axis(), with axes of any length. \param over 1 / (|axis|^2 |to|^2)
HWY_INLINE S turned(const S& light, const V3& direction, const V3& axis, const V3& to, V over) {
  const V c = dot(to, axis);
  const V s = dot(to, cross(direction, axis));
  const V c2 = hn::Mul(over, hn::MulSub(c, c, hn::Mul(s, s)));
  const V s2 = hn::Mul(over, hn::Mul(hn::Add(c, c), s));
  return {light.i, hn::MulAdd(c2, light.q, hn::Mul(s2, light.u)), hn::MulSub(c2, light.u, hn::Mul(s2, light.q)),
          light.v};
}

/// Takes what the way of a ray costs from its light; returns the power.
HWY_INLINE V absorbed(const Rays& rays, std::size_t k, std::size_t count, V way, double absorption_per_mm) {
  const S before = load_light(rays, k);
  const S after = scaled(before, hn::Exp(D(), hn::Mul(way, splat(-absorption_per_mm))));
  store_light(after, rays, k);
  return hn::IfThenElseZero(present(k, count), hn::Sub(before.i, after.i));
}

/// A way along a ray as a fraction, so that many are compared with one division at the end.
struct Way {
  V over;   ///< not negative
  V under;  ///< not negative; 0 for what is never met

  HWY_INLINE V length() const { return hn::Div(over, under); }
};
HWY_INLINE M is_less(const Way& a, const Way& b) {
  return hn::Lt(hn::Mul(a.over, b.under), hn::Mul(b.over, a.under));
}
HWY_INLINE Way chosen(M mask, const Way& yes, const Way& no) {
  return {hn::IfThenElse(mask, yes.over, no.over), hn::IfThenElse(mask, yes.under, no.under)};
}

/// The nearest so far of what rays may meet.
struct Nearest {
  Way way;
  V which;
  V3 normal;

  HWY_INLINE M consider(const Way& next, V number) {
    const M nearer = is_less(next, way);
    way = chosen(nearer, next, way);
    which = hn::IfThenElse(nearer, number, which);
    return nearer;
  }
};

/// What is numbered 1, infinitely far.
HWY_INLINE Nearest nothing() {
  return {{splat(1.0), hn::Zero(D())}, splat(1.0), splat(geometry::Vec3(0.0, 0.0, 1.0))};
}

/// Along rays to a plane that they approach from its inner side, never less than 0.
HWY_INLINE Way way_to(const Plane& plane, const V3& p, const V3& d) {
  const V3 n = splat(plane.normal);
  const V zero = hn::Zero(D());
  return {hn::Max(hn::Sub(splat(plane.offset_mm), dot(n, p)), zero), hn::Max(dot(n, d), zero)};
}

HWY_INLINE void find_border(std::span<const Plane> borders, const V3& p, const V3& d, Nearest& nearest) {
  double number = 2.0;
  for (const Plane& border : borders) {
    nearest.consider(way_to(border, p, d), splat(number));
    number += 1.0;
  }
}

HWY_INLINE void store_met(const Nearest& nearest, V way, const V3& p, const V3& d, const Rays& rays, const Met& met,
                          std::size_t k) {
  store3(along(p, way, d), rays, kX, k);
  store(nearest.which, met.which, k);
  store(nearest.normal.x, met.normal[0], k);
  store(nearest.normal.y, met.normal[1], k);
  store(nearest.normal.z, met.normal[2], k);
}

double advance_inside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double top_mm,
                      std::span<const Plane> borders, double absorption_per_mm, const Met& met) {
  V lost = hn::Zero(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const V3 p = load3(rays, kX, k);
    const V3 d = load3(rays, kDx, k);
    Nearest nearest = nothing();
    for (const Plane& facet : facets) {
      const M nearer = nearest.consider(way_to(facet, p, d), hn::Zero(D()));
      nearest.normal = chosen(nearer, splat(facet.normal), nearest.normal);
    }
    nearest.consider(way_to({geometry::Vec3::UnitZ(), top_mm}, p, d), splat(1.0));
    find_border(borders, p, d, nearest);
    const V way = nearest.way.length();
    store_met(nearest, way, p, d, rays, met, k);
    if (absorption_per_mm > 0.0) lost = hn::Add(lost, absorbed(rays, k, count, way, absorption_per_mm));
  }
  return total(lost);
}

void advance_outside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double depth_mm,
                     std::span<const Plane> borders, const Met& met) {
  const V infinite = hn::Inf(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const V3 p = load3(rays, kX, k);
    const V3 d = load3(rays, kDx, k);
    Nearest nearest = nothing();
    nearest.consider(way_to({-geometry::Vec3::UnitZ(), depth_mm}, p, d), splat(1.0));
    find_border(borders, p, d, nearest);
    V way = nearest.way.length();
    // Into the convex body after the last plane that is entered, before the first that is left.
    V in = hn::Neg(infinite);
    V out = infinite;
    for (const Plane& facet : facets) {
      const V3 n = splat(facet.normal);
      const V towards = dot(n, d);
      const V t = hn::Div(hn::Sub(splat(facet.offset_mm), dot(n, p)), towards);
      const M enters = hn::And(hn::Lt(towards, hn::Zero(D())), hn::Gt(t, in));
      in = hn::IfThenElse(enters, t, in);
      nearest.normal = chosen(enters, n, nearest.normal);
      const M leaves = hn::Gt(towards, hn::Zero(D()));
      out = hn::IfThenElse(leaves, hn::Min(out, t), out);
    }
    const M is_hit = hn::And(hn::And(hn::Lt(in, out), hn::Gt(out, hn::Zero(D()))),
                             hn::And(hn::Lt(in, way), hn::Gt(in, hn::Neg(infinite))));
    way = hn::IfThenElse(is_hit, hn::Max(in, hn::Zero(D())), way);
    nearest.which = hn::IfThenElse(is_hit, hn::Zero(D()), nearest.which);
    store_met(nearest, way, p, d, rays, met, k);
  }
}

HWY_INLINE V value(const LinearForm& form, V x, V y) {
  return hn::MulAdd(splat(form.x), x, hn::MulAdd(splat(form.y), y, splat(form.c)));
}

void refine(const Rays& rays, std::size_t count, const Border& border, double number, double to, double* which) {
  const D d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V before = load(which, i);
    const M here = hn::Eq(before, splat(number));
    if (hn::AllFalse(d, here)) continue;
    const V3 p = load3(rays, kX, i);
    const V s = value(border.along, p.x, p.y);
    V stretch = hn::Zero(d);
    for (const double limit : border.limits)
      stretch = hn::Add(stretch, hn::IfThenElseZero(hn::Ge(s, splat(limit)), splat(1.0)));
    V result = hn::MulAdd(stretch, splat(2.0), splat(to));
    double k = 0.0;
    for (const Border::Stretch& beyond : border.stretches) {
      if (!beyond.is_level) {
        const V x = hn::Add(p.x, splat(beyond.shift.x()));
        const V y = hn::Add(p.y, splat(beyond.shift.y()));
        V highest = hn::Neg(hn::Inf(d));
        for (const LinearForm& form : beyond.heights) highest = hn::Max(highest, value(form, x, y));
        const M is_above = hn::Ge(p.z, highest);
        const M meets_wall = border.inside ? hn::Not(is_above) : is_above;
        result = hn::Add(result, hn::IfThenElseZero(hn::And(meets_wall, hn::Eq(stretch, splat(k))), splat(1.0)));
      }
      k += 1.0;
    }
    store(hn::IfThenElse(here, result, before), which, i);
  }
}

/// Appends the chosen lanes. By hand: Highway's Compress copies its tables to the stack under GCC 12.
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

/// \param from where the ray's other numbers are, at k
/// \param to by value: stores must not make the compiler read the pointers again
HWY_INLINE void append_ray(const V3& place, const V3& direction, const S& light, const V3& axis, M mask,
                           const Rays& from, std::size_t k, const Rays to, std::size_t found) {
  append3(place, mask, to, kX, found);
  append3(direction, mask, to, kDx, found);
  append(light.i, mask, to[kI] + found);
  append(light.q, mask, to[kQ] + found);
  append(light.u, mask, to[kU] + found);
  append(light.v, mask, to[kV] + found);
  append3(axis, mask, to, kAx, found);
  for (std::size_t number = kNumbersOfEndless; number < to.numbers; ++number)
    append(load(from[number], k), mask, to[number] + found);
}

std::size_t select(const double* which, double wanted, std::size_t count, const Rays& all_from, const Rays& all_to) {
  const Rays from = all_from;
  const Rays to = all_to;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
    const M mask = hn::And(hn::Eq(load(which, i), splat(wanted)), present(i, count));
    const std::size_t more = hn::CountTrue(D(), mask);
    if (more == 0) continue;
    for (std::size_t k = 0; k < from.numbers; ++k) append(load(from[k], i), mask, to[k] + found);
    found += more;
  }
  return found;
}

void mark_polygon(const Rays& rays, std::size_t count, std::span<const LinearForm> forms,
                  std::span<const std::uint32_t> first_form, double* which) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
    const V x = load(rays[kX], i);
    const V y = load(rays[kY], i);
    V first = splat(static_cast<double>(first_form.size() - 1));
    for (std::size_t k = first_form.size() - 1; k-- > 0;) {
      V least = hn::Inf(D());
      for (std::uint32_t f = first_form[k]; f < first_form[k + 1]; ++f) least = hn::Min(least, value(forms[f], x, y));
      first = hn::IfThenElse(hn::Ge(least, hn::Zero(D())), splat(static_cast<double>(k)), first);
    }
    store(first, which, i);
  }
}

std::size_t mark_weak(const Rays& rays, double limit, std::size_t count, double* which) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
    const M is_weak = hn::Lt(load(rays[kI], i), splat(limit));
    store(hn::IfThenElseZero(is_weak, splat(1.0)), which, i);
    found += hn::CountTrue(D(), hn::And(is_weak, present(i, count)));
  }
  return found;
}

HWY_INLINE void add(V more, double* to, std::size_t k) {
  store(hn::Add(load(to, k), more), to, k);
}

void shift(const Rays& rays, std::size_t count, const geometry::Vec2& shift) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
    add(splat(shift.x()), rays[kX], i);
    add(splat(shift.y()), rays[kY], i);
    if (!rays.have_periods()) continue;
    add(splat(-shift.x()), rays[kOx], i);
    add(splat(-shift.y()), rays[kOy], i);
  }
}

std::size_t mark_beyond(const Rays& rays, std::size_t count, const Reach& reach, double of, double number,
                        double* which) {
  const D d;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V before = load(which, i);
    const M asked = hn::And(hn::Eq(before, splat(of)), present(i, count));
    if (hn::AllFalse(d, asked)) continue;
    V x = hn::Add(load(rays[kX], i), load(rays[kOx], i));
    V y = hn::Add(load(rays[kY], i), load(rays[kOy], i));
    if (reach.height_mm != 0.0) {
      const V way = hn::Div(splat(reach.height_mm), load(rays[kDz], i));
      x = hn::MulAdd(way, load(rays[kDx], i), x);
      y = hn::MulAdd(way, load(rays[kDy], i), y);
    }
    const M within = hn::And(hn::And(hn::Ge(x, splat(reach.lower.x())), hn::Le(x, splat(reach.upper.x()))),
                             hn::And(hn::Ge(y, splat(reach.lower.y())), hn::Le(y, splat(reach.upper.y()))));
    const M beyond = hn::AndNot(within, asked);
    store(hn::IfThenElse(beyond, splat(number), before), which, i);
    found += hn::CountTrue(d, beyond);
  }
  return found;
}

/// Reflected and transmitted light and directions at interfaces of transparent media, as materials::fresnel().
struct Interface {
  S reflected, transmitted;
  V3 mirrored, refracted;
  V3 axis;  ///< of both
};

/// An axis across the plane of incidence. At normal incidence s and p are alike, any axis serves.
HWY_INLINE V3 axis_at(const V3& d, const V3& axis, const V3& against) {
  const V3 across = cross(d, against);
  return chosen(hn::Lt(dot(across, across), splat(1e-16)), axis, across);
}

/// \param against the normal against the light
HWY_INLINE Interface met(const S& light, const V3& d, const V3& axis, const V3& against, double index_ratio) {
  const D tag;
  const V zero = hn::Zero(tag);
  const V one = splat(1.0);
  const V ratio = splat(index_ratio);
  const V ci = hn::Min(one, hn::Max(zero, hn::Neg(dot(against, d))));
  const V sin2 = hn::Mul(hn::Mul(ratio, ratio), hn::NegMulAdd(ci, ci, one));
  // At grazing incidence everything is reflected, whatever the ratio.
  const M grazes = hn::Le(ci, zero);
  const M total = hn::Or(hn::Ge(sin2, one), grazes);
  const V root = hn::Sqrt(hn::Abs(hn::Sub(one, sin2)));
  const V a_s = hn::Mul(ratio, ci);
  const V b_p = hn::Mul(ratio, root);

  Interface face;
  face.axis = axis_at(d, axis, against);
  // Both fractions of what follows from one division: it takes longer than everything else.
  const V axes2 = hn::Mul(dot(axis, axis), dot(face.axis, face.axis));
  const V sum_s = hn::Add(a_s, root);
  const V sum_p = hn::Add(ci, b_p);
  const V norm =
      hn::IfThenElse(total, hn::Mul(hn::MulAdd(a_s, a_s, hn::Mul(root, root)), hn::MulAdd(ci, ci, hn::Mul(b_p, b_p))),
                     hn::Mul(sum_s, sum_p));
  const V safe = hn::Max(norm, splat(1e-200));
  const V over_both = hn::Div(one, hn::Mul(safe, axes2));
  const V over = hn::Mul(over_both, axes2);
  const S in = turned(light, d, axis, face.axis, hn::Mul(over_both, safe));
  const V s = hn::Mul(splat(0.5), hn::Add(in.i, in.q));
  const V p = hn::Mul(splat(0.5), hn::Sub(in.i, in.q));

  // Partial reflection: real amplitudes. Total: (a - i b) / (a + i b), so that r_s conj(r_p) is a phase.
  const V r_s = hn::Mul(over, hn::Mul(hn::Sub(a_s, root), sum_p));
  const V r_p = hn::Mul(over, hn::Mul(hn::Sub(ci, b_p), sum_s));
  // (a_s - i root)^2 (ci + i b_p)^2 / norm
  const V re_s = hn::MulSub(a_s, a_s, hn::Mul(root, root));
  const V im_s = hn::Mul(splat(-2.0), hn::Mul(a_s, root));
  const V re_p = hn::MulSub(ci, ci, hn::Mul(b_p, b_p));
  const V im_p = hn::Mul(splat(2.0), hn::Mul(ci, b_p));
  const V total_re = hn::IfThenElse(grazes, one, hn::Mul(over, hn::MulSub(re_s, re_p, hn::Mul(im_s, im_p))));
  const V total_im = hn::IfThenElseZero(hn::Not(grazes), hn::Mul(over, hn::MulAdd(re_s, im_p, hn::Mul(im_s, re_p))));
  const V power_s = hn::IfThenElse(total, one, hn::Mul(r_s, r_s));
  const V power_p = hn::IfThenElse(total, one, hn::Mul(r_p, r_p));
  const V re = hn::IfThenElse(total, total_re, hn::Mul(r_s, r_p));
  const V im = hn::IfThenElseZero(total, total_im);
  const V rs = hn::Mul(s, power_s);
  const V rp = hn::Mul(p, power_p);
  face.reflected = {hn::Add(rs, rp), hn::Sub(rs, rp), hn::MulSub(re, in.u, hn::Mul(im, in.v)),
                    hn::MulAdd(re, in.v, hn::Mul(im, in.u))};
  const V ts = hn::Mul(s, hn::Sub(one, power_s));
  const V tp = hn::Mul(p, hn::Sub(one, power_p));
  // t_s t_p = 4 ratio ci root / ((a_s + root) (ci + b_p)), of amplitudes whose squares are shares of power
  const V both =
      hn::IfThenElseZero(hn::Not(total), hn::Mul(over, hn::Mul(splat(4.0 * index_ratio), hn::Mul(ci, root))));
  face.transmitted = {hn::Add(ts, tp), hn::Sub(ts, tp), hn::Mul(both, in.u), hn::Mul(both, in.v)};
  face.mirrored = renormalised(along(d, hn::Add(ci, ci), against));
  face.refracted = renormalised(along(times(ratio, d), hn::MulSub(ratio, ci, root), against));
  return face;
}

/// Of the rays that meet a face, those that take each branch.
struct Chosen {
  M reflected, transmitted;
};

/// Scales what goes on.
HWY_INLINE Chosen choose(const Meeting& meeting, std::size_t k, M here, S& reflected, S& transmitted) {
  constexpr double kGolden = 0.6180339887498949;  // its multiples fill the circle most evenly
  const V r = reflected.i;
  const V t = transmitted.i;
  const V power = hn::Add(r, t);
  const M both = hn::Ge(hn::Min(r, t), splat(meeting.split_power));
  const V number = hn::Add(hn::Iota(D(), 0.0), splat(static_cast<double>(k)));
  const V at = hn::MulAdd(number, splat(kGolden), splat(meeting.start));
  const V u = hn::Sub(at, hn::Floor(at));
  const M takes_reflected = hn::Lt(hn::Mul(u, power), r);
  // All light reflected, or none of it to be chosen from.
  if (hn::AllTrue(D(), hn::Or(hn::Or(both, hn::Not(here)), hn::Le(t, hn::Zero(D())))))
    return {here, hn::And(here, both)};
  // The whole power to the branch that is taken.
  const V factor = hn::IfThenElse(both, splat(1.0), hn::Div(power, hn::IfThenElse(takes_reflected, r, t)));
  reflected = scaled(reflected, factor);
  transmitted = scaled(transmitted, factor);
  return {hn::And(here, hn::Or(both, takes_reflected)), hn::And(here, hn::Or(both, hn::Not(takes_reflected)))};
}

HWY_INLINE M those(const Meeting& meeting, std::size_t k, std::size_t count) {
  return hn::And(hn::Eq(load(meeting.met.which, k), splat(meeting.number)), present(k, count));
}

HWY_INLINE V3 normal_of(const Meeting& meeting, std::size_t k) {
  return times(splat(meeting.towards_light),
               {load(meeting.met.normal[0], k), load(meeting.met.normal[1], k), load(meeting.met.normal[2], k)});
}

Branches meet_faces(const Rays& rays, std::size_t count, const Meeting& meeting, double index_ratio,
                    const Rays& reflected, const Rays& transmitted) {
  Branches found;
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const M here = those(meeting, k, count);
    if (hn::AllFalse(D(), here)) continue;
    found.count += hn::CountTrue(D(), here);
    const V3 place = load3(rays, kX, k);
    Interface face =
        met(load_light(rays, k), load3(rays, kDx, k), load3(rays, kAx, k), normal_of(meeting, k), index_ratio);
    const Chosen take = choose(meeting, k, here, face.reflected, face.transmitted);
    append_ray(place, face.mirrored, face.reflected, face.axis, take.reflected, rays, k, reflected, found.reflected);
    found.reflected += hn::CountTrue(D(), take.reflected);
    if (hn::AllFalse(D(), take.transmitted)) continue;
    append_ray(place, face.refracted, face.transmitted, face.axis, take.transmitted, rays, k, transmitted,
               found.transmitted);
    found.transmitted += hn::CountTrue(D(), take.transmitted);
  }
  return found;
}

std::size_t meet_mirrors(const Rays& rays, std::size_t count, const Meeting& meeting, const Rays& reflected) {
  std::size_t found = 0;
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const M here = those(meeting, k, count);
    if (hn::AllFalse(D(), here)) continue;
    const V3 d = load3(rays, kDx, k);
    const V3 axis = load3(rays, kAx, k);
    const V3 against = normal_of(meeting, k);
    const V3 to = axis_at(d, axis, against);
    // r_s = -1, r_p = 1
    const V axes2 = hn::Mul(dot(axis, axis), dot(to, to));
    const S in = turned(load_light(rays, k), d, axis, to, hn::Div(splat(1.0), axes2));
    append_ray(load3(rays, kX, k), renormalised(along(d, hn::Mul(splat(-2.0), dot(against, d)), against)),
               {in.i, in.q, hn::Neg(in.u), hn::Neg(in.v)}, to, here, rays, k, reflected, found);
    found += hn::CountTrue(D(), here);
  }
  return found;
}

Arrivals meet_entrance(const Rays& rays, std::size_t count, const Meeting& meeting, const Entrance& entrance,
                       const Rays& reflected, std::span<Stokes> returned, const Rays* left_rays) {
  const D tag;
  const V zero = hn::Zero(tag);
  Arrivals arrivals;
  V lost = zero;
  const V3 down = splat(geometry::Vec3(0.0, 0.0, -1.0));
  const V3 to_source = splat(entrance.to_source);
  for (std::size_t k = 0; k < count; k += hn::Lanes(tag)) {
    const M here = those(meeting, k, count);
    if (hn::AllFalse(tag, here)) continue;
    arrivals.count += hn::CountTrue(tag, here);
    const V3 d = load3(rays, kDx, k);
    const V way = hn::Div(splat(entrance.height_mm), d.z);
    const V3 place = along(load3(rays, kX, k), way, d);
    S light = load_light(rays, k);
    if (entrance.absorption_per_mm > 0.0) {
      const S after = scaled(light, hn::Exp(tag, hn::Mul(way, splat(-entrance.absorption_per_mm))));
      lost = hn::Add(lost, hn::IfThenElseZero(here, hn::Sub(light.i, after.i)));
      light = after;
    }
    const V3 axis = load3(rays, kAx, k);
    Interface face = met(light, d, axis, down, entrance.index);
    const M is_total = hn::Le(face.transmitted.i, zero);
    Chosen take{here, here};
    if (entrance.is_lossless) {
      // Beyond the critical angle light ends here.
      const V axes2 = hn::Mul(dot(axis, axis), dot(face.axis, face.axis));
      face.transmitted = turned(light, d, axis, face.axis, hn::Div(splat(1.0), axes2));
      returned.back().i += total(hn::IfThenElseZero(hn::And(here, is_total), light.i));
      take = {hn::Lt(zero, zero), hn::AndNot(is_total, here)};
    } else {
      take = choose(meeting, k, here, face.reflected, face.transmitted);
    }
    // source_axis(): +x, less what lies along the direction.
    const V3 out = face.refracted;
    const V3 x{hn::NegMulAdd(out.x, out.x, splat(1.0)), hn::Neg(hn::Mul(out.x, out.y)), hn::Neg(hn::Mul(out.x, out.z))};
    const V axes2 = hn::Mul(dot(face.axis, face.axis), dot(x, x));
    const S seen = turned(face.transmitted, out, face.axis, x, hn::Div(splat(1.0), axes2));
    if (left_rays != nullptr && !hn::AllFalse(tag, take.transmitted)) {
      append_ray(place, out, seen, x, take.transmitted, rays, k, *left_rays, arrivals.left);
      arrivals.left += hn::CountTrue(tag, take.transmitted);
    }
    const V3 off{hn::Sub(out.x, to_source.x), hn::Sub(out.y, to_source.y), hn::Sub(out.z, to_source.z)};
    const V chord2 = dot(off, off);
    M left = take.transmitted;
    for (std::size_t cone = 0; cone < entrance.cone_chord2.size() && !hn::AllFalse(tag, left); ++cone) {
      const M in_cone = hn::And(left, hn::Le(chord2, splat(entrance.cone_chord2[cone])));
      if (!hn::AllFalse(tag, in_cone)) returned[cone] += total(where(in_cone, seen));
      left = hn::AndNot(in_cone, left);
    }
    if (!hn::AllFalse(tag, left)) returned.back() += total(where(left, seen));
    if (hn::AllFalse(tag, take.reflected)) continue;
    append_ray(place, face.mirrored, face.reflected, face.axis, take.reflected, rays, k, reflected, arrivals.reflected);
    arrivals.reflected += hn::CountTrue(tag, take.reflected);
  }
  arrivals.absorbed = total(lost);
  return arrivals;
}

/// Into the period that starts at 0. \param stands_at where it stands, if that is kept
HWY_INLINE void store_folded(V at, double period, double* to, double* stands_at, std::size_t k) {
  const V periods = hn::Floor(hn::Mul(at, splat(1.0 / period)));
  store(hn::NegMulAdd(periods, splat(period), at), to, k);
  if (stands_at != nullptr) add(hn::Mul(periods, splat(period)), stands_at, k);
}

double fall(const Rays& rays, std::size_t count, double height_mm, double top_mm, const geometry::Vec2& period_mm,
            double absorption_per_mm) {
  V lost = hn::Zero(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const V3 d = load3(rays, kDx, k);
    const V way = hn::Div(splat(-height_mm), d.z);
    store_folded(hn::MulAdd(way, d.x, load(rays[kX], k)), period_mm.x(), rays[kX], rays[kOx], k);
    store_folded(hn::MulAdd(way, d.y, load(rays[kY], k)), period_mm.y(), rays[kY], rays[kOy], k);
    store(splat(top_mm), rays[kZ], k);
    if (absorption_per_mm > 0.0) lost = hn::Add(lost, absorbed(rays, k, count, way, absorption_per_mm));
  }
  return total(lost);
}

double sum(const Rays& rays, std::size_t count) {
  V power = hn::Zero(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D()))
    power = hn::Add(power, hn::IfThenElseZero(present(k, count), load(rays[kI], k)));
  return total(power);
}

Share sum_of(const double* which, double wanted, const Rays& rays, std::size_t count) {
  Share share;
  V power = hn::Zero(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const M here = hn::And(hn::Eq(load(which, k), splat(wanted)), present(k, count));
    power = hn::Add(power, hn::IfThenElseZero(here, load(rays[kI], k)));
    share.count += hn::CountTrue(D(), here);
  }
  share.power = total(power);
  return share;
}

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

/// As nested_flips(), of the digits themselves.
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

/// Digits as fractions times `size`.
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
  // From one point to the next changes the digits by those of the trailing ones.
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

HWY_EXPORT(advance_inside);
HWY_EXPORT(advance_outside);
HWY_EXPORT(refine);
HWY_EXPORT(select);
HWY_EXPORT(mark_polygon);
HWY_EXPORT(mark_weak);
HWY_EXPORT(shift);
HWY_EXPORT(mark_beyond);
HWY_EXPORT(meet_faces);
HWY_EXPORT(meet_mirrors);
HWY_EXPORT(meet_entrance);
HWY_EXPORT(fall);
HWY_EXPORT(sum);
HWY_EXPORT(sum_of);
HWY_EXPORT(sobol);

double advance_inside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double top_mm,
                      std::span<const Plane> borders, double absorption_per_mm, const Met& met) {
  return HWY_DYNAMIC_DISPATCH(advance_inside)(rays, count, facets, top_mm, borders, absorption_per_mm, met);
}
void advance_outside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double depth_mm,
                     std::span<const Plane> borders, const Met& met) {
  HWY_DYNAMIC_DISPATCH(advance_outside)(rays, count, facets, depth_mm, borders, met);
}
void refine(const Rays& rays, std::size_t count, const Border& border, double number, double to, double* which) {
  HWY_DYNAMIC_DISPATCH(refine)(rays, count, border, number, to, which);
}
std::size_t select(const double* which, double wanted, std::size_t count, const Rays& from, const Rays& to) {
  return HWY_DYNAMIC_DISPATCH(select)(which, wanted, count, from, to);
}
void mark_polygon(const Rays& rays, std::size_t count, std::span<const LinearForm> forms,
                  std::span<const std::uint32_t> first_form, double* which) {
  HWY_DYNAMIC_DISPATCH(mark_polygon)(rays, count, forms, first_form, which);
}
std::size_t mark_weak(const Rays& rays, double limit, std::size_t count, double* which) {
  return HWY_DYNAMIC_DISPATCH(mark_weak)(rays, limit, count, which);
}
void shift(const Rays& rays, std::size_t count, const geometry::Vec2& by) {
  HWY_DYNAMIC_DISPATCH(shift)(rays, count, by);
}
std::size_t mark_beyond(const Rays& rays, std::size_t count, const Reach& reach, double of, double number,
                        double* which) {
  return HWY_DYNAMIC_DISPATCH(mark_beyond)(rays, count, reach, of, number, which);
}
Branches meet_faces(const Rays& rays, std::size_t count, const Meeting& meeting, double index_ratio,
                    const Rays& reflected, const Rays& transmitted) {
  return HWY_DYNAMIC_DISPATCH(meet_faces)(rays, count, meeting, index_ratio, reflected, transmitted);
}
std::size_t meet_mirrors(const Rays& rays, std::size_t count, const Meeting& meeting, const Rays& reflected) {
  return HWY_DYNAMIC_DISPATCH(meet_mirrors)(rays, count, meeting, reflected);
}
Arrivals meet_entrance(const Rays& rays, std::size_t count, const Meeting& meeting, const Entrance& entrance,
                       const Rays& reflected, std::span<Stokes> returned, const Rays* left) {
  return HWY_DYNAMIC_DISPATCH(meet_entrance)(rays, count, meeting, entrance, reflected, returned, left);
}
double fall(const Rays& rays, std::size_t count, double height_mm, double top_mm, const geometry::Vec2& period_mm,
            double absorption_per_mm) {
  return HWY_DYNAMIC_DISPATCH(fall)(rays, count, height_mm, top_mm, period_mm, absorption_per_mm);
}
double sum(const Rays& rays, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(sum)(rays, count);
}
Share sum_of(const double* which, double wanted, const Rays& rays, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(sum_of)(which, wanted, rays, count);
}
void sobol(std::uint64_t key_x, std::uint64_t key_y, std::uint32_t first, std::size_t count, const geometry::Vec2& size,
           double* x, double* y) {
  HWY_DYNAMIC_DISPATCH(sobol)(key_x, key_y, first, count, size, x, y);
}

}  // namespace retrace::raytrace::lanes
#endif

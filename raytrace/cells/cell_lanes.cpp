#include "raytrace/cells/cell_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/cells/cell_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file one time for each instruction set
// The following header must be included after foreach_target.h.
#include "raytrace/cells/ray_lanes_inl.h"

HWY_BEFORE_NAMESPACE();
namespace retrace::raytrace::lanes::HWY_NAMESPACE {

/// Reduces the power of rays by the absorption on a path of the length `way`. Returns the absorbed power.
HWY_INLINE V absorbed(const Rays& rays, std::size_t k, std::size_t count, V way, double absorption_per_mm) {
  const S before = load_light(rays, k);
  const S after = scaled(before, hn::Exp(D(), hn::Mul(way, splat(-absorption_per_mm))));
  store_light(after, rays, k);
  return hn::IfThenElseZero(present(k, count), hn::Sub(before.i, after.i));
}

/// Length of a path along a ray, stored as the quotient `over` / `under`. Lengths are compared without division. Only
/// the shortest length is computed by division.
struct Way {
  V over;   ///< numerator, not negative
  V under;  ///< denominator, not negative; 0 for faces that are never met

  HWY_INLINE V length() const { return hn::Div(over, under); }
};
HWY_INLINE M is_less(const Way& a, const Way& b) {
  return hn::Lt(hn::Mul(a.over, b.under), hn::Mul(b.over, a.under));
}
HWY_INLINE Way chosen(M mask, const Way& yes, const Way& no) {
  return {hn::IfThenElse(mask, yes.over, no.over), hn::IfThenElse(mask, yes.under, no.under)};
}

/// The nearest of the faces that have been tested.
struct Nearest {
  Way way;
  VI label;
  V3 normal;

  HWY_INLINE M consider(const Way& next, VI its_label) {
    const M nearer = is_less(next, way);
    way = chosen(nearer, next, way);
    label = chosen(nearer, its_label, label);
    return nearer;
  }
};

/// Returns an infinitely distant face with the label of Hit::end.
HWY_INLINE Nearest nothing() {
  return {{splat(1.0), hn::Zero(D())}, splat(label_of(Hit::end)), splat(geometry::Vec3(0.0, 0.0, 1.0))};
}

/// Returns the path lengths along rays to a plane. The rays start on the inner side of the plane. A length is never
/// negative. It is infinite if the ray does not approach the plane.
HWY_INLINE Way way_to(const Plane& plane, const V3& p, const V3& d) {
  const V3 n = splat(plane.normal);
  const V zero = hn::Zero(D());
  return {hn::Max(hn::Sub(splat(plane.offset_mm), dot(n, p)), zero), hn::Max(dot(n, d), zero)};
}

HWY_INLINE void find_border(std::span<const Plane> borders, const V3& p, const V3& d, Nearest& nearest) {
  Label label = label_of(Hit::border);
  for (const Plane& border : borders) {
    nearest.consider(way_to(border, p, d), splat(label));
    label += kLabelStep;
  }
}

HWY_INLINE void store_met(const Nearest& nearest, V way, const V3& p, const V3& d, const Rays& rays,
                          const FaceHits& met, std::size_t k) {
  store3(along(p, way, d), rays, kX, k);
  store(nearest.label, met.labels, k);
  store(nearest.normal.x, met.normal[0], k);
  store(nearest.normal.y, met.normal[1], k);
  store(nearest.normal.z, met.normal[2], k);
}

double advance_inside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double top_mm,
                      std::span<const Plane> borders, double absorption_per_mm, const FaceHits& met) {
  V lost = hn::Zero(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const V3 p = load3(rays, kX, k);
    const V3 d = load3(rays, kDx, k);
    Nearest nearest = nothing();
    for (const Plane& facet : facets) {
      const M nearer = nearest.consider(way_to(facet, p, d), splat(label_of(Hit::facet)));
      nearest.normal = chosen(nearer, splat(facet.normal), nearest.normal);
    }
    nearest.consider(way_to({geometry::Vec3::UnitZ(), top_mm}, p, d), splat(label_of(Hit::end)));
    find_border(borders, p, d, nearest);
    const V way = nearest.way.length();
    store_met(nearest, way, p, d, rays, met, k);
    if (absorption_per_mm > 0.0) lost = hn::Add(lost, absorbed(rays, k, count, way, absorption_per_mm));
  }
  return total(lost);
}

void advance_outside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double depth_mm,
                     std::span<const Plane> borders, const FaceHits& met) {
  const V infinite = hn::Inf(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const V3 p = load3(rays, kX, k);
    const V3 d = load3(rays, kDx, k);
    Nearest nearest = nothing();
    nearest.consider(way_to({-geometry::Vec3::UnitZ(), depth_mm}, p, d), splat(label_of(Hit::end)));
    find_border(borders, p, d, nearest);
    V way = nearest.way.length();
    // A ray enters the convex body at the last plane that it crosses inward, and leaves it at the first plane that it
    // crosses outward.
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
    nearest.label = chosen(is_hit, splat(label_of(Hit::facet)), nearest.label);
    store_met(nearest, way, p, d, rays, met, k);
  }
}

HWY_INLINE V value(const LinearForm& form, V x, V y) {
  return hn::MulAdd(splat(form.x), x, hn::MulAdd(splat(form.y), y, splat(form.c)));
}

void refine(const Rays& rays, std::size_t count, const Border& border, Label* labels) {
  const D d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const VI before = load(labels, i);
    const M here = are(before, label_of(Hit::border, border.index));
    if (hn::AllFalse(d, here)) continue;
    const V3 p = load3(rays, kX, i);
    const V s = value(border.along, p.x, p.y);
    VI crossing = splat(label_of(Hit::crossing, border.first_interval));
    for (const double limit : border.limits)
      crossing = chosen(hn::Ge(s, splat(limit)), hn::Add(crossing, splat(kLabelStep)), crossing);
    VI result = crossing;
    std::size_t interval = border.first_interval;
    for (const Border::Interval& beyond : border.intervals) {
      if (!beyond.is_flush) {
        const V x = hn::Add(p.x, splat(beyond.shift.x()));
        const V y = hn::Add(p.y, splat(beyond.shift.y()));
        V highest = hn::Neg(hn::Inf(d));
        for (const LinearForm& form : beyond.heights) highest = hn::Max(highest, value(form, x, y));
        const M is_above = hn::Ge(p.z, highest);
        const M meets_wall = border.inside ? hn::Not(is_above) : is_above;
        const M is_here = are(crossing, label_of(Hit::crossing, interval));
        result = chosen(hn::And(meets_wall, is_here), splat(label_of(Hit::wall, interval)), result);
      }
      ++interval;
    }
    store(chosen(here, result, before), labels, i);
  }
}

std::size_t select(const Label* labels, Label wanted, std::size_t count, const Rays& all_from, const Rays& all_to) {
  const Rays from = all_from;
  const Rays to = all_to;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
    const M mask = hn::And(are(load(labels, i), wanted), present(i, count));
    const std::size_t more = hn::CountTrue(D(), mask);
    if (more == 0) continue;
    for (std::size_t k = 0; k < from.component_count; ++k) append(load(from[k], i), mask, to[k] + found);
    found += more;
  }
  return found;
}

void mark_polygon(const Rays& rays, std::size_t count, std::span<const LinearForm> forms,
                  std::span<const std::uint32_t> first_form, Label* labels) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
    const V x = load(rays[kX], i);
    const V y = load(rays[kY], i);
    VI first = splat(static_cast<Label>(first_form.size() - 1));
    for (std::size_t k = first_form.size() - 1; k-- > 0;) {
      V least = hn::Inf(D());
      for (std::uint32_t f = first_form[k]; f < first_form[k + 1]; ++f) least = hn::Min(least, value(forms[f], x, y));
      first = chosen(hn::Ge(least, hn::Zero(D())), splat(static_cast<Label>(k)), first);
    }
    store(first, labels, i);
  }
}

std::size_t mark_weak(const Rays& rays, double limit, std::size_t count, Label* labels) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(D())) {
    const M is_weak = hn::Lt(load(rays[kI], i), splat(limit));
    store(chosen(is_weak, splat(kRemoved), splat(kKept)), labels, i);
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

std::size_t mark_beyond(const Rays& rays, std::size_t count, const BoundsTest& reach, Label tested, Label beyond,
                        Label* labels) {
  const D d;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const VI before = load(labels, i);
    const M is_tested = hn::And(are(before, tested), present(i, count));
    if (hn::AllFalse(d, is_tested)) continue;
    V x = hn::Add(load(rays[kX], i), load(rays[kOx], i));
    V y = hn::Add(load(rays[kY], i), load(rays[kOy], i));
    if (reach.height_mm != 0.0) {
      const V way = hn::Div(splat(reach.height_mm), load(rays[kDz], i));
      x = hn::MulAdd(way, load(rays[kDx], i), x);
      y = hn::MulAdd(way, load(rays[kDy], i), y);
    }
    const M within = hn::And(hn::And(hn::Ge(x, splat(reach.lower.x())), hn::Le(x, splat(reach.upper.x()))),
                             hn::And(hn::Ge(y, splat(reach.lower.y())), hn::Le(y, splat(reach.upper.y()))));
    const M is_beyond = hn::AndNot(within, is_tested);
    store(chosen(is_beyond, splat(beyond), before), labels, i);
    found += hn::CountTrue(d, is_beyond);
  }
  return found;
}

/// Wraps the coordinates `at` into [0, period) and stores them in `to`.
/// \param stands_at array to which the removed multiple of the period is added; may be null
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

PowerSum sum_of(const Label* labels, Label wanted, const Rays& rays, std::size_t count) {
  PowerSum share;
  V power = hn::Zero(D());
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const M here = hn::And(are(load(labels, k), wanted), present(k, count));
    power = hn::Add(power, hn::IfThenElseZero(here, load(rays[kI], k)));
    share.count += hn::CountTrue(D(), here);
  }
  share.power = total(power);
  return share;
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
HWY_EXPORT(fall);
HWY_EXPORT(sum);
HWY_EXPORT(sum_of);

double advance_inside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double top_mm,
                      std::span<const Plane> borders, double absorption_per_mm, const FaceHits& met) {
  return HWY_DYNAMIC_DISPATCH(advance_inside)(rays, count, facets, top_mm, borders, absorption_per_mm, met);
}
void advance_outside(const Rays& rays, std::size_t count, std::span<const Plane> facets, double depth_mm,
                     std::span<const Plane> borders, const FaceHits& met) {
  HWY_DYNAMIC_DISPATCH(advance_outside)(rays, count, facets, depth_mm, borders, met);
}
void refine(const Rays& rays, std::size_t count, const Border& border, Label* labels) {
  HWY_DYNAMIC_DISPATCH(refine)(rays, count, border, labels);
}
std::size_t select(const Label* labels, Label wanted, std::size_t count, const Rays& from, const Rays& to) {
  return HWY_DYNAMIC_DISPATCH(select)(labels, wanted, count, from, to);
}
void mark_polygon(const Rays& rays, std::size_t count, std::span<const LinearForm> forms,
                  std::span<const std::uint32_t> first_form, Label* labels) {
  HWY_DYNAMIC_DISPATCH(mark_polygon)(rays, count, forms, first_form, labels);
}
std::size_t mark_weak(const Rays& rays, double limit, std::size_t count, Label* labels) {
  return HWY_DYNAMIC_DISPATCH(mark_weak)(rays, limit, count, labels);
}
void shift(const Rays& rays, std::size_t count, const geometry::Vec2& by) {
  HWY_DYNAMIC_DISPATCH(shift)(rays, count, by);
}
std::size_t mark_beyond(const Rays& rays, std::size_t count, const BoundsTest& reach, Label tested, Label beyond,
                        Label* labels) {
  return HWY_DYNAMIC_DISPATCH(mark_beyond)(rays, count, reach, tested, beyond, labels);
}
double descend(const Rays& rays, std::size_t count, double height_mm, double top_mm, const geometry::Vec2& period_mm,
               double absorption_per_mm) {
  return HWY_DYNAMIC_DISPATCH(fall)(rays, count, height_mm, top_mm, period_mm, absorption_per_mm);
}
double sum(const Rays& rays, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(sum)(rays, count);
}
PowerSum sum_of(const Label* labels, Label wanted, const Rays& rays, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(sum_of)(labels, wanted, rays, count);
}

}  // namespace retrace::raytrace::lanes
#endif

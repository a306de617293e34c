#include "raytrace/cells/cell_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/cells/face_lanes.cpp"
#include <hwy/foreach_target.h>  // compiles this file one time for each instruction set
// The following header must be included after foreach_target.h.
#include "raytrace/cells/ray_lanes_inl.h"

HWY_BEFORE_NAMESPACE();
namespace retrace::raytrace::lanes::HWY_NAMESPACE {

/// Rotates the first axis of Stokes parameters from `axis` to `to`, as Light::rotate_basis_to_axis() does, but for axes
/// of any length. \param over 1 / (|axis|^2 |to|^2)
HWY_INLINE S turned(const S& light, const V3& direction, const V3& axis, const V3& to, V over) {
  const V c = dot(to, axis);
  const V s = dot(to, cross(direction, axis));
  const V c2 = hn::Mul(over, hn::MulSub(c, c, hn::Mul(s, s)));
  const V s2 = hn::Mul(over, hn::Mul(hn::Add(c, c), s));
  return {light.i, hn::MulAdd(c2, light.q, hn::Mul(s2, light.u)), hn::MulSub(c2, light.u, hn::Mul(s2, light.q)),
          light.v};
}

/// Reflected and transmitted light at interfaces between transparent media, with the directions of this light. The
/// formulas are those of materials::fresnel().
struct Interface {
  S reflected, transmitted;
  V3 mirrored, refracted;
  V3 axis;  ///< first axis of the Stokes parameters of both branches
};

/// Returns an axis perpendicular to the plane of incidence. At normal incidence, `axis` is returned unchanged, because
/// s and p light then have equal coefficients.
HWY_INLINE V3 axis_at(const V3& d, const V3& axis, const V3& against) {
  const V3 across = cross(d, against);
  return chosen(hn::Lt(dot(across, across), splat(1e-16)), axis, across);
}

/// Coefficients of a face: the reflectances for s and p light, the real and the imaginary part of r_s conj(r_p), and
/// t_s t_p (`passed`).
struct Shares {
  V power_s, power_p;
  V re, im;
  V passed;
};

/// Computes the coefficients of a face.
/// \param ci cosine of the angle of incidence
/// \param root cosine of the angle of refraction; for total reflection, the imaginary part of this cosine
/// \param a_s index ratio times `ci`
/// \param b_p index ratio times `root`
/// \param over 1 / ((a_s + root) (ci + b_p)), or 1 / |(a_s + i root) (ci + i b_p)|^2 for total reflection
HWY_INLINE Shares shares(double index_ratio, V ci, V root, V a_s, V b_p, V over, M total, M grazes) {
  const V one = splat(1.0);
  // For partial reflection, the amplitudes are real. For total reflection, r_s = (a_s - i root) / (a_s + i root), and
  // r_s conj(r_p) has the magnitude 1.
  const V r_s = hn::Mul(over, hn::Mul(hn::Sub(a_s, root), hn::Add(ci, b_p)));
  const V r_p = hn::Mul(over, hn::Mul(hn::Sub(ci, b_p), hn::Add(a_s, root)));
  // For total reflection, r_s conj(r_p) = (a_s - i root)^2 (ci + i b_p)^2 * over.
  const V re_s = hn::MulSub(a_s, a_s, hn::Mul(root, root));
  const V im_s = hn::Mul(splat(-2.0), hn::Mul(a_s, root));
  const V re_p = hn::MulSub(ci, ci, hn::Mul(b_p, b_p));
  const V im_p = hn::Mul(splat(2.0), hn::Mul(ci, b_p));
  const V total_re = hn::IfThenElse(grazes, one, hn::Mul(over, hn::MulSub(re_s, re_p, hn::Mul(im_s, im_p))));
  const V total_im = hn::IfThenElseZero(hn::Not(grazes), hn::Mul(over, hn::MulAdd(re_s, im_p, hn::Mul(im_s, re_p))));
  return {hn::IfThenElse(total, one, hn::Mul(r_s, r_s)), hn::IfThenElse(total, one, hn::Mul(r_p, r_p)),
          hn::IfThenElse(total, total_re, hn::Mul(r_s, r_p)), hn::IfThenElseZero(total, total_im),
          // t_s t_p = 4 ratio ci root / ((a_s + root) (ci + b_p)); t_s and t_p are normalized so that their squares are
          // fractions of the power
          hn::IfThenElseZero(hn::Not(total), hn::Mul(over, hn::Mul(splat(4.0 * index_ratio), hn::Mul(ci, root))))};
}

/// Returns the reflected and the transmitted light at an interface.
/// \param against unit normal that faces the light
HWY_INLINE Interface met(const S& light, const V3& d, const V3& axis, const V3& against, double index_ratio) {
  const D tag;
  const V zero = hn::Zero(tag);
  const V one = splat(1.0);
  const V ratio = splat(index_ratio);
  const V ci = hn::Min(one, hn::Max(zero, hn::Neg(dot(against, d))));
  const V sin2 = hn::Mul(hn::Mul(ratio, ratio), hn::NegMulAdd(ci, ci, one));
  // At grazing incidence, all light is reflected for any index ratio.
  const M grazes = hn::Le(ci, zero);
  const M total = hn::Or(hn::Ge(sin2, one), grazes);
  const V root = hn::Sqrt(hn::Abs(hn::Sub(one, sin2)));
  const V a_s = hn::Mul(ratio, ci);
  const V b_p = hn::Mul(ratio, root);

  Interface face;
  face.axis = axis_at(d, axis, against);
  // 1 / norm and 1 / axes2 are computed from a single division, because divisions take most of the time.
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

  const Shares of = shares(index_ratio, ci, root, a_s, b_p, over, total, grazes);
  const V rs = hn::Mul(s, of.power_s);
  const V rp = hn::Mul(p, of.power_p);
  face.reflected = {hn::Add(rs, rp), hn::Sub(rs, rp), hn::MulSub(of.re, in.u, hn::Mul(of.im, in.v)),
                    hn::MulAdd(of.re, in.v, hn::Mul(of.im, in.u))};
  const V ts = hn::Mul(s, hn::Sub(one, of.power_s));
  const V tp = hn::Mul(p, hn::Sub(one, of.power_p));
  face.transmitted = {hn::Add(ts, tp), hn::Sub(ts, tp), hn::Mul(of.passed, in.u), hn::Mul(of.passed, in.v)};
  face.mirrored = renormalised(along(d, hn::Add(ci, ci), against));
  face.refracted = renormalised(along(times(ratio, d), hn::MulSub(ratio, ci, root), against));
  return face;
}

/// Masks of the rays that continue in the reflected branch and in the transmitted branch of a face.
struct Chosen {
  M reflected, transmitted;
};

/// Chooses the branches and scales their light.
HWY_INLINE Chosen choose(const FaceInteraction& meeting, std::size_t k, M here, S& reflected, S& transmitted) {
  constexpr double kGolden = 0.6180339887498949;  // its multiples modulo 1 are evenly distributed
  const V r = reflected.i;
  const V t = transmitted.i;
  const V power = hn::Add(r, t);
  const M both = hn::Ge(hn::Min(r, t), splat(meeting.split_power));
  const V number = hn::Add(hn::Iota(D(), 0.0), splat(static_cast<double>(k)));
  const V at = hn::MulAdd(number, splat(kGolden), splat(meeting.start));
  const V u = hn::Sub(at, hn::Floor(at));
  const M takes_reflected = hn::Lt(hn::Mul(u, power), r);
  // No random choice is needed if, for every ray, both branches continue or no light is transmitted.
  if (hn::AllTrue(D(), hn::Or(hn::Or(both, hn::Not(here)), hn::Le(t, hn::Zero(D())))))
    return {here, hn::And(here, both)};
  // The chosen branch receives the power of both branches.
  const V factor = hn::IfThenElse(both, splat(1.0), hn::Div(power, hn::IfThenElse(takes_reflected, r, t)));
  reflected = scaled(reflected, factor);
  transmitted = scaled(transmitted, factor);
  return {hn::And(here, hn::Or(both, takes_reflected)), hn::And(here, hn::Or(both, hn::Not(takes_reflected)))};
}

HWY_INLINE M those(const FaceInteraction& meeting, std::size_t k, std::size_t count) {
  return hn::And(are(load(meeting.hits.labels, k), meeting.label), present(k, count));
}

HWY_INLINE V3 normal_of(const FaceInteraction& meeting, std::size_t k) {
  return times(splat(meeting.towards_light),
               {load(meeting.hits.normal[0], k), load(meeting.hits.normal[1], k), load(meeting.hits.normal[2], k)});
}

Branches meet_faces(const Rays& rays, std::size_t count, const FaceInteraction& meeting, double index_ratio,
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

std::size_t meet_mirrors(const Rays& rays, std::size_t count, const FaceInteraction& meeting, const Rays& reflected) {
  std::size_t found = 0;
  for (std::size_t k = 0; k < count; k += hn::Lanes(D())) {
    const M here = those(meeting, k, count);
    if (hn::AllFalse(D(), here)) continue;
    const V3 d = load3(rays, kDx, k);
    const V3 axis = load3(rays, kAx, k);
    const V3 against = normal_of(meeting, k);
    const V3 to = axis_at(d, axis, against);
    // A perfect mirror has r_s = -1 and r_p = 1.
    const V axes2 = hn::Mul(dot(axis, axis), dot(to, to));
    const S in = turned(load_light(rays, k), d, axis, to, hn::Div(splat(1.0), axes2));
    append_ray(load3(rays, kX, k), renormalised(along(d, hn::Mul(splat(-2.0), dot(against, d)), against)),
               {in.i, in.q, hn::Neg(in.u), hn::Neg(in.v)}, to, here, rays, k, reflected, found);
    found += hn::CountTrue(D(), here);
  }
  return found;
}

Arrivals meet_entrance(const Rays& rays, std::size_t count, const FaceInteraction& meeting, const Entrance& entrance,
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
      // Beyond the critical angle, the light is not traced further. Its power is added to the light outside of all
      // cones.
      const V axes2 = hn::Mul(dot(axis, axis), dot(face.axis, face.axis));
      face.transmitted = turned(light, d, axis, face.axis, hn::Div(splat(1.0), axes2));
      returned.back().i += total(hn::IfThenElseZero(hn::And(here, is_total), light.i));
      take = {hn::Lt(zero, zero), hn::AndNot(is_total, here)};
    } else {
      take = choose(meeting, k, here, face.reflected, face.transmitted);
    }
    // The following vector is source_axis(out): the component of +x perpendicular to the direction.
    const V3 out = face.refracted;
    const V3 x{hn::NegMulAdd(out.x, out.x, splat(1.0)), hn::Neg(hn::Mul(out.x, out.y)), hn::Neg(hn::Mul(out.x, out.z))};
    const V axes2 = hn::Mul(dot(face.axis, face.axis), dot(x, x));
    const S seen = turned(face.transmitted, out, face.axis, x, hn::Div(splat(1.0), axes2));
    if (left_rays != nullptr && !hn::AllFalse(tag, take.transmitted)) {
      append_ray(place, out, seen, x, take.transmitted, rays, k, *left_rays, arrivals.exited);
      arrivals.exited += hn::CountTrue(tag, take.transmitted);
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

}  // namespace retrace::raytrace::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace retrace::raytrace::lanes {

HWY_EXPORT(meet_faces);
HWY_EXPORT(meet_mirrors);
HWY_EXPORT(meet_entrance);

Branches meet_faces(const Rays& rays, std::size_t count, const FaceInteraction& meeting, double index_ratio,
                    const Rays& reflected, const Rays& transmitted) {
  return HWY_DYNAMIC_DISPATCH(meet_faces)(rays, count, meeting, index_ratio, reflected, transmitted);
}
std::size_t meet_mirrors(const Rays& rays, std::size_t count, const FaceInteraction& meeting, const Rays& reflected) {
  return HWY_DYNAMIC_DISPATCH(meet_mirrors)(rays, count, meeting, reflected);
}
Arrivals meet_entrance(const Rays& rays, std::size_t count, const FaceInteraction& meeting, const Entrance& entrance,
                       const Rays& reflected, std::span<Stokes> returned, const Rays* left) {
  return HWY_DYNAMIC_DISPATCH(meet_entrance)(rays, count, meeting, entrance, reflected, returned, left);
}

}  // namespace retrace::raytrace::lanes
#endif

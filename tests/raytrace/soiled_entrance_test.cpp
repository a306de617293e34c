// Tests of entrance faces with layers, water, dust, scratches and haze: closed forms, an independent trace of a drop,
// reciprocity, and ledgers that add up to 1 in every engine.
#include "raytrace/faces/contaminated_entrance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "geometry/part/part.h"
#include "raytrace/exact/beam_tracer.h"
#include "raytrace/paths/monte_carlo.h"
#include "surface_models/scatter/harvey_shack.h"
#include "tests/support/designs.h"
#include "tests/support/engines.h"
#include "tests/support/statistics.h"

namespace retrace::testing::soiled_entrance_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;
using surface_models::RandomStream;

constexpr double kWater = 1.333;

double sin_deg(double deg) {
  return std::sin(deg * pi / 180.0);
}

Optics with_condition(const EntranceCondition& condition) {
  Optics optics = pmma();
  optics.entrance = condition;
  return optics;
}

EntranceCondition dusty(double coverage, double albedo, double forward) {
  EntranceCondition condition;
  condition.dust = {coverage, albedo, forward};
  return condition;
}

EntranceCondition hazy(double share, double spread_deg) {
  EntranceCondition condition;
  condition.haze = {share, sin_deg(spread_deg)};
  return condition;
}

EntranceCondition wet(double film_coverage) {
  EntranceCondition condition;
  condition.layers = {{kWater, 0.0, 0.0}};
  condition.film_coverage = film_coverage;
  return condition;
}

EntranceCondition with_drops(double coverage, double contact_angle_deg) {
  EntranceCondition condition;
  condition.drops = {coverage, contact_angle_deg * pi / 180.0};
  return condition;
}

/// Returns a condition with all kinds of contamination. Roughness is left out, because a rough face has no film.
EntranceCondition filthy() {
  EntranceCondition condition = wet(0.3);
  condition.layers.insert(condition.layers.begin(), {1.6, 0.01, 0.5});
  condition.drops = {0.1, 30.0 * pi / 180.0};
  condition.dust = {0.15, 0.7, 0.6};
  condition.scratches = {0.1, sin_deg(15.0), {}};
  condition.haze = {0.3, sin_deg(10.0)};
  return condition;
}

EntranceCondition rough() {
  EntranceCondition condition;
  condition.roughness = surface_models::HarveyShack({20.0, 3.0, 0.0, 0.0}, {kPmma, 1.0, 587.56});
  return condition;
}

/// Returns unpolarised light of power 1 on the face.
/// \param k direction cosines along the face, multiplied by the index of the medium of the ray
Ray ray_at(const Vec2& k, bool inside) {
  const Vec2 along = k / (inside ? kPmma : 1.0);
  const double z = std::sqrt(1.0 - along.squaredNorm());
  const Vec3 direction(along.x(), along.y(), inside ? z : -z);
  return {direction, {kUnpolarised, direction.unitOrthogonal()}, inside, false};
}

/// Adds values over many events. An event is one ray that hits the entrance face. Events are divided into batches, and
/// the standard error follows from the sums of the batches.
class Events {
 public:
  static constexpr std::uint32_t kBatches = 32;

  /// \param start returns the ray of an event from two random numbers
  /// \param value returns the value of a ray after the event
  Events(const Optics& optics, std::uint32_t per_batch, const std::function<Ray(double, double)>& start,
         const std::function<double(const Ray&)>& value) {
    const ContaminatedEntrance face(optics);
    EntranceScatter result;
    std::array<double, kBatches> batches{};
    for (std::uint32_t batch = 0; batch < kBatches; ++batch)
      for (std::uint32_t k = 0; k < per_batch; ++k) {
        RandomStream random({11, 5}, batch, k, 0);
        const double u = random.next();
        const double v = random.next();
        result.clear();
        face.meet(start(u, v), 1e-2, random, result);
        absorbed += result.absorbed / per_batch / kBatches;
        for (const Ray& ray : result.rays) batches[batch] += value(ray) / per_batch;
      }
    for (const double sum : batches) mean += sum / kBatches;
    for (const double sum : batches) std_error += (sum - mean) * (sum - mean) / kBatches / (kBatches - 1.0);
    std_error = std::sqrt(std_error);
  }

  double mean = 0.0;
  double std_error = 0.0;
  double absorbed = 0.0;
};

std::function<Ray(double, double)> always(const Ray& ray) {
  return [ray](double, double) { return ray; };
}

double power_in_air(const Ray& ray) {
  return ray.inside ? 0.0 : ray.light.power();
}
double power_in_body(const Ray& ray) {
  return ray.inside ? ray.light.power() : 0.0;
}

/// Returns the mean reflectance for light from the air that is distributed by Lambert's law.
double diffuse_reflectance() {
  double sum = 0.0;
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) {  // equal steps of the squared cosine
    const double cosine = std::sqrt((k + 0.5) / kSteps);
    sum += materials::reflectance(1.0 / kPmma, cosine) / kSteps;
  }
  return sum;
}

// Every event conserves power, and the degree of polarisation is at most 1.
TEST(ContaminatedEntrance, EveryEventKeepsItsPower) {
  for (const EntranceCondition& condition :
       {filthy(), rough(), dusty(1.0, 0.9, 0.5), dusty(0.5, 0.0, 0.5), hazy(1.0, 20.0), with_drops(1.0, 90.0)}) {
    const Optics optics = with_condition(condition);
    const ContaminatedEntrance face(optics);
    EntranceScatter result;
    for (std::uint32_t n = 0; n < 20000; ++n) {
      RandomStream random({3, 7}, n, 0, 0);
      const bool inside = random.next() < 0.5;
      const double radius = 0.999 * std::sqrt(random.next()) * (inside ? kPmma : 1.0);
      const double angle = 2.0 * pi * random.next();
      Ray start = ray_at({radius * std::cos(angle), radius * std::sin(angle)}, inside);
      start.light.stokes = {1.0, 0.6, 0.0, -0.8};
      result.clear();
      face.meet(start, 1e-2, random, result);
      double sum = result.absorbed + result.truncated;
      for (const Ray& ray : result.rays) {
        const auto [i, q, u, v] = ray.light.stokes;
        sum += i;
        EXPECT_LE(q * q + u * u + v * v, i * i * (1.0 + 1e-9));
        EXPECT_NEAR(ray.direction.norm(), 1.0, 1e-12);
        EXPECT_NEAR(ray.direction.dot(ray.light.s_axis), 0.0, 1e-9);
        EXPECT_TRUE(ray.inside ? ray.direction.z() < 0.0 : ray.direction.z() >= 0.0);
      }
      ASSERT_NEAR(sum, 1.0, 1e-11);
    }
  }
}

// A plate has one hazy face, on either side. The fraction of the light beyond 2.5 degrees, as measured by a haze meter,
// must equal the haze that the design specifies.
TEST(ContaminatedEntrance, AHazeMeterReadsTheHaze) {
  constexpr double kHaze = 0.12;
  const double spread_deg = 6.0;
  const double beyond = std::exp(-std::pow(sin_deg(2.5) / sin_deg(spread_deg), 2.0));
  const Optics optics = with_condition(hazy(kHaze / beyond, spread_deg));
  const double edge = sin_deg(2.5);
  const auto in_air = [](const Ray& ray) { return (ray.inside ? kPmma : 1.0) * ray.direction.head<2>().norm(); };
  for (const bool from_inside : {false, true}) {
    const auto passed = [&](const Ray& ray) {
      if (ray.inside == from_inside) return 0.0;
      // If the light has not yet passed the plane face on the other side, the transmittance of this face is included.
      const double through = from_inside ? 1.0 : 1.0 - materials::reflectance(kPmma, -ray.direction.z());
      return through * ray.light.power();
    };
    const Events all(optics, 8000, always(ray_at(Vec2::Zero(), from_inside)), passed);
    const Events diffuse(optics, 8000, always(ray_at(Vec2::Zero(), from_inside)),
                         [&](const Ray& ray) { return in_air(ray) > edge ? passed(ray) : 0.0; });
    EXPECT_NEAR(diffuse.mean / all.mean, kHaze, student_bound(2) * diffuse.std_error / all.mean + 1e-6);
    EXPECT_LT(diffuse.std_error, 1e-3);
  }
}

// Scratches scatter light perpendicular to their direction. The fraction beyond an angle is given by the complementary
// error function erfc. In the direction of the scratches, no light is scattered.
TEST(ContaminatedEntrance, ScratchesThrowLightAcross) {
  EntranceCondition condition;
  condition.scratches = {0.25, sin_deg(8.0), 0.3};
  const Vec2 across(-std::sin(0.3), std::cos(0.3));
  const Vec2 along(std::cos(0.3), std::sin(0.3));
  const Optics optics = with_condition(condition);
  const double passes = 1.0 - materials::reflectance(kPmma, 1.0);
  for (const double deg : {1.0, 5.0, 12.0}) {
    const Events beyond(optics, 4000, always(ray_at(Vec2::Zero(), true)), [&](const Ray& ray) {
      if (ray.inside) return 0.0;
      EXPECT_NEAR(ray.direction.head<2>().dot(along), 0.0, 1e-12);
      return std::abs(ray.direction.head<2>().dot(across)) > sin_deg(deg) ? ray.light.power() : 0.0;
    });
    const double expected = 0.25 * passes * std::erfc(sin_deg(deg) / sin_deg(8.0));
    EXPECT_NEAR(beyond.mean, expected, student_bound(3) * beyond.std_error) << deg;
  }
}

// Dust on a face returns the fraction rho = c (a b + (a f)^2 R / (1 - a b R)) of the light. The fraction c a f (1 - R)
// / (1 - a b R) enters the part, at any angle of incidence. c is the coverage and a the albedo of the dust; it scatters
// the fraction f forwards and b = 1 - f backwards. R is the mean reflectance of the face for Lambertian light.
TEST(ContaminatedEntrance, DustInClosedForm) {
  const double face = diffuse_reflectance();
  const double albedo = 0.8;
  const double forward = 0.7;
  const double ab = albedo * (1.0 - forward);
  const double af = albedo * forward;
  for (const double coverage : {0.02, 0.04, 1.0})
    for (const double k : {0.0, 0.6}) {
      const Optics optics = with_condition(dusty(coverage, albedo, forward));
      const Ray ray = ray_at({k, 0.0}, false);
      const auto scattered = [](const Ray& r) { return r.scattered ? 1.0 : 0.0; };
      const Events back(optics, 4000, always(ray), [&](const Ray& r) { return scattered(r) * power_in_air(r); });
      const Events in(optics, 4000, always(ray), [&](const Ray& r) { return scattered(r) * power_in_body(r); });
      const double returned = coverage * (ab + af * af * face / (1.0 - ab * face));
      const double entered = coverage * af * (1.0 - face) / (1.0 - ab * face);
      EXPECT_NEAR(back.mean, returned, student_bound(18) * back.std_error);
      EXPECT_NEAR(in.mean, entered, student_bound(18) * in.std_error);
      EXPECT_NEAR(back.absorbed, coverage - returned - entered, student_bound(18) * (back.std_error + in.std_error));
    }
}

// The part behind the face returns no light, so that all returned light is from dust. In a cone of half-angle w around
// the source at the incidence t, Lambertian light has the power rho cos t sin^2 w.
TEST(ContaminatedEntrance, DustShinesInADarkField) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5));
  Optics optics = with_condition(dusty(0.1, 0.9, 0.6));
  optics.back_index = optics.index;
  const double face = diffuse_reflectance();
  const double rho = 0.1 * (0.36 + 0.54 * 0.54 * face / (1.0 - 0.36 * face));
  for (const auto engine : {MonteCarlo::Engine::cell, MonteCarlo::Engine::embree}) {
    const ConeResult dark =
        MonteCarlo(part, engine).trace(optics, from(30.0, 20.0), {15.0}, rays(1U << 17), {}).cones[0];
    const double expected = rho * std::cos(pi / 6.0) * std::pow(sin_deg(15.0), 2.0);
    EXPECT_NEAR(dark.rre, expected, student_bound(2) * dark.std_error);
    EXPECT_LT(dark.std_error, 0.03 * expected);
    EXPECT_NEAR(dark.ledger.total(), 1.0, 1e-9);
    EXPECT_NEAR(dark.stokes.q, 0.0, 5.0 * dark.std_error);
  }
}

/// Traces light in the meridional plane of a drop on a face, for s and p separately. This code is used by the test
/// only: it uses plane angles, and Fresnel's formulas as functions of sines and tangents.
struct MeridionalTrace {
  double slope;  ///< sine of the contact angle; the base of the drop has the radius 1
  double in_body = 0.0, up = 0.0, down = 0.0, tangential = 0.0;

  /// Returns the reflectances of s and p for an angle of incidence and an angle of refraction.
  static std::array<double, 2> reflectances(double i, double t) {
    if (i < 1e-9) i = 1e-9, t = i * t / std::max(t, 1e-300);
    const double s = std::sin(i - t) / std::sin(i + t);
    const double p = std::tan(i - t) / std::tan(i + t);
    return {s * s, p * p};
  }
  static std::array<double, 2> at_interface(double from, double to, double angle, bool& is_total) {
    const double sine = from / to * std::sin(angle);
    is_total = sine >= 1.0;
    if (is_total) return {1.0, 1.0};
    if (angle < 1e-7) return {std::pow((from - to) / (from + to), 2.0), std::pow((from - to) / (from + to), 2.0)};
    return reflectances(angle, std::asin(sine));
  }

  /// Continues a path in the water from (x, z). The angle is measured from the downward direction, towards +x.
  void in_water(double x, double z, double angle, std::array<double, 2> power, int depth) {
    if (depth > 40 || power[0] + power[1] < 1e-9) return;
    const double radius = 1.0 / slope;
    const double centre = -std::sqrt(radius * radius - 1.0);
    const double dx = std::sin(angle);
    const double dz = -std::cos(angle);
    const double b = x * dx + (z - centre) * dz;
    const double c = x * x + (z - centre) * (z - centre) - radius * radius;
    const double to_cap = -b + std::sqrt(std::max(0.0, b * b - c));
    const double to_base = dz < 0.0 ? z / -dz : 1e9;
    bool is_total = false;
    if (to_base <= to_cap) {
      const auto r = at_interface(kWater, kPmma, std::abs(angle), is_total);
      const double passed = 0.5 * ((1.0 - r[0]) * power[0] + (1.0 - r[1]) * power[1]);
      in_body += passed;
      tangential += passed * kWater * std::abs(dx);
      return in_water(x + to_base * dx, 0.0, pi - angle, {r[0] * power[0], r[1] * power[1]}, depth + 1);
    }
    const double px = x + to_cap * dx;
    const double pz = z + to_cap * dz;
    const double tilt = std::asin(px / radius);  // angle of the outward normal from +z, towards +x
    const double heading = std::atan2(dx, dz);   // from +z
    double incidence = heading - tilt;
    incidence = std::remainder(incidence, 2.0 * pi);
    const auto r = at_interface(kWater, 1.0, std::abs(incidence), is_total);
    if (!is_total) {
      const double out = tilt + std::copysign(std::asin(kWater * std::sin(std::abs(incidence))), incidence);
      const double passed = 0.5 * ((1.0 - r[0]) * power[0] + (1.0 - r[1]) * power[1]);
      (std::cos(out) > 0.0 ? up : down) += passed;
    }
    const double back = tilt + pi - incidence;  // reflected at the normal
    in_water(px, pz, pi - back, {r[0] * power[0], r[1] * power[1]}, depth + 1);
  }

  /// Traces light that falls vertically on the whole drop.
  void fall(int steps) {
    for (int k = 0; k < steps; ++k) {
      const double x = std::sqrt((k + 0.5) / steps);
      const double radius = 1.0 / slope;
      const double tilt = std::asin(x / radius);
      const double z = radius * std::cos(tilt) - std::sqrt(radius * radius - 1.0);
      bool is_total = false;
      const auto r = at_interface(1.0, kWater, tilt, is_total);
      const double refracted = std::asin(std::sin(tilt) / kWater);
      (std::cos(2.0 * tilt) > 0.0 ? up : down) += 0.5 * (r[0] + r[1]) / steps;
      in_water(x, z, -(tilt - refracted), {(1.0 - r[0]) / steps, (1.0 - r[1]) / steps}, 0);
    }
  }
};

// For light along the normal, all paths are in the meridional plane. Three results are compared with a trace in this
// plane: the fraction that enters, its tangential wave vector, and the returned light. With contact angles of up to 45
// degrees, no light leaves the drop downwards.
TEST(ContaminatedEntrance, ADropAgainstATraceInItsMeridionalPlane) {
  for (const double contact_deg : {10.0, 30.0, 44.0}) {
    MeridionalTrace trace{sin_deg(contact_deg)};
    trace.fall(4000);
    EXPECT_NEAR(trace.in_body + trace.up + trace.down, 1.0, 1e-6);
    EXPECT_LT(trace.down, 5e-3);
    const Optics optics = with_condition(with_drops(1.0, contact_deg));
    const auto start = always(ray_at(Vec2::Zero(), false));
    const Events in(optics, 4000, start, power_in_body);
    const Events tangential(optics, 4000, start, [](const Ray& ray) {
      return ray.inside ? kPmma * ray.direction.head<2>().norm() * ray.light.power() : 0.0;
    });
    // Light that leaves the drop downwards hits the face, and most of it enters.
    EXPECT_NEAR(in.mean, trace.in_body, student_bound(6) * in.std_error + trace.down);
    EXPECT_NEAR(tangential.mean, trace.tangential, student_bound(6) * tangential.std_error + trace.down);
    EXPECT_LT(in.std_error, 2e-3);
  }
}

// Very flat drops act like a film.
TEST(ContaminatedEntrance, FlatDropsAreAFilm) {
  for (const double k : {0.0, 0.5}) {
    const Ray ray = ray_at({k, 0.0}, false);
    const Events drops(with_condition(with_drops(1.0, 1.0)), 4000, always(ray), power_in_body);
    const std::vector<materials::ThickLayer> water = {{kWater, 0.0, 0.0}};
    const materials::FresnelCoefficients film =
        materials::fresnel_thick_layers({}, water, materials::StackSide::outside, 1.0, kPmma, -ray.direction.z());
    EXPECT_NEAR(drops.mean, 0.5 * (std::norm(film.t_s) + std::norm(film.t_p)),
                student_bound(2) * drops.std_error + 1e-4);
  }
}

// Summed over polarisations, the light from given directions in the air into given directions in the body equals the
// light in the reverse direction.
TEST(ContaminatedEntrance, Reciprocal) {
  const Vec2 air(0.3, 0.0);
  const Vec2 body(-0.05, 0.15);
  const double radius = 0.15;
  const auto in_disc = [&](const Vec2& middle, bool inside) {
    return [=](double u, double v) {
      const double r = radius * std::sqrt(u);
      return ray_at(middle + Vec2(r * std::cos(2.0 * pi * v), r * std::sin(2.0 * pi * v)), inside);
    };
  };
  const auto arrives = [&](const Vec2& middle, bool inside) {
    return [=](const Ray& ray) {
      // Reversed light travels in the opposite direction.
      const Vec2 k = (inside ? kPmma : 1.0) * ray.direction.head<2>();
      return ray.inside == inside && (k - middle).norm() < radius ? ray.light.power() : 0.0;
    };
  };
  for (const EntranceCondition& condition :
       {filthy(), rough(), hazy(0.5, 15.0), dusty(0.5, 0.8, 0.7), with_drops(1.0, 30.0)}) {
    const Optics optics = with_condition(condition);
    const Events in(optics, 4000, in_disc(air, false), arrives(body, true));
    const Events out(optics, 4000, in_disc(-body, true), arrives(-air, false));
    EXPECT_NEAR(in.mean, out.mean, student_bound(5) * std::hypot(in.std_error, out.std_error));
    EXPECT_GT(in.mean, 3.0 * in.std_error);
  }
}

// For roughness with a correlation length much longer than the wavelength, the fraction exp(-(4 pi s / w)^2) of the
// reflection remains specular.
TEST(ContaminatedEntrance, RoughnessOfTheFaceDims) {
  EntranceCondition condition;
  condition.roughness = surface_models::HarveyShack({20.0, 30.0, 0.0, 0.0}, {kPmma, 1.0, 587.56});
  const Events specular(with_condition(condition), 2000, always(ray_at(Vec2::Zero(), false)),
                        [](const Ray& ray) { return ray.scattered ? 0.0 : power_in_air(ray); });
  const double kept = std::exp(-std::pow(4.0 * pi * 20.0 / 587.56, 2.0));
  EXPECT_NEAR(specular.mean, kept * materials::reflectance(1.0 / kPmma, 1.0), 2e-3 * specular.mean + 1e-9);
}

// An entrance face has layers and is half wet. Mirrors behind it return all light along the normal. The exact engine
// and the ray tracer must give the RRE R + T^2 / (1 - R'). R and T are the reflectance and transmittance of the face
// for light from outside, and R' is its reflectance for light from inside.
TEST(ContaminatedEntrance, LayersAndFilmBeforeMirrors) {
  const Part part = build_part(single(RtpElement{0.5, 0.5, 90.0}, 0.5));
  EntranceCondition condition = wet(0.5);
  condition.layers.insert(condition.layers.begin(), {1.6, 0.02, 3.0});
  Optics optics = with_condition(condition);
  optics.mirror_facets = true;
  const auto r = [](double a, double b) { return std::pow((a - b) / (a + b), 2.0); };
  // R, T and R' of the layer, and of the layer with water, are sums over multiple reflections between pairs of faces.
  const double a = std::exp(-0.06);
  const auto join = [](std::array<double, 3> one, std::array<double, 3> two, double kept) {  // R, T, R'
    const double sum = 1.0 / (1.0 - one[2] * two[0] * kept * kept);
    return std::array<double, 3>{one[0] + one[1] * one[1] * two[0] * kept * kept * sum, one[1] * two[1] * kept * sum,
                                 two[2] + two[1] * two[1] * one[2] * kept * kept * sum};
  };
  const auto face = [&](double n1, double n2) { return std::array<double, 3>{r(n1, n2), 1.0 - r(n1, n2), r(n1, n2)}; };
  const auto dry = join(face(1.0, 1.6), face(1.6, kPmma), a);
  const auto film = join(join(face(1.0, kWater), face(kWater, 1.6), 1.0), face(1.6, kPmma), a);
  const double reflected = 0.5 * (dry[0] + film[0]);
  const double passed = 0.5 * (dry[1] + film[1]);
  const double back = 0.5 * (dry[2] + film[2]);
  const double expected = reflected + passed * passed / (1.0 - back);
  expect_returned_or_absorbed(part, optics, expected);
  const ConeResult sampled = MonteCarlo(part).trace(optics, {}, {0.5}, rays(1U << 14), {}).cones[0];
  EXPECT_NEAR(sampled.rre, expected, 4.0 * sampled.std_error + 1e-6);
}

// The Monte Carlo engines (Embree, and cell by cell) must agree for infinite and finite parts. Faces with only layers
// and films are also traced by the exact engine.
TEST(ContaminatedEntrance, EnginesAgreeAndLedgersClose) {
  const std::vector<PartSpec> parts = {infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5),
                                       finite(HexagonalCube{0.5}, Arrangement::honeycomb, 3.5, 3.0, 0.8)};
  for (const PartSpec& spec : parts) {
    const Part part = build_part(spec);
    for (const EntranceCondition& condition : {filthy(), rough(), hazy(0.1, 3.0)}) {
      Optics optics = with_condition(condition);
      optics.absorption_per_mm = 0.05;
      const auto trace = [&](MonteCarlo::Engine engine) {
        return MonteCarlo(part, engine).trace(optics, from(15.0, 25.0), {5.0}, rays(1U << 14), {});
      };
      const MonteCarloResult cell = trace(MonteCarlo::Engine::cell);
      const MonteCarloResult embree = trace(MonteCarlo::Engine::embree);
      const double error = std::hypot(cell.cones[0].std_error, embree.cones[0].std_error);
      EXPECT_NEAR(cell.cones[0].rre, embree.cones[0].rre, student_bound(6) * error);
      for (const MonteCarloResult& traced : {cell, embree}) {
        EXPECT_NEAR(traced.cones[0].ledger.total(), 1.0, 1e-9);
        EXPECT_EQ(traced.misses, 0U);
        EXPECT_GT(traced.cones[0].ledger[Account::scattered_out], 0.0);
      }
      for (std::size_t a = 0; a < kAccountCount; ++a)
        EXPECT_NEAR(cell.cones[0].ledger.power[a], embree.cones[0].ledger.power[a], 0.01) << kAccountNames[a];
    }
    Optics layered = with_condition(wet(0.4));
    BeamPolicy policy;
    policy.cutoff = 1e-4 / static_cast<double>(std::max<std::int64_t>(1, part.elements_full));
    const Ledger exact = BeamTracer(part).trace(layered, from(15.0, 25.0), {5.0}, policy).ledgers[0];
    EXPECT_NEAR(exact.total(), 1.0, 1e-9);
    const ConeResult cell =
        MonteCarlo(part, MonteCarlo::Engine::cell).trace(layered, from(15.0, 25.0), {5.0}, rays(1U << 14), {}).cones[0];
    EXPECT_NEAR(cell.rre, exact[Account::retroreflected], 5.0 * cell.std_error + exact[Account::truncated]);
  }
}

// The effect of every kind of contamination is at most the contaminated fraction of the face. It vanishes as this
// fraction goes to 0.
TEST(ContaminatedEntrance, NothingIsLeftOfNothing) {
  const Part part = build_part(infinite(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 0.5));
  const auto ledger = [&](const EntranceCondition& condition) {
    return MonteCarlo(part, MonteCarlo::Engine::cell)
        .trace(with_condition(condition), from(10.0, 25.0), {0.5}, rays(1U << 13), {})
        .cones[0]
        .ledger;
  };
  const Ledger clean = ledger({});
  EXPECT_EQ(ledger(with_drops(0.0, 30.0)).power, clean.power);
  constexpr double kLittle = 1e-6;
  EntranceCondition scratched;
  scratched.scratches = {kLittle, sin_deg(10.0), {}};
  EntranceCondition smooth;
  smooth.roughness = surface_models::HarveyShack({0.02, 3.0, 0.0, 0.0}, {kPmma, 1.0, 587.56});
  for (const EntranceCondition& condition :
       {dusty(kLittle, 0.5, 0.5), hazy(kLittle, 3.0), with_drops(kLittle, 30.0), scratched, smooth}) {
    const Ledger soiled = ledger(condition);
    for (std::size_t a = 0; a < kAccountCount; ++a)
      EXPECT_NEAR(soiled.power[a], clean.power[a], 2e-3) << kAccountNames[a];  // the random choices differ
    EXPECT_LT(soiled[Account::scattered_out], 1e-3);
  }
}

}  // namespace
}  // namespace retrace::testing::soiled_entrance_test

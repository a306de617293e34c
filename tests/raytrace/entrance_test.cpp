// Tests of curved entrance surfaces. A plane surface must equal the plane entrance face. Lenses and wedges are compared
// with rays in closed form. Slabs and light that misses the part are compared with closed forms, and curved surfaces
// with fine meshes. Power must be conserved.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "core/error.h"
#include "geometry/entrance/entrance_mesh.h"
#include "geometry/part/plate.h"
#include "raytrace/faces/entrance_face.h"
#include "raytrace/faces/exact_surface.h"
#include "raytrace/paths/light_path.h"
#include "raytrace/paths/monte_carlo.h"
#include "raytrace/paths/path_tracer.h"
#include "tests/support/designs.h"
#include "tests/support/entrance_surfaces.h"
#include "tests/support/exit_recorder.h"
#include "tests/support/refusals.h"

namespace retrace::testing::front_test {
namespace {

using namespace geometry;
using namespace raytrace;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDeg = std::numbers::pi / 180.0;

Optics mirrored_pmma() {
  Optics optics = pmma();
  optics.mirror_facets = true;
  return optics;
}

/// Returns a policy that follows every branch down to the cut-off, without random choices.
PathPolicy every_branch(double cutoff = 1e-13) {
  PathPolicy policy;
  policy.cutoff = cutoff;
  policy.split_power = 0.0;
  return policy;
}

MonteCarloResult traced(const Part& part, const Entrance* front, const Optics& optics, const Illumination& light,
                        std::uint64_t count, const PathPolicy& policy = {}, double cone_deg = 0.5) {
  return MonteCarlo(part, MonteCarlo::Engine::embree, front).trace(optics, light, {cone_deg}, rays(count), policy);
}

void expect_same(const ConeResult& a, const ConeResult& b, double tolerance) {
  for (std::size_t k = 0; k < kAccountCount; ++k)
    EXPECT_NEAR(a.ledger.power[k], b.ledger.power[k], tolerance) << kAccountNames[k];
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(a.stokes.values()[k], b.stokes.values()[k], tolerance) << k;
}

/// Traces single rays through a part with a curved entrance surface.
struct OneRay {
  OneRay(const Part& part, const Entrance& front, const Vec2& centre)
      : part_(part), centre_(centre), back_(part, centre), face_(make_entrance_face(front, part, centre)) {}

  /// \param entry_mm entry point, relative to the center, in the plane that touches the entrance surface from above
  ExitRecorder follow(const Optics& optics, const Illumination& light, const Vec2& entry_mm) const {
    const PathSetup setup(part_, back_, centre_, optics, light, {0.5}, every_branch(1e-3), face_.get());
    Tally tally(1);
    ExitRecorder exits;
    PathWalker walker(setup, tally, &exits);
    walker.trace(entry_mm, {1, 2}, 0, 0);
    return exits;
  }
  const EntranceFace& face() const { return *face_; }

 private:
  const Part& part_;
  Vec2 centre_;
  BackSurface back_;
  std::unique_ptr<const EntranceFace> face_;
};

Vec3 snell(const Vec3& d, const Vec3& n_out, double n1, double n2) {
  const Vec3 n = n_out.dot(d) < 0.0 ? n_out : Vec3(-n_out);
  const Vec3 tangential = n1 / n2 * (d - d.dot(n) * n);
  return tangential - std::sqrt(1.0 - tangential.squaredNorm()) * n;
}

Vec3 towards_part(double incidence_deg, double azimuth_deg) {
  const double t = incidence_deg * kDeg;
  const double p = azimuth_deg * kDeg;
  return -Vec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
}

// A plane that is given as a surface or as two triangles is equivalent to the plane entrance face: rays, random choices
// and sums are the same.
TEST(Entrance, PlaneIsTheEntranceFace) {
  PartSpec spec = finite(RtpElement{0.5, 0.4, 88.0}, Arrangement::offset, 2.3, 1.9, 0.7);
  const Part part = build_part(spec);
  const Entrance surface = plane_entrance(0.7);
  TriangleMesh sheet;
  sheet.vertices = {{-1, -1, 0}, {4, -1, 0}, {4, 4, 0}, {-1, 4, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Entrance mesh =
      std::make_shared<const SurfacePatch>(entrance_of_mesh(sheet, MeshSide::top, Vec3(0, 0, 0.7), part.outline));
  Illumination light = from(27.0, 30.0);
  light.stokes = {1.0, 0.3, -0.5, -0.4};
  Optics optics = pmma();
  optics.absorption_per_mm = 0.02;
  for (const bool lossless : {false, true}) {
    optics.lossless_entrance = lossless;
    const ConeResult flat = traced(part, nullptr, optics, light, 4096, {}, 8.0).cones[0];
    expect_same(flat, traced(part, &surface, optics, light, 4096, {}, 8.0).cones[0], 1e-12);
    expect_same(flat, traced(part, &mesh, optics, light, 4096, {}, 8.0).cones[0], 1e-12);
  }
}

// Layers on a plane that is given as a surface act like layers on the entrance face. The cases include normal and
// oblique incidence, layers that do not reflect or that absorb, and light of every polarisation.
TEST(Entrance, LayersOnAPlaneAreThoseOfTheEntranceFace) {
  const Part part = build_part(finite(RtpElement{0.5, 0.4, 88.0}, Arrangement::offset, 2.3, 1.9, 0.7));
  const Entrance surface = plane_entrance(0.7);
  for (const materials::LayerStack& layers : {anti_reflection(), thin_aluminium()}) {
    Optics optics = pmma();
    optics.entrance_layers = layers;
    for (Illumination light : {from(0.0), from(27.0, 30.0), from(70.0, 200.0)}) {
      light.stokes = {1.0, 0.3, -0.5, -0.4};
      const ConeResult flat = traced(part, nullptr, optics, light, 4096, {}, 8.0).cones[0];
      const ConeResult curved = traced(part, &surface, optics, light, 4096, {}, 8.0).cones[0];
      expect_same(flat, curved, 1e-12);
      EXPECT_NEAR(curved.ledger.total(), 1.0, 1e-9);
      EXPECT_EQ(curved.ledger[Account::absorbed] > 1e-3, layers.absorbs());
    }
  }
}

// For wavy surfaces with absorbing layers, the accounts of the ledger add up to 1.
TEST(Entrance, LedgersOfCoatedWavesAddUpToOne) {
  const Part part = build_part(finite(RtpElement{0.5, 0.4, 90.0}, Arrangement::offset, 2.3, 1.9, 0.7));
  const Entrance waves = egg_box_entrance(0.8, 0.03, 6.0);
  for (const materials::LayerStack& layers : {anti_reflection(), thin_aluminium()}) {
    Optics optics = pmma();
    optics.entrance_layers = layers;
    for (const double incidence : {0.0, 35.0}) {
      const ConeResult result = traced(part, &waves, optics, from(incidence, 20.0), 2048).cones[0];
      EXPECT_NEAR(result.ledger.total(), 1.0, 1e-9);
      EXPECT_EQ(result.ledger[Account::lost], 0.0);
      EXPECT_EQ(result.ledger[Account::absorbed] > 0.05, layers.absorbs());
    }
  }
}

// A ray passes through a wedge over a mirror: refraction, reflection and refraction. The expected power of both
// polarisations is computed independently.
TEST(Entrance, WedgeRefractsBothPolarisationsAsByHand) {
  const Part plate = build_plate({2.0, 2.0}, 1.0);
  for (const double slope : {0.1, -0.3}) {
    const OneRay tracer(plate, plane_entrance(1.0 - slope, slope), {1.0, 1.0});
    const Vec3 n = Vec3(-slope, 0.0, 1.0).normalized();
    for (const double incidence : {0.0, 12.0, -20.0}) {
      const Vec3 d0 = towards_part(incidence, 0.0);
      const Vec3 d1 = snell(d0, n, 1.0, kPmma);
      const Vec3 d2 = Vec3(d1.x(), d1.y(), -d1.z());
      const Vec3 d3 = snell(d2, n, kPmma, 1.0);
      for (const bool s_polarised : {true, false}) {
        // Powers follow from Fresnel's formulas as functions of angles (Born and Wolf, 1.5.2). The plane of incidence
        // is the xz plane.
        const auto transmitted = [&](const Vec3& before, const Vec3& after) {
          const double a = std::acos(std::abs(n.dot(before)));
          const double b = std::acos(std::abs(n.dot(after)));
          if (a < 1e-9) return 4.0 * kPmma / ((1.0 + kPmma) * (1.0 + kPmma));
          const double r = s_polarised ? std::sin(a - b) / std::sin(a + b) : std::tan(a - b) / std::tan(a + b);
          return 1.0 - r * r;
        };
        Illumination light = from(incidence);
        light.stokes = {1.0, s_polarised ? -1.0 : 1.0, 0.0, 0.0};  // first axis in the plane of incidence
        const ExitRecorder::Exit exit = tracer.follow(mirrored_pmma(), light, {0.05, 0.1}).strongest();
        EXPECT_LT((exit.direction - d3).norm(), 1e-13) << slope << " " << incidence;
        EXPECT_NEAR(exit.power, transmitted(d0, d1) * transmitted(d2, d3), 1e-11) << slope << " " << incidence;
      }
    }
  }
}

/// A ray through a spherical cap to a mirror at z = 0 and back, in closed form. z is measured from the mirror.
struct ByHand {
  Vec3 at;
  Vec3 direction;
};

ByHand through_sphere(double radius, double thickness, double n, const Vec3& from, const Vec3& d0) {
  const Vec3 centre(0.0, 0.0, thickness - radius);
  const auto meet = [&](const Vec3& p, const Vec3& d, double side) {
    const Vec3 q = p - centre;
    const double b = q.dot(d);
    return Vec3(p + (-b + side * std::sqrt(b * b - q.squaredNorm() + radius * radius)) * d);
  };
  const Vec3 in = meet(from, d0, -1.0);
  const Vec3 d1 = snell(d0, (in - centre) / radius, 1.0, n);
  const Vec3 bottom = in - in.z() / d1.z() * d1;
  const Vec3 d2(d1.x(), d1.y(), -d1.z());
  const Vec3 out = meet(bottom, d2, 1.0);
  return {out, snell(d2, (out - centre) / radius, n, 1.0)};
}

/// Returns the power transmittance of a layer between two media, as the sum over all paths with multiple reflections in
/// the layer (Airy): Hecht, Optics, 9.6.1, with Fresnel's amplitudes for each polarisation.
double through_layer(double n0, double n1, double n2, double thickness, double cos0, bool s_polarised) {
  const auto cos_in = [&](double n) { return std::sqrt(1.0 - std::pow(n0 / n, 2.0) * (1.0 - cos0 * cos0)); };
  const auto r = [&](double a, double b) {
    const double ca = cos_in(a), cb = cos_in(b);
    return s_polarised ? (a * ca - b * cb) / (a * ca + b * cb) : (b * ca - a * cb) / (b * ca + a * cb);
  };
  const std::complex<double> turn = std::polar(1.0, 4.0 * std::numbers::pi * n1 * thickness * cos_in(n1));
  const double r01 = r(n0, n1), r12 = r(n1, n2);
  const std::complex<double> reflected = (r01 + r12 * turn) / (1.0 + r01 * r12 * turn);
  return 1.0 - std::norm(reflected);
}

// The effect of layers on a lens depends on the local angle of incidence, both on entry and on exit.
TEST(Entrance, LayersOnALensActByTheLocalIncidence) {
  const double radius = 3.0, thickness = 4.0;
  const Vec2 size(2.4, 2.0);
  const Part plate = build_plate(size, 0.5 * thickness);
  const OneRay tracer(plate, sphere_entrance(radius, thickness, 0.5 * size), 0.5 * size);
  const Vec3 centre(0.0, 0.0, thickness - radius);
  Optics optics = mirrored_pmma();
  for (const double layer : {0.25 / 1.3777, 0.4}) {
    optics.entrance_layers = {{{1.3777, layer}}};
    for (const double incidence : {0.0, 8.0})
      for (const double x : {0.0, 0.5, -0.7})
        for (const bool s_polarised : {true, false}) {
          const Vec3 d0 = towards_part(incidence, 0.0);
          const Vec3 top(x, 0.0, thickness);
          const Vec3 q = top - centre;
          const double b = q.dot(d0);
          const Vec3 normal = (q + (-b - std::sqrt(b * b - q.squaredNorm() + radius * radius)) * d0) / radius;
          const ByHand hand = through_sphere(radius, thickness, kPmma, top, d0);
          const double cos_out = hand.direction.dot(hand.at - centre) / radius;
          Illumination light = from(incidence);
          light.stokes = {1.0, s_polarised ? -1.0 : 1.0, 0.0, 0.0};
          const ExitRecorder::Exit exit = tracer.follow(optics, light, {x, 0.0}).strongest();
          // By reciprocity, the transmittance is the same in both directions.
          const double expected = through_layer(1.0, 1.3777, kPmma, layer, -d0.dot(normal), s_polarised) *
                                  through_layer(1.0, 1.3777, kPmma, layer, cos_out, s_polarised);
          EXPECT_LT((exit.direction - hand.direction).norm(), 1e-12);
          EXPECT_NEAR(exit.power, expected, 1e-10) << layer << " " << incidence << " " << x << " " << s_polarised;
        }
  }
}

TEST(Entrance, LensOverAMirrorFollowsRaysByHand) {
  const double radius = 3.0;
  const Vec2 size(2.4, 2.0);
  for (const double thickness : {4.0, kPmma / (kPmma - 1.0) * radius}) {
    const Part plate = build_plate(size, 0.5 * thickness);
    const OneRay tracer(plate, sphere_entrance(radius, thickness, 0.5 * size), 0.5 * size);
    EXPECT_NEAR(tracer.face().highest_mm(), thickness, 1e-15);
    EXPECT_NEAR(tracer.face().lowest_mm(), thickness - radius + std::sqrt(9.0 - 1.44 - 1.0), 1e-14);
    int compared = 0;
    for (const double incidence : {0.0, 3.0, 8.0})
      for (const Vec2& entry : {Vec2(0.0, 0.0), Vec2(0.3, 0.2), Vec2(-0.7, 0.4), Vec2(0.9, -0.8)}) {
        const Vec3 d0 = towards_part(incidence, 20.0);
        const ByHand hand = through_sphere(radius, thickness, kPmma, {entry.x(), entry.y(), thickness}, d0);
        if (std::abs(hand.at.x()) > 1.19 || std::abs(hand.at.y()) > 0.99) continue;  // leaves through a side
        const ExitRecorder::Exit exit = tracer.follow(mirrored_pmma(), from(incidence, 20.0), entry).strongest();
        EXPECT_LT((exit.direction - hand.direction).norm(), 1e-13) << incidence << " " << entry.transpose();
        EXPECT_LT((exit.position - hand.at).norm(), 1e-12) << incidence << " " << entry.transpose();
        ++compared;
      }
    EXPECT_GE(compared, 8);
  }
}

// The focus of a spherical cap is n R / (n - 1) below the cap. A mirror at the focus returns light parallel to the
// incident light except for spherical aberration. The angle of this aberration is proportional to the cube of the ray
// height, so half the height gives an eighth of the angle. Out of focus, the angle is proportional to the height. It
// follows from ray matrices: refraction at the cap, the path to the mirror and back, and refraction at the cap (Hecht,
// Optics, 6.2.1).
TEST(Entrance, CatsEyeSendsLightBackInParallel) {
  const double radius = 2.0;
  const double focus = kPmma / (kPmma - 1.0) * radius;
  const Vec2 size(1.0, 1.0);
  const auto error = [&](double thickness, double height) {
    const Part plate = build_plate(size, 0.5 * thickness);
    const OneRay tracer(plate, sphere_entrance(radius, thickness, 0.5 * size), 0.5 * size);
    const ExitRecorder::Exit exit = tracer.follow(mirrored_pmma(), from(0.0), {height, 0.0}).strongest();
    return exit.direction.x() / exit.direction.z();
  };
  const double at_tenth = error(focus, 0.1);
  EXPECT_LT(std::abs(at_tenth), 1e-4);
  EXPECT_GT(std::abs(at_tenth), 1e-7);
  EXPECT_NEAR(error(focus, 0.1) / error(focus, 0.05), 8.0, 0.05);
  const double thickness = 0.8 * focus;
  const double height = 1e-3;
  const double in = -(kPmma - 1.0) / (kPmma * radius) * height;  // paraxial angle behind the cap
  const double arrives = height + in * 2.0 * thickness;
  const double out = kPmma * in - (kPmma - 1.0) / radius * arrives;
  EXPECT_NEAR(error(thickness, height), out, 1e-6 * std::abs(out));
}

// At normal incidence, a slab reflects 2 R / (1 + R) and transmits the rest. This is the sum over all paths with
// multiple reflections.
TEST(Entrance, SlabAtNormalIncidence) {
  const Part plate = build_plate({1.0, 0.7}, 0.5);
  const Entrance front = plane_entrance(0.5);
  const double r = std::pow((kPmma - 1.0) / (kPmma + 1.0), 2.0);
  const ConeResult slab = traced(plate, &front, pmma(), from(0.0), 32, every_branch()).cones[0];
  EXPECT_NEAR(slab.rre, 2.0 * r / (1.0 + r), 1e-12);
  EXPECT_NEAR(slab.ledger[Account::transmitted], (1.0 - r) / (1.0 + r), 1e-12);
  EXPECT_NEAR(slab.ledger.total(), 1.0, 1e-12);
}

// The wedge rises by the slope s over the length L. The beam covers the horizontal plane through the upper edge of the
// wedge. At the angle of incidence t, rays within L s tan t of the lower edge miss the wedge and count as transmitted.
TEST(Entrance, WhatPassesBesideIsTransmitted) {
  const double slope = 0.25;
  const Part plate = build_plate({2.0, 1.0}, 1.0);
  const Entrance front = plane_entrance(1.0, slope);
  Optics optics = mirrored_pmma();
  optics.lossless_entrance = true;
  for (const double incidence : {10.0, 40.0}) {
    const ConeResult result = traced(plate, &front, optics, from(incidence), 1U << 15).cones[0];
    EXPECT_NEAR(result.ledger[Account::transmitted], slope * std::tan(incidence * kDeg),
                4.0 / std::sqrt(static_cast<double>(1U << 15)) * 0.05)
        << incidence;
    EXPECT_NEAR(result.ledger.total(), 1.0, 1e-12);
    EXPECT_EQ(result.ledger[Account::lost], 0.0);
  }
  EXPECT_EQ(traced(plate, &front, optics, from(0.0), 1024).cones[0].ledger[Account::transmitted], 0.0);
}

/// Returns the distance to the first intersection of a ray with a surface, found by small steps and bisection. Returns
/// infinity if there is no intersection.
double crossing_by_steps(const EntranceSurface& surface, const Vec3& from, const Vec3& direction, double until,
                         bool inside) {
  const auto gap = [&](double t) {
    const Vec3 p = from + t * direction;
    return (inside ? -1.0 : 1.0) * (p.z() - surface.at(p.head<2>()).height_mm);
  };
  constexpr int kSteps = 20000;
  double before = 1e-9;
  for (int k = 1; k <= kSteps; ++k) {
    double t = until * k / kSteps;
    if (gap(t) > 0.0) {
      before = t;
      continue;
    }
    for (int i = 0; i < 80; ++i) (gap(0.5 * (before + t)) > 0.0 ? before : t) = 0.5 * (before + t);
    return t;
  }
  return kInfinity;
}

// Rays start at random positions above, below and on an egg-box surface, in random directions.
TEST(Entrance, FindsTheFirstCrossing) {
  const Part plate = build_plate({2.0, 2.0}, 0.5);
  const Entrance front = egg_box_entrance(1.0, 0.1, 9.0);
  const EntranceSurface& surface = *std::get<0>(front);
  const auto face = make_entrance_face(front, plate, Vec2::Zero());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int met = 0;
  int found_again = 0;
  for (int k = 0; k < 600; ++k) {
    const bool inside = k % 2 == 0;
    const bool starts_on = k % 3 == 0;
    Vec3 from(1.0 + 0.9 * uniform(random), 1.0 + 0.9 * uniform(random), 0.0);
    // Some rays start on the borders of grid cells, for any number of cells.
    if (k % 5 == 0) from.x() = std::round(32.0 * from.x()) / 32.0;
    if (k % 7 == 0) from.y() = std::round(32.0 * from.y()) / 32.0;
    const EntranceSurface::SurfaceSample place = surface.at(from.head<2>());
    from.z() = starts_on ? place.height_mm : place.height_mm + (inside ? -0.3 : 0.3) * std::abs(uniform(random));
    Vec3 direction = Vec3(uniform(random), uniform(random), 0.4 * uniform(random)).normalized();
    const Vec3 out = Vec3(-place.slope.x(), -place.slope.y(), 1.0);
    if (starts_on && (out.dot(direction) < 0.0) != inside) direction = -direction;
    double until = kInfinity;
    for (int axis = 0; axis < 2; ++axis)
      until = std::min(until, (direction[axis] > 0.0 ? 2.0 - from[axis] : -from[axis]) / direction[axis]);
    const double t = crossing_by_steps(surface, from, direction, until, inside);
    SurfaceRay ray{from, direction, starts_on ? FacetRef{0, 0} : FacetRef{}, inside, until};
    const auto hit = face->first_hit(ray);
    ASSERT_EQ(hit.has_value(), std::isfinite(t)) << k << " " << t << " of " << until;
    if (!hit) continue;
    ++met;
    if (starts_on) ++found_again;
    EXPECT_NEAR(hit->hit.t, t, 1e-9) << k;
    const Vec3 at = from + hit->hit.t * direction;
    const EntranceSurface::SurfaceSample there = surface.at(at.head<2>());
    EXPECT_NEAR(at.z(), there.height_mm, 1e-14) << k;
    EXPECT_NEAR(hit->normal.dot(Vec3(1.0, 0.0, there.slope.x())), 0.0, 1e-12);
  }
  EXPECT_GT(met, 150);
  EXPECT_GT(found_again, 20);
}

// The waves are too fine for the initial grids. The surface is either refused, or all rays find their intersections.
TEST(Entrance, WavesFinerThanTheFirstGridAreNotPassedBy) {
  const Part plate = build_plate({2.0, 2.0}, 0.5);
  for (const double waves : {31.7, 32.0, 64.0}) {
    const double k = 2.0 * std::numbers::pi * waves / 2.0;
    const Entrance front = egg_box_entrance(1.0, 0.005, k, INFINITY);
    const EntranceSurface& surface = *std::get<0>(front);
    const auto face = make_entrance_face(front, plate, Vec2::Zero());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.1, 1.9);
    for (int i = 0; i < 100; ++i) {
      const Vec3 from(uniform(random), uniform(random), 1.006);
      const Vec3 direction = Vec3(0.2, 0.1, -1.0).normalized();
      const double t = crossing_by_steps(surface, from, direction, 0.05, false);
      const auto hit = face->first_hit({from, direction, {}, false, 0.05});
      ASSERT_TRUE(hit.has_value()) << waves << " " << i;
      EXPECT_NEAR(hit->hit.t, t, 1e-9) << waves << " " << i;
    }
  }
  const Entrance fine = formula_entrance("1 + 1e-3 * cos(9e3 * x)");
  EXPECT_THROW(make_entrance_face(fine, plate, Vec2::Zero()), InputError);
}

// Steep lenslets are in front of prisms, so that light may leave one lenslet and enter another. No power is lost, and a
// fine mesh of the same surface gives the same accounts.
TEST(Entrance, SurfaceAndItsMeshAgreeOverPrisms) {
  const Part part = build_part(finite(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.0, 1.0, 0.6));
  const Entrance surface = egg_box_entrance(0.6, 0.08, 2.0 * std::numbers::pi / 0.4);
  const Entrance mesh = std::make_shared<const SurfacePatch>(
      entrance_of_mesh(meshed(*std::get<0>(surface), 1.0, 320), MeshSide::top, Vec3::Zero(), part.outline));
  PathPolicy policy;
  policy.split_power = 1e-3;  // hardly any random choices, so that both runs trace the same rays
  for (const double incidence : {0.0, 35.0, 70.0}) {
    const MonteCarloResult exact = traced(part, &surface, pmma(), from(incidence, 15.0), 1U << 13, policy, 20.0);
    EXPECT_NEAR(exact.cones[0].ledger.total(), 1.0, 1e-9);
    EXPECT_EQ(exact.misses, 0U);
    const MonteCarloResult by_mesh = traced(part, &mesh, pmma(), from(incidence, 15.0), 1U << 13, policy, 20.0);
    EXPECT_EQ(by_mesh.misses, 0U);
    // Both results are estimates. The facets of the mesh cause an additional error of up to 1e-3.
    const double bound = 4.0 * std::hypot(exact.cones[0].spread, by_mesh.cones[0].spread) + 1e-3;
    EXPECT_LT(bound, 0.02);
    for (std::size_t k = 0; k < kAccountCount; ++k)
      EXPECT_NEAR(exact.cones[0].ledger.power[k], by_mesh.cones[0].ledger.power[k], bound) << kAccountNames[k];
  }
}

// For an egg-box surface over a plate, four azimuths must give the same result.
TEST(Entrance, SymmetricFrontsGiveSymmetricAnswers) {
  const Part plate = build_plate({1.2, 1.2}, 0.5);
  const Entrance front = egg_box_entrance(0.6, 0.05, 2.0 * std::numbers::pi / 0.4);
  const MonteCarloResult first = traced(plate, &front, mirrored_pmma(), from(25.0, 0.0), 1U << 15, {}, 10.0);
  for (const double azimuth : {90.0, 180.0, 270.0}) {
    const MonteCarloResult turned = traced(plate, &front, mirrored_pmma(), from(25.0, azimuth), 1U << 15, {}, 10.0);
    EXPECT_NEAR(turned.cones[0].rre, first.cones[0].rre,
                5.0 * std::hypot(first.cones[0].spread, turned.cones[0].spread));
    EXPECT_NEAR(turned.cones[0].ledger.total(), 1.0, 1e-9);
  }
}

TEST(Entrance, RangesAreThoseOfTheOutline) {
  const Polygon outline = to_polygon({Vec2(-0.3, -0.2), Vec2(1.1, 0.9)});
  const EntranceRange range = entrance_range(egg_box_entrance(1.0, 0.1, std::numbers::pi / 0.5), outline);
  EXPECT_NEAR(range.highest_mm, 1.1, 1e-15);
  EXPECT_NEAR(range.lowest_mm, 0.9, 1e-15);
  const EntranceRange slope = entrance_range(plane_entrance(2.0, 0.5, -0.25), outline);
  EXPECT_NEAR(slope.highest_mm, 2.0 + 0.55 + 0.05, 1e-12);
  EXPECT_NEAR(slope.lowest_mm, 2.0 - 0.15 - 0.225, 1e-12);
  EXPECT_NEAR(slope.steepest_slope, std::hypot(0.5, 0.25), 1e-15);
  EXPECT_THROW(entrance_range(sphere_entrance(1.0, 1.0, {0.0, 0.0}), outline), InputError);
}

TEST(Entrance, MeshesMustCoverTheOutlineOnce) {
  const Polygon outline = to_polygon({Vec2(0.0, 0.0), Vec2(1.0, 1.0)});
  const auto message = [&](const TriangleMesh& mesh, MeshSide side) -> std::string {
    return refusal_of([&] { entrance_of_mesh(mesh, side, Vec3::Zero(), outline); });
  };
  EXPECT_EQ(message(box_mesh({1.0, 1.0}, 0.5), MeshSide::top), "");
  EXPECT_EQ(message(box_mesh({1.0, 1.0}, 0.5), MeshSide::bottom), "");
  EXPECT_EQ(message(box_mesh({1.0, 0.5}, 0.5), MeshSide::top), "refused");
  TriangleMesh twice = box_mesh({1.0, 1.0}, 0.5);
  twice.triangles.push_back(twice.triangles[2]);
  EXPECT_EQ(message(twice, MeshSide::top), "refused");
}

// Paths for drawings are refracted at the exact surface, like traced paths. Behind a lossless surface with mirrors,
// light does not split, so that both methods give a single path. Paths are not compared if the traced light does not
// leave, because it meets the surface from inside beyond the critical angle.
TEST(Entrance, DrawnPathsAreTracedPaths) {
  const Part part = build_part(finite(HexagonalCube{1.0}, Arrangement::honeycomb, 5.0, 4.0, 1.0));
  const Vec2 centre = bounding_box(part.outline).centre();
  const Entrance sphere = sphere_entrance(12.0, 1.5, centre);
  const OneRay one(part, sphere, centre);
  const ExactSurface surface(part, centre);
  const HitFinder first_hit = [&](const SurfaceRay& ray) { return surface.first_hit(ray); };
  std::size_t compared = 0;
  for (const double incidence_deg : {0.0, 12.0})
    for (const Vec2& aside : {Vec2(0.11, 0.07), Vec2(-0.6, 0.35), Vec2(0.83, -0.58), Vec2(-0.05, -0.12)}) {
      const Illumination light = from(incidence_deg, 40.0);
      const LightPath path = strongest_path(part, first_hit, centre, ideal(), light, 0.5, centre + aside, &one.face());
      const ExitRecorder exits = one.follow(ideal(), light, aside);
      if (exits.all.empty()) continue;
      ++compared;
      ASSERT_EQ(exits.all.size(), 1U);
      ASSERT_EQ(path.steps.back().event, PathEvent::leaves);
      const std::size_t last = path.points_mm.size() - 1;
      const Vec3 direction = (path.points_mm[last] - path.points_mm[last - 1]).normalized();
      EXPECT_LT((direction - exits.all[0].direction).norm(), 1e-9);
      EXPECT_LT((path.points_mm[last - 1] - exits.all[0].position - Vec3(centre.x(), centre.y(), 0.0)).norm(), 1e-9);
    }
  EXPECT_GE(compared, 4U);
}

TEST(Entrance, DrawnPathsBehindAPlaneSurfaceAreThoseOfThePlaneFace) {
  const Part part = build_part(finite(RtpElement{0.5, 0.4}, Arrangement::offset, 2.3, 1.9, 0.7));
  const Vec2 centre = bounding_box(part.outline).centre();
  const ExactSurface surface(part, centre);
  const HitFinder first_hit = [&](const SurfaceRay& ray) { return surface.first_hit(ray); };
  const auto face = make_entrance_face(plane_entrance(0.7), part, centre);
  for (const double incidence_deg : {0.0, 25.0, 60.0})
    for (const Vec2& at : {Vec2(0.31, 0.27), Vec2(1.2, 0.9), Vec2(2.1, 1.6)}) {
      const Illumination light = from(incidence_deg, 70.0);
      const LightPath plane = strongest_path(part, first_hit, centre, pmma(), light, 0.5, at);
      const LightPath curved = strongest_path(part, first_hit, centre, pmma(), light, 0.5, at, face.get());
      ASSERT_EQ(plane.points_mm.size(), curved.points_mm.size());
      for (std::size_t k = 0; k < plane.points_mm.size(); ++k)
        EXPECT_LT((plane.points_mm[k] - curved.points_mm[k]).norm(), 1e-9) << k;
      EXPECT_NEAR(plane.power, curved.power, 1e-12);
    }
}

}  // namespace
}  // namespace retrace::testing::front_test

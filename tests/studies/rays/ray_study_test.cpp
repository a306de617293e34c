// Tests of a set of rays that hits a part. Positions, wavelengths, polarisation and accounts of the ledger (categories
// of power) are compared with closed forms and with beams.
#include "studies/rays/ray_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "design/io/design_reader.h"
#include "materials/dispersion.h"
#include "materials/io/material_library.h"
#include "studies/rays/ray_accounts.h"
#include "studies/rays/ray_arrays.h"
#include "studies/rre/rre.h"
#include "tests/support/refusals.h"

namespace retrace::testing::ray_study_test {
namespace {

using namespace studies;
using raytrace::Account;

/// A source of rays that are given in memory.
class Given : public RaySource {
 public:
  Given(RaySetInfo info, std::vector<SetRay> rays) : info_(std::move(info)), rays_(std::move(rays)) {}
  const RaySetInfo& info() const override { return info_; }
  bool read(std::size_t, std::vector<SetRay>& rays) override {
    rays = std::move(rays_);
    rays_.clear();
    return !rays.empty();
  }
  double fraction_read() const override { return rays_.empty() ? 1.0 : 0.0; }

 private:
  RaySetInfo info_;
  std::vector<SetRay> rays_;
};

struct Kept : RaySink {
  RaySinkLayout layout;
  std::vector<AccountedRay> rays;
  bool is_finished = false;
  void begin(const RaySinkLayout& given) override { layout = given; }
  void write(std::span<const AccountedRay> more) override { rays.insert(rays.end(), more.begin(), more.end()); }
  void finish() override { is_finished = true; }
};

/// Returns a design of a plate of 10 mm x 10 mm x 2 mm.
/// \param more lines of [body], followed by other sections
design::Design plate(const std::string& more = "refractive_index = 1.5\n") {
  return design::parse_design("[part]\nplate_mm = [10, 10]\n[body]\nthickness_mm = 2\n" + more, "plate.toml");
}

SetRay down_at(double x, double y) {
  SetRay ray;
  ray.position_mm = {x, y, 5.0};
  ray.direction = {0, 0, -1};
  ray.radiant_w = 3.0;
  return ray;
}

RayResult traced(const design::Design& design, const RayRequest& request, RaySource&& source, Kept& kept) {
  return RayStudy(design, request).run(source, &kept, nullptr, nullptr);
}

TEST(RayStudy, APlateSplitsLightAsItsSeriesSays) {
  RayRequest request;
  request.split = 0.0;
  request.cutoff = 1e-9;
  Kept kept;
  const RayResult result = traced(plate(), request, Given({}, {down_at(4, 5)}), kept);
  const double r = 0.04;  // reflectance for n = 1.5: (0.5 / 2.5)^2
  // r is the reflectance of a face. The upward rays have the powers r and (1 - r)^2 r^(2k - 1) for k = 1, 2, ...; the
  // downward rays have the powers (1 - r)^2 r^(2k) for k = 0, 1, ...
  ASSERT_GE(kept.rays.size(), 4U);
  double up = 0.0;
  double down = 0.0;
  for (const AccountedRay& ray : kept.rays) {
    (ray.direction.z() > 0.0 ? up : down) += ray.radiant_w;
    EXPECT_EQ(ray.number, 1U);
    EXPECT_NEAR((ray.position_mm - Vec3(4, 5, ray.direction.z() > 0.0 ? 2.0 : 0.0)).norm(), 0.0, 1e-12);
  }
  EXPECT_NEAR(up, 3.0 * (r + (1 - r) * (1 - r) * r / (1 - r * r)), 1e-7);
  EXPECT_NEAR(down, 3.0 * (1 - r) * (1 - r) / (1 - r * r), 1e-7);
  // The reflected light returns to the source, which is within the cone.
  EXPECT_NEAR(result.ledger.ledger[Account::retroreflected], up, 1e-12);
  EXPECT_NEAR(result.ledger.ledger[Account::transmitted], down, 1e-12);
  EXPECT_NEAR(result.ledger.ledger.total(), 3.0, 1e-9);
  EXPECT_TRUE(kept.is_finished);
  EXPECT_EQ(result.rays_out, kept.rays.size());
}

TEST(RayStudy, APlateShiftsObliqueLightAndPolarisesIt) {
  RayRequest request;
  request.split = 0.0;
  request.stokes = true;
  const double t = 50.0 * std::numbers::pi / 180.0;
  SetRay ray;
  ray.direction = {std::sin(t), 0.0, -std::cos(t)};
  ray.position_mm = Vec3(2.0, 5.0, 2.0) - 3.0 * ray.direction;
  ray.radiant_w = 1.0;
  Kept kept;
  traced(plate(), request, Given({}, {ray}), kept);
  const double inside = std::asin(std::sin(t) / 1.5);
  const double r_s = std::pow(std::sin(t - inside) / std::sin(t + inside), 2.0);
  const double r_p = std::pow(std::tan(t - inside) / std::tan(t + inside), 2.0);
  const auto straight = std::ranges::max_element(kept.rays, {}, &AccountedRay::radiant_w);
  EXPECT_NEAR((straight->position_mm - Vec3(2.0 + 2.0 * std::tan(inside), 5.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((straight->direction - ray.direction).norm(), 0.0, 1e-12);
  const double s = std::pow(1.0 - r_s, 2.0);
  const double p = std::pow(1.0 - r_p, 2.0);
  EXPECT_NEAR(straight->radiant_w, 0.5 * (s + p), 1e-12);
  EXPECT_TRUE(kept.layout.info.has_stokes);
  // More p-polarised light is transmitted. The long axis of the polarisation is therefore in the plane of incidence.
  EXPECT_NEAR(straight->stokes[0], (p - s) / (p + s), 1e-12);
  EXPECT_NEAR(std::abs(straight->axis.y()), 0.0, 1e-9);
}

TEST(RayStudy, StokesParametersOfTheSetGoIn) {
  RayRequest request;
  request.split = 0.0;
  const double brewster = std::atan(1.5);
  SetRay ray;
  ray.direction = {std::sin(brewster), 0.0, -std::cos(brewster)};
  ray.position_mm = Vec3(2.0, 5.0, 2.0) - 3.0 * ray.direction;
  ray.radiant_w = 1.0;
  RaySetInfo info;
  info.has_stokes = true;
  // Light polarised in the plane of incidence is not reflected. At 45 degrees to this plane, the reflectance is half
  // that of perpendicular polarisation.
  for (const double turn : {0.0, 0.25 * std::numbers::pi, 0.5 * std::numbers::pi}) {
    const Vec3 in_plane(std::cos(brewster), 0.0, std::sin(brewster));
    ray.axis = std::cos(turn) * in_plane + std::sin(turn) * Vec3::UnitY();
    ray.stokes = {1.0, 0.0, 0.0};
    Kept kept;
    const RayResult result = traced(plate(), request, Given(info, {ray}), kept);
    const double r_s = std::pow(std::sin(2.0 * brewster - 0.5 * std::numbers::pi), 2.0);
    EXPECT_NEAR(result.ledger.ledger[Account::front_specular], r_s * std::pow(std::sin(turn), 2.0), 1e-12);
  }
}

TEST(RayStudy, MissedRaysAreToldAndKeptOnRequest) {
  for (const bool keep : {false, true}) {
    RayRequest request;
    request.keep_missed = keep;
    Kept kept;
    const RayResult result =
        traced(plate(), request, Given({}, {down_at(-20, 0), down_at(4, 5), down_at(20, 0)}), kept);
    EXPECT_EQ(result.ledger.rays_missed, 2U);
    EXPECT_EQ(result.ledger.missed, 6.0);
    EXPECT_EQ(kept.rays.size(), keep ? 3U : 1U);
    if (!keep) continue;
    EXPECT_EQ(kept.rays[0].account, kMissedAccount);
    EXPECT_EQ(kept.rays[0].number, 1U);
    EXPECT_EQ(kept.rays[1].number, 2U);
    EXPECT_EQ(kept.rays[2].position_mm, Vec3(20, 0, 5));
  }
}

TEST(RayStudy, OneRayInIsOneOutUnlessItIsSplit) {
  Kept kept;
  const RayResult result = traced(plate(), {}, Given({}, std::vector<SetRay>(20000, down_at(4, 5))), kept);
  EXPECT_EQ(kept.rays.size(), 20000U);
  const double through = 0.96 * 0.96 / (1 - 0.04 * 0.04);
  EXPECT_NEAR(result.ledger.ledger[Account::transmitted] / result.ledger.incident, through, 4 * 0.0019);
  EXPECT_NEAR(result.ledger.std_error(), std::sqrt(through * (1 - through) / 20000), 2e-5);
}

/// Returns the refractive index of the plate, computed from the position at which an oblique ray leaves.
double index_from(const AccountedRay& ray, double t) {
  const double tan_inside = (ray.position_mm.x() - 2.0) / 2.0;
  return std::sin(t) / std::sin(std::atan(tan_inside));
}

double index_of_bk7(double nm) {
  const auto library = materials::MaterialLibrary::shipped();
  const materials::Material& glass = library.find("N-BK7", {});
  return materials::index_relative_to_air(glass, library.air(), nm, glass.temperature_c);
}

std::vector<SetRay> oblique(std::size_t count) {
  const double t = 0.7;
  SetRay ray;
  ray.direction = {std::sin(t), 0.0, -std::cos(t)};
  ray.position_mm = Vec3(2.0, 5.0, 2.0) - 3.0 * ray.direction;
  ray.radiant_w = ray.luminous_lm = 1.0;
  return std::vector<SetRay>(count, ray);
}

TEST(RayStudy, EachRayIsTracedAtItsWavelength) {
  RaySetInfo info;
  info.spectrum = RaySpectrum::wavelength_of_each;
  std::vector<SetRay> rays = oblique(3);
  rays[0].wavelength_nm = 440.0;
  rays[1].wavelength_nm = 587.6;
  rays[2].wavelength_nm = 780.0;
  RayRequest request;
  request.split = 0.0;
  Kept kept;
  const RayResult result = traced(plate("material = \"N-BK7\"\n"), request, Given(info, rays), kept);
  EXPECT_EQ(result.shortest_nm, 440.0);
  EXPECT_EQ(result.longest_nm, 780.0);
  EXPECT_TRUE(kept.layout.has_wavelengths);
  for (const AccountedRay& ray : kept.rays)
    if (ray.radiant_w > 0.5) {
      EXPECT_NEAR(index_from(ray, 0.7), index_of_bk7(rays[ray.number - 1].wavelength_nm), 1e-9);
      EXPECT_EQ(ray.wavelength_nm, rays[ray.number - 1].wavelength_nm);
    }
}

TEST(RayStudy, SpectraAreTakenByTheirPower) {
  RaySetInfo info;
  info.spectrum = RaySpectrum::table_of_each;
  info.tables = {{{450.0}, {1.0}}, {{600.0, 610.0, 620.0}, {0.0, 1.0, 0.0}}, {{500.0, 700.0}, {1.0, 1.0}}};
  std::vector<SetRay> rays = oblique(30000);
  for (std::size_t k = 0; k < rays.size(); ++k) rays[k].table = static_cast<std::uint32_t>(1 + k % 3);
  Kept kept;
  traced(plate("material = \"N-BK7\"\n"), {}, Given(info, rays), kept);
  EXPECT_EQ(kept.layout.info.spectrum, RaySpectrum::table_of_each);
  EXPECT_TRUE(kept.layout.has_wavelengths);
  double below_600 = 0.0;
  double of_third = 0.0;
  for (const AccountedRay& ray : kept.rays) {
    const double middle_nm = ray.table == 1 ? 450.0 : ray.table == 2 ? 610.0 : 600.0;
    const double half_nm = ray.table == 1 ? 0.0 : ray.table == 2 ? 10.0 : 100.0;
    EXPECT_LE(std::abs(ray.wavelength_nm - middle_nm), half_nm);
    if (ray.table != 3) continue;
    ++of_third;
    below_600 += ray.wavelength_nm < 600.0 ? 1.0 : 0.0;
  }
  EXPECT_NEAR(below_600 / of_third, 0.5, 0.025);
}

TEST(RayStudy, LightOfTheDesignIsTakenWhereTheSetTellsNone) {
  const std::string lamp = "material = \"N-BK7\"\n[light]\nspectrum = \"A\"\n";
  Kept kept;
  RaySetInfo luminous;
  luminous.has_radiant = false;
  luminous.has_luminous = true;
  const RayResult result = traced(plate(lamp), {}, Given(luminous, oblique(4000)), kept);
  EXPECT_EQ(result.power, RayPower::luminous_lm);
  EXPECT_TRUE(kept.layout.has_wavelengths);
  double sum = 0.0;
  for (const AccountedRay& ray : kept.rays) sum += ray.wavelength_nm / static_cast<double>(kept.rays.size());
  EXPECT_NEAR(sum, 572.0, 3.0);  // luminous centroid of illuminant A: 572 nm
}

TEST(RayStudy, BothFluxesAndTristimulusValuesShrinkAlike) {
  RaySetInfo info;
  info.has_luminous = info.has_tristimulus = true;
  SetRay ray = down_at(4, 5);
  ray.luminous_lm = 300.0;
  ray.tristimulus_x = 200.0;
  ray.tristimulus_z = 100.0;
  RayRequest request;
  request.split = 0.0;
  Kept kept;
  traced(plate("refractive_index = 1.5\nabsorption_per_mm = 0.1\n"), request, Given(info, {ray}), kept);
  for (const AccountedRay& out : kept.rays) {
    EXPECT_NEAR(out.luminous_lm, 100.0 * out.radiant_w, 1e-9);
    EXPECT_NEAR(out.tristimulus_x, 200.0 / 3.0 * out.radiant_w, 1e-9);
    EXPECT_NEAR(out.tristimulus_z, 100.0 / 3.0 * out.radiant_w, 1e-9);
  }
}

/// Ledgers of collimated light from an emitter and of the beam of `retrace rre` from the same direction.
struct EmitterAndBeam {
  RayResult rays;
  RrePoint beam;
};

EmitterAndBeam emitter_and_beam(const design::Design& design, double incidence_deg, double azimuth_deg,
                                std::uint64_t rays) {
  RayRequest request;
  request.placement.incidence_deg = incidence_deg;
  request.placement.azimuth_deg = azimuth_deg;
  const RayStudy study(design, request);
  EmitterRequest emitter;
  emitter.kind = EmitterKind::collimated;
  emitter.rays = rays;
  EmitterSource source(study.emitter_of(emitter));
  studies::RreSettings beam;
  beam.incidence_deg = {incidence_deg};
  beam.azimuth_deg = {azimuth_deg};
  return {study.run(source, nullptr, nullptr, nullptr), RreStudy({design}, beam).run(nullptr, nullptr).points.at(0)};
}

// The power of collimated light from an emitter is divided among the accounts (categories) of the ledger in the same
// proportions as the power of the beam of `retrace rre`. Rays that do not hit the part count as missed and are excluded
// from the comparison.
TEST(RayStudy, AnEmitterThatCoversThePartIsTheBeamOfRre) {
  const design::Design design = design::parse_design(
      "[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"offset\"\nx_length_mm = "
      "6\ny_length_mm = 4\n[body]\nthickness_mm = 0.02\nrefractive_index = 1.4917\n",
      "bricks.toml");
  const auto [result, known] = emitter_and_beam(design, 20.0, 30.0, 60000);
  const double met = result.ledger.incident - result.ledger.missed;
  // The emitter illuminates a disc around the part. The illuminated area is the projection of the entrance face, plus
  // the illuminated sides of the plate and of the prisms. Shifted rows end with half a prism.
  const double rad = std::numbers::pi / 180.0;
  const double at_x_mm2 = 4.0 * 0.02 + 2.0 * 0.5;
  const double at_y_mm2 = 6.0 * 0.02 + 6.0 * 0.25;
  const double lit_mm2 = 24.0 * std::cos(20.0 * rad) +
                         std::sin(20.0 * rad) * (at_x_mm2 * std::cos(30.0 * rad) + at_y_mm2 * std::sin(30.0 * rad));
  EXPECT_NEAR(result.ledger.missed, 1.0 - lit_mm2 / (13.0 * std::numbers::pi), 0.008);  // four standard errors
  for (std::size_t k = 0; k < raytrace::kAccountCount; ++k) {
    // Rays also hit the sides of the plate, which the beam does not. This effect is small, because the plate is only
    // 0.02 mm thick.
    EXPECT_NEAR(result.ledger.ledger.power[k] / met, known.ledger.power[k], 0.02) << raytrace::kAccountNames[k];
  }
}

design::Design endless_triangles() {
  return design::parse_design(
      "[element]\nkind = \"triangular_icc\"\naperture_mm = 1\n[array]\narrangement = \"triangular\"\nextent = "
      "\"infinite\"\n"
      "[body]\nthickness_mm = 1\nrefractive_index = 1.5\n",
      "triangles.toml");
}

// The points of incidence on the entrance face are evenly distributed over a period: each spatial harmonic of the
// period has the mean 0 over these points.
TEST(RayStudy, AnEmitterBeforeAnInfinitePartCoversAPeriodEvenly) {
  constexpr std::uint64_t kRays = 40000;
  for (const double half_angle_deg : {0.0, 5.0}) {
    RayRequest request;
    request.placement.incidence_deg = 50.0;
    request.placement.azimuth_deg = 20.0;
    const RayStudy study(endless_triangles(), request);
    EmitterRequest asked;
    asked.kind = EmitterKind::collimated;
    asked.rays = kRays;
    asked.half_angle_deg = half_angle_deg;
    EmitterSource source(study.emitter_of(asked));
    const RayPlacement placement = placement_of(request.placement, study.part());
    std::vector<SetRay> rays;
    ASSERT_TRUE(source.read(kRays, rays));
    for (const auto& [i, j] : {std::pair{1, 0}, {0, 1}, {1, 1}, {2, -1}, {0, 3}}) {
      std::complex<double> sum;
      for (SetRay ray : rays) {
        placement.apply(ray);
        const double t = (study.part().thickness_mm - ray.position_mm.z()) / ray.direction.z();
        const geometry::Vec2 at =
            (ray.position_mm + t * ray.direction).head<2>().cwiseQuotient(*study.part().period_mm);
        sum += std::polar(1.0, 2.0 * std::numbers::pi * (i * at.x() + j * at.y()));
      }
      EXPECT_LT(std::abs(sum) / kRays, 4.0 / std::sqrt(kRays)) << half_angle_deg << ": " << i << ", " << j;
    }
  }
}

TEST(RayStudy, AnEmitterBeforeAnInfinitePartIsTheBeamOfRre) {
  const auto [result, known] = emitter_and_beam(endless_triangles(), 15.0, 10.0, 100000);
  EXPECT_EQ(result.ledger.rays_missed, 0U);
  for (std::size_t k = 0; k < raytrace::kAccountCount; ++k) {
    // An account of the ledger is a sum over rays. Each ray adds between 0 and its own power. The variance of the
    // account is therefore at most that of a binomial distribution.
    const double share = std::max(known.ledger.power[k], 0.0);  // rounding may make an account negative
    EXPECT_NEAR(result.ledger.ledger.power[k], share, 4.0 * std::sqrt(share * (1.0 - share) / 100000.0) + 1e-6)
        << raytrace::kAccountNames[k];
  }
}

TEST(RayStudy, SourcesAreMovedAndTurned) {
  RayRequest request;
  request.placement.at_mm = {{1.0, 2.0, 12.0}};
  request.placement.aim_mm = {{4.0, 5.0, 2.0}};
  const RayStudy aimed(plate(), request);
  SetRay ray;
  ray.direction = {0, 0, 1};  // along the z axis of its source
  ray.radiant_w = 1.0;
  Given source({}, {ray});
  Kept kept;
  aimed.run(source, &kept, nullptr, nullptr);
  ASSERT_EQ(kept.rays.size(), 1U);
  const Vec3 way = Vec3(3.0, 3.0, -10.0).normalized();
  // The ray leaves through the bottom or is reflected upwards. In both cases its direction is along the rotated axis.
  EXPECT_NEAR(std::abs(kept.rays[0].direction.z()), std::abs(way.z()), 1e-12);
  EXPECT_NEAR((kept.rays[0].direction - way).head<2>().norm(), 0.0, 1e-12);
  const RayPlacement placement = placement_of(request.placement, aimed.part());
  EXPECT_NEAR(placement.part_from_source.determinant(), 1.0, 1e-12);
  EXPECT_NEAR(placement.part_from_source.col(0).dot(way), 0.0, 1e-12);
  EXPECT_GT(placement.part_from_source(0, 0), 0.9);
}

TEST(RayStudy, WhatMakesNoSenseIsRefused) {
  const auto complaint = [](const auto& change) {
    return refusal_of([&] {
      RaysRequest request;
      request.emitter = "lambertian";
      change(request);
      RayStudy(plate(), resolve(request));
    });
  };
  EXPECT_EQ(complaint([](RaysRequest& r) { r.split = 1.5; }), "split");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.cutoff = NAN; }), "cutoff");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.incidence_deg = 90.0; }), "incidence_deg");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.distance_mm = 0.0; }), "distance_mm");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.azimuth_deg = 1e300; }), "azimuth_deg");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.at_mm = {{0, 0, 1e200}}; }), "at_mm");
  EXPECT_EQ(complaint([](RaysRequest& r) {
              r.azimuth_deg = 0.0;
              r.at_mm = {{0, 0, 0}};
            }),
            "at_mm");
  EXPECT_EQ(complaint([](RaysRequest& r) {
              r.at_mm = {{0, 0, 9}};
              r.aim_mm = {{0, 0, 9}};
            }),
            "aim_mm");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.emitter = "laser"; }), "emitter");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.disc_mm = -1.0; }), "disc_mm");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.half_angle_deg = 91.0; }), "half_angle_deg");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.power = 0.0; }), "power");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.rays = 0; }), "rays");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.rays = UINT64_MAX; }), "rays");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.emitter = ""; }), "source");
  EXPECT_EQ(complaint([](RaysRequest& r) { r.source = "rays.csv"; }), "source");
  TraceRequest trace;
  trace.split = -0.5;
  EXPECT_EQ(refusal_of([&] { resolve(trace); }), "split");
}

/// Only the direction of a direction vector counts, not its length. The traced ray is the same for every multiple
/// of the vector, from the smallest to the largest number.
TEST(RayStudy, LengthsOfDirectionsAndAxesDoNotMatter) {
  const std::vector<double> origins = {4.1, 5.2, 9.0};
  const Vec3 direction = Vec3(0.3, -0.2, -0.9).normalized();
  const Vec3 axis(1.0, 0.5, 0.0);
  const std::vector<double> stokes = {2.0, 1.2, -0.6, 0.8};
  const auto read = [&](double factor) {
    const std::vector<double> directions = {factor * direction.x(), factor * direction.y(), factor * direction.z()};
    const std::vector<double> axes = {factor * axis.x(), factor * axis.y(), 0.0};
    std::vector<SetRay> rays;
    ArraySource({origins, directions, stokes, axes, {}}).read(1, rays);
    return rays.at(0);
  };
  const SetRay expected = read(1.0);
  EXPECT_NEAR((expected.direction - direction).norm(), 0.0, 1e-15);
  for (const double factor : {1e-300, 1e-170, 1e-155, 1e-9, 1e9, 1e153, 1e155, 1e170, 1e307}) {
    SCOPED_TRACE(factor);
    const SetRay ray = read(factor);
    EXPECT_NEAR((ray.direction - expected.direction).norm(), 0.0, 1e-15);
    EXPECT_NEAR((ray.axis - expected.axis).norm(), 0.0, 1e-15);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(ray.stokes[k], expected.stokes[k]);
  }
  EXPECT_NE(refusal_of([&] { read(0.0); }), "");
  EXPECT_NE(refusal_of([&] { read(INFINITY); }), "");
}

TEST(RayStudy, ACancelledRunKeepsWhatItHas) {
  Cancellation cancel;
  cancel.request();
  Given source({}, std::vector<SetRay>(1000, down_at(4, 5)));
  Kept kept;
  const RayResult result = RayStudy(plate(), {}).run(source, &kept, nullptr, &cancel);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(kept.is_finished);
  EXPECT_EQ(result.ledger.rays, 0U);
}

}  // namespace
}  // namespace retrace::testing::ray_study_test

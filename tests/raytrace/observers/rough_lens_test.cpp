// Tests of light that is traced through tangent planes of curved entrance surfaces, for parts with rough facets and for
// parts behind shells. Results are compared with closed forms, and power must be conserved.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "raytrace/light/ledger.h"
#include "raytrace/observers/element_light.h"
#include "raytrace/observers/far_field.h"
#include "tests/support/closed_forms.h"
#include "tests/support/designs.h"
#include "tests/support/entrance_surfaces.h"

namespace retrace::testing::rough_lens_test {
namespace {

using namespace geometry;
using namespace raytrace;
using std::numbers::pi;
using Surface = std::shared_ptr<const EntranceSurface>;

constexpr double kArcmin = kDeg / 60.0;
constexpr double kWaveNm = 550.0;
constexpr double kWaveNumber = 2.0 * pi / (1e-6 * kWaveNm);

Optics rough(Optics optics, double sq_nm, double length_um) {
  optics.wavelength_nm = kWaveNm;
  optics.facet_scatter = surface_models::HarveyShack({sq_nm, length_um});
  return optics;
}

/// Variance of the phase that the facets of a cube corner cause together, for light along the axis of the cube corner.
/// The cosine of the angle of incidence is 1 / sqrt(3) at each of the three facets.
double phase_variance(double sq_nm) {
  return std::pow(4.0 * pi * kPmma * sq_nm / kWaveNm, 2.0);
}

BeamPolicy policy_for(const Optics& optics) {
  BeamPolicy beams;
  beams.cutoff = 1e-6;
  beams.separate_cells = true;
  beams.keeps_phases = !optics.is_smooth();
  return beams;
}

std::unique_ptr<const ElementScene> first_scene(const Part& part, const Entrance& entrance, const Vec3& to_source,
                                                const Optics& optics) {
  auto scene = ElementLight(part, std::get<Surface>(entrance)).scene(0, to_source, optics.index);
  EXPECT_TRUE(scene && scene->is_lit);
  return scene;
}

/// Light of the first element of a part.
struct ElementRun {
  double power_factor = 0.0;
  BeamResult beams;
  FarField field;
};

ElementRun run_element(const Part& part, const Entrance& entrance, const Optics& optics,
                       const Vec3& to_source = Vec3::UnitZ(), const Stokes& stokes = kUnpolarised) {
  const auto scene = first_scene(part, entrance, to_source, optics);
  FarFieldPolicy policy;
  policy.wavelength_nm = kWaveNm;
  policy.window_rad = 0.1;
  const Illumination illumination = illumination_of(*scene, to_source, stokes);
  FarFieldCollector collector(scene->excerpt.part, illumination, policy);
  ElementRun run;
  run.power_factor = scene->power_factor;
  run.beams = trace_element(*scene, optics, illumination, {0.5}, policy_for(optics), nullptr,
                            [&](const ReturnedBeam& beam) { collector.add(beam); });
  run.field = collector.finish();
  return run;
}

Part cube_of(double aperture_mm) {
  return build_part(single(HexagonalCube{aperture_mm}, 0.3));
}

Entrance sphere_over(const Part& part, double radius_mm) {
  return sphere_entrance(radius_mm, 0.5, bounding_box(part.outline).centre());
}

/// Intensity of the light that a rough cube corner of mirrors scatters behind a lens, for incident light of power 1
/// along the axis.
///
/// Points at the distance d of the exit plane have the distance sqrt(d^2 + 2 (d . u)^2) on a facet, where u is the
/// direction in which the facet is inclined. Behind a lens of radius R, light that leaves at r is deflected by
/// -2 (n - 1) r / R. The lobe of each point r is moved by this deflection.
class LobesBehindLens {
 public:
  LobesBehindLens(const Polygon& hexagon, double radius_mm, double sq_nm, double length_mm)
      : variance_(phase_variance(sq_nm)), length_mm_(length_mm), per_mm_(-2.0 * (kPmma - 1.0) / radius_mm) {
    const Rectangle box = bounding_box(hexagon);
    for (int j = 0; j < kPixels; ++j)
      for (int i = 0; i < kPixels; ++i) {
        const Vec2 at = Vec2((i + 0.5) / kPixels, (j + 0.5) / kPixels).cwiseProduct(box.size());
        if (contains(hexagon, box.lower + at)) points_.push_back(at - 0.5 * box.size());
      }
  }

  double per_sr(const Vec2& cosines) const {
    constexpr int kSteps = 48;
    const double step_mm = 3.6 * length_mm_ / kSteps;
    double sum = 0.0;
    for (int j = -kSteps; j <= kSteps; ++j)
      for (int i = -kSteps; i <= kSteps; ++i) {
        const Vec2 d = step_mm * Vec2(i, j);
        double covariance = 0.0;
        for (int facet = 0; facet < 3; ++facet) {
          const double along = d.dot(Vec2(std::cos(2.0 * pi * facet / 3.0), std::sin(2.0 * pi * facet / 3.0)));
          covariance += variance_ / 3.0 * std::exp(-(d.squaredNorm() + 2.0 * along * along) / length_mm_ / length_mm_);
        }
        const double correlation = std::exp(-variance_) * std::expm1(covariance);
        if (correlation < 1e-5) continue;
        double moved = 0.0;
        for (const Vec2& r : points_) moved += std::cos(kWaveNumber * (cosines - per_mm_ * r).dot(d));
        sum += correlation * moved / static_cast<double>(points_.size());
      }
    return sum * std::pow(step_mm * kWaveNumber / (2.0 * pi), 2.0);
  }

 private:
  static constexpr int kPixels = 24;
  double variance_, length_mm_, per_mm_;
  std::vector<Vec2> points_;
};

// The lens deflects the lobes of the light that rough facets scatter. Without this deflection, the peak of the lobes
// would be higher by a factor of more than 1.5. The closed form neglects the edges of the aperture, within a
// correlation length, and the convergence of the light inside the part.
TEST(RoughLens, DeflectsScatteredLight) {
  const double sq_nm = 15.0, length_mm = 0.03, radius_mm = 40.0;
  const Part part = cube_of(1.5);
  const Polygon& hexagon = part.outline;
  const LobesBehindLens expected(hexagon, radius_mm, sq_nm, length_mm);
  const LobesBehindLens plane(hexagon, 1e9, sq_nm, length_mm);
  const ElementRun run = run_element(part, sphere_over(part, radius_mm), rough(ideal(), sq_nm, 1e3 * length_mm));
  const double peak = expected.per_sr(Vec2::Zero());
  EXPECT_GT(plane.per_sr(Vec2::Zero()), 1.5 * peak);
  for (const double azimuth_deg : {0.0, 90.0})
    for (const double minutes : {0.0, 20.0, 40.0, 60.0, 90.0}) {
      const double sine = std::sin(minutes * kArcmin);
      const Vec2 cosines = sine * Vec2(std::cos(azimuth_deg * kDeg), std::sin(azimuth_deg * kDeg));
      const Vec3 direction(cosines.x(), cosines.y(), std::sqrt(1.0 - sine * sine));
      EXPECT_NEAR(run.power_factor * run.field.scattered_per_sr(direction), expected.per_sr(cosines), 0.06 * peak)
          << azimuth_deg << " " << minutes;
    }
}

// Roughness moves light from the specular directions into lobes and does not absorb light. The specular fraction is
// exp(-variance) behind any lens, because all light meets the three facets.
TEST(RoughLens, RoughnessConservesPower) {
  const Part part = cube_of(1.5);
  for (const double radius_mm : {50.0, 400.0, 1e6})
    for (const double sq_nm : {5.0, 15.0, 30.0}) {
      const Entrance entrance = sphere_over(part, radius_mm);
      const FarField field = run_element(part, entrance, rough(ideal(), sq_nm, 5.0)).field;
      const FarField smooth = run_element(part, entrance, ideal()).field;
      EXPECT_NEAR(field.total_power(), smooth.total_power(), 1e-9) << radius_mm << " " << sq_nm;
      double specular = field.diffracted_power();
      for (const FarFieldRay& ray : field.rays()) specular += ray.power;
      EXPECT_NEAR(specular + field.scattered_power() + field.unplaced_power(), field.total_power(), 1e-9)
          << radius_mm << " " << sq_nm;
      EXPECT_NEAR(specular, std::exp(-phase_variance(sq_nm)) * field.total_power(), 1e-3) << radius_mm << " " << sq_nm;
    }
}

Shell plate(double index, const Vec3& normal, double absorption_per_mm = 0.0) {
  Shell shell;
  shell.inner = {{0.0, 0.0, 8.0}, normal, 0.0};
  shell.thickness_mm = 2.0;
  shell.outer = {shell.inner.vertex_mm + shell.thickness_mm * normal, normal, 0.0};
  shell.index = index;
  shell.absorption_per_mm = absorption_per_mm;
  return shell;
}

Optics behind(Optics optics, Shells shells) {
  optics.shells = std::move(shells);
  return optics;
}

Vec3 tilted(double x_deg, double y_deg) {
  return Vec3(std::tan(y_deg * kDeg), std::tan(x_deg * kDeg), 1.0).normalized();
}

// A shell of index 1 changes nothing, for smooth and for rough facets.
TEST(ShellBeforeLens, OfIndexOneChangesNothing) {
  const Part part = cube_of(2.0);
  const Vec3 to_source = tilted(7.0, -12.0);
  const Entrance entrance = sphere_over(part, 100.0);
  for (const bool is_rough : {false, true}) {
    const Optics optics = is_rough ? rough(pmma(), 20.0, 5.0) : pmma();
    const ElementRun without = run_element(part, entrance, optics, to_source, {1.0, 0.3, 0.4, 0.1});
    const ElementRun with =
        run_element(part, entrance, behind(optics, {plate(1.0, tilted(15.0, 20.0))}), to_source, {1.0, 0.3, 0.4, 0.1});
    for (std::size_t k = 0; k < kAccountCount; ++k)
      EXPECT_NEAR(with.beams.ledgers[0].power[k], without.beams.ledgers[0].power[k], 1e-12) << kAccountNames[k];
    EXPECT_NEAR(with.field.diffracted_power(), without.field.diffracted_power(), 1e-12);
    EXPECT_NEAR(with.field.scattered_power(), without.field.scattered_power(), 1e-12);
  }
}

// Light along the normal crosses the four surfaces of a plate. Each surface transmits 4 n / (n + 1)^2. The plate
// absorbs 1 - exp(-a d) in each crossing. Specular and scattered light are reduced by the same factor.
TEST(ShellBeforeLens, PlateMultipliesReturnedLight) {
  const Part part = cube_of(2.0);
  const Entrance entrance = sphere_over(part, 200.0);
  const double index = 1.6, absorption_per_mm = 0.05;
  const double factor = std::pow(4.0 * index / std::pow(1.0 + index, 2.0), 4.0) * std::exp(-4.0 * absorption_per_mm);
  for (const bool is_rough : {false, true}) {
    const Optics optics = is_rough ? rough(ideal(), 20.0, 5.0) : ideal();
    const ElementRun without = run_element(part, entrance, optics);
    const ElementRun with =
        run_element(part, entrance, behind(optics, {plate(index, Vec3::UnitZ(), absorption_per_mm)}));
    EXPECT_NEAR(with.field.total_power(), factor * without.field.total_power(), 1e-6);
    EXPECT_NEAR(with.field.scattered_power(), factor * without.field.scattered_power(), 1e-6);
    const Vec3 direction = tilted(0.3, 0.0);
    EXPECT_NEAR(with.field.diffracted_per_sr(direction) / without.field.diffracted_per_sr(direction), factor, 1e-6);
  }
}

// All light of an element is in one of the accounts, for random shells, lenses and directions.
TEST(ShellBeforeLens, AccountsAddUpToTheIncidentLight) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  const Part part = cube_of(1.0);
  for (int k = 0; k < 6; ++k) {
    const Entrance entrance = sphere_over(part, 150.0 + 100.0 * between(random));
    Shells shells = {plate(1.5 + 0.3 * between(random), tilted(20.0 * between(random), 20.0 * between(random)),
                           0.01 * (1.0 + between(random)))};
    if (k % 2 == 1) {
      shells.insert(shells.begin(), plate(1.4, Vec3::UnitZ()));
      for (ShellSurface* const surface : {&shells.front().inner, &shells.front().outer}) surface->vertex_mm.z() += 10.0;
    }
    const Optics optics = behind(k % 3 == 0 ? rough(pmma(), 15.0, 5.0) : pmma(), shells);
    const Vec3 to_source = tilted(10.0 * between(random), 10.0 * between(random));
    const auto scene = first_scene(part, entrance, to_source, optics);
    const BeamResult beams = trace_element(*scene, optics, illumination_of(*scene, to_source, kUnpolarised), {0.5},
                                           policy_for(optics), nullptr, [](const ReturnedBeam&) {});
    double sum = 0.0;
    for (const double power : beams.ledgers[0].power) sum += power;
    EXPECT_NEAR(sum, 1.0, 1e-9) << k;
    EXPECT_GT(beams.ledgers[0][Account::shell_reflected], 0.05) << k;
  }
}

}  // namespace
}  // namespace retrace::testing::rough_lens_test

// Tests of the far field of single cube corners. The references are an independent model of the six sectors of a cube
// corner (SectorModel), closed forms and Parseval's theorem.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "design/io/design_reader.h"
#include "design/optical_model.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/ranging/lit_cubes.h"
#include "studies/ranging/ranging.h"
#include "tests/studies/ranging/sector_model.h"

namespace retrace::testing::cube_field_test {
namespace {

using geometry::Vec2, geometry::Vec3, raytrace::Stokes, studies::CubeCorner, studies::DirectionField;

std::string design_of(const SectorCube& cube) {
  std::string text = "schema = \"retrace.design/1\"\n[element]\n";
  if (cube.is_round)
    text += fmt::format(
        "kind = \"round_icc\"\ndiameter_mm = {}\nlength_mm = {}\nrecess_mm = {}\n[body]\nrefractive_index = {}\n",
        cube.aperture_mm, cube.aperture_mm / std::numbers::sqrt2 + cube.thickness_mm, cube.recess_mm, cube.index);
  else
    text += fmt::format(
        "kind = \"hexagonal_icc\"\naperture_mm = {}\n[array]\narrangement = \"single\"\n[body]\nrefractive_index = {}\n"
        "thickness_mm = {}\n",
        cube.aperture_mm, cube.index, cube.thickness_mm);
  text += fmt::format(
      "[surface]\nwalls = \"absorbing\"\ndihedral_error_arcsec = [{}, {}, {}]\n[light]\nwavelength_nm = {}\n",
      cube.errors_arcsec[0], cube.errors_arcsec[1], cube.errors_arcsec[2], cube.wavelength_nm);
  if (cube.metal)
    text += fmt::format("[coating]\nfacets = [{{ refractive_index = {}, extinction_coefficient = {} }}]\n",
                        cube.metal->real(), cube.metal->imag());
  return text;
}

CubeCorner corner_of(const SectorCube& cube) {
  return CubeCorner(design::parse_design(design_of(cube), "cube.toml"), {}, false);
}

/// Returns equally spaced offsets of a direction cosine within a window.
std::vector<double> offsets_within(double window, int count) {
  std::vector<double> offsets;
  for (int k = 0; k < count; ++k) offsets.push_back(window * (2.0 * k / (count - 1) - 1.0));
  return offsets;
}

std::vector<Vec3> directions_around(const Vec3& to_source, const std::vector<double>& offsets) {
  std::vector<Vec3> directions;
  for (const double y : offsets)
    for (const double x : offsets) {
      const Vec2 q = to_source.head<2>() + Vec2(x, y);
      directions.emplace_back(q.x(), q.y(), std::sqrt(1.0 - q.squaredNorm()));
    }
  return directions;
}

/// Returns cubes with random properties: circular or hexagonal face, with or without coating, angle errors up to 3
/// arcsec, recesses up to 3 mm, and angles of incidence up to 40 degrees.
std::vector<SectorCube> random_cubes(int count) {
  std::mt19937 random(66);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<SectorCube> cubes;
  for (int k = 0; k < count; ++k) {
    SectorCube cube;
    cube.aperture_mm = 10.0 + 40.0 * unit(random);
    cube.thickness_mm = 0.05;
    cube.index = 1.45 + 0.1 * unit(random);
    for (double& error : cube.errors_arcsec) error = 6.0 * unit(random) - 3.0;
    if (k % 2 == 1) cube.metal = {0.5 + unit(random), 5.0 + 2.0 * unit(random)};
    cube.incidence_deg = 40.0 * unit(random);
    cube.azimuth_deg = 360.0 * unit(random);
    cube.is_round = k % 4 < 2;
    if (cube.is_round) cube.recess_mm = 3.0 * unit(random);
    cubes.push_back(cube);
  }
  return cubes;
}

Stokes random_polarisation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Vec3 v = Vec3(normal(random), normal(random), normal(random)).normalized();
  return {1.0, v.x(), v.y(), v.z()};
}

TEST(CubeField, StokesParametersAgreeWithSixSectors) {
  std::mt19937 random(5);
  for (const SectorCube& cube : random_cubes(20)) {
    const SectorModel model(cube);
    const CubeCorner corner = corner_of(cube);
    const studies::CubeField field = corner.field(model.to_source(), 0, nullptr);
    const double detail = 1e-6 * cube.wavelength_nm / cube.aperture_mm;
    const std::vector<double> offsets = offsets_within(6.0 * detail + 4e-5, 25);
    const std::vector<SectorModel::Jones> expected = model.far_field(offsets);
    const std::vector<DirectionField> computed = field.at(directions_around(model.to_source(), offsets));
    const Stokes sent = random_polarisation(random);
    double peak = 0.0;
    for (const SectorModel::Jones& jones : expected) peak = std::max(peak, studies::returned_stokes(jones, sent).i);
    double worst = 0.0;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const Stokes a = studies::returned_stokes(expected[k], sent);
      const Stokes b = studies::returned_stokes(computed[k], sent);
      for (std::size_t component = 0; component < 4; ++component)
        worst = std::max(worst, std::abs(a.values()[component] - b.values()[component]) / peak);
    }
    EXPECT_LT(worst, 5e-3) << "incidence " << cube.incidence_deg << ", azimuth " << cube.azimuth_deg;
  }
}

/// Returns the power inside a circle of direction cosines, for unpolarised incident light of power 1.
double power_within(const studies::CubeField& field, double radius, double step) {
  const auto reach = static_cast<int>(std::ceil(radius / step));
  std::vector<Vec3> directions;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i)
      if (const Vec2 q = step * Vec2(i, j); q.norm() <= radius)
        directions.emplace_back(q.x(), q.y(), std::sqrt(1.0 - q.squaredNorm()));
  double sum = 0.0;
  const std::vector<DirectionField> fields = field.at(directions);
  for (std::size_t k = 0; k < directions.size(); ++k)
    sum += studies::returned_stokes(fields[k], raytrace::kUnpolarised).i / directions[k].z();
  return sum * step * step / (4.0 * std::numbers::pi * 1e-6 * field.beam_mm2());
}

/// All facets are mirrors, so light can leave only through the entrance face. At each arrival, the face transmits the
/// fraction T = 1 - R and reflects the fraction R back to the facets. The power that leaves after k retroreflections is
/// therefore T^2 R^(k - 1). If the request includes reflections at the face, all k count. Otherwise, only odd k count.
TEST(CubeField, PowerOfMirrorsBehindAFaceIsAGeometricSeries) {
  for (const double index : {1.1, 1.2, 1.3, 1.4, 1.4607, 1.5, 1.7, 1.9, 2.0, 2.3, 3.0})
    for (const bool is_round : {true, false}) {
      SectorCube cube;
      cube.index = index;
      cube.is_round = is_round;
      const double r = std::pow((index - 1.0) / (index + 1.0), 2.0);
      const std::string text = design_of(cube) + "[idealisation]\nfacets = \"mirror\"\n";
      for (const bool with_reflections : {false, true}) {
        const CubeCorner corner(design::parse_design(text, "cube.toml"), {}, with_reflections);
        const studies::CubeField field = corner.field(Vec3::UnitZ(), 0, nullptr);
        const double odd = std::pow(1.0 - r, 2.0) / (1.0 - r * r);
        const double all = r + (1.0 - r);  // first reflection at the outer side of the face, and all light that enters
        EXPECT_NEAR(field.diffracted_power() + field.undiffracted_power(), with_reflections ? all : odd, 2e-6)
            << index << ' ' << is_round;
      }
    }
}

/// Returns the cross section of an array of cubes in the direction to the source, in m2.
double centre_of(const std::string& surface, const std::vector<studies::ArrayCube>& cubes) {
  const std::string text =
      "schema = \"retrace.design/1\"\n[element]\nkind = \"round_icc\"\ndiameter_mm = 20\n[body]\nrefractive_index = "
      "1.46\n[light]\nwavelength_nm = 532\n[surface]\n" +
      surface;
  RangingRequest request;
  request.cubes = "cubes.toml";
  request.map_points = 3;
  const studies::RangingResult result =
      studies::RangingStudy(design::parse_design(text, "cube.toml"), request, cubes).run(nullptr, nullptr);
  return result.points.at(0).centre.total;
}

/// The angle errors of a cube must replace the angle errors of the design, which may be given in either unit. An array
/// of equal cubes with parallel axes must return the sum of their light.
TEST(CubeField, ErrorsOfACubeReplaceThoseOfTheDesign) {
  studies::ArrayCube own;
  own.dihedral_error_arcsec = {1.0, 0.5, -1.0};
  const double expected = centre_of("dihedral_error_arcsec = [1, 0.5, -1]\n", {studies::ArrayCube{}});
  for (const std::string surface :
       {"dihedral_error_arcsec = 2\n", "dihedral_error_arcmin = 0.1\n", "walls = \"absorbing\"\n"})
    EXPECT_NEAR(centre_of(surface, {own}),
                surface[0] == 'w'
                    ? centre_of("walls = \"absorbing\"\ndihedral_error_arcsec = [1, 0.5, -1]\n", {studies::ArrayCube{}})
                    : expected,
                1e-9 * expected)
        << surface;
  std::vector<studies::ArrayCube> row(7, own);
  for (std::size_t k = 0; k < row.size(); ++k) row[k].position_mm = {40.0 * static_cast<double>(k), 0.0, 0.0};
  EXPECT_NEAR(centre_of("dihedral_error_arcsec = 2\n", row), 7.0 * expected, 1e-6 * expected);
}

/// Sectors do not overlap. The Stokes parameters, integrated over the far field, must therefore be equal to their sum
/// over all beams. The tracer computes this sum without fields.
TEST(CubeField, IntegralsOfStokesParametersAreThoseOfTheBeams) {
  SectorCube cube;
  cube.aperture_mm = 4.0;
  cube.incidence_deg = 15.0;
  cube.azimuth_deg = 70.0;
  const Vec3 to_source = SectorModel(cube, 8, 1).to_source();
  const Stokes sent{1.0, 0.36, 0.48, 0.8};
  const studies::CubeField field = corner_of(cube).field(to_source, 0, nullptr);
  const double detail = 1e-6 * cube.wavelength_nm / cube.aperture_mm;
  Stokes sum;
  for (const Vec3& direction : directions_around(to_source, offsets_within(30.0 * detail, 121)))
    sum += studies::returned_stokes(field.at(std::vector{direction}).front(), sent);
  const design::Design design = design::parse_design(design_of(cube), "cube.toml");
  const design::OpticalModel model = design::make_model(design, materials::MaterialLibrary::shipped());
  const raytrace::Illumination light{Angle::from_deg(cube.incidence_deg), Angle::from_deg(cube.azimuth_deg), sent};
  const Stokes beams = raytrace::BeamTracer(model.part).trace(model.optics, light, {0.1}, {}).stokes[0];
  EXPECT_NEAR(sum.q / sum.i, beams.q / beams.i, 0.02);
  EXPECT_NEAR(sum.u / sum.i, beams.u / beams.i, 0.02);
  EXPECT_NEAR(sum.v / sum.i, beams.v / beams.i, 0.02);
  EXPECT_GT(std::abs(beams.u) + std::abs(beams.v), 0.1 * beams.i);
}

/// The power outside a large angle a is proportional to 1 / a. A line is therefore fitted to the power inside the angle
/// a as a function of 1 / a. Its value at 1 / a = 0 is the total power.
TEST(CubeField, IntegralIsTheDiffractedPower) {
  SectorCube cube;
  cube.aperture_mm = 4.0;
  cube.errors_arcsec = {2.0, -1.0, 3.0};
  const studies::CubeField field = corner_of(cube).field(Vec3::UnitZ(), 0, nullptr);
  const double detail = 1e-6 * cube.wavelength_nm / cube.aperture_mm;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (double widths = 30.0; widths < 60.0; widths += 1.5) {
    const double x = 1.0 / widths;
    const double y = power_within(field, widths * detail, detail / 2.1);
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const double limit = (sy * sxx - sx * sxy) / (n * sxx - sx * sx);
  EXPECT_NEAR(limit, field.diffracted_power(), 1e-4 * field.diffracted_power());
}

/// With equal angle errors and normal incidence, the cube is symmetric about the plane y = 0 and under rotations by 120
/// degrees. Circularly polarised light has no preferred direction across the beam. The reflection at the plane y = 0
/// exchanges right-handed and left-handed light.
TEST(CubeField, CircularLightHasTheSymmetryOfTheCube) {
  SectorCube cube;
  cube.errors_arcsec = {1.25, 1.25, 1.25};
  const studies::CubeField field = corner_of(cube).field(Vec3::UnitZ(), 0, nullptr);
  const Stokes right{1.0, 0.0, 0.0, 1.0}, left{1.0, 0.0, 0.0, -1.0};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> cosine(-6e-5, 6e-5);
  const auto stokes = [&](const Vec2& q, const Stokes& sent) {
    return studies::returned_stokes(field.at(std::vector{Vec3(q.x(), q.y(), std::sqrt(1.0 - q.squaredNorm()))}).front(),
                                    sent);
  };
  const double peak = stokes(Vec2::Zero(), right).i;
  const Eigen::Rotation2Dd third(2.0 * std::numbers::pi / 3.0);
  for (int k = 0; k < 50; ++k) {
    const Vec2 q(cosine(random), cosine(random));
    const Stokes at = stokes(q, right);
    for (const Stokes& other : {stokes(third * q, right), stokes({q.x(), -q.y()}, left)})
      EXPECT_NEAR(at.i, other.i, 1e-6 * peak);
    EXPECT_NEAR(at.v, stokes(third * q, right).v, 1e-6 * peak);
    EXPECT_NEAR(at.v, -stokes({q.x(), -q.y()}, left).v, 1e-6 * peak);
    EXPECT_NEAR(0.5 * (at.i + stokes(q, left).i), stokes(q, raytrace::kUnpolarised).i, 1e-9 * peak);
  }
}

/// Light that returns through the apex has the optical path 2 L sqrt(n^2 - sin^2 i), from which its phase is computed.
TEST(CubeCorner, RangeCorrectionIsTheDerivativeOfThePhase) {
  const std::string text =
      "schema = \"retrace.design/1\"\n[element]\nkind = \"hexagonal_icc\"\naperture_mm = 30\n[array]\narrangement = "
      "\"single\"\n[body]\nmaterial = \"fused-silica\"\nthickness_mm = 2\n";
  const CubeCorner corner(design::parse_design(text, "cube.toml"), {531.9, 532.0, 532.1, 1064.0}, false);
  const std::vector<studies::CubeIndex>& indices = corner.indices();
  EXPECT_NEAR(indices[1].index, 1.46071, 2e-5);
  EXPECT_NEAR(indices[1].group_index, 1.4849, 2e-3);
  const double edge = 30.0 / (2.0 * std::sqrt(2.0 / 3.0));
  EXPECT_NEAR(corner.depth_mm(), 2.0 + 2.0 * edge / std::sqrt(3.0), 1e-9);
  for (const double sine : {0.0, 0.3, 0.6}) {
    // The phase in cycles is path / w, where w is the wavelength. The derivative of the phase with respect to 1 / w is
    // the group path.
    const auto phase = [&](const studies::CubeIndex& at) {
      return corner.depth_mm() * std::sqrt(at.index * at.index - sine * sine) / at.wavelength_nm;
    };
    const double group =
        (phase(indices[0]) - phase(indices[2])) / (1.0 / indices[0].wavelength_nm - 1.0 / indices[2].wavelength_nm);
    EXPECT_NEAR(studies::range_correction_mm(corner.depth_mm(), indices[1].index, indices[1].group_index, sine), group,
                1e-6);
    // Without dispersion, the usual approximation must be exact.
    EXPECT_NEAR(studies::range_correction_mm(corner.depth_mm(), 1.46, 1.46, sine),
                corner.depth_mm() * std::sqrt(1.46 * 1.46 - sine * sine), 1e-9);
  }
  EXPECT_NEAR(studies::range_correction_mm(20.0, 1.46, 1.48, 0.0), 20.0 * 1.48, 1e-9);
  EXPECT_NEAR(studies::usual_range_correction_mm(20.0, 1.48, 0.5), 20.0 * std::sqrt(1.48 * 1.48 - 0.25), 1e-9);
}

/// The dispersion formula of fused silica can be differentiated in closed form.
TEST(CubeCorner, GroupIndexIsExact) {
  const std::string text =
      "schema = \"retrace.design/1\"\n[element]\nkind = \"hexagonal_icc\"\naperture_mm = 30\n[array]\narrangement = "
      "\"single\"\n[body]\nmaterial = \"fused-silica\"\nthickness_mm = 2\n";
  const CubeCorner corner(design::parse_design(text, "cube.toml"), {532.0, 1064.0}, false);
  // Dispersion formula of fused silica by Malitson (1965), with lengths in um.
  const std::array<std::array<double, 2>, 3> terms = {
      {{0.6961663, 0.00467914825849}, {0.4079426, 0.01351206307396}, {0.8974794, 97.934002537921}}};
  for (const studies::CubeIndex& at : corner.indices()) {
    const double w2 = std::pow(1e-3 * at.wavelength_nm, 2.0);
    double square = 1.0, slope = 0.0;  // n^2, and the derivative of n^2 with respect to w^2
    for (const auto& [strength, resonance] : terms) {
      square += strength * w2 / (w2 - resonance);
      slope -= strength * resonance / std::pow(w2 - resonance, 2.0);
    }
    const double n = std::sqrt(square);
    EXPECT_NEAR(at.index, n, 1e-12);
    EXPECT_NEAR(at.group_index, n - w2 * slope / n, 1e-9);
  }
  // When the temperature increases by t, the index relative to vacuum increases by (n^2 - 1) / (2 n) D0 t. The index of
  // air decreases, which increases the relative index by a further 7e-5.
  const CubeCorner hot(
      design::with(design::parse_design(text, "cube.toml"), std::vector<std::string>{"body.temperature_c=80"}), {532.0},
      false);
  const double n = corner.indices()[0].index;
  EXPECT_NEAR(hot.indices()[0].index - n, (n * n - 1.0) / (2.0 * n) * 2.237e-5 * 60.0, 1e-4);
}

}  // namespace
}  // namespace retrace::testing::cube_field_test

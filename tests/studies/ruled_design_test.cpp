// Tests of designs with `element.kind` = `"ruled"`: agreement with triangular cube corners, engines, effective
// apertures in closed form, and refused input.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "design/io/design_document.h"
#include "design/io/design_format.h"
#include "design/io/design_reader.h"
#include "geometry/direction.h"
#include "geometry/part/mesh_part.h"
#include "raytrace/paths/monte_carlo.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/rre/rre.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/designs.h"
#include "tests/support/documents.h"
#include "tests/support/engines.h"
#include "tests/support/key_table.h"
#include "tests/support/mesh_variants.h"
#include "tests/support/refusals.h"

namespace retrace::testing::ruled_design_test {
namespace {

using namespace studies::photometric_requests;
using geometry::Cell, geometry::RuledCells, geometry::Vec2, geometry::Vec3;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

const std::string kInfinite = "[array]\nextent = \"infinite\"\n[body]\nthickness_mm = 0.2\n";
const std::string kFinite = "[array]\nx_length_mm = 1.1\ny_length_mm = 0.9\n[body]\nthickness_mm = 0.2\n";
const std::string kCanted = "form = \"base_angles\"\nbase_angles_deg = [70, 55, 55]\nspacing_mm = 0.1\n";

/// Returns the text of a design.
/// \param grooves lines of the table [grooves] and of its tables
std::string text_of(const std::string& grooves, const std::string& more = kInfinite) {
  return "[element]\nkind = \"ruled\"\n[grooves]\n" + grooves + more;
}
design::Design read(const std::string& text) {
  return design::parse_design(text, "d.toml", {});
}
const geometry::RuledPattern& pattern_of(const design::Design& design) {
  return *std::get<RuledCells>(design.part().element).pattern;
}
std::string complaint(const std::string& text) {
  return refusal_of([&] { read(text); }, "nothing");
}

design::Design equilateral() {
  return read(text_of("form = \"equilateral\"\nspacing_mm = 0.075\n"));
}
design::Design triangular() {
  return read("[element]\nkind = \"triangular_icc\"\naperture_mm = 0.1\n" + kInfinite);
}

TEST(RuledDesign, EquilateralReturnsTheLightOfTriangularCubeCorners) {
  studies::RreSettings asked;
  asked.incidence_deg = {0.0, 8.0, 23.0, 41.0};
  asked.azimuth_deg = {0.0, 37.0, 190.0};
  asked.engine = raytrace::Engine::exact;
  asked.cutoff = 1e-6;
  const studies::RreResult ruled = studies::RreStudy({equilateral()}, asked).run();
  const studies::RreResult cubes = studies::RreStudy({triangular()}, asked).run();
  ASSERT_EQ(ruled.points.size(), 12U);
  ASSERT_EQ(cubes.points.size(), 12U);
  for (std::size_t k = 0; k < cubes.points.size(); ++k) {
    EXPECT_NEAR(ruled.points[k].rre, cubes.points[k].rre, 1e-12) << k;
    EXPECT_GT(cubes.points[k].rre, 0.0);
  }
}

TEST(RuledDesign, EquilateralHasThePhotometryOfTriangularCubeCorners) {
  for (const bool diffraction : {false, true}) {
    studies::PhotometrySettings request = request_of(points_at({0.2, 0.5}, 1.0));
    request.diffraction = diffraction;
    const studies::PhotometryResult ruled = run(equilateral(), request);
    const studies::PhotometryResult cubes = run(triangular(), request);
    ASSERT_EQ(ruled.points.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_NEAR(ruled.points[k].r_a, cubes.points[k].r_a, 1e-9 * std::max(1.0, cubes.points[k].r_a))
          << diffraction << " " << k;
    if (!diffraction) continue;
    EXPECT_GT(cubes.points[0].r_a, 1.0);
  }
}

// Half of the cells of a canted pair face a source at 30 degrees of incidence, whichever the side. Cells without cant
// return much less light from there if the source is in the plane across the grooves of the set a.
TEST(RuledDesign, CantedPairsReturnLightFromLargeEntranceAnglesInBothPresentations) {
  studies::PhotometrySettings request = request_of(points_at({0.2}, 1.0));
  request.test_plan.points.front().v_deg = 30.0;
  request.diffraction = true;
  const auto r_a = [&](const design::Design& design, double rotation_deg) {
    request.rotation_deg = {rotation_deg};
    return run(design, request).points[0].r_a;
  };
  const design::Design pair = read(text_of(kCanted));
  const double upright = r_a(equilateral(), 0.0);
  EXPECT_GT(r_a(pair, 0.0), 2.0 * upright);
  EXPECT_GT(r_a(pair, 90.0), 2.0 * upright);
  // A rotation by 180 degrees exchanges the cells of a pair. Beams below the cut-off are not followed, and the incident
  // beam is not divided symmetrically.
  request.cutoff = 1e-7;
  EXPECT_NEAR(r_a(pair, 180.0), r_a(pair, 0.0), 1e-7 * r_a(pair, 0.0));
}

/// Returns the fraction of a triangle that is also in its mirror image about a point. In barycentric coordinates, the
/// common region is 0 <= x_k <= 2 c_k, where c are the coordinates of the point. Its area follows from inclusion and
/// exclusion of the three corners that the bounds cut off.
double overlap_of_triangle(const geometry::Polygon& t, const Vec2& about) {
  const auto twice = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  };
  std::array<double, 3> c{};
  for (std::size_t k = 0; k < 3; ++k) c[k] = twice(about, t[(k + 1) % 3], t[(k + 2) % 3]) / twice(t[0], t[1], t[2]);
  double fraction = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (c[k] <= 0.0) return 0.0;
    const double cut = std::max(0.0, 1.0 - 2.0 * c[k]);
    const double both = std::max(0.0, 1.0 - 2.0 * c[k] - 2.0 * c[(k + 1) % 3]);
    fraction += both * both - cut * cut;
  }
  return fraction;
}

// Light leaves a cube corner at the mirror image of the point where it enters, about the image of the apex along the
// light. The faces reach the plane of the rims along the sides of the base triangle.
TEST(RuledDesign, EffectiveApertureIsTheOverlapOfTheBaseTriangleWithItsImage) {
  int lit = 0;
  for (const std::array<double, 3>& base :
       {std::array{60.0, 60.0, 60.0}, std::array{70.0, 55.0, 55.0}, std::array{54.0, 58.0, 68.0}}) {
    const geometry::RuledPattern pattern =
        geometry::ruled_pattern(geometry::perpendicular_groove_sets(base, 0.1), std::nullopt);
    for (int k = 0; k < 20; ++k) {
      const Vec3 light = -geometry::direction_at(Angle::from_deg(1.5 * k), Angle::from_deg(77.0 * k));
      for (const Cell& cell : pattern.cells) {
        const Vec2 image = cell.at_mm + light.head<2>() * (pattern.lowest_mm / -light.z());
        const double expected = overlap_of_triangle(cell.outline, image);
        EXPECT_NEAR(studies::effective_aperture(cell, light), expected, 1e-9) << base[0] << " " << k;
        lit += expected > 0.1 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(lit, 150);
}

TEST(RuledDesign, InspectionReportsCantBaseAnglesAndTruncation) {
  const studies::Inspection plain = studies::inspect(read(text_of(kCanted)), materials::MaterialLibrary::shipped());
  ASSERT_TRUE(plain.ruled);
  ASSERT_EQ(plain.ruled->cells.size(), 4U);
  double azimuth_deg = 0.0;
  for (const studies::RuledCellReport& cell : plain.ruled->cells) {
    ASSERT_TRUE(cell.dihedral_deg && cell.cant_deg && cell.base_deg);
    for (const double deg : *cell.dihedral_deg) EXPECT_NEAR(deg, 90.0, 1e-10);
    EXPECT_NEAR(*cell.cant_deg,
                (std::asin(1.0 / std::tan(55.0 * kRadPerDeg)) - std::asin(1.0 / std::sqrt(3.0))) / kRadPerDeg, 1e-9);
    EXPECT_NEAR((*cell.base_deg)[0], 55.0, 1e-9);
    EXPECT_NEAR((*cell.base_deg)[2], 70.0, 1e-9);
    EXPECT_EQ(cell.truncated_fraction, 0.0);
    azimuth_deg += std::abs(std::remainder(cell.cant_azimuth_deg, 360.0)) / 4.0;
  }
  EXPECT_NEAR(azimuth_deg, 90.0, 1e-9) << "half of the cells are canted towards +x, the others towards -x";
  EXPECT_NEAR(plain.full_element_area_fraction, 1.0, 1e-12);
  // The top of a pyramid is similar to its base. Its area is (1 - depth / height)^2.
  const double height_mm = -pattern_of(plain.design).lowest_mm;
  const studies::Inspection cut =
      studies::inspect(read(text_of(kCanted + "depth_mm = 0.03\n")), materials::MaterialLibrary::shipped());
  for (const studies::RuledCellReport& cell : cut.ruled->cells) {
    EXPECT_NEAR(cell.truncated_fraction, std::pow(1.0 - 0.03 / height_mm, 2.0), 1e-10);
    EXPECT_LT(cell.effective_aperture, 1.0 - cell.truncated_fraction + 1e-12);
  }
  EXPECT_NEAR(cut.dead_zone_fraction, std::pow(1.0 - 0.03 / height_mm, 2.0), 1e-10);
  EXPECT_NEAR(cut.element_depth_mm, 0.03, 1e-12);
  EXPECT_NE(studies::inspect_json(cut).find("\"truncated_fraction\""), std::string::npos);
  EXPECT_NE(studies::inspect_text(cut).find("cant 9.1"), std::string::npos);
}

const std::string kPattern =
    "form = \"equilateral\"\nspacing_mm = 0.1\ndepth_mm = 0.045\n"
    "[grooves.a]\nhalf_angle_error_arcmin = [[6, -4], [0, 9]]\n[grooves.b]\nspacing_error_um = 0\n"
    "half_angle_error_arcmin = -5\n";
const std::string kLoose =
    "[grooves.a]\nazimuth_deg = 90\nspacing_mm = [0.1, 0.08]\nhalf_angle_deg = [[35, 40]]\n"
    "[grooves.b]\nazimuth_deg = 30\nspacing_mm = 0.09\nhalf_angle_deg = [[33, 30]]\ndepth_error_um = -12\n"
    "[grooves.c]\nazimuth_deg = 147\nspacing_mm = 0.09\nhalf_angle_deg = 36\noffset_mm = 0.02\n";

TEST(RuledDesign, PartsAreClosed) {
  for (const std::string& grooves : {kCanted, kCanted + "depth_mm = 0.03\n", kCanted + "bottom_flat_um = 4\n", kPattern,
                                     kLoose, kCanted + "bottom_radius_um = 2\n"})
    expect_closed_part(read(text_of(grooves, kFinite)).part());
}

// Beams, stochastic beams and rays use the surface in different ways.
TEST(RuledDesign, EnginesAgree) {
  expect_engines_agree(read(text_of(kCanted)).part(), 1e-2);
  expect_engines_agree(read(text_of(kCanted + "depth_mm = 0.03\n")).part(), 1e-2);
  expect_engines_agree(read(text_of(kPattern, kFinite)).part(), 4e-2);
  for (const std::string& grooves : {kCanted, kPattern})
    expect_same_accounts(geometry::build_part(read(text_of(grooves)).part()), from(14.0, 20.0), 1e-7, 4e-3, grooves);
  expect_nothing_lost(geometry::build_part(read(text_of(kLoose, kFinite)).part()), {0.0, 25.0}, 1U << 12, "loose");
}

// The STL file of a part is traced as a mesh. Its faces are found from triangles in single precision.
TEST(RuledDesign, StlFileReturnsTheSameLight) {
  for (const std::string& grooves : {kCanted, kPattern, kCanted + "depth_mm = 0.03\n"}) {
    const geometry::PartSpec spec = read(text_of(grooves, kFinite)).part();
    const geometry::Part part = geometry::build_part(spec);
    const geometry::Part meshed = geometry::part_of_mesh(stl_mesh_of(spec));
    const raytrace::Illumination light = from(9.0, 25.0);
    const raytrace::ConeResult direct =
        raytrace::MonteCarlo(part).trace(pmma(), light, {0.5}, rays(1U << 16), {}).cones[0];
    const raytrace::ConeResult of_mesh =
        raytrace::MonteCarlo(meshed).trace(pmma(), light, {0.5}, rays(1U << 16), {}).cones[0];
    EXPECT_NEAR(direct.rre, of_mesh.rre, 4.0 * std::hypot(direct.std_error, of_mesh.std_error)) << grooves;
    EXPECT_GT(direct.rre, 0.0);
  }
}

TEST(RuledDesign, DocumentsAreReadBack) {
  for (const std::string& grooves : {kCanted, kPattern, kCanted + "bottom_flat_um = 4\n"}) {
    const design::Design first = read(text_of(grooves));
    const design::Design second = read(design::design_text(first, ""));
    EXPECT_EQ(design::design_text(first, ""), design::design_text(second, ""));
    ASSERT_EQ(pattern_of(first).cells.size(), pattern_of(second).cells.size());
    for (std::size_t k = 0; k < pattern_of(first).cells.size(); ++k)
      EXPECT_NEAR((pattern_of(first).cells[k].at_mm - pattern_of(second).cells[k].at_mm).norm(), 0.0, 1e-15);
  }
}

TEST(RuledDesign, DocumentationDescribesTheKeysOfGrooveSets) {
  for (const schema::Table& table : design::design_format().root.tables)
    if (table.name == "grooves") {
      EXPECT_EQ(documents_test::documented("design_file.md", "groove sets"), schema::key_table(table.tables[0]));
    }
}

TEST(RuledDesign, RefusesContradictoryInput) {
  EXPECT_EQ(complaint("[element]\nkind = \"ruled\"\n" + kInfinite), "d.toml: grooves");
  EXPECT_EQ(complaint(text_of("")), "d.toml:3: grooves");
  EXPECT_EQ(complaint(text_of("form = \"base_angles\"\nspacing_mm = 0.1\nbase_angles_deg = [70, 55, 50]\n")),
            "d.toml:6: grooves.base_angles_deg");
  EXPECT_EQ(complaint(text_of(kCanted + "bottom_flat_um = 120\n")), "d.toml:7: grooves.bottom_flat_um");
  EXPECT_EQ(complaint(text_of(kCanted + "bottom_radius_um = 80\n")), "d.toml:7: grooves.bottom_radius_um");
  EXPECT_EQ(complaint(text_of(kCanted + "bottom_flat_um = 1\nbottom_radius_um = 1\n")),
            "d.toml:8: grooves.bottom_radius_um");
  const std::string parallel =
      "[grooves.a]\nazimuth_deg = 0\nspacing_mm = 0.1\nhalf_angle_deg = 35\n"
      "[grooves.b]\nazimuth_deg = 180\nspacing_mm = 0.1\nhalf_angle_deg = 35\n";
  EXPECT_EQ(complaint(text_of(parallel)), "d.toml:3: grooves");
  EXPECT_EQ(complaint(text_of(kLoose)), "d.toml:19: array.extent") << "the grooves have no period";
  EXPECT_EQ(complaint(text_of(kLoose, kFinite)), "nothing");
  EXPECT_EQ(complaint(text_of(kCanted + "[grooves.d]\noffset_mm = 0\n")), "d.toml:7: grooves.d");
  EXPECT_EQ(complaint(text_of(kCanted + "[grooves.a]\nhalf_angle_error_arcmin = 400\n")),
            "d.toml:8: grooves.a.half_angle_error_arcmin");
  for (const char* key : {"dihedral_error_arcmin", "rim_radius_um"})
    EXPECT_EQ(complaint(text_of(kCanted, kInfinite + "[surface]\n" + key + " = 1\n")),
              std::string("d.toml:12: surface.") + key);
  EXPECT_EQ(complaint(text_of(kCanted, kInfinite + "[form]\nsink_um = 0.1\n")), "d.toml:11: form");
  EXPECT_EQ(complaint("[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[grooves]\n" + kInfinite),
            "d.toml:5: grooves");
}

}  // namespace
}  // namespace retrace::testing::ruled_design_test

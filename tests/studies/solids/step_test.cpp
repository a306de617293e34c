#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "geometry/entrance/curved_boundary.h"
#include "geometry/io/step_file.h"
#include "geometry/part/mould_boundary.h"
#include "geometry/part/welded_part.h"
#include "tests/studies/solids/solid_specs.h"
#include "tests/studies/solids/step_reader.h"
#include "tests/support/entrance_surfaces.h"

// Tests of STEP files. OpenCASCADE must read them back as one valid solid without free edges, whose volume equals a
// closed form.

namespace retrace::geometry::step_test {
namespace {

using test::array_part;
using test::single_part;

test::StepFindings read_back(const BoundaryMesh& mesh) {
  const auto file = std::filesystem::temp_directory_path() / ("retrace_step_" + std::to_string(::getpid()) + ".step");
  std::ofstream(file, std::ios::binary) << step_text({faceted_solid(mesh), {}}, "test");
  const test::StepFindings found = test::read_step(file.string());
  std::filesystem::remove(file);
  return found;
}

void expect_solid(const BoundaryMesh& mesh, double volume_mm3) {
  const test::StepFindings found = read_back(mesh);
  ASSERT_TRUE(found.is_read);
  EXPECT_EQ(found.roots, 1);
  EXPECT_EQ(found.solids, 1);
  EXPECT_EQ(found.shells, 1);
  EXPECT_TRUE(found.is_valid);
  EXPECT_EQ(found.free_edges, 0);
  EXPECT_NEAR(found.volume_mm3, volume_mm3, 1e-9 * volume_mm3);
  EXPECT_NEAR(found.area_mm2, area_mm2(mesh), 1e-9 * area_mm2(mesh));
}

TEST(Step, SingleElementsHaveTheirVolume) {
  const double t = 0.7;
  expect_solid(closed_boundary(build_part(single_part(RtpElement{0.5, 0.4, 90.0}))),
               0.5 * 0.4 * t + test::prism_volume_mm3(0.5, 0.4));
  expect_solid(closed_boundary(build_part(single_part(HexagonalCube{1.6}))),
               test::hexagon_area_mm2(1.6) * t + test::hexagonal_volume_mm3(1.6));
  expect_solid(closed_boundary(build_part(single_part(TriangularCube{1.6}))),
               test::triangle_area_mm2(1.6) * t + test::triangular_volume_mm3(1.6));
}

TEST(Step, PrismArraysWithGapsMarginsAndMouldsHaveTheirVolume) {
  PartSpec spec = array_part(RtpElement{0.5, 0.4, 90.0}, Arrangement::aligned, 3.0, 2.0);
  spec.array.x_gap_mm = 0.1;
  spec.array.y_gap_mm = 0.05;
  spec.array.x_offset_mm = 0.05;
  const Part part = build_part(spec);
  ASSERT_EQ(part.elements_full, 20);
  const double below_mm3 = 20.0 * test::prism_volume_mm3(0.5, 0.4);
  expect_solid(closed_boundary(part), 6.0 * 0.7 + below_mm3);
  expect_solid(mould_boundary(part, 0.3), 6.0 * (0.25 + 0.3) - below_mm3);
}

TEST(Step, BrickRowsWithCutElementsHaveTheirVolume) {
  // The array has six rows with six prisms each. Every second row is shifted by half a prism and therefore has half a
  // prism at each end.
  const Part part = build_part(array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.0, 3.0));
  expect_solid(closed_boundary(part), 9.0 * 0.7 + 36.0 * test::prism_volume_mm3(0.5, 0.5));
}

// The volume below an inclined plane is the area times the height at the centre.
TEST(Step, SolidsWithCurvedEntranceSurfacesAreValid) {
  const Part part = build_welded_part(array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::offset, 3.0, 3.0));
  expect_solid(curved_boundary(part, testing::plane_entrance(0.7, 0.05, 0.02), 1e-3).mesh,
               9.0 * (0.7 + 0.05 * 1.5 + 0.02 * 1.5) + 36.0 * test::prism_volume_mm3(0.5, 0.5));
  const BoundaryMesh mesh = curved_boundary(part, testing::sphere_entrance(8.0, 0.9, {1.5, 1.4}), 1e-3).mesh;
  expect_solid(mesh, volume_mm3(mesh));
}

TEST(Step, CubeCornerArraysAreSolids) {
  for (const auto& [element, arrangement] : {std::pair{Element(HexagonalCube{1.0}), Arrangement::honeycomb},
                                             std::pair{Element(TriangularCube{1.0}), Arrangement::triangular}}) {
    const BoundaryMesh mesh = closed_boundary(build_part(array_part(element, arrangement, 5.0, 4.0)));
    expect_solid(mesh, volume_mm3(mesh));
  }
}

// The solid has 15 x 26 = 390 prisms of 0.5 mm x 0.3 mm.
TEST(Step, ThreeHundredAndNinetyElementsAreOneSolid) {
  const Part part = build_welded_part(array_part(RtpElement{0.5, 0.3, 90.0}, Arrangement::aligned, 7.5, 7.8));
  ASSERT_EQ(part.elements_full, 390);
  expect_solid(closed_boundary(part), 7.5 * 7.8 * 0.7 + 390.0 * test::prism_volume_mm3(0.5, 0.3));
}

TEST(Step, RoundedEdgesAndRandomTiltsAreSolids) {
  PartSpec spec = array_part(RtpElement{0.5, 0.5, 90.0}, Arrangement::aligned, 1.5, 1.5);
  spec.edges.root_radius_mm = 0.01;
  spec.edges.rim_radius_mm = 0.01;
  spec.edges.chords = 4;
  const BoundaryMesh rounded = closed_boundary(build_part(spec));
  expect_solid(rounded, volume_mm3(rounded));
  spec.edges = {};
  spec.random_tilts.sigma_arcmin = 3.0;
  const BoundaryMesh tilted = closed_boundary(build_part(spec));
  expect_solid(tilted, volume_mm3(tilted));
}

TEST(Step, TheSameSolidGivesTheSameText) {
  const ExactSolid solid = {faceted_solid(closed_boundary(build_part(single_part(HexagonalCube{1.6})))), {}};
  const std::string text = step_text(solid, "cube");
  EXPECT_TRUE(text == step_text(solid, "cube"));
  EXPECT_TRUE(text.find("AUTOMOTIVE_DESIGN") != std::string::npos);  // AP214
  EXPECT_TRUE(text.find("MANIFOLD_SOLID_BREP") != std::string::npos);
  EXPECT_TRUE(text.find(".MILLI.,.METRE.") != std::string::npos);
}

TEST(Step, EdgesThatItCannotHoldAreRefused) {
  const BoundaryMesh mesh = closed_boundary(build_part([] {
    PartSpec spec = single_part(RtpElement{1e-6, 1e-6, 90.0});
    spec.thickness_mm = 1e-6;
    return spec;
  }()));
  EXPECT_THROW(step_text({faceted_solid(mesh), {}}, "speck"), InputError);
}

}  // namespace
}  // namespace retrace::geometry::step_test

// Tests of designs with `element.kind` = `"round_icc"`: keys, geometry of the part, refused input, and photometry.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/number_format.h"
#include "design/azimuth_symmetry.h"
#include "design/io/design_document.h"
#include "design/io/design_reader.h"
#include "design/optical_model.h"
#include "geometry/elements/element_cells.h"
#include "geometry/outline/plan_region.h"
#include "raytrace/exact/beam_tracer.h"
#include "studies/fabrication/job_maker.h"
#include "studies/scene/scene.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"
#include "tests/support/statistics.h"

namespace retrace::studies::round_cube_design_test {
namespace {

using namespace photometric_requests;
using geometry::RoundCube;

std::string design(const std::string& element = "", const std::string& more = "") {
  return "[element]\nkind = \"round_icc\"\ndiameter_mm = 25.4\n" + element + "\n" + more;
}
const std::string kMirrors = "[idealisation]\nfacets = \"mirror\"\n";

design::Design read(const std::string& text) {
  return design::parse_design(text, "d.toml", {});
}
const RoundCube& cube_of(const design::Design& design) {
  return std::get<RoundCube>(design.part().element);
}
double length_of(const std::string& text) {
  const geometry::PartSpec part = read(text).part();
  return geometry::element_depth_mm(part.element) + part.thickness_mm;
}
std::string complaint(const std::string& text) {
  return refusal_of([&] { read(text); }, "nothing");
}

TEST(RoundCubeDesign, LengthIsThatOfTheKeysOrTheMinimum) {
  const double min_mm = 25.4 / std::numbers::sqrt2;
  EXPECT_NEAR(length_of(design()), min_mm, 2e-6);
  EXPECT_GT(length_of(design()), min_mm);
  EXPECT_NEAR(length_of(design("length_mm = 19")), 19.0, 1e-12);
  EXPECT_NEAR(length_of(design("edge_length_mm = 33")), 33.0 / std::numbers::sqrt3, 1e-12);
  // Angle errors raise the highest points of the facets. The entrance face must be above these points.
  const design::Design raised = read(design("", "[surface]\ndihedral_error_arcmin = [20, -10, 5]\n"));
  EXPECT_GT(raised.part().thickness_mm, 0.01);
  EXPECT_NO_THROW(geometry::build_part(raised.part()));
}

/// At normal incidence, a cube corner returns all light that meets its face. Paths in the three-dimensional view must
/// begin on the face, and not in the corners of its bounding box.
TEST(RoundCubeDesign, PathsOfTheViewBeginOnTheFace) {
  const DesignScene scene = make_scene(
      read(design("", "[body]\nmaterial = \"fused-silica\"\n[light]\nwavelength_nm = 532\n")), {SceneLight{}});
  ASSERT_FALSE(scene.paths.empty());
  double returned = 0.0;
  for (const ScenePath& path : scene.paths) {
    EXPECT_TRUE(path.path.is_returned);
    returned += path.fraction;
  }
  EXPECT_NEAR(returned, 1.0, 1e-12);
}

TEST(RoundCubeDesign, MountHasTheDiameterOfTheFaceByDefault) {
  EXPECT_EQ(cube_of(read(design())).mount_diameter_mm, 0.0);
  EXPECT_EQ(cube_of(read(design("recess_mm = 2"))).mount_diameter_mm, 25.4);
  EXPECT_EQ(cube_of(read(design("recess_mm = 2\nmount_diameter_mm = 24"))).mount_diameter_mm, 24.0);
  const geometry::Part part = geometry::build_part(read(design("recess_mm = 2\nchamfer_mm = 0.5")).part());
  ASSERT_TRUE(part.mount);
  EXPECT_EQ(part.mount->height_mm, 2.0);
  EXPECT_NEAR(geometry::area(part.mount->outline), 0.25 * std::numbers::pi * 25.4 * 25.4, 1e-9);
  EXPECT_NEAR(geometry::area(part.clear_face), 0.25 * std::numbers::pi * 24.4 * 24.4, 1e-9);
}

TEST(RoundCubeDesign, ArcSecondsAreSixtiethsOfArcMinutes) {
  const design::Design seconds = read(design("length_mm = 19", "[surface]\ndihedral_error_arcsec = [1.2, -3, 0.6]\n"));
  const design::Design minutes =
      read(design("length_mm = 19", "[surface]\ndihedral_error_arcmin = [0.02, -0.05, 0.01]\n"));
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(seconds.part().angle_errors.dihedral_error_arcmin[k],
                minutes.part().angle_errors.dihedral_error_arcmin[k], 1e-16);
  const design::Design hexagonal = read(
      "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\n[array]\nextent = \"infinite\"\n[body]\nthickness_mm = 1\n"
      "[surface]\ndihedral_error_arcsec = 6\n");
  for (const double error : hexagonal.part().angle_errors.dihedral_error_arcmin) EXPECT_NEAR(error, 0.1, 1e-15);
}

TEST(RoundCubeDesign, DocumentsDescribeTheSamePart) {
  for (const std::string& text :
       {design(), design("length_mm = 19\nchamfer_mm = 0.3\nrecess_mm = 1.5\nmount_diameter_mm = 25\ncant_deg = 1"),
        design("length_mm = 19", "[outline]\ncircle_mm = [0, 0, 10]\n"), design("hollow = true", kMirrors)}) {
    const design::Design first = read(text);
    const design::Design second = read(design::design_text(first));
    const geometry::Part a = geometry::build_part(first.part());
    const geometry::Part b = geometry::build_part(second.part());
    EXPECT_NEAR(a.thickness_mm, b.thickness_mm, 1e-12) << text;
    EXPECT_NEAR(a.entrance_area_mm2, b.entrance_area_mm2, 1e-9) << text;
    EXPECT_EQ(a.clear_face.size(), b.clear_face.size()) << text;
    EXPECT_EQ(a.mount.has_value(), b.mount.has_value()) << text;
    EXPECT_EQ(first.substance.refractive_index, second.substance.refractive_index) << text;
    EXPECT_EQ(first.substance.is_hollow, second.substance.is_hollow) << text;
  }
}

TEST(RoundCubeDesign, AHollowCubeHasTheIndexOfAir) {
  const design::Design hollow = read(design("hollow = true", kMirrors));
  const design::OpticalModel model = design::make_model(hollow, materials::MaterialLibrary::shipped());
  EXPECT_EQ(model.optics.index, 1.0);
  EXPECT_EQ(model.optics.absorption_per_mm, 0.0);
  const raytrace::Ledger ledger = raytrace::BeamTracer(model.part).trace(model.optics, {}, {0.5}, {}).ledgers[0];
  EXPECT_NEAR(ledger[raytrace::Account::retroreflected], 1.0, 1e-9);
}

TEST(RoundCubeDesign, FaultsAreReportedAtTheirKey) {
  const std::string outline = "[outline]\n";
  expect_refusals(
      complaint,
      {{"[element]\nkind = \"round_icc\"\n", "d.toml:1: element.diameter_mm"},
       {"[element]\nkind = \"round_icc\"\ndiameter_mm = 0\n", "d.toml:3: element.diameter_mm"},
       {design("length_mm = 17"), "d.toml:4: element.length_mm"},
       {design("length_mm = -1"), "d.toml:4: element.length_mm"},
       {design("edge_length_mm = 31"), "d.toml:4: element.edge_length_mm"},
       {design("length_mm = 19\nedge_length_mm = 33"), "d.toml:5: element.edge_length_mm"},
       {design("length_mm = 18", "[surface]\ndihedral_error_arcmin = -20\n"), "d.toml:4: element.length_mm"},
       {design("recess_mm = -1"), "d.toml:4: element.recess_mm"},
       {design("mount_diameter_mm = 0"), "d.toml:4: element.mount_diameter_mm"},
       {design("chamfer_mm = -0.1"), "d.toml:4: element.chamfer_mm"},
       {design("chamfer_mm = 12.7"), "d.toml:4: element.chamfer_mm"},
       {design("aperture_mm = 1"), "d.toml:4: element.aperture_mm"},
       {design("hollow = 1"), "d.toml:4: element.hollow"},
       {design("hollow = true"), "d.toml:4: element.hollow"},
       {design("hollow = true", kMirrors + "[body]\nmaterial = \"PC\"\n"), "d.toml:8: body.material"},
       {design("hollow = true", kMirrors + "[body]\nrefractive_index = 1.5\n"), "d.toml:8: body.refractive_index"},
       {design("", "[body]\nthickness_mm = 1\n"), "d.toml:6: body.thickness_mm"},
       {design("", "[array]\narrangement = \"honeycomb\"\n"), "d.toml:6: array.arrangement"},
       {design("", "[array]\nx_length_mm = 10\n"), "d.toml:6: array.x_length_mm"},
       {design("", "[array]\nextent = \"infinite\"\n"), "d.toml:6: array.extent"},
       {design("", "[substrate]\nkind = \"sphere\"\nradius_mm = 100\n"), "d.toml:6: substrate.kind"},
       {design("", "[surface]\nrim_radius_um = 10\n"), "d.toml:6: surface.rim_radius_um"},
       {design("", "[surface]\nrim_chamfer_um = 10\n"), "d.toml:6: surface.rim_chamfer_um"},
       {design("", "[surface]\ndihedral_error_arcsec = [1, 2]\n"), "d.toml:6: surface.dihedral_error_arcsec"},
       {design("", "[surface]\ndihedral_error_arcsec = 20000\n"), "d.toml:6: surface.dihedral_error_arcsec"},
       {design("", "[surface]\ndihedral_error_arcmin = 1\ndihedral_error_arcsec = 1\n"),
        "d.toml:7: surface.dihedral_error_arcsec"},
       {design("", "[part]\nfacets = \"planes.csv\"\n"), "d.toml:6: part.facets"},
       {design("recess_mm = 1", "[[shell]]\nthickness_mm = 1\ngap_mm = 10\n"), "d.toml:5: shell"},
       {design("chamfer_mm = 1", outline + "circle_mm = [0, 0, 10]\n"), "d.toml:4: element.chamfer_mm"},
       {design("", outline + "circle_mm = [0, 0, 10]\nmargin_mm = 1\n"), "d.toml:7: outline.margin_mm"},
       {design("", outline + "circle_mm = [0, 0, 10]\nholes_mm = [[5, 5, 1]]\n"), "d.toml:7: outline.holes_mm"},
       {design("", outline + "polygon_mm = [[0, 0], [10, 0], [0, 10]]\n"), "nothing"},
       {design("", outline + "polygon_mm = [[0, 0], [10, 0], [1, 1], [0, 10]]\n"), "d.toml:6: outline.polygon_mm"},
       {"[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\nlength_mm = 3\n", "d.toml:5: element.length_mm"},
       {"[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\nrecess_mm = 3\n", "d.toml:4: element.recess_mm"},
       {"[element]\nkind = \"rtp\"\nbase_mm = 1\nwidth_mm = 1\n[array]\narrangement = \"single\"\n[body]\nthickness_mm "
        "= 1\n"
        "[surface]\ndihedral_error_arcsec = 3\n",
        "d.toml:10: surface.dihedral_error_arcsec"}});
}

TEST(RoundCubeDesign, JobsRefuseIt) {
  for (const char* const strategy : {"dmc", "bidirectional"}) {
    JobRequest request;
    request.strategy = strategy;
    request.tool_width_mm = 0.1;
    EXPECT_EQ(refusal_of([&] { make_job(read(design()), request); }), "d.toml:2: element.kind") << strategy;
  }
}

TEST(RoundCubeDesign, SymmetryEndsWithTheOutline) {
  EXPECT_TRUE(design::azimuth_symmetry(read(design("recess_mm = 1\nchamfer_mm = 0.2"))));
  EXPECT_FALSE(
      design::azimuth_symmetry(read(design("", "[outline]\npolygon_mm = [[0, 0], [10, 0], [10, 10], [0, 10]]\n"))));
}

// An outline cuts a round cube corner to a hexagon. Its far field must be equal to the far field of a hexagonal cube
// corner.
TEST(RoundCubeDesign, PhotometryIsThatOfAHexagonalCubeIfTheFaceIsAHexagon) {
  constexpr double kAperture = 2.0;
  std::vector<std::string> points;
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3.0;
    points.push_back("[" + shortest(0.5 * kAperture * std::cos(angle)) + ", " +
                     shortest(0.5 * kAperture * std::sin(angle)) + "]");
  }
  std::string polygon = points.front();
  for (std::size_t k = 1; k < points.size(); ++k) polygon += ", " + points[k];
  const std::string errors = "[surface]\ndihedral_error_arcsec = [20, -10, 5]\n[body]\nrefractive_index = 1.46\n";
  const double length_mm = 3.0;
  const std::string round =
      "[element]\nkind = \"round_icc\"\ndiameter_mm = 3\nlength_mm = 3\n[outline]\npolygon_mm = [" + polygon + "]\n" +
      errors;
  const std::string hexagonal =
      "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 2\n[array]\narrangement = \"single\"\n" + errors +
      "thickness_mm = " + shortest(length_mm - kAperture / std::numbers::sqrt2) + "\n";
  PhotometrySettings request = request_of(points_at({0.1, 0.2, 0.33, 0.5, 1.0}, 1.0));
  request.diffraction = true;
  request.cutoff = 1e-13;
  request.area_cm2 = 0.01 * 1.5 * std::numbers::sqrt3;
  for (const double rotation_deg : {0.0, 35.0}) {
    request.rotation_deg = {rotation_deg};
    const PhotometryResult a = run(read(round), request);
    const PhotometryResult b = run(read(hexagonal), request);
    ASSERT_EQ(a.points.size(), b.points.size());
    double most = 0.0;
    for (const PhotometricPoint& point : b.points) most = std::max(most, point.r_a);
    for (std::size_t k = 0; k < a.points.size(); ++k) EXPECT_NEAR(a.points[k].r_a, b.points[k].r_a, 1e-9 * most) << k;
  }
}

}  // namespace
}  // namespace retrace::studies::round_cube_design_test

// Tests of the table [form] in designs: keys, refused values, and results of studies. A form is the smooth deviation of
// a facet from a plane.
#include "design/form_of_design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/number_format.h"
#include "design/io/design_document.h"
#include "materials/io/material_library.h"
#include "studies/inspect/inspect.h"
#include "studies/inspect/io/inspect_files.h"
#include "studies/photometry/photometer.h"
#include "studies/rre/rre.h"
#include "tests/studies/design_texts.h"
#include "tests/studies/photometric_requests.h"
#include "tests/support/refusals.h"

namespace retrace::studies::form_of_design_test {
namespace {

using geometry::Vec2, surface_models::FacetForm;

const std::string kCubes =
    "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 0.5\n[array]\narrangement = \"honeycomb\"\n"
    "extent = \"infinite\"\n[body]\nthickness_mm = 1.5\n";

FacetForm form_of(const std::string& text) {
  Warnings warnings;
  return design::form_of_design(design::parse_design(text, "d.toml"), warnings);
}

design::FormReport report_of(const std::string& text) {
  const design::Design design = design::parse_design(text, "d.toml");
  Warnings warnings;
  return design::report_form(design, design::form_of_design(design, warnings));
}

std::string refused(const std::string& text) {
  return refusal_of([&] { form_of(text); });
}

// The slope of a polynomial is the derivative of its height.
TEST(FacetForm, SlopeIsTheDerivativeOfTheHeight) {
  FacetForm form;
  for (int i = 0; i <= FacetForm::kMaxDegree; ++i)
    for (int j = 0; i + j <= FacetForm::kMaxDegree; ++j) form.add(i, j, std::sin(1.0 + 3.0 * i + 7.0 * j));
  EXPECT_NEAR(
      form.height_mm({1.0, 0.0}) - form.height_mm({0.0, 0.0}),
      [] {
        double sum = 0.0;
        for (int i = 1; i <= FacetForm::kMaxDegree; ++i) sum += std::sin(1.0 + 3.0 * i);
        return sum;
      }(),
      1e-12);
  constexpr double kStep = 1e-5;
  for (const Vec2& p : {Vec2(0.3, -0.7), Vec2(-0.9, 0.2), Vec2(0.0, 0.5)}) {
    const Vec2 slope = form.slope(p);
    EXPECT_NEAR(slope.x(),
                (form.height_mm(p + Vec2(kStep, 0.0)) - form.height_mm(p - Vec2(kStep, 0.0))) / (2.0 * kStep), 1e-7);
    EXPECT_NEAR(slope.y(),
                (form.height_mm(p + Vec2(0.0, kStep)) - form.height_mm(p - Vec2(0.0, kStep))) / (2.0 * kStep), 1e-7);
  }
}

// The sink of a square facet is a paraboloid with the mean height 0. The center of the paraboloid is one sink below its
// corners and a third of the sink below the mean height. The variance of the heights is 2 / 45 of the square of the
// sink.
TEST(FormOfDesign, SinkIsAParaboloidAboutItsMean) {
  const design::FormReport report = report_of(kCubes + "[form]\nsink_um = 0.1\n");
  EXPECT_NEAR(report.radius_mm, 0.5 / (2.0 * std::sqrt(2.0 / 3.0)) / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(report.lowest_um, -0.1 / 3.0, 1e-12);
  EXPECT_NEAR(report.highest_um, 0.2 / 3.0, 1e-12);
  EXPECT_NEAR(report.rms_um, 0.05 * std::sqrt(8.0 / 45.0), 1e-12);
  EXPECT_NEAR(report.tilt_mrad, 0.0, 1e-12);
  EXPECT_NEAR(report.steepest_mrad, 0.2 / report.radius_mm, 1e-9);
  // A negative sink is a bulge.
  EXPECT_NEAR(report_of(kCubes + "[form]\nsink_um = -0.1\n").highest_um, 0.1 / 3.0, 1e-12);
  // A facet of a triangular cube is not square. Its form must also have no tilt relative to its best-fitting plane.
  const std::string triangles =
      "[element]\nkind = \"triangular_icc\"\naperture_mm = 0.5\n[array]\narrangement = "
      "\"triangular\"\nextent = \"infinite\"\n[body]\nthickness_mm = 1.5\n";
  EXPECT_NEAR(report_of(triangles + "[form]\nsink_um = 0.1\n").tilt_mrad, 0.0, 1e-12);
  EXPECT_TRUE(form_of(kCubes + "[form]\nsink_um = 0\n").is_plane());
  EXPECT_TRUE(form_of(kCubes).is_plane());
}

TEST(FormOfDesign, TermsAreInUnitsOfTheRadiusAndAddUp) {
  const std::string terms =
      "terms = [{ x_power = 1, y_power = 0, height_um = 0.2 }, { x_power = 0, y_power = 3, height_um = -0.3 }]\n";
  const FacetForm form = form_of(kCubes + "[form]\n" + terms);
  const double radius = report_of(kCubes + "[form]\n" + terms).radius_mm;
  EXPECT_NEAR(form.height_mm({radius, 0.0}), 2e-4, 1e-15);
  EXPECT_NEAR(form.height_mm({0.0, -radius}), 3e-4, 1e-15);
  const FacetForm both = form_of(kCubes + "[form]\nsink_um = 0.5\n" + terms);
  const FacetForm sink = form_of(kCubes + "[form]\nsink_um = 0.5\n");
  for (const Vec2& p : {Vec2(0.1, -0.05), Vec2(-0.02, 0.07)})
    EXPECT_NEAR(both.height_mm(p), sink.height_mm(p) + form.height_mm(p), 1e-15);
  EXPECT_NEAR(report_of(kCubes + "[form]\nterms = [{ x_power = 1, y_power = 0, height_um = 0.2 }]\n").tilt_mrad,
              0.2 / radius, 1e-9);
}

/// A temporary folder with a height map of 41 x 35 points, 12 um apart by default. `height` returns the height in nm as
/// a function of the position relative to the center, in um.
class MapFolder {
 public:
  template <class Height>
  explicit MapFolder(const Height& height, double pixel_um = 12.0) {
    std::string name = (std::filesystem::temp_directory_path() / "retrace_form_XXXXXX").string();
    path_ = ::mkdtemp(name.data());
    std::string text = "pixel_um " + shortest(pixel_um) + "\nheight_unit nm\n";
    for (int row = -17; row <= 17; ++row)
      for (int column = -20; column <= 20; ++column)
        text += shortest(height(pixel_um * column, pixel_um * row)) + (column == 20 ? "\n" : " ");
    std::ofstream(path_ / "map.txt") << text;
  }
  ~MapFolder() { std::filesystem::remove_all(path_); }
  MapFolder(const MapFolder&) = delete;
  MapFolder& operator=(const MapFolder&) = delete;

  std::string text(const std::string& keys) const {
    return kCubes + "[form]\nmap = \"" + (path_ / "map.txt").string() + "\"\n" + keys;
  }

 private:
  std::filesystem::path path_;
};

// If a map is a polynomial, the form is this polynomial without its best-fitting plane. The test has odd and even
// powers along both axes.
TEST(FormOfDesign, MapGivesItsPolynomial) {
  const MapFolder folder([](double x_um, double y_um) {
    return 30.0 + 0.2 * x_um - 0.1 * y_um + 5e-3 * x_um * x_um - 3e-3 * x_um * y_um + 4e-5 * y_um * y_um * y_um;
  });
  FacetForm expected;  // coefficients in mm
  expected.add(2, 0, 5e-3);
  expected.add(1, 1, -3e-3);
  expected.add(0, 3, 4e-2);
  for (const int degree : {3, 4, 6}) {
    const FacetForm form = form_of(folder.text("map_degree = " + std::to_string(degree) + "\n"));
    // Second differences do not depend on planes.
    const auto bend = [](const FacetForm& f, const Vec2& p, const Vec2& step) {
      return f.height_mm(p + step) - 2.0 * f.height_mm(p) + f.height_mm(p - step);
    };
    for (const Vec2& p : {Vec2(0.0, 0.0), Vec2(0.05, -0.08)})
      for (const Vec2& step : {Vec2(0.04, 0.0), Vec2(0.0, 0.04), Vec2(0.03, 0.03)})
        EXPECT_NEAR(bend(form, p, step), bend(expected, p, step), 1e-12);
  }
  EXPECT_NEAR(report_of(folder.text("")).tilt_mrad, 0.0, 1e-9);
  // If the y axis of the map is the horizontal axis of the facet, the heights along y of the map are along x of the
  // facet.
  const FacetForm turned = form_of(folder.text("map_horizontal_axis = \"y\"\n"));
  const auto second = [&](const Vec2& step) {
    return turned.height_mm(step) - 2.0 * turned.height_mm({0.0, 0.0}) + turned.height_mm(-step);
  };
  EXPECT_NEAR(second({0.0, 0.04}), 2.0 * 5e-3 * 0.04 * 0.04, 1e-12);
  EXPECT_NEAR(second({0.04, 0.0}), 0.0, 1e-12);
}

TEST(FormOfDesign, WrongFormsAreRefused) {
  const auto said = [](const std::string& lines) { return refused(kCubes + "[form]\n" + lines); };
  expect_refusals(said,
                  {{"sink_um = 101", "d.toml:10: form.sink_um"},
                   {"sink = 0.1", "d.toml:10: form.sink"},
                   {"map_degree = 3", "d.toml:10: form.map_degree"},
                   {"terms = 3", "d.toml:10: form.terms"},
                   {"terms = [{ x_power = 2, y_power = 7, height_um = 0.1 }]", "d.toml:10: form.terms[1].y_power"},
                   {"sink_um = 10", "d.toml:10: form.sink_um"}});
  EXPECT_EQ(said("terms = [{ x_power = 1.5, y_power = 0, height_um = 0.1 }]"), "d.toml:10: form.terms[1].x_power");
  EXPECT_EQ(said("terms = [{ x_power = 1, y_power = 0 }]"), "d.toml:10: form.terms[1].height_um");
  EXPECT_EQ(said("map = \"none.txt\""), "d.toml:10: form.map");
  const MapFolder small([](double, double) { return 0.0; }, 5.0);
  EXPECT_EQ(refused(small.text("")), "d.toml:10: form.map");
  // Parts without elements have no facets that could have a form.
  const std::string form = "[form]\nsink_um = 1\n";
  EXPECT_EQ(complaint("[element]\nkind = \"ball\"\ndiameter_mm = 1\n" + form), "d.toml:4: form");
  EXPECT_EQ(complaint("[part]\nplate_mm = [1, 1]\n[body]\nthickness_mm = 1\n" + form), "d.toml:5: form");
}

TEST(FormOfDesign, IsWrittenAsItWasRead) {
  const std::string text =
      kCubes +
      "[form]\nsink_um = 0.25\nterms = [{ x_power = 2, y_power = 1, height_um = -0.5 }]\nmap = \"m.gsf\"\n"
      "map_horizontal_axis = \"y\"\nmap_degree = 6\n";
  const design::Design again =
      design::parse_design(design::design_text(design::parse_design(text, "d.toml")), "d.toml");
  const design::FormOfFacets& form = again.surface.form;
  EXPECT_EQ(form.sink_um, 0.25);
  ASSERT_EQ(form.terms.size(), 1U);
  EXPECT_EQ(form.terms[0].x_power, 2);
  EXPECT_EQ(form.terms[0].y_power, 1);
  EXPECT_EQ(form.terms[0].height_um, -0.5);
  ASSERT_TRUE(form.map);
  EXPECT_EQ(form.map->name, "m.gsf");
  EXPECT_EQ(form.map->horizontal_axis, design::HeightMapAxis::y);
  EXPECT_EQ(form.map->degree, 6);
  EXPECT_TRUE(design::parse_design(kCubes, "d.toml").surface.form.is_plane());
}

TEST(FormOfDesign, InspectTellsIt) {
  const materials::MaterialLibrary library = materials::MaterialLibrary::shipped();
  const auto told = [&](const std::string& lines) {
    return inspect_text(inspect(design::parse_design(kCubes + lines, "d.toml"), library));
  };
  EXPECT_NE(
      told("[form]\nsink_um = 0.1\n")
          .find("form of facets      -0.0333 to 0.0667 um from their planes, rms 0.0211 um, slopes up to 0.924 mrad\n"),
      std::string::npos);
  EXPECT_EQ(told("").find("form of facets"), std::string::npos);
  EXPECT_NE(inspect_json(inspect(design::parse_design(kCubes + "[form]\nsink_um = 0.1\n", "d.toml"), library))
                .find("\"steepest_mrad\""),
            std::string::npos);
}

// A facet with a form does not reflect a beam as a plane wave. Rays are used by default. Exact engines are refused with
// a message that reports the key.
TEST(FormOfDesign, ExactEnginesAreForPlanes) {
  const design::Design sunk = design::parse_design(kCubes + "[form]\nsink_um = 0.1\n", "d.toml");
  const auto refusal = [&](const auto& change) {
    RreSettings request;
    change(request);
    return refusal_of([&] { RreStudy({sunk}, request); });
  };
  const std::string message = "d.toml:10: form.sink_um";
  EXPECT_EQ(refusal([](RreSettings& r) { r.engine = raytrace::Engine::exact; }), message);
  EXPECT_EQ(refusal([](RreSettings& r) { r.footprint = true; }), message);
  EXPECT_EQ(refusal([](RreSettings& r) { r.derivatives = true; }), message);
  RreSettings automatic;
  automatic.rays = std::nullopt;
  automatic.target_error = 1e-3;
  EXPECT_EQ(RreStudy({sunk}, automatic).run().points.front().engine, "cell");
}

using namespace photometric_requests;

// As the sink goes to 0, its effect vanishes. A sink of 0.1 um has a large effect.
TEST(FormOfDesign, PhotometryIsContinuousInTheSink) {
  design::Design design = photometric_requests::design_of(honeycomb(0.0, 0.5));
  PhotometrySettings request = request_of(points_at({0.2}, 100.0));
  request.diffraction = true;
  // With this engine, weak beams are truncated for plane facets, too, and not only for facets with a form.
  request.engine = raytrace::Engine::exact;
  const auto r_a = [&](double sink_um) {
    design.surface.form.sink_um = sink_um;
    const Photometer photometer(design, request, 1);
    EXPECT_TRUE(photometer.is_exact() && photometer.has_diffraction());
    return photometer.measure({{.v_deg = 5.0, .observation_deg = {0.2, 1.0 / 3.0}}}, nullptr, nullptr)->front().r_a;
  };
  const std::vector<double> plane = r_a(0.0), little = r_a(1e-7), sunk = r_a(0.1);
  ASSERT_EQ(sunk.size(), 2U);
  for (std::size_t k = 0; k < plane.size(); ++k) {
    EXPECT_NEAR(little[k], plane[k], 1e-4 * plane[k]) << "which of the faintest 1e-4 are diffracted may differ";
    EXPECT_GT(std::abs(sunk[k] - plane[k]), 0.05 * plane[k]);
  }
}

// Unequal dihedral errors move the edges of facets away from the corners of the outline. Facets then have an additional
// corner. The effect of the errors must go to 0 as the errors go to 0.
TEST(FormOfDesign, RreIsContinuousInUnequalDihedralErrors) {
  const auto rre = [](double arcmin, const std::string& lengths) {
    design::Design design = design::parse_design(
        "[element]\nkind = \"hexagonal_icc\"\naperture_mm = 1\n[array]\n" + lengths +
            "[body]\nthickness_mm = 2\n[form]\nterms = [{ x_power = 1, y_power = 1, height_um = 1 }]\n[detector]\n"
            "acceptance_half_angle_deg = [0.03, 0.1, 0.2]\n",
        "d.toml");
    design.part().angle_errors.dihedral_error_arcmin = {arcmin, 2.0 * arcmin, 3.0 * arcmin};
    RreSettings request;
    request.rays = 1U << 13;
    request.engine = raytrace::Engine::montecarlo;
    std::vector<double> values;
    for (const RrePoint& point : RreStudy({design}, request).run().points) values.push_back(point.rre);
    return values;
  };
  for (const std::string lengths : {"extent = \"infinite\"\n", "x_length_mm = 6\ny_length_mm = 4\n"}) {
    const std::vector<double> without = rre(0.0, lengths);
    ASSERT_EQ(without.size(), 3U);
    for (const double arcmin : {1e-6, 1e-4}) {
      const std::vector<double> with = rre(arcmin, lengths);
      for (std::size_t k = 0; k < with.size(); ++k) EXPECT_NEAR(with[k], without[k], 2e-3) << k << " " << lengths;
    }
  }
}

TEST(FormOfDesign, PhotometryIsContinuousInUnequalDihedralErrors) {
  design::Design design = photometric_requests::design_of(honeycomb(0.0, 0.5));
  design.surface.form.sink_um = 0.1;
  PhotometrySettings request = request_of(points_at({0.2}, 100.0));
  request.diffraction = true;
  request.engine = raytrace::Engine::exact;
  const auto r_a = [&](double arcmin) {
    design.part().angle_errors.dihedral_error_arcmin = {arcmin, 2.0 * arcmin, 3.0 * arcmin};
    return Photometer(design, request, 1)
        .measure({{.v_deg = 5.0, .observation_deg = {0.2, 1.0 / 3.0}}}, nullptr, nullptr)
        ->front()
        .r_a;
  };
  const std::vector<double> without = r_a(0.0), with = r_a(1e-5);
  for (std::size_t k = 0; k < without.size(); ++k) EXPECT_NEAR(with[k], without[k], 1e-3 * without[k]) << k;
}

TEST(FormOfDesign, PhotometryTakesRaysBesideATexture) {
  design::Design design = photometric_requests::design_of(honeycomb(0.0, 0.5));
  design.surface.form.sink_um = 0.1;
  PhotometrySettings request = request_of(points_at({0.2}, 1e6));
  request.rays = 1U << 12;
  EXPECT_EQ(run(design, request).engine, "embree") << "without diffraction";
  request.engine = raytrace::Engine::exact;
  request.rays.reset();
  EXPECT_EQ(refusal_of([&] { run(design, request); }), "form");
  request.engine = raytrace::Engine::automatic;
  request.diffraction = true;
  design.surface.texture = design::HarveyShackTexture{.roughness_sq_nm = 5.0, .correlation_length_um = 20.0};
  const PhotometryResult rough = run(design, request);
  EXPECT_EQ(rough.engine, "embree");
  EXPECT_EQ(rough.reason.no_diffraction, NoDiffraction(raytrace::Obstacle::form_and_texture));
  record_message(rough.reason.text);
  request.engine = raytrace::Engine::exact;
  EXPECT_EQ(refusal_of([&] { run(design, request); }), "form");
}

}  // namespace
}  // namespace retrace::studies::form_of_design_test

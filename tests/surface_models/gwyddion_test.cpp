// Compares the library's results for surfaces with those of the Gwyddion libraries, whose lengths and heights are in
// metres.

#include <gtest/gtest.h>
#include <libgwyddion/gwycontainer.h>
#include <libgwyddion/gwyserializable.h>
#include <libprocess/gwyprocess.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "surface_models/autocorrelation.h"
#include "surface_models/form.h"
#include "surface_models/gaussian_filter.h"
#include "surface_models/height_parameters.h"
#include "surface_models/io/height_map_reader.h"
#include "surface_models/spectrum.h"
#include "tests/support/synthetic_surface.h"

namespace retrace::surface_models::gwyddion_test {
namespace {

struct Release {
  void operator()(void* object) const { g_object_unref(object); }
};
using Field = std::unique_ptr<GwyDataField, Release>;
using Line = std::unique_ptr<GwyDataLine, Release>;

Field field_of(const HeightMap& map) {
  Field field(gwy_data_field_new(static_cast<gint>(map.columns), static_cast<gint>(map.rows),
                                 static_cast<double>(map.columns) * map.x_pixel_um * 1e-6,
                                 static_cast<double>(map.rows) * map.y_pixel_um * 1e-6, TRUE));
  gdouble* const data = gwy_data_field_get_data(field.get());
  std::transform(map.heights_nm.begin(), map.heights_nm.end(), data, [](double z) { return z * 1e-9; });
  return field;
}

/// Returns a rough surface with a wave, a plane, and an asymmetric distribution of heights.
HeightMap skewed_surface() {
  HeightMap map = testing::gaussian_surface(384, 300, 9.0, 4.0, 8);
  for (double& z : map.heights_nm) z += 0.02 * z * z;
  testing::add_wave(map, 15.0, 1.0 / 120.0, 1.0 / 300.0, 0.3);
  testing::add_plane(map, 40.0, 300.0, -200.0);
  return map;
}

TEST(Gwyddion, AgreesOnHeightParametersOfALevelledSurface) {
  const HeightMap map = skewed_surface();
  const Field field = field_of(map);
  gdouble a = 0.0;
  gdouble bx = 0.0;
  gdouble by = 0.0;
  gwy_data_field_fit_plane(field.get(), &a, &bx, &by);
  gwy_data_field_plane_level(field.get(), a, bx, by);
  gdouble mean = 0.0;
  gdouble ra = 0.0;
  gdouble rms = 0.0;
  gdouble skew = 0.0;
  gdouble excess_kurtosis = 0.0;
  gwy_data_field_get_stats(field.get(), &mean, &ra, &rms, &skew, &excess_kurtosis);

  const HeightMap levelled = without_form(map, 1);
  const HeightParameters p = height_parameters(levelled.heights_nm);
  EXPECT_NEAR(p.sa_nm, ra * 1e9, 1e-9 * p.sa_nm);
  EXPECT_NEAR(p.sq_nm, rms * 1e9, 1e-9 * p.sq_nm);
  EXPECT_NEAR(p.ssk, skew, 1e-9);
  EXPECT_NEAR(p.sku, excess_kurtosis + 3.0, 1e-9);
  EXPECT_NEAR(p.sz_nm, (gwy_data_field_get_max(field.get()) - gwy_data_field_get_min(field.get())) * 1e9, 1e-8);
  const gdouble* const heights = gwy_data_field_get_data_const(field.get());
  for (std::size_t i = 0; i < levelled.heights_nm.size(); i += 97)
    EXPECT_NEAR(levelled.heights_nm[i], heights[i] * 1e9, 1e-7);
}

TEST(Gwyddion, AgreesOnTheGaussianFilterInside) {
  const HeightMap map = without_form(skewed_surface(), 1);
  constexpr double kCutoff = 40.0;
  const Field field = field_of(map);
  // exp(-pi x^2 / (a L)^2) has the standard deviation a L / sqrt(2 pi).
  const double sigma = kCutoff * std::sqrt(std::numbers::ln2 / std::numbers::pi / (2.0 * std::numbers::pi));
  gwy_data_field_row_gaussian(field.get(), sigma);
  gwy_data_field_column_gaussian(field.get(), sigma);
  const gdouble* const smooth = gwy_data_field_get_data_const(field.get());
  const Split split = gaussian_split(map, kCutoff);
  for (std::size_t row = 40; row + 40 < map.rows; row += 11)
    for (std::size_t column = 40; column + 40 < map.columns; column += 13)
      EXPECT_NEAR(split.waviness.at(column, row), smooth[row * map.columns + column] * 1e9, 1e-3);
}

TEST(Gwyddion, AgreesOnSpectraAlongBothAxes) {
  // Gwyddion scales each line to the variance that it had before the window was applied. The map therefore contains
  // only short waves: a long wave, of which a line contains only one period, would get a different amplitude.
  HeightMap map = testing::gaussian_surface(384, 300, 9.0, 3.0, 8);
  testing::add_wave(map, 5.0, 1.0 / 16.0, 1.0 / 12.0, 0.3);
  const Field field = field_of(map);
  for (const Axis axis : {Axis::x, Axis::y}) {
    const Line line(gwy_data_line_new(1, 1.0, FALSE));
    gwy_data_field_psdf(field.get(), line.get(),
                        axis == Axis::x ? GWY_ORIENTATION_HORIZONTAL : GWY_ORIENTATION_VERTICAL,
                        GWY_INTERPOLATION_LINEAR, GWY_WINDOWING_HANN, -1);
    const Spectrum spectrum = line_spectrum(map, axis);
    // Both densities begin with the first harmonic. Gwyddion's density is two-sided, in m^3, and a function of the
    // angular frequency 2 pi f.
    constexpr double kOneSided = 2.0;
    constexpr double kNm2MmPerM3 = 1e21;
    double ours = 0.0;
    double theirs = 0.0;
    for (gint k = 4; k < 120; ++k) {
      ours += spectrum.density[static_cast<std::size_t>(k)];
      theirs += kOneSided * 2.0 * std::numbers::pi * kNm2MmPerM3 * gwy_data_line_get_val(line.get(), k);
    }
    EXPECT_NEAR(ours / theirs, 1.0, 0.02) << (axis == Axis::x ? "x" : "y");
  }
}

TEST(Gwyddion, AgreesOnTheAutocorrelation) {
  const HeightMap map = testing::gaussian_surface(384, 300, 9.0, 6.0, 18);
  const Field field = field_of(map);
  gwy_data_field_add(field.get(), -gwy_data_field_get_avg(field.get()));
  const Field acf(gwy_data_field_new(1, 1, 1.0, 1.0, FALSE));
  gwy_data_field_area_2dacf(field.get(), acf.get(), 0, 0, static_cast<gint>(map.columns), static_cast<gint>(map.rows),
                            20, 20);
  // Distance 0 is at the center of the field.
  const gint middle_x = gwy_data_field_get_xres(acf.get()) / 2;
  const gint middle_y = gwy_data_field_get_yres(acf.get()) / 2;
  const Autocorrelation r = autocorrelation(map, 30.0);
  for (gint dy = -15; dy <= 15; dy += 3)
    for (gint dx = 0; dx <= 15; dx += 3)
      EXPECT_NEAR(r.at(static_cast<std::size_t>(dx), dy),
                  gwy_data_field_get_val(acf.get(), middle_x + dx, middle_y + dy) * 1e18, 1e-9 * r.variance_nm2())
          << dx << " " << dy;
}

TEST(Gwyddion, WritesFilesThatAreReadBack) {
  const HeightMap map = testing::gaussian_surface(40, 30, 9.0, 4.0, 8);
  const std::unique_ptr<GwyContainer, Release> container(gwy_container_new());
  for (const char* name : {"/2/data", "/5/data"}) {
    const Field field = field_of(map);
    if (name[1] == '5') gwy_data_field_multiply(field.get(), 2.0);
    for (GwySIUnit* unit : {gwy_data_field_get_si_unit_xy(field.get()), gwy_data_field_get_si_unit_z(field.get())})
      gwy_si_unit_set_from_string(unit, "m");
    gwy_container_set_object(container.get(), g_quark_from_string(name), field.get());
  }
  gwy_container_set_const_string(container.get(), g_quark_from_string("/2/data/title"),
                                 reinterpret_cast<const guchar*>("Height"));
  gwy_container_set_boolean(container.get(), g_quark_from_string("/2/data/visible"), TRUE);
  GByteArray* const bytes = gwy_serializable_serialize(G_OBJECT(container.get()), nullptr);
  const std::string content = "GWYP" + std::string(reinterpret_cast<const char*>(bytes->data), bytes->len);
  g_byte_array_free(bytes, TRUE);

  const HeightMapFile first = parse_height_map(content, "two.gwy", {});
  EXPECT_EQ(first.map.columns, 40U);
  EXPECT_EQ(first.map.rows, 30U);
  EXPECT_NEAR(first.map.x_pixel_um, 1.0, 1e-12);
  EXPECT_EQ(first.warnings.size(), 1U) << "which channel was taken";
  HeightMapOptions options;
  options.channel = 5;
  const HeightMapFile second = parse_height_map(content, "two.gwy", options);
  EXPECT_TRUE(second.warnings.empty());
  for (std::size_t i = 0; i < map.heights_nm.size(); ++i) {
    EXPECT_NEAR(first.map.heights_nm[i], map.heights_nm[i], 1e-12);
    EXPECT_NEAR(second.map.heights_nm[i], 2.0 * map.heights_nm[i], 1e-12);
  }
  // A file that is cut at any position causes an error.
  for (std::size_t length = 4; length < content.size(); length += 7)
    EXPECT_THROW(parse_height_map(content.substr(0, length), "cut.gwy", {}), InputError) << length;
}

}  // namespace
}  // namespace retrace::surface_models::gwyddion_test

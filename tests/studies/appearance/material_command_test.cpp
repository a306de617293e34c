#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "tests/app/program.h"
#include "tests/studies/appearance/material_readers.h"
#include "tests/support/sample_size.h"

// Tests of `retrace export` for materials. The files are read by independent readers and compared with the results of
// `retrace photometry` and `retrace rre` for the same design.

namespace retrace::test::material_command_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Returns a design with cube corners whose angle errors cause six spots of returned light.
/// \param aperture_mm size of the elements: 0.5 causes visible diffraction; with 20, diffraction is negligible compared
/// with the discs of source and receiver
std::string cubes(const std::string& aperture_mm) {
  return "[element]\nkind = \"hexagonal_icc\"\naperture_mm = " + aperture_mm +
         "\n[array]\narrangement = \"honeycomb\"\nextent = \"infinite\"\n[body]\nthickness_mm = 1\n"
         "refractive_index = 1.4917\n[surface]\ndihedral_error_arcmin = 2.2\n";
}

/// Returns the arguments of an export.
/// \param window_deg half-width of the window; it must include the spots, widened by the discs of source and receiver
/// \param entrance_deg largest entrance angle
Arguments export_of(const std::string& file, const std::string& window_deg = "0.4", const std::string& error = "0.02",
                    const std::string& entrance_deg = "8") {
  return {"export",     "d.toml",
          file,         "--entrance-deg",
          entrance_deg, "--window-deg",
          window_deg,   "--source-arcmin",
          "20",         "--receiver-arcmin",
          "20",         "--max-directions",
          "64",         "--error",
          error,        "--quiet"};
}

/// Geometry of a goniometer, and the R_A that `retrace photometry` computes for it.
struct Reading {
  double observation_deg, v_deg, h_deg, turn_deg;
  double r_a = 0.0;
};

/// Returns readings of `retrace photometry` in random geometries, ten for each rotation of the part. The geometries
/// avoid the direction in which the entrance face reflects the lamp.
std::vector<Reading> readings(const TemporaryFolder& folder) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Reading> all;
  for (int turn = 0; turn < 5; ++turn) {
    const double turn_deg = 360.0 * share(random);
    std::string limits = "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n";
    for (int k = 0; k < 10; ++k) {
      const double beta_deg = 2.0 + 5.9 * share(random);
      const double round = 2.0 * kPi * share(random);
      const Reading at{0.39 * share(random), beta_deg * std::sin(round), beta_deg * std::cos(round), turn_deg};
      all.push_back(at);
      std::ostringstream row;
      row.precision(15);
      row << "S,,white," << at.observation_deg << ',' << at.v_deg << ',' << at.h_deg << ",1,cd/lx/m2,read\n";
      limits += row.str();
    }
    folder.write("limits.csv", limits);
    std::ostringstream turn_text;
    turn_text.precision(15);
    turn_text << turn_deg;
    const Json json = retrace_json(
        folder, {"photometry", "d.toml", "--standard", "limits.csv", "--area-cm2", "10", "--light", "d65", "--rotation",
                 turn_text.str(), "--source-arcmin", "20", "--receiver-arcmin", "20", "--no-advice"});
    for (std::size_t k = 0; k < 10; ++k)
      all[all.size() - 10 + k].r_a = json.at("points").at(k).at("r_a_cd_per_lx_m2").get<double>();
  }
  return all;
}

double rad(double deg) {
  return deg * kPi / 180.0;
}

/// Returns the presentation angle, entrance angle and orientation angle by the relations of CIE 54.2.
Triple intrinsic_deg(const Reading& at) {
  const double beta1 = rad(-at.v_deg);
  const double beta2 = rad(-at.h_deg);
  const double beta = std::acos(std::cos(beta1) * std::cos(beta2));
  const double gamma = std::atan2(std::sin(beta2), std::sin(beta1) * std::cos(beta2));
  const double omega = rad(at.turn_deg) + kPi / 2.0 - std::atan2(std::sin(beta1), std::cos(beta1) * std::sin(beta2));
  return {gamma / rad(1.0), beta / rad(1.0), omega / rad(1.0)};
}

/// Rotates a vector by -turn_deg about +z, from the frame of the goniometer into the part frame.
Triple turned_back(const Triple& v, double turn_deg) {
  const double c = std::cos(rad(turn_deg));
  const double s = std::sin(rad(turn_deg));
  return {c * v[0] + s * v[1], -s * v[0] + c * v[1], v[2]};
}

/// Returns the direction to the source in the part frame, with V increased by `up_deg`.
Triple at_v(const Reading& at, double up_deg) {
  const double v = rad(at.v_deg + up_deg);
  const double h = rad(at.h_deg);
  return turned_back({std::sin(h) * std::cos(v), std::sin(v), std::cos(h) * std::cos(v)}, at.turn_deg);
}

/// Returns the sorted relative errors. Errors of values below 1 % of the maximum are relative to 1 % of the maximum.
std::vector<double> errors_of(const std::vector<Reading>& truth, const std::vector<double>& told) {
  double most = 0.0;
  for (const Reading& at : truth) most = std::max(most, at.r_a);
  std::vector<double> errors;
  for (std::size_t k = 0; k < truth.size(); ++k)
    errors.push_back(std::abs(told[k] - truth[k].r_a) / std::max(truth[k].r_a, 0.01 * most));
  std::sort(errors.begin(), errors.end());
  return errors;
}

/// Returns the values of a table for given geometries, read by the script of the examples.
std::vector<Triple> read_by_example(const TemporaryFolder& folder, const std::vector<Reading>& at) {
  std::ostringstream geometries;
  geometries.precision(12);
  for (const Reading& reading : at) {
    const Triple angles = intrinsic_deg(reading);
    geometries << reading.observation_deg << ' ' << angles[0] << ' ' << angles[1] << ' ' << angles[2] << '\n';
  }
  Child reader(folder.path(), {RETRACE_PYTHON, "-B", RETRACE_SOURCE_DIR "/examples/material/print_r_a.py", "m.json"},
               geometries.str());
  const Outcome outcome = reader.wait();
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::vector<Triple> told;
  for (Triple rgb{}; lines >> rgb[0] >> rgb[1] >> rgb[2];) told.push_back(rgb);
  EXPECT_EQ(told.size(), at.size()) << outcome.out;
  return told;
}

/// Results for cube corners of 0.5 mm that several tests use. They are computed only one time, because this takes
/// several seconds.
struct SmallCubes {
  SmallCubes() {
    folder.write("d.toml", cubes("0.5"));
    truth = readings(folder);
    summary = retrace_json(folder, export_of("m.glsl"));
  }

  TemporaryFolder folder;      ///< contains the design d.toml and the shader m.glsl
  std::vector<Reading> truth;  ///< readings of photometry
  Json summary;                ///< JSON that the export of the shader writes to standard output
};
const SmallCubes& small_cubes() {
  static const SmallCubes once;
  return once;
}

TEST(Material, IsWithinTwoPercentOfPhotometryByItsExampleReader) {
  const auto& [folder, truth, summary] = small_cubes();
  ASSERT_EQ(retrace(folder, export_of("m.json")).code, 0);
  std::vector<double> told;
  for (const Triple& rgb : read_by_example(folder, truth))
    told.push_back(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
  ASSERT_EQ(told.size(), truth.size());
  EXPECT_LT(errors_of(truth, told).back(), 0.02);
  const Json header = folder.json("m.json");
  EXPECT_EQ(header.at("schema"), "retrace.material/2");
  EXPECT_LT(header.at("error").at("of_95_percent"), 0.02);
}

/// Prisms reverse the component of the light direction across their roof edge and keep the component along it. The
/// table must be centred on the direction of this reflected light.
TEST(Material, PrismsAreToldWhereTheySendTheLight) {
  const TemporaryFolder folder;
  folder.write("d.toml",
               "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\narrangement = \"aligned\"\n"
               "extent = \"infinite\"\n[body]\nthickness_mm = 1\nrefractive_index = 1.4917\n");
  Arguments arguments = export_of("m.json");
  *std::find(arguments.begin(), arguments.end(), "64") = "300";
  *std::find(arguments.begin(), arguments.end(), "8") = "4";
  ASSERT_EQ(retrace(folder, arguments).code, 0);
  const Json header = folder.json("m.json");
  EXPECT_EQ(header.at("back"), Json::array({1.0, -1.0}));
  // If the light is inclined along the roof edge, almost none returns to the source, but the table contains all light
  // that the facets reflect.
  for (const Json& at : header.at("directions"))
    if (at.at("azimuth_deg") == 90.0 && at.at("entrance_deg") == 4.0) {
      EXPECT_GT(at.at("returned"), 0.85);
    }
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::vector<Reading> truth;
  std::string limits = "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\n";
  for (int k = 0; k < 20; ++k) {
    Reading at{0.1 + 0.1 * share(random), 0.1 * share(random), 3.9 * share(random), 0.0};
    std::ostringstream row;
    row.precision(15);
    row << "S,,white," << at.observation_deg << ',' << at.v_deg << ',' << at.h_deg << ",1,cd/lx/m2,read\n";
    limits += row.str();
    truth.push_back(at);
  }
  folder.write("limits.csv", limits);
  const Json json =
      retrace_json(folder, {"photometry", "d.toml", "--standard", "limits.csv", "--area-cm2", "10", "--light", "d65",
                            "--source-arcmin", "20", "--receiver-arcmin", "20", "--no-advice"});
  for (std::size_t k = 0; k < truth.size(); ++k)
    truth[k].r_a = json.at("points").at(k).at("r_a_cd_per_lx_m2").get<double>();
  std::vector<double> told;
  for (const Triple& rgb : read_by_example(folder, truth))
    told.push_back(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
  ASSERT_EQ(told.size(), truth.size());
  EXPECT_LT(errors_of(truth, told).back(), 0.02);
}

/// The bodies are coloured. Chromaticities are computed from red, green and blue with the primaries of sRGB (IEC
/// 61966-2-1), and compared with the colour of photometry. One body is so red that its colour is outside of sRGB. A
/// long run also tests a body with a colour inside of sRGB.
TEST(Material, ColoursAreThoseOfPhotometry) {
  std::vector<std::string> absorptions = {"[[380, 3], [560, 2.5], [600, 0.3], [640, 0.01], [780, 0]]"};
  if (is_long_run()) absorptions.emplace_back("[[380, 0.4], [480, 0.2], [560, 0.05], [780, 0.02]]");
  for (const std::string& absorption : absorptions) {
    const TemporaryFolder folder;
    std::string design = cubes("0.5");
    design.replace(design.find("refractive_index"), 0, "absorption_per_mm = " + absorption + "\n");
    folder.write("d.toml", design);
    ASSERT_EQ(retrace(folder, export_of("m.json")).code, 0);
    std::vector<Reading> at = {{0.1, 3.0, 1.0, 0.0}, {0.2, 0.5, -4.0, 20.0}, {0.3, -6.0, 2.0, 77.0}};
    const std::vector<Triple> told = read_by_example(folder, at);
    ASSERT_EQ(told.size(), at.size());
    for (std::size_t k = 0; k < at.size(); ++k) {
      std::ostringstream row;
      row.precision(15);
      row << "standard,class,colour,observation_deg,v_deg,h_deg,minimum,unit,status\nS,,white," << at[k].observation_deg
          << ',' << at[k].v_deg << ',' << at[k].h_deg << ",1,cd/lx/m2,read\n";
      folder.write("limits.csv", row.str());
      const Json json = retrace_json(folder, {"photometry", "d.toml", "--standard", "limits.csv", "--area-cm2", "10",
                                              "--light", "d65", "--rotation", std::to_string(at[k].turn_deg),
                                              "--source-arcmin", "20", "--receiver-arcmin", "20", "--no-advice"});
      const auto& [r, g, b] = told[k];
      const double x = 0.4124 * r + 0.3576 * g + 0.1805 * b;
      const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
      const double z = 0.0193 * r + 0.1192 * g + 0.9505 * b;
      EXPECT_NEAR(x / (x + y + z), json.at("chromaticity").at("x").get<double>(), 0.002) << k;
      EXPECT_NEAR(y / (x + y + z), json.at("chromaticity").at("y").get<double>(), 0.002) << k;
      const double r_a = json.at("points").at(0).at("r_a_cd_per_lx_m2").get<double>();
      EXPECT_NEAR(y, r_a, 0.02 * r_a) << k;
    }
  }
}

/// The reference compiler of Khronos must accept the shader, for desktops and for browsers.
TEST(Material, TheShaderCompiles) {
  const auto& [folder, truth, summary] = small_cubes();
  for (const char* version : {"#version 330\n", "#version 300 es\nprecision highp float;\n"}) {
    folder.write("m.frag", version + folder.read("m.glsl") +
                               "out vec4 colour;\nvoid main() {\n  colour = vec4(retrace_brdf(vec3(0.0, 0.0, 1.0), "
                               "normalize(gl_FragCoord.xyz)), 1.0);\n}\n");
    Child compiler(folder.path(), {"/usr/bin/env", "glslangValidator", "m.frag"}, "");
    const Outcome outcome = compiler.wait();
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  }
}

TEST(Material, LobesOfAShaderAreAsFarOffAsTheySay) {
  const auto& [folder, truth, summary] = small_cubes();
  const GlslFile shader(folder.read("m.glsl"));
  std::vector<double> told;
  for (const Reading& at : truth) {
    const Triple to_source = at_v(at, 0.0);
    const Triple to_observer = at_v(at, at.observation_deg);
    told.push_back(shader.brdf(to_source, to_observer) * to_source[2] * to_observer[2]);
  }
  const std::vector<double> errors = errors_of(truth, told);
  EXPECT_LT(errors[errors.size() * 95 / 100], 0.05);
  // The errors of the lobes in the file were measured at other random geometries. Those geometries extend to larger
  // angles than the readings.
  EXPECT_LT(errors[errors.size() / 2], 2.0 * summary.at("error_of_lobes").at("median").get<double>());
  EXPECT_GT(summary.at("error_of_lobes").at("max"), summary.at("error").at("max"));
}

TEST(Material, EveryFormatKeepsThePower) {
  const TemporaryFolder folder;
  folder.write("d.toml", cubes("20"));
  const Triple to_source = direction(2.0, 20.0);
  const double rre =
      retrace_json(folder, {"rre", "d.toml", "--incidence", "2", "--azimuth", "20", "--target-error", "1e-4"})
          .at("points")
          .at(0)
          .at("rre")
          .get<double>();
  ASSERT_GT(rre, 0.7);

  ASSERT_EQ(retrace(folder, export_of("m.json", "0.6", "0.1", "3")).code, 0);
  const Json header = folder.json("m.json");
  // Sum over the grid of the CSV file that belongs to the nearest tabulated direction of light.
  std::size_t nearest = 0;
  const auto distance = [&](std::size_t k) {
    const Json& at = header.at("directions").at(k);
    const Triple d = direction(at.at("entrance_deg"), at.at("azimuth_deg"));
    return std::hypot(d[0] - to_source[0], d[1] - to_source[1]);
  };
  for (std::size_t k = 0; k < header.at("directions").size(); ++k)
    if (distance(k) < distance(nearest)) nearest = k;
  const Json& at = header.at("directions").at(nearest);
  const Triple light = direction(at.at("entrance_deg"), at.at("azimuth_deg"));
  const double half = header.at("half_width");
  const double step = 2.0 * half / (header.at("columns").get<double>() - 1.0);
  std::istringstream rows(folder.read("m.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "direction,row,column,red,green,blue");
  double sum = 0.0;
  while (std::getline(rows, row)) {
    std::replace(row.begin(), row.end(), ',', ' ');
    std::istringstream values(row);
    double k = 0.0, j = 0.0, i = 0.0, red = 0.0, green = 0.0, blue = 0.0;
    values >> k >> j >> i >> red >> green >> blue;
    if (k != static_cast<double>(nearest)) continue;
    const double x = light[0] + i * step - half;
    const double y = light[1] + j * step - half;
    const double r_a = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    sum += r_a / (light[2] * std::sqrt(1.0 - x * x - y * y)) * step * step;
  }
  const std::string there = std::to_string(at.at("entrance_deg").get<double>());
  const double rre_there =
      retrace_json(folder, {"rre", "d.toml", "--incidence", there, "--azimuth",
                            std::to_string(at.at("azimuth_deg").get<double>()), "--target-error", "1e-4"})
          .at("points")
          .at(0)
          .at("rre")
          .get<double>();
  EXPECT_NEAR(sum, rre_there, 0.01 * rre_there) << there;
  EXPECT_NEAR(at.at("returned").get<double>(), sum, 0.005 * sum);

  ASSERT_EQ(retrace(folder, export_of("m.xml", "0.6", "0.1", "3")).code, 0);
  const RadianceFile bsdf(folder.read("m.xml"));
  EXPECT_NEAR(bsdf.reflected(to_source), rre, 0.01 * rre);
  // The light returns to the source and to no other direction.
  const double projected_sr = kPi * bsdf.min_leaf() * bsdf.min_leaf();
  double about = 0.0;
  for (int j = -4; j <= 4; ++j)
    for (int i = -4; i <= 4; ++i) {
      const double width = std::sqrt(projected_sr);
      Triple out = {to_source[0] + i * width / 4.0, to_source[1] + j * width / 4.0, 0.0};
      about = std::max(about, bsdf.brdf(to_source, out) * projected_sr);
    }
  EXPECT_GT(about, 0.2 * rre);
  EXPECT_EQ(bsdf.brdf(to_source, {-to_source[0], -to_source[1], to_source[2]}), 0.0);

  ASSERT_EQ(retrace(folder, export_of("m.glsl", "0.6", "0.1", "3")).code, 0);
  const GlslFile shader(folder.read("m.glsl"));
  double power = 0.0;
  constexpr int kPoints = 120;
  for (int j = -kPoints; j < kPoints; ++j)
    for (int i = -kPoints; i < kPoints; ++i) {
      const double fine = half / kPoints;
      const Triple out = {to_source[0] + (i + 0.5) * fine, to_source[1] + (j + 0.5) * fine, 0.0};
      power += shader.brdf(to_source, out) * fine * fine;
    }
  EXPECT_NEAR(power, rre, 0.01 * rre);
}

TEST(Material, WhatCannotBeIsRefusedAndNothingWritten) {
  const TemporaryFolder folder;
  folder.write("d.toml", cubes("0.5"));
  const auto refused = [&](Arguments more, const std::string& text) {
    more.insert(more.begin(), {"export", "d.toml"});
    EXPECT_EQ(refused_at(retrace(folder, more)), text);
  };
  refused({"m.json", "--entrance-deg", "50"}, "--entrance-deg");
  refused({"m.json", "--window-deg", "0"}, "--window-deg");
  refused({"m.json", "--error", "nan"}, "--error");
  refused({"m.json", "--max-directions", "3"}, "--max-directions");
  refused({"m.json", "--source-arcmin", "-1"}, "--source-arcmin");
  refused({"m.xml", "--what", "element"}, "--what");
  refused({"m.stl", "--error", "0.1"}, "--error");
  refused({"m.json", "--json", "m.csv"}, "--json");
  EXPECT_EQ(refused_at(retrace(folder, {"export", example("fronts/cats_eye_lenslets.toml"), "m.json"})),
            "examples/fronts/cats_eye_lenslets.toml:10: entrance_surface.turned_part");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"d.toml"});
}

}  // namespace
}  // namespace retrace::test::material_command_test

#include "studies/design/design_reader.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "geometry/lattice.h"
#include "studies/design/init_templates.h"

namespace retrace::studies {
namespace {

namespace fs = std::filesystem;
using geometry::AngleErrors;
using geometry::Arrangement;
using geometry::Extent;
using geometry::HexagonalCube;
using geometry::PartialElements;
using geometry::RowParity;
using geometry::RtpElement;
using geometry::TriangularCube;

/// The lines of a valid design, so that tests can speak of line numbers.
const std::vector<std::string> kLines = {
    "[element]",                 // 1
    "kind = \"rtp\"",            // 2
    "base_mm = 0.5",             // 3
    "width_mm = 0.5",            // 4
    "[array]",                   // 5
    "arrangement = \"offset\"",  // 6
    "x_length_mm = 10",          // 7
    "y_length_mm = 10",          // 8
    "[body]",                    // 9
    "thickness_mm = 2.0",        // 10
};

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The valid design with line `number` (from 1) replaced; number 11 appends.
std::string with_line(std::size_t number, const std::string& line) {
  std::vector<std::string> lines = kLines;
  lines.resize(std::max(lines.size(), number));
  lines[number - 1] = line;
  return joined(lines);
}

/// What reading `text` complains of; empty if it does not.
std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_design(text, "d.toml", overrides);
    return {};
  } catch (const InputError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::bad_input);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
}

/// What a valid design complains of when `key=value` is set.
std::string set_complaint(const std::vector<std::string>& overrides) {
  return complaint(joined(kLines), overrides);
}

Design set(const std::vector<std::string>& overrides) {
  return parse_design(joined(kLines), "d.toml", overrides);
}

/// A design of one element kind: `element` and `array` hold the lines of these tables, separated by "; ".
std::string design_of(std::string element, std::string array) {
  const auto in_lines = [](std::string text) {
    for (std::size_t at; (at = text.find("; ")) != std::string::npos;) text.replace(at, 2, 1, '\n');
    return text + "\n";
  };
  return "[element]\n" + in_lines(element) + "[array]\n" + in_lines(array) + "[body]\nthickness_mm = 1\n";
}

const std::string kHexagonal = "kind = \"hexagonal_icc\"; aperture_mm = 2";
const std::string kTriangular = "kind = \"triangular_icc\"; aperture_mm = 2";
const std::string kRtp = "kind = \"rtp\"; base_mm = 1; width_mm = 1";

TEST(DesignReader, MinimalDesignHasTheDefaults) {
  const Design design = parse_design(joined(kLines), "d.toml", {});
  const auto& rtp = std::get<RtpElement>(design.part.element);
  EXPECT_EQ(design.source, "d.toml");
  EXPECT_EQ(design.title, "");
  EXPECT_EQ(rtp.base_mm, 0.5);
  EXPECT_EQ(rtp.width_mm, 0.5);
  EXPECT_EQ(rtp.apex_angle_deg, 90.0);
  EXPECT_EQ(design.part.arrangement, Arrangement::offset);
  EXPECT_EQ(design.part.extent, Extent::finite);
  EXPECT_EQ(design.part.shifted_rows, RowParity::even);
  EXPECT_EQ(design.part.partial_elements, PartialElements::cut);
  EXPECT_EQ(design.part.x_length_mm, 10.0);
  EXPECT_EQ(design.part.y_length_mm, 10.0);
  EXPECT_EQ(design.part.x_gap_mm, 0.0);
  EXPECT_EQ(design.part.y_offset_mm, 0.0);
  EXPECT_EQ(design.part.overlap_percent, 50.0);
  EXPECT_EQ(design.part.angle_errors, AngleErrors{});
  EXPECT_EQ(design.part.thickness_mm, 2.0);
  EXPECT_EQ(design.material, "PMMA");
  EXPECT_FALSE(design.refractive_index);
  EXPECT_FALSE(design.absorption_per_mm);
  EXPECT_EQ(design.wavelength_nm, 587.56);
  EXPECT_EQ(design.polarisation.values(), raytrace::kUnpolarised.values());
  EXPECT_EQ(design.acceptance_half_angle_deg, std::vector<double>{0.5});
  EXPECT_FALSE(design.idealisation.mirror_facets);
  EXPECT_FALSE(design.idealisation.lossless_entrance);
}

TEST(DesignReader, ArrangementDefaultsToTheOneOfItsKind) {
  const std::string lengths = "x_length_mm = 10; y_length_mm = 10";
  EXPECT_EQ(parse_design(design_of(kRtp, lengths), "d", {}).part.arrangement, Arrangement::aligned);
  EXPECT_EQ(parse_design(design_of(kHexagonal, lengths), "d", {}).part.arrangement, Arrangement::honeycomb);
  EXPECT_EQ(parse_design(design_of(kTriangular, lengths), "d", {}).part.arrangement, Arrangement::triangular);
}

TEST(DesignReader, EveryServedKeyArrives) {
  const Design design = parse_design(R"(schema = "retrace.design/1"
title = "all"
[element]
kind = "rtp"
base_mm = 1
width_mm = 2
apex_angle_deg = 91.5
[array]
arrangement = "offset"
extent = "finite"
shifted_rows = "odd"
partial_elements = "omit"
x_length_mm = 20
y_length_mm = 30
x_gap_mm = 0.1
y_gap_mm = 0.2
x_offset_mm = 1
y_offset_mm = 2
overlap_percent = 25
[body]
thickness_mm = 3
material = "PC"
refractive_index = 1.58
absorption_per_mm = 0.001
back_index = 1
facet_coating = "none"
[light]
wavelength_nm = 633
polarisation = "linear"
polarisation_angle_deg = 30
[detector]
acceptance_half_angle_deg = [1, 0.2, 0.5, 0.2]
[surface]
model = "smooth"
roughness_sq_nm = 0
walls = "smooth"
dihedral_error_arcmin = -0.5
facet_tilt_arcmin = [1, 2.5]
[idealisation]
facets = "mirror"
entrance = "lossless"
)",
                                     "d.toml", {});
  EXPECT_EQ(design.title, "all");
  EXPECT_EQ(std::get<RtpElement>(design.part.element).apex_angle_deg, 91.5);
  EXPECT_EQ(design.part.shifted_rows, RowParity::odd);
  EXPECT_EQ(design.part.partial_elements, PartialElements::omit);
  EXPECT_EQ(design.part.y_length_mm, 30.0);
  EXPECT_EQ(design.part.x_gap_mm, 0.1);
  EXPECT_EQ(design.part.y_gap_mm, 0.2);
  EXPECT_EQ(design.part.x_offset_mm, 1.0);
  EXPECT_EQ(design.part.y_offset_mm, 2.0);
  EXPECT_EQ(design.part.overlap_percent, 25.0);
  EXPECT_EQ(design.material, "PC");
  EXPECT_EQ(design.material_location.line, 22);
  EXPECT_EQ(design.material_location.key, "body.material");
  EXPECT_EQ(design.refractive_index, 1.58);
  EXPECT_EQ(design.absorption_per_mm, 0.001);
  EXPECT_EQ(design.wavelength_nm, 633.0);
  EXPECT_NEAR(design.polarisation.q, 0.5, 1e-15);
  EXPECT_EQ(design.part.angle_errors, (AngleErrors{{-0.5, 0.0, 0.0}, {1.0, 2.5, 0.0}}));
  EXPECT_EQ(design.acceptance_half_angle_deg, (std::vector<double>{0.2, 0.5, 1.0}));
  EXPECT_TRUE(design.idealisation.mirror_facets);
  EXPECT_TRUE(design.idealisation.lossless_entrance);
}

TEST(DesignReader, NumbersOutOfRangeAreRefused) {
  EXPECT_EQ(complaint(with_line(3, "base_mm = -3")), "d.toml:3: element.base_mm: must be > 0, got -3");
  EXPECT_EQ(complaint(with_line(3, "base_mm = 0")), "d.toml:3: element.base_mm: must be > 0, got 0");
  EXPECT_EQ(complaint(with_line(3, "base_mm = 0.0")), "d.toml:3: element.base_mm: must be > 0, got 0");
  EXPECT_EQ(complaint(with_line(3, "base_mm = inf")), "d.toml:3: element.base_mm: must be a finite number, got inf");
  EXPECT_EQ(complaint(with_line(3, "base_mm = nan")), "d.toml:3: element.base_mm: must be a finite number, got nan");
  EXPECT_EQ(complaint(with_line(3, "base_mm = 1e7")),
            "d.toml:3: element.base_mm: must be >= 1e-06 and <= 1e+06, got 1e+07");
  EXPECT_EQ(complaint(with_line(3, "base_mm = 1e-7")),
            "d.toml:3: element.base_mm: must be >= 1e-06 and <= 1e+06, got 1e-07");
  EXPECT_EQ(complaint(with_line(7, "x_length_mm = -inf")),
            "d.toml:7: array.x_length_mm: must be a finite number, got -inf");
  EXPECT_EQ(complaint(with_line(10, "thickness_mm = 0")), "d.toml:10: body.thickness_mm: must be > 0, got 0");
  EXPECT_EQ(complaint(with_line(11, "refractive_index = 0.9")),
            "d.toml:11: body.refractive_index: must be >= 1, got 0.9");
  EXPECT_EQ(complaint(with_line(11, "absorption_per_mm = -1")),
            "d.toml:11: body.absorption_per_mm: must be >= 0, got -1");
  EXPECT_EQ(complaint(with_line(11, "light.wavelength_nm = 0")),
            "d.toml:11: body.light: unknown key (allowed: thickness_mm, material, refractive_index, "
            "absorption_per_mm, back_index, facet_coating)");
  EXPECT_EQ(complaint(with_line(11, "[light]\nwavelength_nm = 0")),
            "d.toml:12: light.wavelength_nm: must be > 0, got 0");
}

TEST(DesignReader, WholeNumbersOfAnySizeAreNumbers) {
  EXPECT_EQ(complaint(with_line(3, "base_mm = 9223372036854775807")),
            "d.toml:3: element.base_mm: must be >= 1e-06 and <= 1e+06, got 9223372036854775807");
}

TEST(DesignReader, ApexAngleIsFrom60To120) {
  const std::string range = "must be >= 60 and <= 120, got ";
  EXPECT_EQ(complaint(with_line(4, "width_mm = 0.5\napex_angle_deg = 59.9")),
            "d.toml:5: element.apex_angle_deg: " + range + "59.9");
  EXPECT_EQ(complaint(with_line(4, "width_mm = 0.5\napex_angle_deg = 121")),
            "d.toml:5: element.apex_angle_deg: " + range + "121");
  EXPECT_EQ(std::get<RtpElement>(set({"element.apex_angle_deg=60"}).part.element).apex_angle_deg, 60.0);
  EXPECT_EQ(std::get<RtpElement>(set({"element.apex_angle_deg=120"}).part.element).apex_angle_deg, 120.0);
}

TEST(DesignReader, AcceptanceIsANumberOrAListWithin90Degrees) {
  const auto refused = [](const std::string& value) {
    return complaint(with_line(11, "[detector]\nacceptance_half_angle_deg = " + value));
  };
  const std::string where = "d.toml:12: detector.acceptance_half_angle_deg: ";
  EXPECT_EQ(refused("0"), where + "must be > 0 and <= 90, got 0");
  EXPECT_EQ(refused("90.5"), where + "must be > 0 and <= 90, got 90.5");
  EXPECT_EQ(refused("[0.5, -1]"), where + "must be > 0 and <= 90, got -1");
  EXPECT_EQ(refused("[0.5,\n\"x\"]"), "d.toml:13: detector.acceptance_half_angle_deg: must be a number, got \"x\"");
  EXPECT_EQ(refused("[]"), where + "must be a number or a list of at least one number, got an empty list");
  EXPECT_EQ(refused("\"a\""), where + "must be a number or a list of numbers, got \"a\"");
  EXPECT_EQ(refused("90"), "");
}

TEST(DesignReader, PolarisationIsAWordOrStokesParameters) {
  const auto stokes = [](const std::vector<std::string>& overrides) { return set(overrides).polarisation.values(); };
  using Values = std::array<double, 4>;
  EXPECT_EQ(stokes({"light.polarisation=unpolarised"}), (Values{1, 0, 0, 0}));
  EXPECT_EQ(stokes({"light.polarisation=linear"}), (Values{1, 1, 0, 0}));
  EXPECT_EQ(stokes({"light.polarisation=right_circular"}), (Values{1, 0, 0, 1}));
  EXPECT_EQ(stokes({"light.polarisation=left_circular"}), (Values{1, 0, 0, -1}));
  EXPECT_EQ(stokes({"light.polarisation=[1, 0, 0, 0]"}), (Values{1, 0, 0, 0}));
  EXPECT_EQ(stokes({"light.polarisation=[2, 1, -0.5, 0.25]"}), (Values{1, 0.5, -0.25, 0.125}));
  EXPECT_EQ(stokes({"light.polarisation=[1, 0.6, 0.8, 0]"}), (Values{1, 0.6, 0.8, 0}));
  const auto expect_linear = [&](const std::string& angle, double q, double u) {
    const Values values = stokes({"light.polarisation=linear", "light.polarisation_angle_deg=" + angle});
    EXPECT_EQ(values[0], 1.0);
    EXPECT_NEAR(values[1], q, 1e-15);
    EXPECT_NEAR(values[2], u, 1e-15);
    EXPECT_EQ(values[3], 0.0);
  };
  expect_linear("45", 0.0, 1.0);
  expect_linear("90", -1.0, 0.0);
  expect_linear("-30", 0.5, -0.5 * std::sqrt(3.0));
  expect_linear("360", 1.0, 0.0);
}

TEST(DesignReader, WhatIsNoPolarisationIsRefused) {
  const auto refused = [](const std::string& value) {
    return complaint(with_line(11, "[light]\npolarisation = " + value));
  };
  const std::string where = "d.toml:12: light.polarisation: ";
  const std::string words =
      "must be one of \"unpolarised\", \"linear\", \"right_circular\" or \"left_circular\" or a list of four Stokes "
      "parameters, got ";
  EXPECT_EQ(refused("\"liner\""), where + words + "\"liner\"; did you mean \"linear\"?");
  EXPECT_EQ(refused("1"), where + "must be a string or a list of four Stokes parameters, got 1");
  EXPECT_EQ(refused("[1, 0, 0]"), where + "must be a list of four Stokes parameters, got a list of 3");
  EXPECT_EQ(refused("[]"), where + "must be a list of four Stokes parameters, got a list of 0");
  EXPECT_EQ(refused("[1, 0, 0, \"x\"]"), where + "must be a number, got \"x\"");
  EXPECT_EQ(refused("[1, 0, 0, inf]"), where + "must be a finite number, got inf");
  const std::string stokes = where + "must be [i, q, u, v] with i > 0 and q^2 + u^2 + v^2 <= i^2, got ";
  EXPECT_EQ(refused("[0, 0, 0, 0]"), stokes + "[0, 0, 0, 0]");
  EXPECT_EQ(refused("[-1, 0, 0, 1]"), stokes + "[-1, 0, 0, 1]");
  EXPECT_EQ(refused("[1, 0.8, 0, 0.7]"), stokes + "[1, 0.8, 0, 0.7]");
  EXPECT_EQ(refused("\"linear\"\npolarisation_angle_deg = 361"),
            "d.toml:13: light.polarisation_angle_deg: must be >= -360 and <= 360, got 361");
  const std::string alone =
      "--set light.polarisation_angle_deg=0: light.polarisation_angle_deg: only allowed for polarisation = \"linear\", "
      "got 0";
  EXPECT_EQ(set_complaint({"light.polarisation_angle_deg=0"}), alone);
  EXPECT_EQ(set_complaint({"light.polarisation=left_circular", "light.polarisation_angle_deg=0"}), alone);
  EXPECT_EQ(set_complaint({"light.polarisation=[1, 1, 0, 0]", "light.polarisation_angle_deg=0"}), alone);
}

TEST(DesignReader, WrongTypesAreRefused) {
  EXPECT_EQ(complaint(with_line(3, "base_mm = \"0.5\"")), "d.toml:3: element.base_mm: must be a number, got \"0.5\"");
  EXPECT_EQ(complaint(with_line(3, "base_mm = true")), "d.toml:3: element.base_mm: must be a number, got true");
  EXPECT_EQ(complaint(with_line(3, "base_mm = [1]")), "d.toml:3: element.base_mm: must be a number, got a list");
  EXPECT_EQ(complaint(with_line(3, "base_mm = {a = 1}")), "d.toml:3: element.base_mm: must be a number, got a table");
  EXPECT_EQ(complaint(with_line(3, "base_mm = 2020-01-01")),
            "d.toml:3: element.base_mm: must be a number, got a date or time");
  EXPECT_EQ(complaint(with_line(2, "kind = 5")), "d.toml:2: element.kind: must be a string, got 5");
  EXPECT_EQ(complaint("title = 1\n" + joined(kLines)), "d.toml:1: title: must be a string, got 1");
  EXPECT_EQ(complaint("element = 3\n"), "d.toml:1: element: must be a table, got 3");
  EXPECT_EQ(complaint("[[element]]\nkind = \"rtp\"\n"), "d.toml:1: element: must be a table, got a list");
}

TEST(DesignReader, UnknownKeysAreNamedWithASuggestion) {
  EXPECT_EQ(
      complaint(with_line(3, "bse_mm = 0.5")),
      "d.toml:3: element.bse_mm: unknown key, did you mean \"base_mm\"? (allowed: kind, base_mm, width_mm, "
      "apex_angle_deg, aperture_mm, cant_deg, cant_azimuth_deg, diameter_mm, mirror_offset_mm, mirror_half_angle_deg)");
  EXPECT_EQ(complaint(with_line(10, "thickness = 2")),
            "d.toml:10: body.thickness: unknown key, did you mean \"thickness_mm\"? (allowed: thickness_mm, material, "
            "refractive_index, absorption_per_mm, back_index, facet_coating)");
  EXPECT_EQ(complaint(with_line(11, "colour = \"red\"")),
            "d.toml:11: body.colour: unknown key (allowed: thickness_mm, material, refractive_index, "
            "absorption_per_mm, back_index, facet_coating)");
  EXPECT_EQ(complaint(with_line(11, "[boddy]\nx = 1")),
            "d.toml:11: boddy: unknown table, did you mean \"body\"? (allowed: element, array, body, light, detector, "
            "surface, base, part, front, idealisation)");
  EXPECT_EQ(complaint("titel = \"x\"\n" + joined(kLines)),
            "d.toml:1: titel: unknown key, did you mean \"title\"? (allowed: schema, title, element, array, body, "
            "light, detector, surface, base, part, front, idealisation)");
  EXPECT_EQ(complaint("thickness_mm = 2\n" + joined(kLines)),
            "d.toml:1: thickness_mm: unknown key at the top level, it belongs in [body]");
}

TEST(DesignReader, TheFirstUnknownKeyOfTheFileIsReported) {
  const std::string text = "[light]\nzz = 1\naa = 2\n[array]\nbb = 3\n";
  EXPECT_EQ(complaint(text).substr(0, 21), "d.toml:2: light.zz: u");
  EXPECT_EQ(complaint(text, {"array.aa=1"}).substr(0, 21), "d.toml:2: light.zz: u");
}

TEST(DesignReader, MissingKeysAreReportedAtTheirTable) {
  EXPECT_EQ(complaint(with_line(3, "")), "d.toml:1: element.base_mm: missing, must be > 0");
  EXPECT_EQ(
      complaint(with_line(2, "")),
      "d.toml:1: element.kind: missing, must be one of \"rtp\", \"hexagonal_icc\", \"triangular_icc\" or \"ball\"");
  EXPECT_EQ(complaint(with_line(8, "")), "d.toml:5: array.y_length_mm: missing, must be > 0");
  EXPECT_EQ(complaint(with_line(10, "")), "d.toml:9: body.thickness_mm: missing, must be > 0");
  EXPECT_EQ(complaint("[element]\nkind = \"hexagonal_icc\"\n"), "d.toml:1: element.aperture_mm: missing, must be > 0");
  EXPECT_EQ(complaint(""),
            "d.toml: element.kind: missing, must be one of \"rtp\", \"hexagonal_icc\", \"triangular_icc\" or \"ball\"");
  EXPECT_EQ(complaint("", {"element.kind=rtp"}), "d.toml: element.base_mm: missing, must be > 0");
}

TEST(DesignReader, WordsAreCheckedWithASuggestion) {
  EXPECT_EQ(
      complaint(with_line(2, "kind = \"rpt\"")),
      "d.toml:2: element.kind: must be one of \"rtp\", \"hexagonal_icc\", \"triangular_icc\" or \"ball\", got \"rpt\"; "
      "did you mean \"rtp\"?");
  EXPECT_EQ(complaint(with_line(2, "kind = \"hexagonal\"")),
            "d.toml:2: element.kind: must be one of \"rtp\", \"hexagonal_icc\", \"triangular_icc\" or \"ball\", got "
            "\"hexagonal\"");
  EXPECT_EQ(complaint(with_line(6, "arrangement = \"ofset\"")),
            "d.toml:6: array.arrangement: must be one of \"aligned\", \"offset\", \"checker\" or \"single\", got "
            "\"ofset\"; did you mean \"offset\"?");
  EXPECT_EQ(set_complaint({"array.shifted_rows=uneven"}),
            "--set array.shifted_rows=uneven: array.shifted_rows: must be one of \"even\" or \"odd\", got \"uneven\"; "
            "did you mean \"even\"?");
  EXPECT_EQ(set_complaint({"idealisation.facets=miror"}),
            "--set idealisation.facets=miror: idealisation.facets: must be one of \"real\" or \"mirror\", got "
            "\"miror\"; did you mean \"mirror\"?");
  EXPECT_EQ(complaint("schema = \"retrace.design/2\"\nnew_key = 1\n"),
            "d.toml:1: schema: must be \"retrace.design/1\", got \"retrace.design/2\"");
  EXPECT_EQ(complaint(with_line(11, "material = \"\"")),
            "d.toml:11: body.material: must name a material, such as \"PMMA\", got \"\"");
}

TEST(DesignReader, ArrangementMustFitTheKind) {
  EXPECT_EQ(complaint(with_line(6, "arrangement = \"honeycomb\"")),
            "d.toml:6: array.arrangement: must be \"aligned\", \"offset\", \"checker\" or \"single\" for kind = "
            "\"rtp\", got \"honeycomb\"");
  EXPECT_EQ(
      complaint(design_of(kHexagonal, "arrangement = \"triangular\"")),
      "d.toml:5: array.arrangement: must be \"honeycomb\", \"pins\" or \"single\" for kind = \"hexagonal_icc\", got "
      "\"triangular\"");
  EXPECT_EQ(complaint(design_of(kTriangular, "arrangement = \"offset\"")),
            "d.toml:5: array.arrangement: must be \"triangular\" or \"single\" for kind = \"triangular_icc\", got "
            "\"offset\"");
}

TEST(DesignReader, KeysOfAnotherKindAreRefused) {
  EXPECT_EQ(set_complaint({"element.aperture_mm=1"}),
            "--set element.aperture_mm=1: element.aperture_mm: not allowed for kind = \"rtp\", which has base_mm and "
            "width_mm, got 1");
  EXPECT_EQ(complaint(design_of(kHexagonal + "; base_mm = 1", "")),
            "d.toml:4: element.base_mm: only allowed for kind = \"rtp\", others have aperture_mm, got 1");
}

TEST(DesignReader, SingleAndInfiniteTakeNoLengths) {
  const std::string single = "not allowed for arrangement = \"single\", whose extent is the element's aperture, got ";
  const std::string infinite = "not allowed for extent = \"infinite\", which is one periodic cell, got ";
  EXPECT_EQ(complaint(design_of(kRtp, "arrangement = \"single\"; x_length_mm = 1")),
            "d.toml:7: array.x_length_mm: " + single + "1");
  EXPECT_EQ(complaint(design_of(kRtp, "arrangement = \"single\"; y_offset_mm = 1")),
            "d.toml:7: array.y_offset_mm: " + single + "1");
  EXPECT_EQ(complaint(design_of(kRtp, "extent = \"infinite\"; y_length_mm = 3")),
            "d.toml:7: array.y_length_mm: " + infinite + "3");
  EXPECT_EQ(complaint(design_of(kRtp, "extent = \"infinite\"; x_offset_mm = 3")),
            "d.toml:7: array.x_offset_mm: " + infinite + "3");
  EXPECT_EQ(complaint(design_of(kRtp, "arrangement = \"single\"; extent = \"infinite\"")),
            "d.toml:7: array.extent: must be \"finite\" for arrangement = \"single\", got \"infinite\"");
  EXPECT_EQ(complaint(design_of(kRtp, "arrangement = \"single\"; x_offset_mm = 0; x_gap_mm = 0.0")), "");
}

TEST(DesignReader, GapsRowsAndOverlapOnlyWhereTheyMeanSomething) {
  EXPECT_EQ(complaint(design_of(kHexagonal, "extent = \"infinite\"; x_gap_mm = 0.1")),
            "d.toml:6: array.x_gap_mm: only allowed for kind = \"rtp\", got 0.1");
  EXPECT_EQ(complaint(design_of(kRtp, "arrangement = \"single\"; y_gap_mm = 0.1")),
            "d.toml:7: array.y_gap_mm: not allowed for arrangement = \"single\", got 0.1");
  EXPECT_EQ(complaint(design_of(kRtp, "extent = \"infinite\"; shifted_rows = \"odd\"")),
            "d.toml:7: array.shifted_rows: only allowed for arrangement = \"offset\", got \"odd\"");
  EXPECT_EQ(complaint(design_of(kRtp, "extent = \"infinite\"; overlap_percent = 50")),
            "d.toml:7: array.overlap_percent: only allowed for arrangement = \"offset\", got 50");
  EXPECT_EQ(complaint(design_of(kRtp, "extent = \"infinite\"; x_gap_mm = 0.1")), "");
  EXPECT_EQ(set_complaint({"array.x_gap_mm=-0.1"}),
            "--set array.x_gap_mm=-0.1: array.x_gap_mm: must be >= 0 and <= 1e+06, got -0.1");
  EXPECT_EQ(set_complaint({"array.y_offset_mm=-0.1"}),
            "--set array.y_offset_mm=-0.1: array.y_offset_mm: must be >= 0 and <= 1e+06, got -0.1");
  EXPECT_EQ(set_complaint({"array.overlap_percent=100"}),
            "--set array.overlap_percent=100: array.overlap_percent: must be >= 0 and < 100, got 100");
  EXPECT_EQ(set({"array.overlap_percent=0"}).part.overlap_percent, 0.0);
}

TEST(DesignReader, CheckerNeedsSquareCells) {
  const std::string lengths = "x_length_mm = 10; y_length_mm = 10; arrangement = \"checker\"";
  EXPECT_EQ(complaint(design_of("kind = \"rtp\"; base_mm = 0.5; width_mm = 0.4", lengths)),
            "d.toml:4: element.width_mm: must equal base_mm (0.5) for arrangement = \"checker\", got 0.4");
  EXPECT_EQ(complaint(design_of("kind = \"rtp\"; base_mm = 0.5; width_mm = 0.5000000001", lengths)), "");
}

TEST(DesignReader, ArrayMustHoldOneElement) {
  EXPECT_EQ(complaint(with_line(7, "x_length_mm = 0.3")),
            "d.toml:7: array.x_length_mm: must be >= 0.5 to hold one element of 0.5 mm, got 0.3");
  EXPECT_EQ(set_complaint({"array.y_offset_mm=4.9"}),
            "d.toml:8: array.y_length_mm: must be >= 10.3 to hold one element of 0.5 mm and two margins of 4.9 mm, got "
            "10");
  EXPECT_EQ(complaint(design_of(kRtp, "x_length_mm = 0.9999999999; y_length_mm = 1")), "");
  // A hexagon or triangle of radius 1 with its apex at the centre of the extent: 2 by sqrt(3).
  for (const std::string& cube : {kHexagonal, kTriangular}) {
    EXPECT_EQ(complaint(design_of(cube, "x_length_mm = 2; y_length_mm = 1.7320508075688772")), "");
    EXPECT_EQ(
        complaint(design_of(cube, "x_length_mm = 2; y_length_mm = 1.73")),
        "d.toml:6: array.y_length_mm: must be >= 1.7320508075688772 to hold one element of 1.7320508075688772 mm, "
        "got 1.73");
    EXPECT_EQ(complaint(design_of(cube, "x_length_mm = 1.9; y_length_mm = 5")),
              "d.toml:5: array.x_length_mm: must be >= 2 to hold one element of 2 mm, got 1.9");
  }
}

TEST(DesignReader, ArrayHasAtMost1e8Elements) {
  EXPECT_EQ(
      set_complaint({"array.x_length_mm=1e6", "array.y_length_mm=1e6"}),
      "--set array.x_length_mm=1e6: array.x_length_mm: the array would have 4e+12 elements, at most 100000000 are "
      "allowed; make it smaller or its elements larger");
  EXPECT_EQ(set_complaint({"array.x_length_mm=5000", "array.y_length_mm=5000"}), "");
}

TEST(DesignReader, HeightMapIsFoundFromTheDesignsFolder) {
  const std::string text = with_line(11, "[surface]\nheight_map = \"maps/m.gsf\"");
  const FacetTexture texture = parse_design(text, "parts/d.toml").texture;
  EXPECT_EQ(texture.model, FacetTexture::Model::height_map);
  EXPECT_EQ(texture.height_map, "maps/m.gsf");
  EXPECT_EQ(texture.height_map_file, fs::path("parts/maps/m.gsf"));
  EXPECT_EQ(texture.height_map_level_axis, HeightMapAxis::x);
  EXPECT_EQ(texture.height_map_form_degree, 1);
  EXPECT_EQ(parse_design(text, "standard input").texture.height_map_file, fs::path("maps/m.gsf"));
  const std::vector<std::string> overrides = {"surface.height_map=m.txt", "surface.height_map_level_axis=y",
                                              "surface.height_map_form=poly3"};
  const FacetTexture other = parse_design(text, "parts/d.toml", overrides).texture;
  EXPECT_EQ(other.height_map_file, fs::path("m.txt")) << "as typed, from the working directory";
  EXPECT_EQ(other.height_map_level_axis, HeightMapAxis::y);
  EXPECT_EQ(other.height_map_form_degree, 3);
}

TEST(DesignReader, HeightMapKeysAreChecked) {
  const auto said = [](const std::string& lines) { return complaint(with_line(11, "[surface]\n" + lines)); };
  EXPECT_EQ(said("model = \"height_map\""),
            "d.toml:11: surface.height_map: missing, must name the file of a measured map");
  EXPECT_EQ(said("height_map = \"\""), "d.toml:12: surface.height_map: must name a file, got \"\"");
  EXPECT_EQ(said("height_map = 3"), "d.toml:12: surface.height_map: must be a string, got 3");
  EXPECT_EQ(said("model = \"smooth\"\nheight_map = \"m.txt\""),
            "d.toml:13: surface.height_map: only allowed for model = \"height_map\", got \"m.txt\"");
  EXPECT_EQ(said("height_map_form = \"poly2\""),
            "d.toml:12: surface.height_map_form: only allowed for model = \"height_map\", got \"poly2\"");
  EXPECT_EQ(said("model = \"height_map\"\nheight_map = \"m.txt\"\nwaviness_sq_nm = 5\nwaviness_length_um = 9"),
            "d.toml:14: surface.waviness_sq_nm: must be 0 for model = \"height_map\", whose map holds both, got 5");
  EXPECT_TRUE(said("height_map = \"m.txt\"\nheight_map_level_axis = \"z\"")
                  .starts_with("d.toml:13: surface.height_map_level_axis: must be one of \"x\" or \"y\", got \"z\""));
  EXPECT_TRUE(said("height_map = \"m.txt\"\nheight_map_form = \"none\"")
                  .starts_with("d.toml:13: surface.height_map_form: must be one of \"plane\""));
}

TEST(DesignReader, WhatThisVersionCannotDoIsRefusedPlainly) {
  const std::string no = ": not available in this version";
  const auto refused = [](const std::string& set) { return set_complaint({set}); };
  EXPECT_EQ(refused("array.mask_threshold=0.7"),
            "--set array.mask_threshold=0.7: array.mask_threshold: only allowed with mask, got 0.7");
  EXPECT_EQ(refused("body.back_index=0.9"),
            "--set body.back_index=0.9: body.back_index: must be >= 1 and <= 3, got 0.9");
  EXPECT_EQ(refused("body.back_index=1.33"), "");
  EXPECT_EQ(refused("body.facet_coating=aluminium"), "");
  EXPECT_EQ(
      refused("body.facet_coating=silver"),
      "--set body.facet_coating=silver: body.facet_coating: must be one of \"none\" or \"aluminium\", got \"silver\"");
  EXPECT_EQ(complaint(with_line(11, "[part]\nmesh = \"a.stl\"")),
            "d.toml:1: element: not allowed beside part.mesh, which is the whole part");
  EXPECT_EQ(refused("surface.roughness_sq_nm=rough"),
            "--set surface.roughness_sq_nm=rough: surface.roughness_sq_nm: must be a number, got \"rough\"");
}

TEST(DesignReader, PlanesOfSingleFacetsAreAFile) {
  const std::string text =
      "[element]\nkind = \"rtp\"\nbase_mm = 0.5\nwidth_mm = 0.5\n[array]\nx_length_mm = 1\ny_length_mm = 1\n"
      "[body]\nthickness_mm = 1\n[part]\nfacets = \"planes.csv\"\n";
  const Design design = parse_design(text, "folder/d.toml");
  ASSERT_TRUE(design.facet_planes);
  EXPECT_EQ(design.facet_planes->name, "planes.csv");
  EXPECT_EQ(design.facet_planes->file, std::filesystem::path("folder/planes.csv"));
  const auto refused = [&](const std::vector<std::string>& sets) {
    try {
      parse_design(text, "d.toml", sets);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused({"surface.facet_tilt_arcmin=[1,1]"}),
            "d.toml:11: part.facets: not allowed together with errors of angle, which its planes hold");
  EXPECT_NE(refused({"surface.angle_error_sigma_arcmin=1"}), "accepted");
  EXPECT_NE(refused({"part.facets=3"}), "accepted");
  EXPECT_NE(refused({"part.facet=a.csv"}), "accepted");
}

TEST(DesignReader, SpectrumIsANameAFileOrLines) {
  using Kind = LightSpectrum::Kind;
  EXPECT_FALSE(set({}).spectrum);
  const auto spectrum = [](const std::string& value) { return *set({"light.spectrum=" + value}).spectrum; };
  EXPECT_EQ(spectrum("A").kind, Kind::illuminant_a);
  EXPECT_EQ(spectrum("D65").kind, Kind::illuminant_d65);
  EXPECT_TRUE(spectrum("A").photopic);
  EXPECT_FALSE(set({"light.spectrum=A", "light.weighting=radiant"}).spectrum->photopic);
  EXPECT_TRUE(set({"light.spectrum=A", "light.weighting=photopic"}).spectrum->photopic);
  const LightSpectrum file = spectrum("\"lamps/led.csv\"");
  EXPECT_EQ(file.kind, Kind::file);
  EXPECT_EQ(file.name, "lamps/led.csv");
  EXPECT_EQ(file.file, "lamps/led.csv") << "of an override: from the working directory";
  EXPECT_EQ(parse_design(joined(kLines) + "[light]\nspectrum = \"led.csv\"\n", "a/d.toml", {}).spectrum->file,
            "a/led.csv");
  const LightSpectrum lines = spectrum("[[589.6, 1], [589.0, 2]]");
  EXPECT_EQ(lines.kind, Kind::lines);
  ASSERT_EQ(lines.lines.size(), 2U);
  EXPECT_EQ(lines.lines[0].wavelength_nm, 589.0) << "ascending";
  EXPECT_EQ(lines.lines[0].power, 2.0);
  EXPECT_EQ(lines.lines[1].wavelength_nm, 589.6);
  EXPECT_EQ(parse_design(joined(kLines) + "[light]\nspectrum = \"A\"\n", "d.toml", {}).spectrum->location.line, 12);
}

TEST(DesignReader, AbsorptionIsANumberOrPairsOverTheWavelength) {
  const std::string key = "body.absorption_per_mm";
  const Design red = set({key + "=[[400, 2], [600, 0.5], [800, 0]]"});
  EXPECT_FALSE(red.absorption_per_mm);
  ASSERT_EQ(red.absorption_by_wavelength.size(), 3U);
  EXPECT_EQ(red.absorption_by_wavelength[1].wavelength_nm, 600.0);
  EXPECT_EQ(red.absorption_by_wavelength[1].per_mm, 0.5);
  EXPECT_TRUE(set({key + "=0.1"}).absorption_by_wavelength.empty());
  const auto refused = [&](const std::string& value) {
    return complaint(with_line(11, "absorption_per_mm = " + value));
  };
  const std::string where = "d.toml:11: " + key + ": ";
  EXPECT_EQ(refused("[[400, 1], [400, 2]]"), where + "wavelengths must ascend, got 400 after 400");
  EXPECT_EQ(refused("[[500, 1], [400, 2]]"), where + "wavelengths must ascend, got 400 after 500");
  EXPECT_EQ(refused("[[500, 1]]"), where + "must be a number or a list of two or more pairs, got a list of one");
  EXPECT_EQ(refused("[[500, -1], [600, 1]]"), where + "must be >= 0, got -1");
  EXPECT_EQ(refused("[500, 600]"), where + "must be a list of [wavelength_nm, absorption_per_mm], got 500 in it");
  EXPECT_EQ(refused("[]"), where + "must be a list of [wavelength_nm, absorption_per_mm], got an empty list");
  EXPECT_EQ(refused("\"much\""), where + "must be a number, got \"much\"");
}

TEST(DesignReader, WhatIsNoSpectrumIsRefused) {
  const auto refused = [](const std::string& value) {
    return complaint(with_line(11, "[light]\nspectrum = " + value));
  };
  const std::string where = "d.toml:12: light.spectrum: ";
  const std::string allowed =
      where + "must be \"A\", \"D65\", a file that ends in .csv or a list of [wavelength_nm, power], got ";
  EXPECT_EQ(refused("\"F11\""), allowed + "\"F11\"");
  EXPECT_EQ(refused("\"a\""), allowed + "\"a\"");
  EXPECT_EQ(refused("\"\""), allowed + "\"\"");
  EXPECT_EQ(refused("\"a\\u0000.csv\""), allowed + "\"a\\x00.csv\"");
  EXPECT_EQ(refused("555"), allowed + "555");
  EXPECT_EQ(refused("{ a = 1 }"), allowed + "a table");
  const std::string list = where + "must be a list of [wavelength_nm, power], got ";
  EXPECT_EQ(refused("[]"), list + "an empty list");
  EXPECT_EQ(refused("[555, 1]"), list + "555 in it");
  EXPECT_EQ(refused("[[555]]"), list + "a list of 1 in it");
  EXPECT_EQ(refused("[[555, 1, 2]]"), list + "a list of 3 in it");
  EXPECT_EQ(refused("[[555, \"x\"]]"), where + "must be a number, got \"x\"");
  EXPECT_EQ(refused("[[555, 1], [0, 1]]"), where + "must be > 0, got 0");
  EXPECT_EQ(refused("[[555, -1]]"), where + "must be >= 0, got -1");
  EXPECT_EQ(refused("[[555, nan]]"), where + "must be a finite number, got nan");
  EXPECT_EQ(refused("[[555, 1], [555.0, 2]]"), where + "must name each wavelength once, got 555 twice");
  EXPECT_EQ(
      refused("\"A\"\nwavelength_nm = 555"),
      "d.toml:13: light.wavelength_nm: not allowed together with spectrum: one of the two says what the light is, "
      "got 555");
  EXPECT_EQ(refused("\"A\"\nweighting = \"eye\""),
            "d.toml:13: light.weighting: must be one of \"photopic\" or \"radiant\", got \"eye\"");
  EXPECT_EQ(set_complaint({"light.weighting=photopic"}),
            "--set light.weighting=photopic: light.weighting: only allowed together with spectrum, got \"photopic\"");
}

TEST(DesignReader, CantIsReadForCubeCornersAlone) {
  const auto read = [](const std::string& element, const std::vector<std::string>& overrides) {
    return parse_design(design_of(element, "extent = \"infinite\""), "d", overrides).part;
  };
  const auto refused = [&](const std::string& element, const std::vector<std::string>& overrides) -> std::string {
    try {
      read(element, overrides);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const std::string& cube : {kHexagonal, kTriangular}) {
    const std::string azimuth = "element.cant_azimuth_deg=-90";
    const geometry::Cant cant =
        geometry::cant_of(read(cube, {"element.cant_deg=7.5", azimuth, "body.thickness_mm=9"}).element);
    EXPECT_EQ(cant.deg, 7.5);
    EXPECT_EQ(cant.azimuth_deg, -90.0);
    EXPECT_EQ(geometry::cant_of(read(cube, {}).element).deg, 0.0);
    EXPECT_EQ(refused(cube, {"element.cant_deg=31"}),
              "--set element.cant_deg=31: element.cant_deg: must be >= 0 and <= 30, got 31");
    EXPECT_EQ(refused(cube, {"element.cant_azimuth_deg=361"}),
              "--set element.cant_azimuth_deg=361: element.cant_azimuth_deg: must be >= -360 and <= 360, got 361");
    EXPECT_EQ(refused(cube, {"element.cant_deg=30", "surface.facet_tilt_arcmin=[0, -300, 0]"}),
              "--set surface.facet_tilt_arcmin=[0, -300, 0]: surface.facet_tilt_arcmin: the steepest facet of the "
              "canted cube with its errors must be <= 88 degrees, got 89.74");
    EXPECT_NE(
        refused(cube, {"element.cant_deg=20", "body.thickness_mm=1e-3"}).find("rims that errors of angle or cant"),
        std::string::npos);
  }
  for (const std::string key : {"element.cant_deg", "element.cant_azimuth_deg"}) {
    EXPECT_EQ(refused(kRtp, {key + "=2"}), "--set " + key + "=2: " + key + ": only allowed for cube corners, got 2");
    EXPECT_EQ(refused(kRtp, {key + "=0"}), "");
  }
}

TEST(DesignReader, AngleErrorsAreReadForEveryKind) {
  const auto errors = [](const std::string& element, const std::vector<std::string>& overrides) {
    return parse_design(design_of(element, "extent = \"infinite\""), "d", overrides).part.angle_errors;
  };
  EXPECT_EQ(errors(kRtp, {"surface.dihedral_error_arcmin=2"}), (AngleErrors{{2.0, 0.0, 0.0}, {}}));
  EXPECT_EQ(errors(kRtp, {"surface.facet_tilt_arcmin=[2, -300]"}), (AngleErrors{{}, {2.0, -300.0, 0.0}}));
  for (const std::string& cube : {kHexagonal, kTriangular}) {
    EXPECT_EQ(errors(cube, {"surface.dihedral_error_arcmin=-2"}), (AngleErrors{{-2.0, -2.0, -2.0}, {}}));
    EXPECT_EQ(errors(cube, {"surface.dihedral_error_arcmin=[3]"}), (AngleErrors{{3.0, 3.0, 3.0}, {}}));
    EXPECT_EQ(errors(cube, {"surface.dihedral_error_arcmin=[1, -2, 0.5]", "surface.facet_tilt_arcmin=[4, 5, 6]"}),
              (AngleErrors{{1.0, -2.0, 0.5}, {4.0, 5.0, 6.0}}));
    EXPECT_EQ(errors(cube, {"surface.facet_tilt_arcmin=0"}), AngleErrors{});
  }
}

TEST(DesignReader, RandomTiltsNeedAFiniteArray) {
  const std::string key = "surface.angle_error_sigma_arcmin";
  const Design design = parse_design(design_of(kHexagonal, "x_length_mm = 10\ny_length_mm = 10"), "d",
                                     std::vector<std::string>{key + "=1.5", "surface.angle_error_seed=7"});
  EXPECT_EQ(design.part.random_tilts.sigma_arcmin, 1.5);
  EXPECT_EQ(design.part.random_tilts.seed, 7U);
  EXPECT_EQ(set_complaint({key + "=-1"}), "--set " + key + "=-1: " + key + ": must be >= 0 and <= 60, got -1");
  EXPECT_EQ(set_complaint({"surface.angle_error_seed=1.5"}),
            "--set surface.angle_error_seed=1.5: surface.angle_error_seed: must be a whole number >= 0 and <= "
            "4294967295, got 1.5");
  EXPECT_EQ(complaint(design_of(kRtp, "extent = \"infinite\"") + "[surface]\nangle_error_sigma_arcmin = 1"),
            "d.toml:10: " + key +
                ": must be 0 for extent = \"infinite\", whose elements are all alike; give lengths instead");
}

TEST(DesignReader, TexturesOfFacetsAreRead) {
  using Model = FacetTexture::Model;
  const auto texture = [](const std::vector<std::string>& overrides) {
    return parse_design(design_of(kRtp, "extent = \"infinite\""), "d", overrides).texture;
  };
  const FacetTexture rough = texture({"surface.roughness_sq_nm=5", "surface.correlation_length_um=2"});
  EXPECT_EQ(rough.model, Model::harvey_shack) << "usual for a roughness";
  EXPECT_EQ(rough.roughness_sq_nm, 5.0);
  EXPECT_EQ(rough.correlation_length_um, 2.0);
  EXPECT_EQ(texture({"surface.roughness_sq_nm=0"}).model, Model::smooth);
  EXPECT_EQ(texture({"surface.model=harvey_shack"}).model, Model::smooth) << "0 is the smooth answer";
  EXPECT_EQ(texture({"surface.model=abg", "surface.abg_a=1e-4", "surface.abg_b=1e-4", "surface.abg_g=2"}).model,
            Model::abg);
  const FacetTexture waves = texture({"surface.model=microfacet", "surface.waviness_sq_nm=300",
                                      "surface.waviness_length_um=80", "surface.slope_distribution=ggx"});
  EXPECT_EQ(waves.model, Model::microfacet);
  EXPECT_TRUE(waves.ggx);
  EXPECT_TRUE(texture({"surface.walls=absorbing"}).absorbing_walls);
}

TEST(DesignReader, TexturesThatSayTooLittleOrTooMuchAreRefused) {
  const auto refused = [](const std::vector<std::string>& overrides) { return set_complaint(overrides); };
  EXPECT_EQ(refused({"surface.roughness_sq_nm=5"}),
            "d.toml: surface.correlation_length_um: must be > 0 where roughness_sq_nm is given, got 0");
  EXPECT_EQ(refused({"surface.waviness_sq_nm=5"}),
            "d.toml: surface.waviness_length_um: must be > 0 where waviness_sq_nm is given, got 0");
  EXPECT_NE(refused({"surface.roughness_sq_nm=-1"}).find("must be >= 0 and <= 1e+05, got -1"), std::string::npos);
  EXPECT_NE(refused({"surface.roughness_sq_nm=rough"}).find("must be a number, got \"rough\""), std::string::npos);
  EXPECT_NE(refused({"surface.model=matt"}).find("surface.model: must be one of \"smooth\""), std::string::npos);
  EXPECT_NE(refused({"surface.model=abg"}).find("surface.abg_a: missing"), std::string::npos);
  EXPECT_NE(refused({"surface.abg_a=1"}).find("only allowed for model = \"abg\""), std::string::npos);
  EXPECT_NE(refused({"surface.slope_distribution=ggx"}).find("only allowed for model = \"microfacet\""),
            std::string::npos);
  EXPECT_NE(refused({"surface.model=smooth", "surface.roughness_sq_nm=5", "surface.correlation_length_um=2"})
                .find("surface.roughness_sq_nm: must be 0 for this model"),
            std::string::npos);
  EXPECT_NE(refused({"surface.walls=rough"}).find("surface.walls: must be one of \"smooth\" or \"absorbing\""),
            std::string::npos);
}

TEST(DesignReader, EdgesMustFitIntoTheFacets) {
  const Design design = parse_design(design_of(kRtp, "extent = \"infinite\""), "d",
                                     std::vector<std::string>{"surface.root_radius_um=5", "surface.rim_radius_um=2"});
  EXPECT_EQ(design.part.edges, (geometry::EdgeShape{5e-3, 0.0, 2e-3}));
  for (const std::string key :
       {"surface.root_radius_um", "surface.root_chamfer_um", "surface.rim_radius_um", "surface.rim_chamfer_um"})
    for (const std::string value : {"-1", "1e6", "nan", "wide"})
      EXPECT_NE(set_complaint({key + "=" + value}).find(key + ": must be "), std::string::npos)
          << set_complaint({key + "=" + value});
  EXPECT_NE(set_complaint({"surface.root_radius_um=1", "surface.root_chamfer_um=1"}).find("root_chamfer_um: must be 0"),
            std::string::npos);
  EXPECT_NE(set_complaint({"surface.rim_radius_um=1", "surface.rim_chamfer_um=1"})
                .find("surface.rim_chamfer_um: must be 0 where rim_radius_um is given"),
            std::string::npos);
  for (const std::string value : {"2", "66", "7", "8.5", "-8"})
    EXPECT_NE(set_complaint({"surface.edge_chords=" + value}).find("surface.edge_chords: must be "), std::string::npos)
        << value;
}

TEST(DesignReader, ScratchesAreThoseOfPrisms) {
  const std::string good = "facet = \"-x\", position_um = 40, width_um = 3, depth_um = 0.5";
  const auto with = [](const std::string& element, const std::string& list) {
    return design_of(element, "extent = \"infinite\"") + "[surface]\nscratches = " + list + "\n";
  };
  const std::string other = "{ facet = \"+x\", position_um = 40, width_um = 3, depth_um = -0.5 }";
  const Design design = parse_design(with(kRtp, "[{ " + good + " }, " + other + "]"), "d.toml", {});
  ASSERT_EQ(design.part.scratches.size(), 2U);
  EXPECT_EQ(design.part.scratches[0].facet, 0U);
  EXPECT_DOUBLE_EQ(design.part.scratches[0].position_mm, 0.04);
  EXPECT_EQ(design.part.scratches[1].facet, 1U);
  EXPECT_DOUBLE_EQ(design.part.scratches[1].depth_mm, -5e-4);
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string entry = good;
    return complaint(with(kRtp, "[{ " + entry.replace(entry.find(from), from.size(), to) + " }]"));
  };
  EXPECT_NE(refused("-x", "y").find("surface.scratches[1].facet: must be one of \"-x\" or \"+x\""), std::string::npos);
  EXPECT_NE(refused("40", "600").find("surface.scratches[1].position_um: must be >= "), std::string::npos);
  EXPECT_NE(refused("3,", "0,").find("surface.scratches[1].width_um: must be >= 0.01 and <= 100, got 0"),
            std::string::npos);
  EXPECT_NE(refused("0.5", "1.6").find("surface.scratches[1].depth_um: must be >= -1.5 and <= 1.5, got 1.6"),
            std::string::npos);
  EXPECT_NE(refused("depth_um = 0.5", "depth = 0.5").find("surface.scratches[1].depth_um: missing"), std::string::npos);
  EXPECT_NE(complaint(with(kRtp, "[{ " + good + " }, { " + good + " }]"))
                .find("surface.scratches[2].position_um: must keep clear of the other scratches of its facet"),
            std::string::npos);
  EXPECT_NE(complaint(with(kRtp, "3")).find("surface.scratches: must be a list of tables"), std::string::npos);
  EXPECT_NE(
      complaint(with(kHexagonal, "[{ " + good + " }]")).find("surface.scratches: only allowed for kind = \"rtp\""),
      std::string::npos);
}

TEST(DesignReader, RimsOfEveryKindAndWhatTheyNeed) {
  const auto rims = [](const std::string& element, const std::string& array, const std::string& lines) {
    return parse_design(design_of(element, array) + "[surface]\n" + lines, "d.toml", {}).part.edges;
  };
  EXPECT_EQ(rims(kHexagonal, "extent = \"infinite\"", "rim_radius_um = 1"), (geometry::EdgeShape{0.0, 0.0, 1e-3}));
  EXPECT_EQ(rims(kTriangular, "extent = \"infinite\"", "rim_chamfer_um = 2\nedge_chords = 8"),
            (geometry::EdgeShape{0.0, 0.0, 0.0, 2e-3, 8}));
  const std::string apart = "extent = \"infinite\"\nx_gap_mm = 0.01";
  EXPECT_EQ(rims(kRtp, apart, "rim_radius_um = 12"), (geometry::EdgeShape{0.0, 0.0, 12e-3}));
  // tan(22.5 degrees) 20 um on either side
  EXPECT_NE(complaint(design_of(kRtp, apart) + "[surface]\nrim_radius_um = 20")
                .find("surface.rim_radius_um: rims of that shape need an array.x_gap_mm of 0 or >= 0.0165"),
            std::string::npos);
  EXPECT_NE(complaint(design_of(kRtp, apart) + "[surface]\nrim_chamfer_um = 20")
                .find("surface.rim_chamfer_um: rims of that shape need an array.x_gap_mm of 0 or >= 0.0216"),
            std::string::npos);
  EXPECT_NE(complaint(design_of(kRtp, "arrangement = \"checker\"\nextent = \"infinite\"\ny_gap_mm = 0.001") +
                      "[surface]\nrim_radius_um = 20")
                .find("surface.rim_radius_um: rims of that shape need an array.y_gap_mm of 0 or >= 0.0082"),
            std::string::npos);
}

TEST(DesignReader, AngleErrorsThatDoNotFitAreRefused) {
  const auto refused = [](const std::string& element, const std::string& line) {
    return complaint(design_of(element, "extent = \"infinite\"") + "[surface]\n" + line);
  };
  const std::string dihedral = ": surface.dihedral_error_arcmin: ";
  const std::string tilt = ": surface.facet_tilt_arcmin: ";
  EXPECT_EQ(refused(kRtp, "dihedral_error_arcmin = [1, 2, 3]"),
            "d.toml:10" + dihedral + "must be a number, got a list");
  EXPECT_EQ(refused(kRtp, "dihedral_error_arcmin = 301"),
            "d.toml:10" + dihedral + "must be >= -300 and <= 300, got 301");
  EXPECT_EQ(refused(kHexagonal, "dihedral_error_arcmin = [1, -301, 0]"),
            "d.toml:9" + dihedral + "must be >= -300 and <= 300, got -301");
  EXPECT_EQ(refused(kHexagonal, "dihedral_error_arcmin = [1, 2]"),
            "d.toml:9" + dihedral + "must be a number or a list of three, one for each dihedral edge, got a list of 2");
  EXPECT_EQ(refused(kHexagonal, "dihedral_error_arcmin = \"1\""),
            "d.toml:9" + dihedral + "must be a number or a list of numbers, got \"1\"");
  EXPECT_EQ(refused(kRtp, "facet_tilt_arcmin = [1, 2, 3]"),
            "d.toml:10" + tilt + "must be a list of 2, one for each facet, or 0, got a list of 3");
  EXPECT_EQ(refused(kTriangular, "facet_tilt_arcmin = [1, 2]"),
            "d.toml:9" + tilt + "must be a list of 3, one for each facet, or 0, got a list of 2");
  EXPECT_EQ(refused(kTriangular, "facet_tilt_arcmin = 1"),
            "d.toml:9" + tilt + "must be a list of 3, one for each facet, or 0, got 1");
  EXPECT_EQ(refused(kTriangular, "facet_tilt_arcmin = [1, nan, 2]"),
            "d.toml:9" + tilt + "must be a finite number, got nan");
  EXPECT_EQ(refused(kRtp + "; apex_angle_deg = 119", "facet_tilt_arcmin = [30, 31]"),
            "d.toml:11" + tilt + "the apex angle with its errors must be >= 60 and <= 120, got 120.01666666666667");
  EXPECT_EQ(refused(kRtp + "; apex_angle_deg = 61", "facet_tilt_arcmin = [-30, -30]\ndihedral_error_arcmin = -60"),
            "d.toml:12" + dihedral + "the apex angle with its errors must be >= 60 and <= 120, got 59");
  EXPECT_EQ(refused(kRtp + "; apex_angle_deg = 120", "facet_tilt_arcmin = [7, -7]"), "");
  EXPECT_EQ(
      set_complaint({"surface.facet_tilt_arcmin=[1]"}),
      "--set surface.facet_tilt_arcmin=[1]" + tilt + "must be a list of 2, one for each facet, or 0, got a list of 1");
}

TEST(DesignReader, PlateMustBeThickerThanRimsStand) {
  const std::vector<std::string> errors = {"surface.facet_tilt_arcmin=[-60, 60]"};
  EXPECT_EQ(complaint(with_line(10, "thickness_mm = 0.001"), errors).substr(0, 46),
            "d.toml:10: body.thickness_mm: must be >= 0.008");
  EXPECT_EQ(complaint(with_line(10, "thickness_mm = 0.01"), errors), "");
  EXPECT_EQ(complaint(with_line(10, "thickness_mm = 1e-6")), "");
}

TEST(DesignReader, TextThatIsNotTomlIsRefusedWithItsLine) {
  EXPECT_EQ(complaint("[element]\nkind = \n").substr(0, 26), "d.toml:2: not valid TOML: ");
  EXPECT_EQ(complaint("[\n").substr(0, 26), "d.toml:1: not valid TOML: ");
  EXPECT_EQ(complaint("[element]\nkind = \"a\nb\"\n").substr(0, 26), "d.toml:2: not valid TOML: ");
  EXPECT_EQ(complaint("[element]\n[element]\n").substr(0, 26), "d.toml:2: not valid TOML: ");
  EXPECT_EQ(complaint("a = 1e999\n").substr(0, 26), "d.toml:1: not valid TOML: ");
  EXPECT_EQ(complaint("title = \"\xff\"\n"), "d.toml:1: not valid TOML: Encountered invalid utf-8 sequence");
  EXPECT_NE(complaint(std::string("a = \0 1\n", 8)), "");
}

TEST(DesignReader, TextOfAbsurdLengthOrDepthIsRefused) {
  EXPECT_EQ(complaint(std::string(70000, '\n')), "d.toml: too long for a design file, at most 16384 bytes are allowed");
  std::string deep;
  for (int i = 0; i < 8100; ++i) deep += "a.";
  EXPECT_EQ(complaint(deep + "a=1\n").substr(0, 24), "d.toml:1: a: unknown tab");
  EXPECT_NE(complaint("x = " + std::string(16000, '[')), "");
}

TEST(DesignReader, MessagesShowControlCharactersEscapedAndStayShort) {
  EXPECT_EQ(complaint(with_line(2, "kind = \"a\\nb\\u001bc\\u0085\"")),
            "d.toml:2: element.kind: must be one of \"rtp\", \"hexagonal_icc\", \"triangular_icc\" or \"ball\", got "
            "\"a\\nb\\x1bc\\xc2\\x85\"");
  EXPECT_LT(complaint(with_line(2, "kind = \"" + std::string(5000, 'x') + "\"")).size(), 250U);
  EXPECT_LT(complaint(with_line(3, std::string(5000, 'x') + " = 1")).size(), 300U);  // with the keys there are
}

TEST(DesignReader, OverridesTakePrecedenceAndTheLastOneWins) {
  const Design design = set({"element.base_mm=0.3", "array.arrangement=aligned", "title=\"two words\"",
                             "array.x_length_mm = 12", "element.base_mm=0.4"});
  EXPECT_EQ(std::get<RtpElement>(design.part.element).base_mm, 0.4);
  EXPECT_EQ(design.part.arrangement, Arrangement::aligned);
  EXPECT_EQ(design.part.x_length_mm, 12.0);
  EXPECT_EQ(design.title, "two words");
  EXPECT_EQ(set({"array.arrangement=\"aligned\""}).part.arrangement, Arrangement::aligned);
  EXPECT_EQ(set({"title=Part #3 \"new\" \\ old"}).title, "Part #3 \"new\" \\ old");
  EXPECT_EQ(set({"detector.acceptance_half_angle_deg=[1,2]"}).acceptance_half_angle_deg, (std::vector<double>{1, 2}));
  EXPECT_EQ(set({"body={material=\"PC\"}"}).part.thickness_mm, 2.0);
  EXPECT_EQ(set({"body.material=PC"}).material_location.file, "--set body.material=PC");
}

TEST(DesignReader, AnOverrideMendsAFileThatIsWrongThere) {
  EXPECT_EQ(complaint(with_line(3, "base_mm = -1"), {"element.base_mm=1"}), "");
}

TEST(DesignReader, ErrorsInOverridesNameTheOverride) {
  EXPECT_EQ(set_complaint({"element.base_mm=0"}), "--set element.base_mm=0: element.base_mm: must be > 0, got 0");
  EXPECT_EQ(set_complaint({"element.base_mm=0.4mm"}),
            "--set element.base_mm=0.4mm: element.base_mm: must be a number, got \"0.4mm\"");
  EXPECT_EQ(set_complaint({"element.base_mm="}), "--set element.base_mm=: element.base_mm: must be a number, got \"\"");
  EXPECT_EQ(set_complaint({"elemnt.base_mm=1"}),
            "--set elemnt.base_mm=1: elemnt: unknown table, did you mean \"element\"? (allowed: element, array, body, "
            "light, detector, surface, base, part, front, idealisation)");
  EXPECT_EQ(set_complaint({"element=3"}), "--set element=3: element: must be a table, got 3");
  const std::string form = ": must be of the form KEY=VALUE, such as element.base_mm=0.5";
  for (const std::string text : {"", "x", "=3", "[body]", "# x", "a b=3"})
    EXPECT_EQ(set_complaint({text}), "--set " + text + form) << text;
  EXPECT_EQ(set_complaint({"title=a\nb=1"}), "--set title=a\\nb=1: must be one line of the form KEY=VALUE");
  EXPECT_EQ(set_complaint({"a..b=x"}).substr(0, 31), "--set a..b=x: not valid TOML: E");
  EXPECT_EQ(set_complaint({"title=\xff"}).substr(0, 33), "--set title=\\xff: not valid TOML:");
}

TEST(DesignReader, UnreadablePathsAreRefused) {
  const auto refused = [](const fs::path& path) -> std::string {
    try {
      read_design(path);
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refused("no/such.toml"), "no/such.toml: cannot be read: No such file or directory");
  EXPECT_EQ(refused("/"), "/: cannot be read: it is a folder");
  EXPECT_EQ(refused("/dev/zero"), "/dev/zero: too long for a design file, at most 16384 bytes are allowed");
  EXPECT_EQ(refused("/dev/null").substr(0, 24), "/dev/null: element.kind:");
}

/// Stands in for standard input while it lives.
class StandardInput {
 public:
  explicit StandardInput(const std::string& text) : stream_(text), before_(std::cin.rdbuf(stream_.rdbuf())) {}
  ~StandardInput() {
    std::cin.rdbuf(before_);
    std::cin.clear();
  }
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

 private:
  std::istringstream stream_;
  std::streambuf* before_;
};

TEST(DesignReader, DashIsStandardInput) {
  {
    const StandardInput input(joined(kLines));
    EXPECT_EQ(read_design("-").source, "-");
  }
  const StandardInput input(with_line(3, "base_mm = -3"));
  try {
    read_design("-");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "standard input:3: element.base_mm: must be > 0, got -3");
  }
}

TEST(DesignReader, EveryExampleIsValid) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(RETRACE_SOURCE_DIR) / "examples")) {
    if (entry.path().extension() != ".toml") continue;
    std::ifstream stream(entry.path());
    std::stringstream text;
    text << stream.rdbuf();
    // Studies and jobs live in the same folder; a design says so or says nothing.
    if (text.str().find("schema = \"retrace.design/1\"") == std::string::npos) continue;
    ++count;
    EXPECT_NO_THROW(read_design(entry.path())) << entry.path();
    EXPECT_EQ(text.str().substr(0, 2), "# ") << entry.path() << " has no head that says what it is";
  }
  EXPECT_GE(count, 9);
}

TEST(InitTemplates, EveryKindParsesAndIsCommented) {
  ASSERT_EQ(design_kinds().size(), 3U);
  for (const std::string_view kind : design_kinds()) {
    const std::string text = design_template(kind);
    EXPECT_NO_THROW(parse_design(text, "t.toml", {})) << kind;
    EXPECT_EQ(text.substr(0, 2), "# ");
  }
  EXPECT_TRUE(std::holds_alternative<RtpElement>(parse_design(design_template("rtp"), "t", {}).part.element));
  EXPECT_TRUE(
      std::holds_alternative<HexagonalCube>(parse_design(design_template("hexagonal_icc"), "t", {}).part.element));
  EXPECT_TRUE(
      std::holds_alternative<TriangularCube>(parse_design(design_template("triangular_icc"), "t", {}).part.element));
}

/// The lines that show a default must be valid when their "#" is taken away.
TEST(InitTemplates, CommentedDefaultsAreValidAndTheDefaults) {
  for (const std::string_view kind : design_kinds()) {
    std::istringstream lines(design_template(kind));
    std::string text;
    int uncommented = 0;
    for (std::string line; std::getline(lines, line);) {
      const bool is_setting = line.substr(0, 2) == "# " && (line.find(" = ") != std::string::npos || line[2] == '[');
      const bool needs_more =
          line.find("refractive_index") != std::string::npos || line.find("absorption") != std::string::npos;
      uncommented += is_setting ? 1 : 0;
      text += (is_setting && !needs_more ? line.substr(2) : line) + "\n";
    }
    EXPECT_GT(uncommented, 5);
    EXPECT_NO_THROW(parse_design(text, "t.toml", {})) << text;
  }
}

TEST(InitTemplates, UnknownKindIsRefused) {
  try {
    design_template("cube");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "KIND must be one of \"rtp\", \"hexagonal_icc\" or \"triangular_icc\", got \"cube\"");
  }
}

/// Whatever the text is, the reader returns or throws an InputError of one line; anything else fails the test.
void expect_graceful(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    parse_design(text, "d.toml", overrides);
  } catch (const InputError& error) {
    RC_ASSERT(std::string(error.what()).find('\n') == std::string::npos);
  }
}

TEST(DesignReader, ArbitraryBytesNeverCrash) {
  EXPECT_TRUE(rc::check("bytes", [](const std::string& text) { expect_graceful(text, {}); }));
  EXPECT_TRUE(rc::check("override", [](const std::string& text) {
    expect_graceful(joined(kLines), {text});
    expect_graceful(joined(kLines), {"element.base_mm=" + text});
  }));
}

TEST(DesignReader, DamagedDesignsNeverCrash) {
  EXPECT_TRUE(rc::check("a valid design with one stretch replaced", [] {
    std::string text = design_template("rtp");
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto length = *rc::gen::inRange<std::size_t>(0, 20);
    text.replace(at, length, *rc::gen::arbitrary<std::string>());
    expect_graceful(text, {});
  }));
}

}  // namespace
}  // namespace retrace::studies
